// The CAN controller as a register model, without a processor.

#include <gtest/gtest.h>

#include "vcan_tests/emulator/peripherals/bxcan.hpp"
#include "vcan_tests/emulator/tests/fake_lines.hpp"

namespace kinebus::emulator {
namespace {

struct Can {
  Can() : can(lines) {
    can.write(0x00, 1, 0);
    can.write(0x1C, 2u << 24 | 1u << 20 | 0xAu << 16 | 2, 0);
    can.write(0x00, 0, 0);
    can.advance(kLater);
  }
  static constexpr Cycle kLater = 11 * kCoreHz / 1'000'000;  // 11 recessive bits
  void filter(std::uint32_t bank, std::uint32_t r1, std::uint32_t r2, std::uint32_t fifo) {
    can.write(0x200, can.read(0x200, 0) | 1, 0);
    can.write(0x20C, can.read(0x20C, 0) | 1u << bank, 0);
    if (fifo == 1) can.write(0x214, can.read(0x214, 0) | 1u << bank, 0);
    can.write(0x240 + 8 * bank, r1, 0);
    can.write(0x244 + 8 * bank, r2, 0);
    can.write(0x21C, can.read(0x21C, 0) | 1u << bank, 0);
    can.write(0x200, can.read(0x200, 0) & ~1u, 0);
  }
  void send(std::uint32_t mailbox, std::uint32_t id) {
    can.write(0x184 + 16 * mailbox, 2, 0);
    can.write(0x188 + 16 * mailbox, 0xBBAA, 0);
    can.write(0x180 + 16 * mailbox, id << 21 | 1, 0);
  }
  Lines lines;
  BxCan can;
};

TEST(BxCan, KnowsItsBitRate) {
  Can c;
  EXPECT_EQ(c.can.bit_rate(), 1'000'000u);
  EXPECT_NEAR(c.can.sample_point(), 0.857, 0.001);
}

TEST(BxCan, FiltersByMaskIntoTheChosenFifo) {
  Can c;
  c.filter(0, 0x080u << 21, 0x780u << 21 | 6, 0);
  c.filter(1, 0x605u << 21, 0x7FFu << 21 | 6, 1);
  c.can.write(0x14, 2 | 0x10, 0);
  c.can.on_frame(CanFrame::make(0x085, {1}), Can::kLater);
  c.can.on_frame(CanFrame::make(0x605, {2}), Can::kLater);
  c.can.on_frame(CanFrame::make(0x606, {3}), Can::kLater);
  EXPECT_EQ(c.can.read(0x0C, 0) & 3, 1u);
  EXPECT_EQ(c.can.read(0x10, 0) & 3, 1u);
  EXPECT_EQ(c.can.read(0x1C0, 0) >> 21, 0x605u);
  EXPECT_TRUE(c.lines[BxCan::kFifo0Irq]);
  c.can.write(0x0C, 0x20, 0);
  EXPECT_FALSE(c.lines[BxCan::kFifo0Irq]);
  EXPECT_EQ(c.can.counters().accepted, 2u);
}

TEST(BxCan, TheFourthFrameThatNobodyFetchesIsAnOverrun) {
  Can c;
  c.filter(0, 0, 0, 0);
  for (std::uint8_t i = 0; i < 4; ++i) c.can.on_frame(CanFrame::make(0x100, {i}), Can::kLater);
  EXPECT_EQ(c.can.read(0x0C, 0), 3u | 8 | 0x10);
  EXPECT_EQ(c.can.counters().overruns, 1u);
}

TEST(BxCan, TakesPartWhenTheBusWasRecessiveForElevenBits) {
  Lines lines;
  BxCan can(lines);
  can.set_dominant(true, 0);
  can.write(0x00, 0, 0);
  can.write(0x180, 0x181u << 21 | 1, 0);
  can.advance(kCoreHz);
  EXPECT_EQ(can.read(0x04, kCoreHz) & 1, 1u) << "still initialising";
  EXPECT_FALSE(can.listening());
  can.set_dominant(false, kCoreHz);
  can.advance(kCoreHz + Can::kLater - 1);
  EXPECT_FALSE(can.listening());
  EXPECT_TRUE(can.take_requests().empty());
  can.advance(kCoreHz + Can::kLater);
  EXPECT_EQ(can.read(0x04, kCoreHz + Can::kLater) & 1, 0u);
  EXPECT_EQ(can.take_requests().size(), 1u);
}

TEST(BxCan, SendsAndAbortsByMailbox) {
  Can c;
  c.can.write(0x14, 1, 0);
  c.send(0, 0x181);
  c.send(1, 0x701);
  auto requests = c.can.take_requests();
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[0].frame, CanFrame::make(0x181, {0xAA, 0xBB}));
  c.can.on_sent(0);
  EXPECT_TRUE(c.lines[BxCan::kTransmitIrq]);
  EXPECT_EQ(c.can.read(0x08, 0) & 0x3, 3u);
  c.can.write(0x08, 1, 0);
  EXPECT_FALSE(c.lines[BxCan::kTransmitIrq]);
  c.can.write(0x08, 0x8000, 0);
  requests = c.can.take_requests();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_TRUE(requests[0].abort);
  c.can.on_aborted(1);
  EXPECT_EQ(c.can.read(0x08, 0) >> 8 & 3, 1u) << "done, not sent";
}

TEST(BxCan, ThirtyTwoErrorsAreBusOffAndRecoveryTakesItsTime) {
  Can c;
  c.can.write(0x00, 0x40, 0);
  c.can.write(0x14, 0x8600, 0);
  for (int i = 0; i < 16; ++i) c.can.on_error(true, 0);
  EXPECT_EQ(c.can.read(0x18, 0) & 7, 3u) << "passive";
  EXPECT_TRUE(c.lines[BxCan::kStateIrq]);
  for (int i = 0; i < 16; ++i) c.can.on_error(true, 1000);
  EXPECT_TRUE(c.can.bus_off());
  c.send(0, 0x181);
  EXPECT_TRUE(c.can.take_requests().empty());
  EXPECT_EQ(c.can.next_event(), 1000u + 1408 * 168);
  c.can.advance(c.can.next_event());
  EXPECT_FALSE(c.can.bus_off());
  EXPECT_EQ(c.can.take_requests().size(), 1u);
}

}  // namespace
}  // namespace kinebus::emulator
