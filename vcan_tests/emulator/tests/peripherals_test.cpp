// The chip's peripherals as register models, without a processor.

#include <gtest/gtest.h>

#include <bit>
#include <numeric>

#include "vcan_tests/emulator/peripherals/adc.hpp"
#include "vcan_tests/emulator/peripherals/as5047.hpp"
#include "vcan_tests/emulator/peripherals/flash.hpp"
#include "vcan_tests/emulator/peripherals/gpio.hpp"
#include "vcan_tests/emulator/peripherals/rcc.hpp"
#include "vcan_tests/emulator/peripherals/spi.hpp"
#include "vcan_tests/emulator/peripherals/timer.hpp"
#include "vcan_tests/emulator/peripherals/usart.hpp"
#include "vcan_tests/emulator/peripherals/watchdog.hpp"
#include "vcan_tests/emulator/tests/fake_lines.hpp"

namespace kinebus::emulator {
namespace {

void run(Peripheral& peripheral, Cycle until) {
  while (peripheral.next_event() <= until) peripheral.advance(peripheral.next_event());
}

TEST(Rcc, WorksOutTheClockTreeAndRefusesWhatTheChipCannotDo) {
  Rcc rcc;
  EXPECT_EQ(rcc.system_hz(), 16'000'000u);
  rcc.write(0x00, 1u << 16, 0);
  EXPECT_NE(rcc.read(0x00, 0) & 1u << 17, 0u);
  rcc.write(0x04, 1u << 22 | 7u << 24 | 336u << 6 | 8, 0);
  rcc.write(0x00, 1u << 16 | 1u << 24, 0);
  rcc.write(0x08, 5u << 10 | 4u << 13 | 2, 0);
  EXPECT_EQ(rcc.system_hz(), 168'000'000u);
  EXPECT_EQ(rcc.apb1_hz(), 42'000'000u);
  EXPECT_EQ(rcc.apb2_hz(), 84'000'000u);
  rcc.write(0x08, 4u << 10 | 4u << 13 | 2, 0);
  EXPECT_EQ(rcc.apb1_hz(), std::nullopt) << "84 MHz is too fast for APB1";
}

struct FlashUnderTest {
  FlashUnderTest() : memory(1 << 20, 0xFF), flash(memory) {}
  void unlock() {
    flash.write(0x04, 0x45670123, 0);
    flash.write(0x04, 0xCDEF89AB, 0);
  }
  std::vector<std::uint8_t> memory;
  FlashController flash;
};

TEST(Flash, ProgramsOnlyUnlockedAndOnlyClearsBits) {
  FlashUnderTest f;
  EXPECT_FALSE(f.flash.program(0x08008000, 0, 4, 0));
  EXPECT_NE(f.flash.read(0x0C, 0) & 0x80, 0u);
  f.unlock();
  f.flash.write(0x10, 1 | 2u << 8, 0);
  EXPECT_TRUE(f.flash.program(0x08008000, 0xFFFF00FF, 4, 0));
  EXPECT_TRUE(f.flash.program(0x08008000, 0x0F0FFFFF, 4, 0));
  EXPECT_EQ(f.memory[0x8001], 0x00);
  EXPECT_EQ(f.memory[0x8003], 0x0F);
  EXPECT_FALSE(f.flash.program(0x08008004, 0, 1, 0)) << "the size is set to words";
}

TEST(Flash, TakesTheLongestTimesOfTheDataSheet) {
  FlashUnderTest f;
  f.unlock();
  f.flash.write(0x10, 1 | 2u << 8, 0);
  EXPECT_TRUE(f.flash.program(0x08008000, 0, 4, 0));
  EXPECT_EQ(f.flash.busy_until(), kCoreHz / 10'000) << "100 us a word";
  f.flash.write(0x10, 2 | 2u << 3 | 1u << 16, kCoreHz);
  EXPECT_EQ(f.flash.busy_until(), kCoreHz + kCoreHz / 2) << "0.5 s for 16 KiB";
  f.flash.write(0x10, 2 | 5u << 3 | 1u << 16, 2 * kCoreHz);
  EXPECT_EQ(f.flash.busy_until(), 4 * kCoreHz) << "2 s for 128 KiB";
}

TEST(Flash, OptionsNeedTheirKeysAndProtectSectorsForGood) {
  FlashUnderTest f;
  constexpr std::uint32_t kWanted = 0x0FFCAAE0;  // brown-out level 3, sectors 0 and 1
  EXPECT_EQ(f.flash.read(0x14, 0), 0x0FFFAAEDu) << "as delivered, locked";
  f.flash.write(0x14, kWanted | 2, 0);
  EXPECT_EQ(f.flash.options(), 0x0FFFAAECu) << "locked";
  f.flash.write(0x08, 0x08192A3B, 0);
  f.flash.write(0x08, 0x4C5D6E7F, 0);
  f.flash.write(0x14, kWanted, 0);
  EXPECT_EQ(f.flash.options(), 0x0FFFAAECu) << "not started";
  EXPECT_DOUBLE_EQ(f.flash.brown_out_volts(), 1.8);
  f.flash.write(0x14, kWanted | 2, 0);
  EXPECT_NE(f.flash.read(0x0C, 1000) & 1u << 16, 0u) << "busy";
  EXPECT_EQ(f.flash.options(), kWanted);
  EXPECT_DOUBLE_EQ(f.flash.brown_out_volts(), 2.7);
  f.flash.reset();
  EXPECT_EQ(f.flash.read(0x14, kCoreHz), kWanted | 1) << "kept, and locked again";
  f.unlock();
  f.flash.write(0x10, 2 | 1u << 3 | 1u << 16, kCoreHz);
  EXPECT_NE(f.flash.read(0x0C, kCoreHz) & 0x10, 0u) << "sector 1 is protected";
  f.flash.write(0x10, 1 | 2u << 8, kCoreHz);
  EXPECT_FALSE(f.flash.program(0x08000000, 0, 4, kCoreHz));
  EXPECT_TRUE(f.flash.program(0x08008000, 0, 4, kCoreHz)) << "sector 2 is not";
}

TEST(Flash, ErasesTheSectorAndNothingElse) {
  FlashUnderTest f;
  std::iota(f.memory.begin(), f.memory.end(), std::uint8_t{0});
  f.unlock();
  f.flash.write(0x10, 2 | 2u << 3 | 1u << 16, 1000);
  EXPECT_NE(f.flash.read(0x0C, 1001) & 1u << 16, 0u);
  EXPECT_EQ(f.flash.read(0x0C, f.flash.busy_until()) & 1u << 16, 0u);
  EXPECT_EQ(f.memory[0x8000], 0xFF);
  EXPECT_EQ(f.memory[0xBFFF], 0xFF);
  EXPECT_EQ(f.memory[0x7FFE], 0xFE);
  EXPECT_EQ(f.memory[0xC001], 0x01);
}

TEST(Exti, GivesTheEdgesThatAreAskedForFromThePortThatIsChosen) {
  Lines lines;
  Exti exti(lines);
  exti.write(0x00, 1u << 4 | 1u << 10, 0);
  exti.write(0x08, 1u << 4 | 1u << 10, 0);
  exti.select(1, 2);  // line 4 from port C
  exti.on_level(0, 4, true);
  EXPECT_FALSE(lines[10]);
  exti.on_level(2, 4, true);
  EXPECT_TRUE(lines[10]);
  exti.write(0x14, 1u << 4, 0);
  EXPECT_FALSE(lines[10]);
  exti.on_level(2, 4, false);
  EXPECT_FALSE(lines[10]) << "falling edges are not asked for";
  exti.select(2, 1u << 8);
  exti.on_level(1, 10, true);
  EXPECT_TRUE(lines[40]);
}

TEST(Gpio, BsrrSetsAndClearsAndPullsHoldUndrivenPins) {
  GpioPort port;
  port.write(0x00, 1u << 8, 0);
  port.write(0x18, 1u << 4, 0);
  EXPECT_TRUE(port.output_high(4));
  port.write(0x18, 1u << 20, 0);
  EXPECT_FALSE(port.output_high(4));
  port.write(0x0C, 1u << 12, 0);
  EXPECT_TRUE(port.level(6));
  port.drive(6, false);
  EXPECT_FALSE(port.level(6));
}

TEST(Timer, CentreAlignedCountsUpAndDownAndUpdatesEveryRepetition) {
  Lines lines;
  Timer timer(lines, {.update_irq = 25});
  std::vector<Cycle> triggers;
  timer.on_trigger = [&](Cycle at) { triggers.push_back(at); };
  timer.write(0x2C, 2100, 0);
  timer.write(0x30, 3, 0);
  timer.write(0x18, 0x6868, 0);
  timer.write(0x14, 1, 0);
  timer.write(0x04, 2u << 4, 0);
  timer.write(0x00, 0xA1, 0);
  EXPECT_EQ(timer.read(0x24, 700), 700u);
  EXPECT_EQ(timer.read(0x24, 2100 + 700), 1400u);
  timer.write(0x34, 1234, 3000);
  EXPECT_EQ(timer.sweep().compare[0], 0u) << "preloaded, not yet in force";
  run(timer, 40'000);
  EXPECT_EQ(timer.sweep().compare[0], 1234u);
  ASSERT_GE(triggers.size(), 3u);
  EXPECT_EQ(triggers[1] - triggers[0], 4u * 2100) << "20 kHz of 40 kHz";
  EXPECT_EQ(triggers[0] % 4200, 0u)
      << "at the underflow, where all outputs have been high for half their time";
}

TEST(Timer, TheFreeRunningTimeBaseCountsThroughItsPrescaler) {
  Lines lines;
  Timer timer(lines, {.cycles_per_tick = 2, .advanced = false});
  timer.write(0x28, 20, 0);
  timer.write(0x2C, 0xFFFFFFFF, 0);
  timer.write(0x14, 1, 100);
  timer.write(0x00, 1, 100);
  EXPECT_EQ(timer.read(0x24, 100 + 42 * 1000 + 41), 1000u);
}

TEST(Timer, TheBreakInputTakesTheMainOutputAndKeepsItUntilItIsGone) {
  Lines lines;
  Timer timer(lines, {.break_irq = 24});
  timer.write(0x0C, 0x80, 0);
  timer.write(0x44, 1u << 15 | 1u << 12, 0);
  EXPECT_TRUE(timer.sweep().main_output);
  timer.set_break_level(false, 10);
  EXPECT_FALSE(timer.sweep().main_output);
  EXPECT_TRUE(lines[24]);
  timer.write(0x10, ~0x80u, 20);
  timer.write(0x44, 1u << 15 | 1u << 12, 20);
  EXPECT_FALSE(timer.sweep().main_output) << "the input is still active";
  timer.set_break_level(true, 30);
  timer.write(0x44, 1u << 15 | 1u << 12, 40);
  EXPECT_TRUE(timer.sweep().main_output);
}

TEST(Adc, ConvertsTheInjectedGroupsOfBothConvertersTogether) {
  Lines lines;
  AdcBlock adc(lines);
  std::vector<std::pair<int, Cycle>> sampled;
  adc.sample = [&](int channel, Cycle at) {
    sampled.emplace_back(channel, at);
    return channel / 10.0;
  };
  adc.write(0x304, 5 | 1u << 16, 0);
  for (const std::uint32_t base : {0x000u, 0x100u}) {
    adc.write(base + 0x04, 0x100 | (base == 0 ? 0x80u : 0), 0);
    adc.write(base + 0x08, 1u | (base == 0 ? 1u << 20 | 1u << 16 : 0), 0);
    // Two conversions: first in JSQ3, then JSQ4.
    adc.write(base + 0x38, 1u << 20 | (base == 0 ? 0u : 1u) << 10 | (base == 0 ? 2u : 3u) << 15, 0);
  }
  adc.on_trigger(1, 1000);
  run(adc, 5000);
  ASSERT_EQ(sampled.size(), 4u);
  EXPECT_EQ(sampled[0].second, 1000u + 3 * 8) << "3 clocks of 21 MHz after the trigger";
  EXPECT_TRUE(lines[AdcBlock::kIrq]);
  EXPECT_EQ(adc.read(0x3C, 5000), 0u);
  EXPECT_EQ(adc.read(0x40, 5000), 819u);
  EXPECT_EQ(adc.read(0x13C, 5000), 410u);
  EXPECT_EQ(adc.read(0x140, 5000), 1229u);
  adc.write(0x00, ~4u, 5000);
  EXPECT_FALSE(lines[AdcBlock::kIrq]);
}

TEST(Encoder, AnswersInTheNextFrameWithEvenParity) {
  Lines lines;
  As5047 encoder;
  encoder.turns = [](Cycle) { return 3.25; };
  Spi spi(lines, 35, kApb2Divider, encoder);
  spi.write(0x00, 0xB45 | 3u << 3, 0);  // master, 16 bits, enabled, APB / 16
  Cycle now = 0;
  const auto exchange = [&](std::uint32_t value) {
    encoder.select(true, now);
    spi.write(0x0C, value, now);
    EXPECT_EQ(spi.read(0x08, now) & 1, 0u);
    now = spi.next_event();
    EXPECT_EQ(spi.read(0x08, now) & 1, 1u);
    encoder.select(false, now);
    return spi.read(0x0C, now);
  };
  exchange(0xFFFF);
  EXPECT_EQ(now, 16u * 32) << "16 bits of 5.25 MHz";
  const std::uint32_t answer = exchange(0xFFFF);
  EXPECT_EQ(answer & 0x3FFF, 4096u);
  EXPECT_EQ(std::popcount(answer) % 2, 0);
  exchange(0x7FFF);  // wrong parity
  EXPECT_NE(exchange(0xFFFF) & 0x4000, 0u);
  encoder.unplug(true);
  EXPECT_EQ(exchange(0xFFFF), 0xFFFFu);
}

TEST(Usart, SendsAtTheSetRateAndReceives) {
  Lines lines;
  Usart usart(lines, 37, kApb2Divider);
  usart.write(0x08, 729, 0);
  usart.write(0x0C, 0x200C | 0x20, 0);
  EXPECT_NEAR(usart.baud(), 115'200, 100);
  usart.write(0x04, 'o', 0);
  usart.write(0x04, 'k', 0);
  EXPECT_EQ(usart.read(0x00, 0) & 0x80, 0u);
  run(usart, 2 * 10 * 2 * 729);
  EXPECT_EQ(usart.take_sent(), "ok");
  usart.receive("?");
  EXPECT_TRUE(lines[37]);
  EXPECT_EQ(usart.read(0x04, 99'999), static_cast<std::uint32_t>('?'));
  EXPECT_FALSE(lines[37]);
}

TEST(Watchdog, OnlyTheKeyHoldsItOff) {
  Watchdog dog;
  dog.reset();
  dog.write(0, 0xCCCC, 0);
  dog.write(0, 0x5555, 0);
  dog.write(4, 1, 0);    // / 8
  dog.write(8, 399, 0);  // 68 ms of the fastest chip
  const Cycle ready = Watchdog::kTakesOver, time = Watchdog::kFastestClock * 8 * 400;
  dog.write(0, 0xAAAA, ready);
  EXPECT_EQ(dog.next_event(), ready + time);
  dog.write(0, 0xAAAA, ready + time / 2);
  EXPECT_FALSE(dog.expired(ready + time));
  EXPECT_TRUE(dog.expired(ready + time + time / 2));
}

TEST(Watchdog, TakesOverASettingFiveClocksLaterAndNoOtherUntilThen) {
  Watchdog dog;
  dog.reset();
  dog.write(0, 0x5555, 0);
  dog.write(8, 99, 0);
  EXPECT_EQ(dog.read(12, kCoreHz), 2u) << "without its start there is no oscillator";
  dog.write(0, 0xCCCC, kCoreHz);
  dog.write(0, 0x5555, kCoreHz);
  dog.write(8, 7, kCoreHz + 1000);
  EXPECT_EQ(dog.read(8, 0), 99u) << "busy";
  dog.write(0, 0xAAAA, kCoreHz + 1000);
  EXPECT_EQ(dog.next_event(), kCoreHz + 1000 + Watchdog::kFastestClock * 4 * 0x1000) << "the value of before";
  EXPECT_EQ(dog.read(12, kCoreHz + Watchdog::kTakesOver), 0u);
  dog.write(0, 0xAAAA, kCoreHz + Watchdog::kTakesOver);
  EXPECT_EQ(dog.next_event(), kCoreHz + Watchdog::kTakesOver + Watchdog::kFastestClock * 4 * 100);
}

TEST(RccClock, IsLiveAfterAReadBackOrAfterTheErratumsDelayAndNotBefore) {
  Rcc rcc;
  constexpr std::uint32_t kApb1Enable = 0x40;
  constexpr Rcc::Clock kCan{kApb1Enable, 25}, kTim2{kApb1Enable, 0};
  EXPECT_FALSE(rcc.live(kCan, 1000));
  rcc.write(kApb1Enable, 1u << 25, 1000);
  EXPECT_FALSE(rcc.live(kCan, 1003)) << "the next instruction but one";
  EXPECT_TRUE(rcc.live(kCan, 1100));
  rcc.write(kApb1Enable, 1u << 25 | 1, 2000);
  EXPECT_TRUE(rcc.live(kCan, 2003)) << "has been on for long";
  EXPECT_FALSE(rcc.live(kTim2, 2003));
  rcc.read(kApb1Enable, 2004);
  EXPECT_TRUE(rcc.live(kTim2, 2005)) << "the read back took the time";
  rcc.write(kApb1Enable, 0, 3000);
  EXPECT_FALSE(rcc.live(kCan, 4000));
}

}  // namespace
}  // namespace kinebus::emulator
