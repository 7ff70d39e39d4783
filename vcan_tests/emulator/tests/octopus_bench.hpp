#pragma once
// An emulated Octopus with its image, and a gateway's side of its bus. Axes are counted over the board: 0 to
// 7, two for each of its nodes.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"
#include "vcan_tests/emulator/tests/gateway_bench.hpp"

namespace kinebus::emulator {

inline constexpr std::uint8_t kId = 7;  ///< of the first node
inline constexpr double kCount = 4294967296.0;
inline constexpr Cycle kMicrosecond = kCoreHz / 1'000'000, kCyclesPerLocalCount = kMicrosecond / 4;
inline constexpr int kControl = kFirstInterrupt + 57;
inline constexpr double kControlPeriod = 64.0 * kMicrosecond;

inline const ElfImage& octopus_image() {
  static const ElfImage loaded = load_elf(KINEBUS_OCTOPUS_IMAGE);
  return loaded;
}

constexpr std::uint8_t id_of(int axis) {
  return static_cast<std::uint8_t>(kId + axis / 2);
}

struct OneOctopus {
  explicit OneOctopus(const BoardOptions& options = {}, BoardMaker make = &make_board<OctopusBoard>,
                      bool keeps_id = false, double hot_end_c = 22)
      : machine(
            octopus_image(),
            {EmulatedNodeOptions{.board = options, .node_id = kId, .keeps_node_id = keeps_id, .make = make}}),
        bench(machine),
        board(machine.board<OctopusBoard>(0)) {
    board.heated().hot_end().begin_at(hot_end_c);
    bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
    bench.run(20ms);
  }
  void write(int axis, int index, std::uint8_t sub, int size, std::int64_t value) {
    bench.write(id_of(axis), static_cast<std::uint16_t>(index + 0x800 * (axis % 2)), sub, size, value);
  }
  std::int64_t read(int axis, int index) {
    return bench.read(id_of(axis), static_cast<std::uint16_t>(index + 0x800 * (axis % 2)), 0);
  }
  void enable(int axis, int mode) { bench.enable(id_of(axis), axis % 2, mode); }
  void move(int axis, std::int64_t counts, std::int64_t speed, std::int64_t acceleration) {
    bench.move(id_of(axis), axis % 2, counts, speed, acceleration);
  }
  std::uint16_t statusword(int axis) { return bench.statusword(id_of(axis), axis % 2); }
  void expect_good_drivers() {
    for (int axis = 0; axis < 8; ++axis) {
      const auto& shortest = board.driver(axis).shortest();
      EXPECT_GE(shortest.high, 19 * kMicrosecond / 10) << "axis " << axis;
      EXPECT_GE(shortest.low, 19 * kMicrosecond / 10);
      EXPECT_GE(shortest.set_up, 19 * kMicrosecond / 10);
      EXPECT_GE(shortest.hold, 19 * kMicrosecond / 10);
      EXPECT_EQ(board.driver(axis).while_disabled(), 0u);
    }
  }
  EmulatedMachine machine;
  GatewayBench bench;
  OctopusBoard& board;
};

inline std::int64_t nearest_step(double counts) {
  return static_cast<std::int64_t>(std::floor(counts / OctopusBoard::kCountsPerStep + 0.5));
}

}  // namespace kinebus::emulator
