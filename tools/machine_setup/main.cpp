// kinebus-setup: from boards as they come to a machine that prints.

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <array>
#include <csignal>
#include <filesystem>

#include "gateway/description/machine_file.hpp"
#include "protocol/host/can_interface.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/patient_can.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/host/usage.hpp"
#include "tools/cli/shell_words.hpp"
#include "tools/machine_setup/boards_report.hpp"
#include "tools/machine_setup/walk.hpp"

namespace {

using namespace kinebus;

volatile std::sig_atomic_t interrupted = 0;

BusAccess bus_of(SocketCan& can) {
  return {.send = [&can](const CanFrame& frame) { send_or_throw(can, frame); },
          .receive = [&can](LocalTime until) { return receive_until(can, until); },
          .now = monotonic_now};
}

/// Empty: the interface is open and nothing is in the way.
std::string open_bus(SocketCan& can, const std::string& interface, std::vector<std::string>& advices) {
  if (const auto kernel = ask_kernel(interface)) {
    if (std::string words = obstacle(interface, *kernel); !words.empty()) return words;
    advices = advice(interface, *kernel);
  }
  return can.open(interface, false);
}

int list_boards(const std::string& interface, bool json) {
  BoardsReport report{.interface = interface};
  SocketCan can;
  report.bus_trouble = open_bus(can, interface, report.advices);
  if (report.bus_trouble.empty()) try {
      const BusAccess bus = bus_of(can);
      NodeIds ids(bus, {});
      if (ids.gateway_speaks())
        report.bus_trouble = fmt::format(
            "a gateway runs on {}: kinebus status tells of its nodes; stop it to ask the boards themselves "
            "(systemctl stop kinebusd)",
            interface);
      else
        report.bus = find_bus_boards(bus, ids);
    } catch (const std::runtime_error& error) {
      report.bus_trouble = error.what();
    }
  report.usb = find_usb_boards();
  fmt::print("{}", json ? as_json(report) : as_text(report));
  return report.bus_trouble.empty() && board_troubles(report.bus).empty() ? 0 : 1;
}

/// A line of standard input; nullopt: it has ended, or Ctrl-C.
std::optional<std::string> read_line() {
  static std::string buffer;
  for (;;) {
    if (const std::size_t end = buffer.find('\n'); end != std::string::npos) {
      const std::string line = buffer.substr(0, end);
      buffer.erase(0, end + 1);
      // Without a person at the keyboard the answer would not stand in the record.
      if (::isatty(STDIN_FILENO) == 0) fmt::print("{}\n", line);
      return line;
    }
    pollfd wait{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&wait, 1, 200);
    if (interrupted != 0) return std::nullopt;
    if (ready <= 0) continue;
    std::array<char, 512> bytes{};
    const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count <= 0) return std::nullopt;
    buffer.append(bytes.data(), static_cast<std::size_t>(count));
    constexpr std::size_t kLongestLine = 4096;
    if (buffer.size() > kLongestLine && buffer.find('\n') == std::string::npos) buffer.resize(kLongestLine);
  }
}

/// kinebus-flash, that beside this program or that in PATH.
bool flash(const std::string& interface, const std::string& image, const std::vector<std::uint8_t>& nodes,
           bool other_kind) {
  std::error_code code;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", code).parent_path() / "kinebus-flash";
  std::vector<std::string> words{std::filesystem::exists(beside, code) ? beside.string() : "kinebus-flash",
                                 image, "-i", interface};
  for (const std::uint8_t node : nodes) words.insert(words.end(), {"-n", std::to_string(node)});
  if (other_kind) words.emplace_back("--force");
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(stdout);
  pid_t pid = 0;
  if (::posix_spawnp(&pid, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) {
    fmt::print("kinebus-flash cannot be run: it comes with the same package as kinebus-setup\n");
    return false;
  }
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int walk_through(const WalkOptions& options, const std::string& programs) {
  SocketCan can;
  std::vector<std::string> advices;
  if (const std::string trouble = open_bus(can, options.interface, advices); !trouble.empty())
    return fmt::print(stderr, "{}\n", trouble), 1;
  for (const std::string& words : advices) fmt::print("{}\n", words);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { interrupted = 1; });
  std::signal(SIGPIPE, SIG_IGN);  // a terminal that goes away must not leave a motor on
  SetupHost host{.bus = bus_of(can),
                 .io = {.read_line = read_line,
                        .print =
                            [](std::string_view words) {
                              fmt::print("{}", words);
                              std::fflush(stdout);
                            }},
                 .interrupted = [] { return interrupted != 0; },
                 .flash = [&](const std::string& image, const std::vector<std::uint8_t>& nodes,
                              bool other_kind) { return flash(options.interface, image, nodes, other_kind); },
                 .usb = find_usb_boards,
                 .programs = programs};
  return walk(host, options);
}

std::vector<std::string> words_of(std::span<const SetupChoice> choices) {
  std::vector<std::string> words;
  for (const SetupChoice& choice : choices) words.emplace_back(choice.word);
  return words;
}

/// The place of a word that was checked before.
template <typename Enum>
Enum chosen(std::span<const SetupChoice> choices, const std::string& word) {
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].word == word) return static_cast<Enum>(i);
  throw std::logic_error("unknown word " + word);
}

int run(int argc, char** argv) {
  CLI::App app(
      "kinebus-setup: lists the boards on bus and USB, and leads through the first set-up of a machine: "
      "ids,\n"
      "machine file, and a test of each motor, switch, fan and heater.",
      "kinebus-setup");
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", KINEBUS_VERSION);
  WalkOptions options;
  app.add_option("-i,--interface", options.interface, "SocketCAN interface")->capture_default_str();
  bool json = false;
  auto* boards =
      app.add_subcommand("boards", "Every board on the bus and on USB, and what is wrong with them");
  boards->add_flag("--json", json, "As JSON");
  auto* walk_command =
      app.add_subcommand("walk", "Questions and answers, from boards as they come to a tested machine file");
  std::string file = "machine.toml", programs = ".", machine = "m1", set = "octopus+ebb";
  walk_command->add_option("-f,--file", file, "The machine file that is written; answers are kept beside it")
      ->capture_default_str();
  walk_command->add_option("--programs", programs, "The folder that has the boards' programs, kinebus-*.bin")
      ->capture_default_str();
  walk_command->add_flag("--anew", options.anew, "Forget the answers of an earlier time");
  FirstMachine first;
  int heat_node = 0;
  auto* file_command = app.add_subcommand("file", "The first machine file alone, on standard output");
  file_command->add_option("-m,--machine", machine, "Which machine")
      ->check(CLI::IsMember(words_of(setup_machines())))
      ->capture_default_str();
  file_command->add_option("-b,--boards", set, "Which boards")
      ->check(CLI::IsMember(words_of(board_sets())))
      ->capture_default_str();
  file_command->add_option("--heat-node", heat_node, "Of cards: id of the heat node; 0: there is none")
      ->check(CLI::Range(0, 126));
  file_command->add_flag("--probe", first.probe, "There is a probe");
  add_shell_words(app, KINEBUS_VERSION);
  if (const auto end = parse_arguments(app, argc, argv)) return *end;
  if (*boards) return list_boards(options.interface, json);
  if (*walk_command) return options.file = file, walk_through(options, programs);
  if (*file_command) {
    first.machine = chosen<SetupMachine>(setup_machines(), machine);
    first.boards = chosen<BoardSet>(board_sets(), set);
    first.heat_node = static_cast<std::uint8_t>(heat_node);
    first.interface = options.interface;
    const std::string text = file_text(first, make_description(first));
    if (const auto read = parse_machine(text, "file"); !read)
      return fmt::print(stderr, "{}", to_string(read.error())), 1;
    fmt::print("{}", text);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-setup", [&] { return run(argc, argv); });
}
