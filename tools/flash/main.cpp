// kinebus-flash: new programs for nodes: over CAN with progress, or by the standard tools for USB and SWD.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <stdexcept>
#include <vector>

#include "node_firmware/boot/boot_loader.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/patient_can.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/host/usage.hpp"
#include "tools/flash/console_request.hpp"
#include "tools/flash/program_file.hpp"
#include "tools/flash/program_update.hpp"
#include "tools/node_id/node_ids.hpp"

namespace {

using namespace kinebus;
using namespace std::chrono_literals;

struct Arguments {
  std::string image, interface = "can0", console;
  std::vector<int> nodes;
  bool all = false, force = false, protect = false, yes = false, dfu = false, swd = false;
  double answer_s = 6, revision = 0;
};

LocalTime answer_time(const Arguments& arguments) {
  return LocalTime{std::llround(arguments.answer_s * 1e9)};
}

/// Frames until `end`, or until `done` says so.
template <typename OnFrame, typename Done>
void receive_until(SocketCan& can, LocalTime end, OnFrame on_frame, Done done) {
  for (LocalTime now = monotonic_now(); now < end && !done(); now = monotonic_now()) {
    pollfd wait{.fd = can.fd(), .events = POLLIN, .revents = 0};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now).count();
    ::poll(&wait, 1, static_cast<int>(std::min<std::int64_t>(left, 100)));
    while (const auto got = can.receive())
      if (got->kind == SocketCan::Kind::kFrame) on_frame(got->when, got->frame);
  }
}

/// By which nodes the boards of these take their programs.
std::set<std::uint8_t> boards_of(SocketCan& can, const std::set<std::uint8_t>& nodes, LocalTime answer) {
  NodeIds ids({.send = [&](const CanFrame& frame) { send_or_throw(can, frame); },
               .receive = [&](LocalTime until) { return receive_until(can, until); },
               .now = monotonic_now},
              {.answer = answer});
  std::set<std::uint8_t> boards = NodeIds::boards_of(ids.find_configured(), nodes);
  for (const std::uint8_t node : nodes)
    if (!boards.contains(node))
      fmt::print("node {} is of a board with several nodes: the first of them takes the program for all\n",
                 node);
  return boards;
}

/// Whoever answers to a question for its program.
std::set<std::uint8_t> find_nodes(SocketCan& can, LocalTime within) {
  std::set<std::uint8_t> found;
  for (std::uint8_t id = 1; id < 127; ++id) {
    const CanFrame question = sdo::frame_of(cob_id::kSdoRequest + id, 0x40, {0x1F51, 1});
    for (const CanFrame& frame : {end_of_transfer(id), question})
      if (const std::string error = can.send_patiently(frame); !error.empty())
        throw std::runtime_error(error);
  }
  receive_until(
      can, monotonic_now() + within,
      [&](LocalTime, const CanFrame& frame) {
        const std::uint32_t id = frame.id - cob_id::kSdoReply;
        if (id >= 1 && id < 127 && frame.length == 8 && sdo::specifier(frame) == sdo::kReplyInitiateUpload)
          found.insert(static_cast<std::uint8_t>(id));
      },
      [] { return false; });
  return found;
}

bool update(SocketCan& can, std::uint8_t node, const std::vector<std::uint8_t>& image,
            const Arguments& arguments) {
  const LocalTime began = monotonic_now();
  ProgramUpdate::Options options;
  options.even_if_same = arguments.force;
  options.other_kind = arguments.force && !arguments.all;
  options.protect = arguments.protect;
  options.record_revision = static_cast<std::uint32_t>(std::lround(10 * arguments.revision));
  options.answer = answer_time(arguments);
  options.boot = std::max(options.boot, options.answer / 2);
  ProgramUpdate work(node, image, began, options);
  std::string shown;
  while (work.status() == ProgramUpdate::Status::kBusy) {
    while (const auto frame = work.next_frame())
      if (const std::string error = can.send_patiently(*frame); !error.empty())
        return fmt::print(stderr, "{}\n", error), false;
    bool heard = false;
    receive_until(
        can, std::min(work.next_deadline(), monotonic_now() + 200ms),
        [&](LocalTime when, const CanFrame& frame) { heard = true, work.on_frame(when, frame); },
        [&] { return heard || work.status() != ProgramUpdate::Status::kBusy; });
    work.on_time(monotonic_now());
    const std::string line = fmt::format("node {}: {:<22} {:3} %", node, work.message(), work.percent());
    if (line != shown && ::isatty(STDOUT_FILENO) != 0) {
      fmt::print("\r{}", shown = line);
      std::fflush(stdout);
    }
  }
  const double seconds = to_seconds(monotonic_now() - began);
  if (::isatty(STDOUT_FILENO) != 0) fmt::print("\r");
  fmt::print("node {}: {} ({:.1f} s)\n", node, work.message(), seconds);
  if ((work.unprotected() & ProgramFlash::kNoBrownOut) != 0)
    fmt::print("node {}: no brown-out reset at 2.7 V: --protect sets it\n", node);
  if ((work.unprotected() & ProgramFlash::kBootLoaderOpen) != 0)
    fmt::print("node {}: the boot loader is not write protected: --protect does it\n", node);
  std::fflush(stdout);
  return work.status() == ProgramUpdate::Status::kDone;
}

/// For good, as far as CAN goes: asked for twice.
bool confirmed(const Arguments& arguments) {
  if ((!arguments.protect && arguments.revision == 0) || arguments.yes) return true;
  if (arguments.revision != 0)
    fmt::print(
        "Each board will be recorded, for good, as the one that this image is for, revision {:.1f}: look at "
        "the\n"
        "print on the board. It has room for 16 records, of which the last counts.\n",
        arguments.revision);
  if (arguments.protect)
    fmt::print(
        "Option bytes will be written: brown-out reset at 2.7 V, boot loader write protected. Only SWD or "
        "DFU "
        "undo that.\n"
        "The nodes' power must stay on meanwhile.\n");
  fmt::print("Type yes to go on: ");
  std::fflush(stdout);
  std::string answer;
  return static_cast<bool>(std::getline(std::cin, answer)) && answer == "yes";
}

/// Hands over to a standard tool, which must be installed.
int hand_over(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  fmt::print("{}\n", fmt::join(command, " "));
  std::fflush(stdout);
  ::execvp(arguments[0], arguments.data());
  fmt::print(stderr, "{} is not installed: apt-get install {}\n", command[0], command[0]);
  return 1;
}

int flash(const Arguments& arguments) {
  if (arguments.dfu) {
    if (!arguments.console.empty())
      if (const std::string error = request_system_boot(arguments.console); !error.empty())
        return fmt::print(stderr, "{}\n", error), 1;
    return hand_over(
        {"dfu-util", "-w", "-a", "0", "-d", "0483:df11", "-s", "0x08020000:leave", "-D", arguments.image});
  }
  if (arguments.swd)
    return hand_over({"openocd", "-f", "interface/stlink.cfg", "-f", "target/stm32f4x.cfg", "-c",
                      fmt::format("program {} 0x08020000 verify reset exit", arguments.image)});
  const ProgramFile program = read_program_file(arguments.image);
  if (!program.trouble.empty()) return fmt::print(stderr, "{}\n", program.trouble), 1;
  if (!confirmed(arguments)) return fmt::print(stderr, "not confirmed: nothing was done\n"), 1;
  SocketCan can;
  if (const std::string error = can.open(arguments.interface, false); !error.empty())
    return fmt::print(stderr, "{}\n", error), 1;
  std::set<std::uint8_t> nodes(arguments.nodes.begin(), arguments.nodes.end());
  if (arguments.all) nodes = find_nodes(can, answer_time(arguments) / 12);
  if (nodes.empty()) return fmt::print(stderr, "no node answers on {}\n", arguments.interface), 1;
  nodes = boards_of(can, nodes, answer_time(arguments) / 12);
  int failed = 0;
  // One after another: a bus has room for one download, and the others stay what they are meanwhile.
  for (const std::uint8_t node : nodes) failed += update(can, node, program.bytes, arguments) ? 0 : 1;
  if (failed != 0) fmt::print(stderr, "{} of {} boards not updated: run it again\n", failed, nodes.size());
  return failed == 0 ? 0 : 1;
}

int run(int argc, char** argv) {
  CLI::App app("kinebus-flash: writes a program into nodes, over CAN, USB (DFU) or SWD");
  Arguments arguments;
  app.add_option("image", arguments.image, "The board's program, as kinebus-node.bin of the firmware preset")
      ->required();
  app.add_option("-i,--interface", arguments.interface, "SocketCAN interface")->capture_default_str();
  auto* node =
      app.add_option("-n,--node", arguments.nodes, "Node id; may be given again")->check(CLI::Range(1, 126));
  auto* all = app.add_flag("-a,--all", arguments.all, "Every node that answers")->excludes(node);
  app.add_flag("-f,--force", arguments.force,
               "Also when the node runs this program already; with --node also when its board was another "
               "kind of node");
  app.add_option("--answer", arguments.answer_s,
                 "Seconds to wait for an answer: an erase takes up to 4, emulated boards may be slow")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
  auto* protect =
      app.add_flag("--protect", arguments.protect,
                   "Sets the chip's brown-out reset and write protects its boot loader; asks first");
  auto* record =
      app.add_option("--record", arguments.revision,
                     "Records in the chip, for good, which board it is on: the one that the image is "
                     "for, of this revision (1.1); asks first")
          ->check(CLI::Range(0.1, 99.9));
  app.add_flag("--yes", arguments.yes, "Does not ask");
  auto* dfu = app.add_flag("--dfu", arguments.dfu,
                           "By USB: the chip's own boot loader (BOOT0 or --console), with dfu-util");
  app.add_option("--console", arguments.console,
                 "The node's console, /dev/ttyACM0: asks it for its USB boot loader")
      ->needs(dfu);
  auto* swd = app.add_flag("--swd", arguments.swd, "By a debug probe, with openocd");
  protect->excludes(dfu)->excludes(swd);
  record->excludes(dfu)->excludes(swd);
  if (const auto end = parse_arguments(app, argc, argv)) return *end;
  if (*dfu || *swd || *node || *all) return flash(arguments);
  fmt::print(stderr, "say which: --node ID, --all, --dfu or --swd\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-flash", [&] { return run(argc, argv); });
}
