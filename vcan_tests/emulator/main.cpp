// kinebus-emulate: the firmware's image on emulated boards, for a look at its cost or on a real CAN
// interface.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <deque>
#include <exception>
#include <string_view>
#include <utility>

#include "protocol/bytes.hpp"
#include "protocol/canopen/nmt.hpp"
#include "vcan_tests/emulator/board_words.hpp"
#include "vcan_tests/emulator/cost_report.hpp"
#include "vcan_tests/emulator/live_boards.hpp"
#include "vcan_tests/emulator/live_usb.hpp"
#include "vcan_tests/emulator/paced_boards.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::emulator;
using namespace std::chrono_literals;

// The default machine's carriages on nodes 1 and 2, with switches under them at 40 mm; node 3 turns the table
// and the extruder.
EmulatedNodeOptions board_of(int node) {
  constexpr double kCountsPerMm = 1280;
  EmulatedNodeOptions options;
  options.node_id = static_cast<std::uint8_t>(node);
  options.keeps_node_id = true;
  options.board.unique_id = {0x00330045, 0x31365108, 0x36373800u + static_cast<std::uint32_t>(node)};
  if (node == 0 || node > 2) return options;
  for (int axis = 0; axis < 2; ++axis) {
    VirtualAxis& a = options.board.axes[static_cast<std::size_t>(axis)];
    a.start_counts = (110 - 2 * node + axis) * kCountsPerMm;
    a.switch_input = axis + 1;
    a.switch_counts = 40 * kCountsPerMm;
    a.active_above = false;
  }
  return options;
}

void advance(EmulatedMachine& machine, BusTime& now, BusTime span) {
  now += span;
  while (!machine.advance(now)) {
  }
  while (machine.receive()) {
  }
}

void write(EmulatedMachine& machine, BusTime& now, std::uint16_t index, std::uint8_t sub, int size,
           std::int64_t value) {
  CanFrame request{.id = 0x601, .length = 8};
  request.data[0] = static_cast<std::uint8_t>(0x23 | ((4 - size) << 2));
  put_u16_le(std::span(request.data).subspan(1), index);
  request.data[3] = sub;
  put_u32_le(std::span(request.data).subspan(4), static_cast<std::uint32_t>(value));
  machine.send(now, request);
  advance(machine, now, 3ms);
}

/// Both motors up to `turns_per_s` and on for a while: the costs of everything that runs then.
void report(const ElfImage& image, double turns_per_s, double seconds) {
  EmulatedMachine machine(image, {board_of(1)});
  Board& board = machine.board(0);
  BusTime now{0};
  machine.send(now, nmt_frame(NmtCommand::kStart, 1));
  advance(machine, now, 20ms);
  for (const std::uint16_t axis : {std::uint16_t{0}, std::uint16_t{0x800}}) {
    write(machine, now, static_cast<std::uint16_t>(0x6060 + axis), 0, 1, 1);
    for (const int word : {6, 7, 15})
      write(machine, now, static_cast<std::uint16_t>(0x6040 + axis), 0, 2, word);
  }
  advance(machine, now, 200ms);
  for (const std::uint16_t axis : {std::uint16_t{0}, std::uint16_t{0x800}}) {
    write(machine, now, static_cast<std::uint16_t>(0x607F + axis), 0, 4, 1'000'000);
    write(machine, now, static_cast<std::uint16_t>(0x6081 + axis), 0, 4, std::llround(turns_per_s * 51200));
    write(machine, now, static_cast<std::uint16_t>(0x6083 + axis), 0, 4, 4'000'000);
    write(machine, now, static_cast<std::uint16_t>(0x607A + axis), 0, 4, 1'000'000'000);
    write(machine, now, static_cast<std::uint16_t>(0x6040 + axis), 0, 2, 0x1F);
  }
  advance(machine, now, 300ms);
  board.cpu().clear_costs();
  board.cpu().start_profile();
  const Cycle began = board.now(), idle = board.cpu().idle();
  advance(machine, now, BusTime{static_cast<std::int64_t>(seconds * 1e9)});
  fmt::print("both motors at {:.2f} turns/s (rotors {:.2f} and {:.2f}), {:.2f} s\n", turns_per_s,
             board.motor(0).speed_rad_per_s() / 6.283185307, board.motor(1).speed_rad_per_s() / 6.283185307,
             seconds);
  fmt::print("{}\n{}", cost_table(board, began, idle), profile_table(board, 25));
  if (const std::string text = board.console().take_sent(); !text.empty()) fmt::print("console:\n{}\n", text);
}

/// The first board's USB at this computer's, or at that of who connects to the Unix socket.
int run_at_usb(const ElfImage& image, const std::vector<EmulatedNodeOptions>& boards,
               const std::string& socket, const LiveOptions& live) {
  OwnUsb own;
  StreamedUsb streamed;
  std::string error = socket.empty() ? "" : streamed.open(socket);
  if (error.empty())
    error = run_usb(image, boards, socket.empty() ? static_cast<UsbLine&>(own) : streamed, live);
  if (!error.empty()) std::fprintf(stderr, "kinebus-emulate: %s\n", error.c_str());
  return error.empty() ? 0 : 1;
}

int run(int argc, char** argv) {
  CLI::App app{
      "Runs the firmware's image on emulated boards.\n"
      "Without an interface: turns both motors of one board and prints what its interrupts cost."};
  std::string file, boot, interface, socket;
  std::vector<int> nodes;
  double speed = 15, seconds = 0.5, late_ms = 50;
  app.add_option("image", file, "kinebus-node.elf")->required();
  app.add_option("--boot", boot, "kinebus-boot.elf: the boot loader in front of it, as on a board");
  auto* on_interface = app.add_option("-i,--interface", interface,
                                      "SocketCAN interface, such as vcan0: runs live until stopped");
  app.add_option(
         "--socket", socket,
         "Instead of an interface: a Unix socket, made here, of whose one guest the struct can_frames are "
         "the bus (kinebus-can-port)")
      ->excludes(on_interface);
  bool paced = false;
  std::string board = "stm32f405";
  app.add_option("--board", board, "What the image is for; without an interface always the F405")
      ->check(CLI::IsMember(board_words()))
      ->capture_default_str();
  app.add_flag("--paced", paced,
               "Instead of an interface: the program that has started this one sends and reads frames on the "
               "standard streams, and says how much time passes (paced_boards.hpp)")
      ->excludes(on_interface);
  LiveOptions live;
  std::vector<std::string> also, switches;
  app.add_option("--also", also, "Live: a further board of another kind, without node id: KIND=IMAGE");
  app.add_option("--switch", switches,
                 "Live: BOARD:MOTOR:INPUT:COUNTS, from 0 on: that input goes high as soon as the motor has "
                 "turned so far, either way");
  app.add_option(
      "--bench", live.bench_folder,
      "Live: a folder with files for the eyes and hands of a person at the boards (workbench.hpp)");
  app.add_option("--power", live.power_file, "Live: the boards have power while this file exists");
  app.add_option("-n,--node", nodes,
                 "Node id, given by LSS; once for each board; 0: none, as a new board comes")
      ->check(CLI::Range(0, 126));
  app.add_option(
         "--late", late_ms,
         "Live: ms that the boards may be late before their time slips; 0 where the computer is slow and "
         "only order counts")
      ->check(CLI::Range(0.0, 10'000.0))
      ->capture_default_str();
  bool usb = false;
  app.add_flag("--usb", usb,
               "The first board's USB connector at this computer's vhci_hcd, or with --socket at that of the "
               "socket's guest (kinebus-usb-port): runs live until stopped");
  app.add_option("--speed", speed, "Report: turns a second")->capture_default_str();
  app.add_option("--seconds", seconds, "Report: measured so long")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  ElfImage image = load_elf(file);
  if (!boot.empty())
    for (ElfImage::Piece& piece : load_elf(boot).pieces) image.pieces.push_back(std::move(piece));
  if (interface.empty() && socket.empty() && !paced && !usb) {
    report(image, speed, seconds);
    return 0;
  }
  if (nodes.empty()) nodes = {1};
  std::vector<EmulatedNodeOptions> boards;
  boards.reserve(nodes.size() + also.size());
  for (const int node : nodes) {
    boards.push_back(board_of(node));
    boards.back().make = maker_of(board);
  }
  std::deque<ElfImage> images;
  for (const std::string& words : also) boards.push_back(further_board(words, images));
  for (const std::string& words : switches) wire_switch(words, boards);
  live.most_behind = BusTime{std::llround(late_ms * 1e6)};
  InterfacePort can;
  StreamPort stream;
  if (paced) {
    const std::string trouble = run_paced(image, boards);
    if (!trouble.empty()) std::fprintf(stderr, "kinebus-emulate: %s\n", trouble.c_str());
    return trouble.empty() ? 0 : 1;
  }
  if (usb) return run_at_usb(image, boards, socket, live);
  std::string error = socket.empty() ? can.open(interface) : stream.listen_at(socket);
  if (error.empty() && !socket.empty()) error = stream.wait();
  if (error.empty())
    error = run_live(image, boards, socket.empty() ? static_cast<CanPort&>(can) : stream, live);
  if (!error.empty()) std::fprintf(stderr, "kinebus-emulate: %s\n", error.c_str());
  return error.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinebus-emulate: %s\n", error.what());
    return 1;
  }
}
