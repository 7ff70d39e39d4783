#pragma once
// An emulated EBB with its image, and a gateway's side of its bus.

#include <gtest/gtest.h>

#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/tests/gateway_bench.hpp"

namespace kinebus::emulator {

inline constexpr std::uint8_t kId = 9;
inline constexpr Cycle kMicrosecond = kCoreHz / 1'000'000;
inline constexpr int kControl = kFirstInterrupt + 9;
inline constexpr double kControlClocks = 64.0 * 64;  // of the core, in 64 us
/// What a plan has left when the next one is due (StepPort::kPlan).
inline constexpr double kLongestPass = 5.6e-3;

inline const ElfImage& ebb_image() {
  static const ElfImage loaded = load_elf(KINEBUS_EBB_IMAGE);
  return loaded;
}

struct OneEbb {
  explicit OneEbb(const BoardOptions& options = {}, BoardMaker make = &make_board<EbbBoard>,
                  bool keeps_id = false)
      : machine(ebb_image(), {EmulatedNodeOptions{
                                 .board = options, .node_id = kId, .keeps_node_id = keeps_id, .make = make}}),
        bench(machine),
        board(machine.board<EbbBoard>(0)) {
    bench.send(nmt_frame(NmtCommand::kStart, kId));
    bench.run(20ms);
  }
  void write(int index, std::uint8_t sub, int size, std::int64_t value) {
    bench.write(kId, static_cast<std::uint16_t>(index), sub, size, value);
  }
  std::int64_t read(int index, std::uint8_t sub = 0) {
    return bench.read(kId, static_cast<std::uint16_t>(index), sub);
  }
  void expect_good_driver() {
    const auto& shortest = board.driver().shortest();
    EXPECT_GE(shortest.high, 19 * kMicrosecond / 10);
    EXPECT_GE(shortest.low, 19 * kMicrosecond / 10);
    EXPECT_GE(shortest.set_up, 19 * kMicrosecond / 10);
    EXPECT_GE(shortest.hold, 19 * kMicrosecond / 10);
    EXPECT_EQ(board.driver().while_disabled(), 0u);
  }
  EmulatedMachine machine;
  GatewayBench bench;
  EbbBoard& board;
};

}  // namespace kinebus::emulator
