// The firmware's image on one emulated board: starts, answers, keeps the rules of the chip.

#include <gtest/gtest.h>

#include <algorithm>

#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

const ElfImage& image() {
  static const ElfImage loaded = load_elf(KINEBUS_FIRMWARE_IMAGE);
  return loaded;
}

struct OneNode {
  OneNode() : machine(image(), {EmulatedNodeOptions{.board = {.unique_id = {1, 2, 3}}, .node_id = 5}}) {}
  /// Runs on and gives all frames from the node.
  std::vector<CanFrame> run(BusTime duration) {
    std::vector<CanFrame> frames;
    now += duration;
    for (bool done = false; !done;) {
      done = machine.advance(now);
      while (const auto got = machine.receive())
        if (!got->own) frames.push_back(got->frame);
    }
    return frames;
  }
  std::vector<CanFrame> ask(const CanFrame& frame, BusTime duration = 5ms) {
    machine.send(now, frame);
    return run(duration);
  }
  EmulatedMachine machine;
  BusTime now{0};
};

TEST(Image, SetsTheClockTreeAndTheBitTimingThatTheBoardNeeds) {
  OneNode node;
  Board& board = node.machine.board(0);
  EXPECT_EQ(board.rcc().system_hz(), 168'000'000u);
  EXPECT_EQ(board.rcc().apb1_hz(), 42'000'000u);
  EXPECT_EQ(board.rcc().apb2_hz(), 84'000'000u);
  EXPECT_EQ(board.flash().wait_states(), 5u);
  EXPECT_EQ(board.can().bit_rate(), 1'000'000u);
  EXPECT_GE(board.can().sample_point(), 0.75);
  EXPECT_LE(board.can().sample_point(), 0.88);
  EXPECT_TRUE(board.strange_accesses().empty()) << std::hex << board.strange_accesses().front();
}

TEST(Image, EveryPeripheralHasItsClockBeforeItIsTouched) {
  OneNode node;
  node.run(20ms);
  const auto& lost = node.machine.board(0).lost_accesses();
  EXPECT_TRUE(lost.empty()) << std::hex << lost.front() << ", and " << lost.size() - 1 << " more";
}

TEST(Image, AnswersSdoAndSendsItsHeartbeat) {
  OneNode node;
  const auto answer = node.ask(CanFrame::make(0x605, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0}));
  ASSERT_EQ(answer.size(), 1u);
  EXPECT_EQ(answer[0], CanFrame::make(0x585, {0x43, 0x00, 0x10, 0, 0x92, 0x01, 0xFF, 0xFF}));
  node.ask(CanFrame::make(0x605, {0x2B, 0x17, 0x10, 0, 10, 0, 0, 0}));  // 10 ms
  node.ask(CanFrame::make(0x000, {1, 5}));
  const auto beats = node.run(100ms);
  EXPECT_GE(beats.size(), 9u);
  EXPECT_LE(beats.size(), 11u);
  EXPECT_EQ(beats.front(), CanFrame::make(0x705, {5}));
}

TEST(Image, StartsAgainAfterResetByNmt) {
  OneNode node;
  const auto frames = node.ask(CanFrame::make(0x000, {0x81, 5}), 50ms);
  EXPECT_NE(std::find(frames.begin(), frames.end(), CanFrame::make(0x705, {0})), frames.end());
}

TEST(Image, TheSameRunTwice) {
  OneNode one, two;
  one.run(50ms);
  two.run(50ms);
  EXPECT_EQ(one.machine.board(0).cpu().instructions(), two.machine.board(0).cpu().instructions());
}

}  // namespace
}  // namespace kinebus::emulator
