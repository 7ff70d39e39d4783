// kinebus-firmware-cycles: the image's interrupts in numbers: what each takes of the processor while both
// motors turn and the bus is busy. Cycles are estimates of the emulator (flash wait states, pipeline).

#include <fmt/format.h>

#include "protocol/host/guarded_main.hpp"
#include "vcan_tests/emulator/cycles/load.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::emulator;

struct Row {
  const char* name;
  int exception;
  double rate_hz;  ///< for the share of the worst case
};
constexpr double kCoreHz = 168e6;

int run(int argc, char** argv) {
  if (argc != 2) return fmt::print(stderr, "usage: kinebus-firmware-cycles kinebus-node.elf\n"), 2;
  const ElfImage image = load_elf(argv[1]);
  Load load(image);
  load.bring_up();
  Board& board = load.board();
  const auto fit = image.symbol("_ZN7kinebus13ClockEstimate3fitEv");
  if (!fit) return fmt::print(stderr, "the image has no ClockEstimate::fit\n"), 1;
  board.cpu().watch(*fit);
  load.synchronise();
  board.cpu().clear_costs();
  const Cycle began = board.now(), idle = board.cpu().idle();
  load.move_both();
  const double seconds = static_cast<double>(board.now() - began) / kCoreHz;
  const double asleep =
      static_cast<double>(board.cpu().idle() - idle) / static_cast<double>(board.now() - began);

  constexpr Row kRows[] = {{"control, both motors", 16 + 18, 20e3}, {"CAN receive", 16 + 20, 1e6 / 135}};
  fmt::print("{:<22}{:>9}{:>8}{:>8}{:>9}{:>9}{:>8}{:>12}\n", "interrupt", "calls", "instr", "worst", "cycles",
             "worst", "share", "latency us");
  bool good = true;
  for (const Row& row : kRows) {
    const ExceptionCost& cost = board.cpu().cost(row.exception);
    const double calls = static_cast<double>(std::max<std::uint64_t>(cost.calls, 1));
    const double share = cost.worst_cycles * row.rate_hz / kCoreHz;
    fmt::print("{:<22}{:>9}{:>8.0f}{:>8}{:>9.0f}{:>9}{:>7.1f}%{:>12.2f}\n", row.name, cost.calls,
               static_cast<double>(cost.instructions) / calls, cost.worst_instructions,
               static_cast<double>(cost.cycles) / calls, cost.worst_cycles, 100 * share,
               static_cast<double>(cost.worst_latency) / 168);
    if (row.exception == 16 + 18) {
      good = good && share <= 0.35 && cost.calls > 0;
      fmt::print("{:<22}{:>61.1f}%  (limit 35 % at 20 kHz)\n", "  at 40 kHz", 200 * share);
    }
  }
  fmt::print("processor asleep {:.1f} % of {:.2f} s; stack used {} bytes\n", 100 * asleep, seconds,
             load.stack_used());
  const CallCost& fits = board.cpu().watched();
  const auto us = [](Cycle cycles) { return static_cast<double>(cycles) / 168; };
  fmt::print(
      "clock fit, window full: {} calls, {} cycles at most, {:.0f} us with the interrupts that came in "
      "between\n",
      fits.calls, fits.worst_own, us(fits.worst));
  fmt::print("main loop: {:.0f} us at most from one sleep to the next (a stop is named {:.0f} us ahead)\n",
             us(board.cpu().longest_pass()), static_cast<double>(kStopMargin.count()) / 1e3);
  good = good && fits.calls > 0;
  const std::uint32_t overruns = load.receive_overruns();
  fmt::print("bus full of frames that the node takes: {} receive overruns\n", overruns);
  fmt::print("following error at most {:.1f} counts, of {} a turn\n", load.worst_following_counts(), 51'200);
  good = good && overruns == 0;
  if (!good) fmt::print(stderr, "a limit is not kept\n");
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-firmware-cycles", [&] { return run(argc, argv); });
}
