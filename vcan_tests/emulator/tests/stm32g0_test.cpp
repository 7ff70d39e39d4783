// The STM32G0B1's own peripherals, without a processor: what a program must not count on.

#include <gtest/gtest.h>

#include <map>

#include "vcan_tests/emulator/peripherals/fdcan.hpp"
#include "vcan_tests/emulator/peripherals/stm32g0.hpp"
#include "vcan_tests/emulator/peripherals/stm32g0_adc.hpp"
#include "vcan_tests/emulator/peripherals/stm32g0_usart.hpp"
#include "vcan_tests/emulator/peripherals/timer.hpp"

namespace kinebus::emulator {
namespace {

struct G0Lines final : InterruptLines {
  std::map<int, bool> level;
  void set_line(int irq, bool high) override { level[irq] = high; }
};

struct FdcanOnABus : testing::Test {
  static constexpr std::uint32_t kCccr = 0x18, kIr = 0x50, kIe = 0x54, kIle = 0x5C, kRxgfc = 0x80,
                                 kRxf0s = 0x90, kTxfqs = 0xC4, kTxbar = 0xCC, kTxbrp = 0xC8;
  void join() {
    can.write(kCccr, 1, 0);
    can.write(kCccr, 3, 0);
    can.write(kRxgfc, 1u << 16 | 2u << 4 | 2u << 2, 0);
    can.write_memory(0, 2u << 30 | 1u << 27 | 0x123u << 16 | 0x7FF);
    can.write(kIe, 1 | 1u << 19, 0);
    can.write(kIle, 3, 0);
    can.write(kCccr, 0, 0);
    now = 12 * kCoreHz / 1'000'000;
    can.advance(now);
    ASSERT_TRUE(can.listening());
  }
  G0Lines lines;
  Fdcan can{lines, 21, 22};
  Cycle now = 0;
};

TEST_F(FdcanOnABus, TakesPartWhenTheBusWasRecessiveForElevenBits) {
  can.write(kCccr, 0, 0);
  can.advance(10 * kCoreHz / 1'000'000);
  EXPECT_FALSE(can.listening());
  can.advance(11 * kCoreHz / 1'000'000);
  EXPECT_TRUE(can.listening());
}

TEST_F(FdcanOnABus, FiltersAndLosesTheFourthFrameThatNobodyFetches) {
  join();
  can.on_frame(CanFrame::make(0x124, {1}), now);
  EXPECT_EQ(can.read(kRxf0s, now) & 0xF, 0u);
  for (int i = 0; i < 4; ++i) can.on_frame(CanFrame::make(0x123, {1}), now);
  EXPECT_EQ(can.read(kRxf0s, now) & 0xF, 3u);
  EXPECT_TRUE(lines.level[21]);
  EXPECT_EQ(can.counters().overruns, 1u);
}

TEST_F(FdcanOnABus, SendsTheBufferOfThePutIndexOnly) {
  join();
  static_cast<void>(can.take_requests());
  can.write(kTxbar, 2, now);
  EXPECT_TRUE(can.take_requests().empty());
  can.write(kTxbar, 1, now);
  EXPECT_EQ(can.take_requests().size(), 1u);
  EXPECT_EQ(can.read(kTxfqs, now) >> 16 & 3, 1u);
  can.on_sent(0);
  EXPECT_EQ(can.read(kTxbrp, now), 0u);
}

TEST_F(FdcanOnABus, StaysOffTheBusUntilTheProgramLetsItGo) {
  join();
  for (int i = 0; i < 32; ++i) can.on_error(true, now);
  ASSERT_TRUE(can.bus_off());
  EXPECT_EQ(can.read(kCccr, now) & 1, 1u);
  can.advance(now + kCoreHz);
  EXPECT_TRUE(can.bus_off());
  can.write(kCccr, 0, now + kCoreHz);
  can.advance(now + kCoreHz + 128 * 11 * kCoreHz / 1'000'000);
  EXPECT_TRUE(can.bus_off()) << "129 times 11 bits";
  can.advance(now + kCoreHz + 129 * 11 * kCoreHz / 1'000'000);
  EXPECT_FALSE(can.bus_off());
}

TEST(G0Flash, TakesDoubleWordsOnceAndTheLowerWordFirst) {
  std::vector<std::uint8_t> memory(4096, 0xFF);
  g0::Flash flash(memory);
  constexpr std::uint32_t kAt = g0::Flash::kBase;
  EXPECT_FALSE(flash.program(kAt, 1, 4, 0)) << "locked";
  flash.write(0x10, 0xFFFFFFFF, 0);
  flash.write(0x08, 0x45670123, 0);
  flash.write(0x08, 0xCDEF89AB, 0);
  flash.write(0x14, 1, 0);
  EXPECT_FALSE(flash.program(kAt + 4, 1, 4, 0)) << "the upper word alone";
  flash.write(0x10, 0xFFFFFFFF, 0);
  EXPECT_FALSE(flash.program(kAt, 1, 4, 0)) << "not before its other half";
  EXPECT_TRUE(flash.program(kAt + 4, 2, 4, 0));
  EXPECT_EQ(memory[0] + 256 * memory[4], 1 + 256 * 2);
  const std::uint64_t errors = flash.errors();
  static_cast<void>(flash.program(kAt, 0, 4, 0));
  EXPECT_FALSE(flash.program(kAt + 4, 2, 4, 0)) << "a second time";
  EXPECT_EQ(flash.errors(), errors + 1);
}

struct G0Adc : testing::Test {
  static constexpr std::uint32_t kIsr = 0x00, kCr = 0x08, kCfgr1 = 0x0C, kCfgr2 = 0x10, kSmpr = 0x14,
                                 kChselr = 0x28, kDr = 0x40;
  static constexpr std::uint32_t kRegulator = 1u << 28, kCalibrate = 1u << 31;
  static constexpr Cycle kMicrosecond = kCoreHz / 1'000'000;
  void write(std::uint32_t offset, std::uint32_t value) { adc.write(offset, value, now); }
  std::uint32_t read(std::uint32_t offset) { return adc.read(offset, now); }
  void wait(Cycle us) { now += us * kMicrosecond; }
  void switch_on() {
    write(kCr, kRegulator);
    wait(21);
    write(kCfgr2, 2u << 30);
    write(kCr, kRegulator | kCalibrate);
    wait(10);
    write(kCr, kRegulator | 1);
    wait(2);
    write(kChselr, 1u << 3);
    wait(2);
  }
  g0::Adc adc;
  Cycle now = 0;
};

TEST_F(G0Adc, WhatComesTooSoonIsNotDone) {
  write(kCr, 1);
  write(kCr, kRegulator);
  wait(19);
  write(kCr, kRegulator | kCalibrate);
  EXPECT_EQ(adc.refused(), 2u) << "no regulator, and not long enough";
  wait(2);
  write(kCfgr2, 2u << 30);
  write(kCr, kRegulator | kCalibrate);
  write(kCr, kRegulator | 1);
  EXPECT_EQ(adc.refused(), 3u) << "it calibrates";
  wait(10);
  write(kCr, kRegulator | 1);
  write(kChselr, 1u << 3);
  write(kCr, kRegulator | 5);
  EXPECT_EQ(adc.refused(), 4u) << "not ready";
  wait(2);
  write(kCr, kRegulator | 5);
  EXPECT_EQ(adc.refused(), 4u);
  EXPECT_TRUE(adc.running());
  write(kSmpr, 7);
  EXPECT_EQ(adc.refused(), 5u) << "it converts";
}

TEST_F(G0Adc, AddsUpAndTakesItsTime) {
  adc.sample = [](int channel, Cycle) { return channel == 3 ? 0.5 : 0; };
  switch_on();
  write(kCfgr1, 3u << 12);
  write(kSmpr, 7);
  write(kCfgr2, 2u << 30 | 1 | 7u << 2 | 4u << 5);
  write(kCr, kRegulator | 5);
  EXPECT_EQ(adc.refused(), 0u);
  // 256 times 173 clocks of 16 MHz.
  wait(2767);
  EXPECT_EQ(read(kIsr) & 4, 0u);
  wait(2);
  EXPECT_EQ(read(kIsr) & 4, 4u);
  EXPECT_EQ(read(kDr), 2048u * 16);
  EXPECT_EQ(read(kIsr) & 4, 0u);
  wait(2 * 2768);
  EXPECT_EQ(read(kIsr) & 16, 16u) << "one was not fetched";
}

/// On one wire by RX's pin, 40 kbaud of 64 MHz; 168 MHz is the time base.
struct G0Usart : testing::Test {
  static constexpr std::uint32_t kCr1 = 0x00, kCr2 = 0x04, kCr3 = 0x08, kBrr = 0x0C, kRqr = 0x18, kIsr = 0x1C,
                                 kIcr = 0x20, kRdr = 0x24, kTdr = 0x28;
  static constexpr Cycle kBit = 1600 * 21 / 8;
  G0Usart() {
    usart.on_output = [this](Cycle at) {
      edges.emplace_back(at, !usart.drives_low());
      usart.on_wire(!usart.drives_low(), at);
    };
  }
  void switch_on(std::uint32_t fifos = 1u << 29) {
    usart.write(kBrr, 1600, 0);
    usart.write(kCr2, 1u << 15, 0);
    usart.write(kCr3, 8, 0);
    usart.write(kCr1, fifos | 4 | 8 | 1, 0);
    usart.advance(11 * kBit);
  }
  void hear(std::uint32_t frame, Cycle from, Cycle bit) {
    for (Cycle i = 0; i < 10; ++i) {
      usart.advance(from + i * bit);
      usart.on_wire((frame >> i & 1) != 0, from + i * bit);
    }
    usart.advance(from + 10 * bit);
  }
  g0::Usart usart{21, 8};
  std::vector<std::pair<Cycle, bool>> edges;
};

TEST_F(G0Usart, SendsBitsAndHearsItselfOnItsOneWire) {
  switch_on();
  EXPECT_TRUE(usart.one_wire_at_rx());
  const Cycle from = 20 * kBit;
  usart.write(kTdr, 0x05, from);
  usart.advance(from + 10 * kBit);
  ASSERT_GE(edges.size(), 5u);
  EXPECT_EQ(edges[0], (std::pair{from, false}));
  EXPECT_EQ(edges[1], (std::pair{from + kBit, true}));
  EXPECT_EQ(edges[2], (std::pair{from + 2 * kBit, false}));
  EXPECT_EQ(usart.read(kIsr, from) & 0x60, 0x60u) << "complete, and heard";
  EXPECT_EQ(usart.read(kRdr, from), 0x05u);
  EXPECT_FALSE(usart.drives());
}

TEST_F(G0Usart, TakesNoSettingWhileItIsOnAndLetsGoOfWhatItHasNoRoomFor) {
  switch_on();
  usart.write(kBrr, 800, 0);
  usart.write(kCr2, 0, 0);
  usart.write(kCr3, 0, 0);
  EXPECT_EQ(usart.read(kBrr, 0), 1600u);
  EXPECT_TRUE(usart.one_wire_at_rx());
  for (int i = 0; i < 8; ++i) usart.write(kTdr, 0x55, 20 * kBit);
  EXPECT_EQ(usart.read(kIsr, 0) & 0x80, 0u) << "full";
  usart.write(kTdr, 0x55, 20 * kBit);
  EXPECT_EQ(usart.misused(), 1u);
  usart.advance(101 * kBit);
  EXPECT_EQ(usart.read(kIsr, 0) & 0x40, 0x40u);
}

TEST_F(G0Usart, LosesTheNinthByteThatNobodyFetches) {
  switch_on();
  for (Cycle i = 0; i < 9; ++i) hear(1u << 9 | 0x42u << 1, (20 + 11 * i) * kBit, kBit);
  EXPECT_EQ(usart.read(kIsr, 0) & 8, 8u);
  usart.write(kIcr, 0xF, 0);
  usart.write(kRqr, 8, 0);
  EXPECT_EQ(usart.read(kIsr, 0) & 0x28, 0u);
}

TEST_F(G0Usart, HearsBitsThatAreThreePercentOffAndNotThoseOfEight) {
  switch_on();
  hear(1u << 9 | 0xA5u << 1, 20 * kBit, kBit * 103 / 100);
  EXPECT_EQ(usart.read(kRdr, 0), 0xA5u);
  hear(1u << 9 | 0xA5u << 1, 60 * kBit, kBit * 108 / 100);
  usart.advance(80 * kBit);
  const bool framing_error = (usart.read(kIsr, 0) & 2) != 0;
  EXPECT_TRUE(framing_error || usart.read(kRdr, 0) != 0xA5u);
}

TEST_F(G0Usart, DmaKeepsWhatItHears) {
  G0Lines lines;
  g0::Dma dma{lines};
  std::vector<std::uint8_t> kept(4);
  dma.take = [&](std::uint32_t, Cycle at) { return static_cast<std::uint8_t>(usart.read(kRdr, at)); };
  dma.keep = [&](std::uint32_t address, std::uint8_t byte) { kept[address] = byte; };
  usart.on_request = [&](Cycle at) { dma.on_request(52, at); };
  switch_on();
  usart.write(kCr3, 8 | 0x40, 0);
  dma.write(0x804, 52, 0);
  dma.write(8 + 20 + 4, 2, 0);
  dma.write(8 + 20, 0x81, 0);
  for (Cycle i = 0; i < 3; ++i)
    hear(1u << 9 | static_cast<std::uint32_t>(i + 1) << 1, (20 + 11 * i) * kBit, kBit);
  EXPECT_EQ(kept, (std::vector<std::uint8_t>{1, 2, 0, 0}));
  EXPECT_EQ(dma.read(8 + 20 + 4, 0), 0u);
  EXPECT_EQ(usart.read(kIsr, 0) & 0x20, 0x20u) << "the third is left";
}

struct G0Dma : testing::Test {
  static constexpr std::uint32_t kIsr = 0x00, kCcr = 0x08, kCndtr = 0x0C, kCpar = 0x10, kCmar = 0x14,
                                 kRequest = 0x800, kLine = 20;
  static constexpr std::uint32_t kWordsOut = 0xA91, kBytesIn = 0x81, kOnError = 8, kFailed = 9;
  G0Dma() {
    dma.fetch = [](std::uint32_t address) { return address; };
    dma.put = [this](std::uint32_t address, std::uint32_t, Cycle) { written.push_back(address); };
    dma.take = [](std::uint32_t, Cycle) { return std::uint8_t{1}; };
    dma.keep = [this](std::uint32_t address, std::uint8_t) { written.push_back(address); };
  }
  void transfer(std::uint32_t ccr, std::uint32_t peripheral, std::uint32_t memory) {
    dma.write(4, kFailed, 0);
    dma.write(kRequest, kLine, 0);
    dma.write(kCcr, 0, 0);
    dma.write(kCndtr, 2, 0);
    dma.write(kCpar, peripheral, 0);
    dma.write(kCmar, memory, 0);
    dma.write(kCcr, ccr, 0);
    dma.on_request(kLine, 0);
  }
  G0Lines lines;
  g0::Dma dma{lines};
  std::vector<std::uint32_t> written;
};

TEST_F(G0Dma, DoesNotReachThePorts) {
  constexpr std::uint32_t kMemory = 0x20000000, kTimer = 0x40014418, kPorts = 0x50000000, kLast = 0x500017FC;
  for (const auto& [ccr, peripheral, memory] : {std::tuple{kWordsOut, kPorts + 0xC18, kMemory},
                                                {kWordsOut, kPorts, kMemory},
                                                {kWordsOut, kLast, kMemory},
                                                {kWordsOut, kTimer, kPorts + 0x10},
                                                {kBytesIn, kPorts + 0x10, kMemory},
                                                {kBytesIn, kTimer, kPorts + 0x14}}) {
    transfer(ccr | kOnError, peripheral, memory);
    EXPECT_EQ(dma.read(kIsr, 0), kFailed) << std::hex << peripheral;
    EXPECT_EQ(dma.read(kCcr, 0) & 1, 0u) << "off";
    EXPECT_EQ(dma.read(kCndtr, 0), 2u);
    EXPECT_TRUE(lines.level[9]);
  }
  EXPECT_TRUE(written.empty());
  transfer(kWordsOut, kTimer, kMemory);
  EXPECT_EQ(written, (std::vector{kTimer})) << "a timer it does";
  EXPECT_EQ(dma.read(kIsr, 0) & 8, 0u);
}

/// A timer's channel 1, as TIM16 has it.
struct G0ForcedOutput : testing::Test {
  static constexpr std::uint32_t kCr2 = 0x04, kCcmr1 = 0x18, kCcer = 0x20, kBdtr = 0x44;
  static constexpr std::uint32_t kFrozen = 0, kLow = 0x40, kHigh = 0x50, kMainOutput = 1u << 15;
  G0ForcedOutput() {
    timer.on_output = [this](Cycle at) { edges.emplace_back(at, timer.output_high()); };
  }
  void mode(std::uint32_t value, Cycle at) { timer.write(kCcmr1, value, at); }
  G0Lines lines;
  Timer timer{lines, {.cycles_per_tick = 21, .ticks = 8}};
  std::vector<std::pair<Cycle, bool>> edges;
};

TEST_F(G0ForcedOutput, FollowsItsModeAndStaysAsItWasWhenFrozen) {
  timer.write(kCcer, 1, 0);
  timer.write(kBdtr, kMainOutput, 0);
  mode(kHigh, 10);
  mode(kFrozen, 20);
  EXPECT_TRUE(timer.output_high());
  mode(kHigh, 30);
  mode(kLow, 40);
  mode(kFrozen, 50);
  EXPECT_FALSE(timer.output_high());
  EXPECT_EQ(edges, (std::vector<std::pair<Cycle, bool>>{{10, true}, {40, false}}));
}

TEST_F(G0ForcedOutput, NeedsItsChannelAndTheMainOutputAndNoOtherMode) {
  mode(kHigh, 0);
  EXPECT_FALSE(timer.output_high());
  timer.write(kCcer, 1, 1);
  EXPECT_FALSE(timer.output_high());
  timer.write(kBdtr, kMainOutput, 2);
  EXPECT_TRUE(timer.output_high());
  timer.write(kBdtr, 0, 3);
  EXPECT_FALSE(timer.output_high());
  timer.write(kBdtr, kMainOutput, 4);
  timer.write(kCcer, 3, 5);
  EXPECT_FALSE(timer.output_high()) << "the other polarity";
  timer.write(kCcer, 1, 6);
  mode(kLow, 7);
  mode(kHigh | 1u << 16, 8);
  mode(kHigh | 1, 9);
  EXPECT_FALSE(timer.output_high()) << "a mode of another kind, and an input";
  timer.write(kCr2, 1, 10);
  mode(kHigh, 11);
  EXPECT_FALSE(timer.output_high()) << "kept back until a commutation";
}

}  // namespace
}  // namespace kinebus::emulator
