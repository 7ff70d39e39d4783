#include "tools/cli/job_watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace kinebus {
namespace {

using nlohmann::json;
constexpr int kBarWidth = 32;

/// One line that is written over on a terminal, and a line every ten per cent elsewhere.
class ProgressLine {
 public:
  void show(double fraction, const std::string& text) {
    const int filled = static_cast<int>(std::lround(std::clamp(fraction, 0.0, 1.0) * kBarWidth));
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
    if (terminal_) {
      fmt::print("\r[{}] {:5.1f} %  {}\033[K", bar, 100 * fraction, text);
      open_ = true;
    } else if (const int tenth = static_cast<int>(fraction * 10); tenth != last_tenth_) {
      last_tenth_ = tenth;
      fmt::print("[{}] {:5.1f} %  {}\n", bar, 100 * fraction, text);
    }
    std::fflush(stdout);
  }
  void end() {
    if (open_) fmt::print("\n");
    open_ = false;
  }

 private:
  bool terminal_ = ::isatty(STDOUT_FILENO) != 0;
  bool open_ = false;
  int last_tenth_ = -1;
};

void print_event(const json& event) {
  const std::string kind = event.value("kind", "");
  const std::string words = event.value("words", "");
  if (kind == "alarm")
    fmt::print("ALARM {}\n      {}\n", words, event.value("advice", ""));
  else if (kind == "problem")
    fmt::print("line {}: {}\n", event.value("line", 0), words);
  else if (kind == "message" || kind == "finished")
    fmt::print("{}\n", words);
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw ClientError(path + ": cannot be read");
  return std::move(text).str();
}

void upload(Client& client, const std::string& file, const std::string& name) {
  const std::string text = read_file(file);
  ProgressLine line;
  const json reply = client.ask_with_bytes({{"do", "upload"}, {"name", name}}, text, [&](std::size_t sent) {
    line.show(static_cast<double>(sent) / static_cast<double>(std::max<std::size_t>(text.size(), 1)),
              "sending " + name);
  });
  line.end();
  if (!reply.value("ok", false)) throw ClientError("upload: " + reply.value("error", "failed"));
}

/// Follows statuses and events until `done(status)`; returns the last status.
template <typename Done>
json follow(Client& client, ProgressLine& line, Done done) {
  for (;;) {
    const json message = client.next(10'000);
    if (message.is_null()) throw ClientError("the daemon has gone silent");
    if (message.contains("event")) {
      line.end();
      print_event(message["event"]);
    }
    if (!message.contains("status")) continue;
    const json& status = message["status"];
    if (!status.value("job", "").empty())
      line.show(status.value("progress", 0.0),
                fmt::format("line {}  {}  {} to go", status.value("line", 0), status.value("doing", ""),
                            time_words(status.value("remaining_s", 0.0))));
    if (done(status)) {
      line.end();
      return status;
    }
  }
}

}  // namespace

std::string time_words(double seconds) {
  const long whole = std::lround(std::max(0.0, seconds));
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

int wait_until_rest(Client& client, const std::function<bool(const json&)>& good) {
  ProgressLine line;
  const json status = follow(client, line, [](const json& s) { return s.value("at_rest", false); });
  return good(status) ? 0 : 1;
}

int watch_job(Client& client) {
  ProgressLine line;
  const json status = follow(
      client, line, [](const json& s) { return s.value("at_rest", false) && !s.value("held", false); });
  return status.value("ready", false) ? 0 : 1;
}

int run_job(Client& client, const std::string& file, bool detach) {
  std::string name = file;
  if (std::filesystem::exists(file)) {
    name = std::filesystem::path(file).filename().string();
    upload(client, file, name);
  }
  client.ask({{"do", "watch"}, {"hz", 5}});
  // Events that come before the reply (pre-flight problems) are kept for the reader.
  client.on_news = [](const json& message) {
    if (message.contains("event")) print_event(message["event"]);
  };
  const json reply = client.ask({{"do", "run"}, {"name", name}});
  if (!reply.value("ok", false)) throw ClientError(reply.value("error", "the job was refused"));
  if (detach) {
    fmt::print("{} has started; 'kinebus watch' shows it\n", name);
    return 0;
  }
  return watch_job(client);
}

}  // namespace kinebus
