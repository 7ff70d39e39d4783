// What a real chip does and a friendly one does not: long flash times, resets, a bus that is not there.

#include <gtest/gtest.h>

#include "vcan_tests/emulator/tests/one_board.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kDeviceState = 0x0800'0022;

// 100 us a word and 0.5 s an erase, in which no control interrupt comes.
TEST(Silicon, NoFlashIsWrittenWhileAMotorHasPower) {
  OneBoard node;
  node.configure(1500, 0);
  node.enable(1);
  Board& board = node.board;
  const std::uint64_t erases = board.flash().erases(), words = board.flash().programs();
  EXPECT_EQ(node.bench.try_write(OneBoard::kId, 0x1010, 1, 4, 0x65766173), kDeviceState);
  EXPECT_EQ(node.bench.try_write(OneBoard::kId, 0x1011, 1, 4, 0x64616F6C), kDeviceState);
  EXPECT_EQ(node.bench.try_write(OneBoard::kId, 0x1F51, 1, 1, 0), kDeviceState);
  const std::size_t from = node.bench.seen.size();
  for (const CanFrame& lss :
       {CanFrame::make(0x7E5, {4, 1, 0, 0, 0, 0, 0, 0}), CanFrame::make(0x7E5, {23, 0, 0, 0, 0, 0, 0, 0}),
        CanFrame::make(0x7E5, {4, 0, 0, 0, 0, 0, 0, 0})}) {
    node.bench.send(lss);
    node.bench.run(20ms);
  }
  const CanFrame refused = CanFrame::make(0x7E4, {23, 255, 1, 0, 0, 0, 0, 0});
  EXPECT_TRUE(std::any_of(node.bench.seen.begin() + static_cast<std::ptrdiff_t>(from), node.bench.seen.end(),
                          [&](const GatewayBench::Seen& s) { return s.frame == refused; }));
  EXPECT_EQ(board.flash().erases(), erases);
  EXPECT_EQ(board.flash().programs(), words);
  // Without power all of it is written, as slowly as a chip may, and the watchdog waits.
  for (int axis = 0; axis < 2; ++axis) node.write(axis, 0x6040, 0, 2, 0);
  node.bench.run(20ms);
  const Cycle began = board.now();
  for (int i = 0; i < 8; ++i) {
    node.write(0, 0x6081, 0, 4, 1000 + i);
    node.bench.send(CanFrame::make(0x605, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
    node.bench.run(1s);
    ASSERT_NE(node.bench.last(0x585), nullptr);
    EXPECT_EQ(*node.bench.last(0x585), CanFrame::make(0x585, {0x60, 0x10, 0x10, 1, 0, 0, 0, 0})) << i;
  }
  EXPECT_GT(board.flash().programs(), words + 8);
  EXPECT_GT(board.now(), began);
  EXPECT_EQ(board.resets(), 0u);
  EXPECT_TRUE(node.bench.emergencies(OneBoard::kId).empty());
}

}  // namespace
}  // namespace kinebus::emulator
