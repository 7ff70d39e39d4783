// The model of TMC5160 and TMC2130 as a judge of who speaks to it.

#include "vcan_tests/emulator/physics/tmc_spi_chip.hpp"

#include <gtest/gtest.h>

namespace kinebus::emulator {
namespace {

/// A master that keeps every rule, until it is told otherwise.
struct SpiMaster {
  explicit SpiMaster(const SpiDriverParameters& parameters = {}) : chip(parameters) {}
  /// 40 bits: status and what the datagram before has asked for.
  std::uint64_t say(std::uint8_t address, std::uint32_t value = 0, int bytes = 5) {
    const auto bits8 = static_cast<Cycle>(8.0 * static_cast<double>(kCoreHz) / clock.hz);
    now += gap;
    chip.on_select(true, now);
    now += around;
    const std::uint64_t said = std::uint64_t{address} << 32 | value;
    std::uint64_t heard = 0;
    for (int i = 0; i < bytes; ++i) {
      now += bits8;
      heard = heard << 8 | chip.exchange(static_cast<std::uint8_t>(said >> (32 - 8 * i)), clock, now);
    }
    now += around;
    chip.on_select(false, now);
    return heard;
  }
  static std::uint32_t value_of(std::uint64_t heard) { return static_cast<std::uint32_t>(heard); }
  TmcSpiChip chip;
  TmcSpiChip::Clock clock{};
  Cycle now = kCoreHz, gap = kCoreHz / 1'000'000, around = 10;
};

TEST(TmcSpiChip, AnswersOneDatagramLateAndBringsBackWhatWasWritten) {
  SpiMaster spi;
  spi.say(0x6C);
  EXPECT_EQ(spi.value_of(spi.say(0x04)), 0x1041'0150u) << "CHOPCONF after reset";
  EXPECT_EQ(spi.value_of(spi.say(0x80 | 0x10, 0x0006'1F0A)) >> 24, 0x30u) << "IOIN";
  const std::uint64_t heard = spi.say(0x01);
  EXPECT_EQ(spi.value_of(heard), 0x0006'1F0Au);
  EXPECT_EQ(heard >> 32 & 1, 1u) << "status: it was reset";
  EXPECT_EQ(spi.value_of(spi.say(0x80 | 0x01, 7)), 1u) << "GSTAT";
  spi.say(0x01);
  EXPECT_EQ(spi.value_of(spi.say(0x01)), 0u) << "cleared by writing";
  EXPECT_EQ(spi.chip.bad_datagrams(), 0u);
}

TEST(TmcSpiChip, ATmc2130ClearsGstatWhenItIsReadAndHasFewerRegisters) {
  SpiMaster spi{tmc2130_parameters()};
  spi.say(0x04);
  EXPECT_EQ(spi.value_of(spi.say(0x01)) >> 24, 0x11u);
  EXPECT_EQ(spi.value_of(spi.say(0x01)), 1u);
  EXPECT_EQ(spi.value_of(spi.say(0x01)), 0u);
  EXPECT_EQ(spi.chip.bad_datagrams(), 0u);
  spi.say(0x80 | 0x0B, 128);
  EXPECT_EQ(spi.chip.bad_datagrams(), 1u) << "GLOBALSCALER is a TMC5160's";
}

TEST(TmcSpiChip, JudgesModeClockAndTimes) {
  const auto bad = [](auto change) {
    SpiMaster spi;
    spi.say(0x04);
    change(spi);
    return spi.chip.bad_datagrams();
  };
  EXPECT_EQ(bad([](SpiMaster& spi) { spi.say(0x04); }), 0u);
  EXPECT_GT(bad([](SpiMaster& spi) { spi.clock.mode = 0, spi.say(0x04); }), 0u);
  EXPECT_GT(bad([](SpiMaster& spi) { spi.clock.hz = 4.2e6, spi.say(0x04); }), 0u);
  EXPECT_GT(bad([](SpiMaster& spi) { spi.say(0x04, 0, 4); }), 0u) << "32 bits";
  EXPECT_GT(bad([](SpiMaster& spi) { spi.gap = 20, spi.say(0x04); }), 0u) << "CSN high for 120 ns";
  EXPECT_GT(bad([](SpiMaster& spi) { spi.around = 0, spi.say(0x04); }), 0u) << "no time around CSN";
  EXPECT_GT(bad([](SpiMaster& spi) { spi.say(0x80 | 0x0B, 16); }), 0u) << "GLOBALSCALER below 32";
}

TEST(TmcSpiChip, TellsWhatItFinds) {
  SpiMaster spi;
  TmcSpiChip& chip = spi.chip;
  spi.say(0x80 | 0x01, 7);
  spi.say(0x80 | 0x6C, 0x1441'00C3);
  chip.on_enable(true);
  EXPECT_TRUE(chip.bridges_on());
  chip.short_to_ground(true);
  EXPECT_FALSE(chip.bridges_on());
  EXPECT_EQ(chip.read_register(0x6F) >> 27 & 3, 1u);
  EXPECT_EQ(chip.read_register(0x01), 2u);
  chip.short_to_ground(false);
  EXPECT_FALSE(chip.bridges_on()) << "until it is disabled";
  chip.on_enable(false);
  chip.on_enable(true);
  EXPECT_TRUE(chip.bridges_on());
  chip.set_temperature(125);
  EXPECT_EQ(chip.read_register(0x6F) >> 25 & 3, 2u) << "pre-warning";
  chip.set_temperature(155);
  EXPECT_EQ(chip.read_register(0x6F) >> 25 & 3, 3u);
  EXPECT_FALSE(chip.bridges_on());
  chip.set_temperature(40);
  chip.set_supply(false);
  chip.set_supply(true);
  EXPECT_EQ(chip.read_register(0x01), 1u);
  EXPECT_FALSE(chip.bridges_on()) << "TOFF is 0 after power-up";
}

}  // namespace
}  // namespace kinebus::emulator
