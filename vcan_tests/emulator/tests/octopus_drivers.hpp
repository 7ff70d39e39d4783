#pragma once
// The Octopus' drivers under test: what is done to one while its axis moves, and what the node makes of it.

#include <gtest/gtest.h>

#include <algorithm>

#include "vcan_tests/emulator/tests/octopus_bench.hpp"

namespace kinebus::emulator {

struct OctopusDriverRig : testing::Test {
  explicit OctopusDriverRig(BoardMaker make) : octopus({}, make) {}
  std::int64_t driver_object(int axis, std::uint8_t sub) {
    return octopus.bench.read(id_of(axis), static_cast<std::uint16_t>(0x2170 + 0x800 * (axis % 2)), sub);
  }
  bool told(int axis, std::uint16_t code, std::size_t from = 0) {
    const auto codes = octopus.bench.emergencies(id_of(axis), from);
    return std::ranges::find(codes, code) != codes.end();
  }
  void start_moving(int axis) {
    octopus.write(axis, 0x607F, 0, 4, 400'000);
    octopus.enable(axis, 1);
    octopus.move(axis, 4'000'000, 50'000, 800'000);
    octopus.bench.run(200ms);
    EXPECT_GT(octopus.board.driver(axis).steps(), 200);
  }
  bool faulty(int axis) { return (octopus.statusword(axis) & 0x4F) == 0x08; }
  void disable(int axis) {
    octopus.write(axis, 0x6040, 0, 2, 0);
    octopus.bench.run(50ms);
  }
  /// What takes the axis' power within 0.5 s, is told by `code`, and can be reset when it has gone.
  template <typename Driver, typename Begin, typename End>
  void expect_fault(int axis, Driver& driver, std::uint16_t code, Begin begin, End end) {
    start_moving(axis);
    const std::size_t from = octopus.bench.seen.size();
    begin(driver);
    octopus.bench.run(500ms);
    EXPECT_TRUE(faulty(axis)) << "axis " << axis;
    EXPECT_TRUE(told(axis, code, from)) << "axis " << axis;
    EXPECT_EQ(octopus.read(axis, 0x603F), code);
    EXPECT_FALSE(octopus.board.driver(axis).enabled());
    end(driver);
    octopus.bench.run(1500ms);
    for (const int word : {0x80, 0x00}) octopus.write(axis, 0x6040, 0, 2, word);
    octopus.enable(axis, 1);
    EXPECT_TRUE(octopus.board.driver(axis).enabled());
    disable(axis);
  }
  OneOctopus octopus;
};

/// What the processor is busy with while a stranger talks all the time.
struct OctopusLoad {
  double control = 0, worst_control = 0;  ///< the control interrupt's share, on average and at most
  double awake = 0;
  double longest_pass_ms = 0;
};
template <typename Beside>
OctopusLoad load_of(OneOctopus& octopus, Beside beside) {
  octopus.bench.run(50ms, 200us, beside);
  octopus.board.cpu().clear_costs();
  const Cycle began = octopus.board.now(), idle = octopus.board.cpu().idle();
  octopus.bench.run(200ms, 200us, beside);
  const ExceptionCost control = octopus.board.cpu().cost(kControl);
  return {
      .control = static_cast<double>(control.cycles) / static_cast<double>(control.calls) / kControlPeriod,
      .worst_control = static_cast<double>(control.worst_cycles) / kControlPeriod,
      .awake = 1 - static_cast<double>(octopus.board.cpu().idle() - idle) /
                       static_cast<double>(octopus.board.now() - began),
      .longest_pass_ms = seconds_of(octopus.board.cpu().longest_pass()) * 1e3};
}
/// Eight devices that nobody knows fill the bus by turns.
inline auto strangers_on(OneOctopus& octopus) {
  return [&octopus, sent = 0u]() mutable {
    octopus.bench.send(CanFrame::make(0x0C1 + sent++ % 8, {0, 0, 0, 0, 0, 0, 0, 0}));
  };
}
inline void expect_within_budget(const OctopusLoad& load) {
  EXPECT_LE(load.control, 0.6);
  EXPECT_LE(load.worst_control, 0.6);
  EXPECT_LT(load.longest_pass_ms, 4) << "half of a plan";
}

}  // namespace kinebus::emulator
