#include "tools/cli/job_watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

namespace kinebus {
namespace {

using joblink::Event;
using joblink::Status;
constexpr int kBarWidth = 32;

/// One line that is written over on a terminal; elsewhere a line every ten per cent, and one a minute.
class ProgressLine {
 public:
  void show(double fraction, const std::string& text) {
    const int filled = static_cast<int>(std::lround(std::clamp(fraction, 0.0, 1.0) * kBarWidth));
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
    if (terminal_) {
      fmt::print("\r[{}] {:5.1f} %  {}\033[K", bar, 100 * fraction, text);
      open_ = true;
    } else if (const int tenth = static_cast<int>(fraction * 10);
               tenth != last_tenth_ || Clock::now() - printed_ >= kMinute) {
      last_tenth_ = tenth;
      printed_ = Clock::now();
      fmt::print("[{}] {:5.1f} %  {}\n", bar, 100 * fraction, text);
    }
    std::fflush(stdout);
  }
  void end() {
    if (open_) fmt::print("\n");
    open_ = false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::minutes kMinute{1};
  bool terminal_ = ::isatty(STDOUT_FILENO) != 0;
  bool open_ = false;
  int last_tenth_ = -1;
  Clock::time_point printed_{};
};

void print_event(const Event& event) {
  switch (event.kind()) {
    case joblink::EVENT_ALARM:
      fmt::print("ALARM {}\n      {}\n", event.words(), event.advice());
      break;
    case joblink::EVENT_PROBLEM:
      fmt::print("line {}: {}\n", event.line(), event.words());
      break;
    case joblink::EVENT_MESSAGE:
    case joblink::EVENT_FINISHED:
      fmt::print("{}\n", event.words());
      break;
    default:
      break;
  }
}

/// So long a daemon may be silent before that is said, and before it is given up: one that has ended closes
/// the link, so what is silent on a busy computer has only to wait.
constexpr std::chrono::seconds kSaidAfter{10}, kGivenUpAfter{120};

/// What became of a job, by the events of it that were seen.
struct JobEnd {
  bool ran = false;
  bool finished = false;  ///< the last word was that it was done, or that it was not begun
  void note(const Event& event) {
    if (event.kind() == joblink::EVENT_FINISHED) finished = true;
    if (event.kind() != joblink::EVENT_STATE || event.state() == joblink::STATE_READY) return;
    finished = false;
    ran = ran || event.state() == joblink::STATE_RUNNING;
  }
};

/// The next status; events that come before it are printed.
Status next_status(Client& client, ProgressLine& line, JobEnd* end = nullptr) {
  std::chrono::seconds silent{0};
  for (;;) {
    const auto report = client.next(kSaidAfter);
    if (!report) {
      silent += kSaidAfter;
      if (silent >= kGivenUpAfter) throw ClientError("the daemon has gone silent");
      line.end();
      fmt::print(stderr, "the daemon does not answer yet; what it prints goes on without this command\n");
      continue;
    }
    silent = {};
    if (const auto* status = std::get_if<Status>(&*report)) return *status;
    line.end();
    if (end != nullptr) end->note(std::get<Event>(*report));
    print_event(std::get<Event>(*report));
  }
}

/// The same of one heater, by its name.
joblink::Heater next_heater(Client& client, ProgressLine& line, const std::string& name) {
  const Status status = next_status(client, line);
  const auto found = std::find_if(status.heaters().begin(), status.heaters().end(),
                                  [&](const joblink::Heater& h) { return h.name() == name; });
  if (found == status.heaters().end()) throw ClientError("the daemon tells nothing of " + name);
  return *found;
}

/// Follows statuses and events until `done(status)`; returns the last status.
template <typename Done>
Status follow(Client& client, ProgressLine& line, Done done, JobEnd* end = nullptr) {
  for (;;) {
    Status status = next_status(client, line, end);
    if (!status.job().empty())
      line.show(status.progress(), fmt::format("line {}  {}  {} to go", status.line(), status.doing(),
                                               time_words(status.remaining_s())));
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

int wait_until_rest(Client& client, const std::function<bool(const Status&)>& good) {
  ProgressLine line;
  const Status status = follow(client, line, [](const Status& s) { return s.at_rest(); });
  return good(status) ? 0 : 1;
}

int wait_for_heat(Client& client, const std::string& heater, double celsius) {
  using Clock = std::chrono::steady_clock;
  constexpr double kWindow = 2;  // K
  constexpr auto kSettle = std::chrono::seconds{2}, kTaken = std::chrono::seconds{5};
  ProgressLine line;
  std::optional<double> from;
  bool taken = false;
  const auto asked = Clock::now();
  auto outside = asked;
  for (;;) {
    joblink::Heater found = next_heater(client, line, heater);
    const auto now = Clock::now();
    const double actual = found.actual_celsius();
    // A status may be older than what was asked.
    if (std::abs(found.target_celsius() - celsius) > 0.1) {
      if (!taken && now - asked < kTaken) continue;
      line.end();
      fmt::print(stderr, "kinebus: the {} is to be at {:.0f} C by now, not at {:.0f} C\n", heater,
                 found.target_celsius(), celsius);
      return 1;
    }
    taken = true;
    if (!from) from = actual;
    if (std::abs(actual - celsius) > kWindow) outside = now;
    const double way = celsius - *from;
    line.show(way == 0 ? 1 : (actual - *from) / way,
              fmt::format("{} {:.1f} / {:.0f} C", heater, actual, celsius));
    if (now - outside < kSettle) continue;
    line.end();
    return 0;
  }
}

joblink::Heater watch_tuning(Client& client, const std::string& heater) {
  ProgressLine line;
  std::optional<double> from;
  double shown = 0;
  bool runs = false;
  const auto asked = std::chrono::steady_clock::now();
  for (;;) {
    joblink::Heater found = next_heater(client, line, heater);
    const joblink::HeaterTuning& tuning = found.tuning();
    const bool over = tuning.stage() == joblink::TUNING_DONE || tuning.stage() == joblink::TUNING_FAILED;
    // A status may be older than what was asked.
    runs = runs || (!over && tuning.stage() != joblink::TUNING_NONE);
    const bool new_by_now = std::chrono::steady_clock::now() - asked > std::chrono::seconds{2};
    if (over && (runs || new_by_now)) {
      line.end();
      return found;
    }
    if (!from) from = found.actual_celsius();
    // Full power for half of the way, then about as long without: the second half has no number of its own.
    const double half = std::max(1.0, (tuning.celsius() - *from) / 2);
    if (tuning.stage() == joblink::TUNING_HEATS)
      shown = std::clamp((found.actual_celsius() - *from) / half, 0.0, 1.0) / 2;
    line.show(shown, fmt::format("{} {:.1f} C  {}", heater, found.actual_celsius(),
                                 tuning.stage() == joblink::TUNING_HEATS ? "full power" : "off, its curve"));
  }
}

int watch_job(Client& client) {
  ProgressLine line;
  JobEnd end;
  bool rests = false;
  const Status status = follow(
      client, line,
      [&end, &rests](const Status& s) {
        end.ran = end.ran || s.state() == joblink::STATE_RUNNING;
        const bool rested = std::exchange(rests, s.at_rest() && s.state() != joblink::STATE_HELD);
        // A status may come before the events of the same moment: the next one is behind them.
        return rests && (end.finished || rested);
      },
      &end);
  const bool refused = end.finished && !end.ran, given_up = end.ran && !end.finished;
  return status.state() == joblink::STATE_READY && !refused && !given_up ? 0 : 1;
}

std::string upload_job(Client& client, const std::string& file) {
  std::string name = std::filesystem::path(file).filename().string();
  ProgressLine line;
  client.upload(file, name, [&](std::uint64_t received, std::uint64_t all) {
    line.show(static_cast<double>(received) / static_cast<double>(std::max<std::uint64_t>(all, 1)),
              "sending " + name);
  });
  line.end();
  return name;
}

int run_job(Client& client, const std::string& file, bool detach) {
  std::error_code error;
  const std::string name = std::filesystem::is_regular_file(file, error) ? upload_job(client, file) : file;
  joblink::ClientMessage request;
  request.mutable_start_job()->set_name(name);
  client.ask(std::move(request));
  // The job runs on the gateway: whoever wants to hold it may do so while this program only shows it.
  client.release_control();
  if (detach) {
    fmt::print("{} has started; 'kinebus watch' shows it\n", name);
    return 0;
  }
  return watch_job(client);
}

}  // namespace kinebus
