#include "tools/cli/console_session.hpp"

#include <editline/readline.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "tools/cli/job_watch.hpp"

namespace kinebus {
namespace {

constexpr char kPrompt[] = "kinebus> ";
constexpr int kHistoryLines = 1000;
constexpr auto kLook = std::chrono::milliseconds{30};  ///< for news of the gateway, between keys

std::string trimmed(const std::string& line) {
  const auto from = line.find_first_not_of(" \t\r");
  return from == std::string::npos ? "" : line.substr(from, line.find_last_not_of(" \t\r") - from + 1);
}

bool ends(const std::string& line) {
  return line == "quit" || line == "exit";
}

/// Empty: there is no place for it.
std::filesystem::path history_file() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state != nullptr && *state != '\0') return std::filesystem::path(state) / "kinebus" / "console_history";
  if (home == nullptr || *home == '\0') return {};
  return std::filesystem::path(home) / ".local" / "state" / "kinebus" / "console_history";
}

/// Of this session and those before.
class History {
 public:
  History() : file_(history_file()) {
    ::using_history();
    ::stifle_history(kHistoryLines);
    if (!file_.empty()) ::read_history(file_.c_str());
  }
  ~History() {
    if (file_.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(file_.parent_path(), error);
    if (!error) ::write_history(file_.c_str());
  }
  History(const History&) = delete;
  History& operator=(const History&) = delete;

 private:
  std::filesystem::path file_;
};

/// The terminal's line, edited while the gateway is listened to. One at a time: the library keeps its state
/// in globals.
class LineEditor {
 public:
  LineEditor() {
    at_work = this;
    ::rl_callback_handler_install(kPrompt, &LineEditor::take);
  }
  ~LineEditor() {
    ::rl_callback_handler_remove();
    at_work = nullptr;
  }
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  /// Takes the keys that were pressed.
  void read_keys() {
    pollfd keys{STDIN_FILENO, POLLIN, 0};
    while (lines_.empty() && !ended_ && ::poll(&keys, 1, 0) > 0) ::rl_callback_read_char();
  }
  bool ended() const { return ended_; }
  bool has_line() const { return !lines_.empty(); }
  std::string next_line() {
    std::string line = std::move(lines_.front());
    lines_.pop_front();
    return line;
  }
  /// Words that come between stand above the line at work.
  static void print_above(const std::string& words) {
    fmt::print("\r\033[K{}\n", words);
    std::fflush(stdout);
    ::rl_forced_update_display();
  }

 private:
  static void take(char* text) {
    const std::unique_ptr<char, decltype(&std::free)> owned(text, &std::free);
    if (text == nullptr) {
      at_work->ended_ = true;
      return;
    }
    std::string line = trimmed(text);
    if (line.empty()) return;
    ::add_history(line.c_str());
    at_work->lines_.push_back(std::move(line));
  }

  static inline LineEditor* at_work = nullptr;
  std::deque<std::string> lines_;
  bool ended_ = false;
};

void print_news(const Client::Report& report) {
  const auto* event = std::get_if<joblink::Event>(&report);
  if (event == nullptr) return;
  if (event->kind() == joblink::EVENT_ALARM)
    LineEditor::print_above("ALARM " + event->words() +
                            (event->advice().empty() ? "" : ": " + event->advice()));
  else if (event->kind() == joblink::EVENT_MESSAGE)
    LineEditor::print_above(event->words());
}

/// Control is given back: others may command the machine while this one thinks.
void carry_out(Client& client, const std::string& line) {
  try {
    static_cast<void>(console_line(client, line, true));
  } catch (const ClientError& error) {
    fmt::print("refused: {}\n", error.what());
  }
  client.release_control();
}

int on_a_terminal(Client& client) {
  fmt::print("G-code and M-codes, a line each; 'quit' or Ctrl-D ends.\n");
  std::fflush(stdout);
  const History history;
  for (;;) {
    std::string line;
    {
      LineEditor editor;
      while (!editor.has_line() && !editor.ended()) {
        if (const auto report = client.next(kLook)) print_news(*report);
        editor.read_keys();
      }
      if (!editor.has_line()) break;
      line = editor.next_line();
    }
    if (ends(line)) return 0;
    carry_out(client, line);
  }
  fmt::print("\n");
  return 0;
}

int from_a_pipe(Client& client) {
  std::string text;
  for (int number = 1; std::getline(std::cin, text); ++number) {
    const std::string line = trimmed(text);
    if (line.empty()) continue;
    if (ends(line)) return 0;
    try {
      if (console_line(client, line, true) != 0) return 1;
    } catch (const ClientError& error) {
      throw ClientError(fmt::format("line {}: {}", number, error.what()));
    }
  }
  return 0;
}

}  // namespace

int console_line(Client& client, const std::string& line, bool wait) {
  joblink::ClientMessage request;
  request.mutable_console()->set_line(line);
  const std::string answer = client.ask(std::move(request)).console().text();
  if (!answer.empty()) fmt::print("{}\n", answer);
  std::fflush(stdout);
  return wait ? wait_until_rest(client, [](const joblink::Status&) { return true; }) : 0;
}

int console_session(Client& client) {
  return ::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0 ? on_a_terminal(client)
                                                                     : from_a_pipe(client);
}

}  // namespace kinebus
