// The firmware's image on one emulated board: starts, answers, keeps the rules of the chip.

#include <gtest/gtest.h>

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

TEST(Image, TheSameRunTwice) {
  OneNode one, two;
  one.run(50ms);
  two.run(50ms);
  EXPECT_EQ(one.machine.board(0).cpu().instructions(), two.machine.board(0).cpu().instructions());
}

}  // namespace
}  // namespace kinebus::emulator
