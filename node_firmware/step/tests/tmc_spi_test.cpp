// What is said to a TMC5160 or TMC2130 by SPI: datagrams and settings, how it is found, and what becomes of
// answers that are none.

#include "node_firmware/step/tmc_spi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "node_firmware/step/driver_chain.hpp"

namespace kinebus::tmc_spi {
namespace {

using namespace std::chrono_literals;
using step::DriverState;

// Both datasheets, "Getting started" (SPI datagram example sequence).
TEST(TmcSpiDatagram, IsAsTheDatasheetsExamplesAre) {
  EXPECT_EQ(write_of(reg::kChopconf, 0x0001'00C3), (Datagram{0xEC, 0x00, 0x01, 0x00, 0xC3}));
  EXPECT_EQ(write_of(reg::kIholdIrun, 0x0006'1F0A), (Datagram{0x90, 0x00, 0x06, 0x1F, 0x0A}));
  EXPECT_EQ(write_of(reg::kTpowerdown, 10), (Datagram{0x91, 0x00, 0x00, 0x00, 0x0A}));
  EXPECT_EQ(write_of(reg::kGconf, 4), (Datagram{0x80, 0x00, 0x00, 0x00, 0x04}));
  EXPECT_EQ(write_of(reg::kTpwmthrs, 500), (Datagram{0x93, 0x00, 0x00, 0x01, 0xF4}));
  EXPECT_EQ(write_of(reg::kPwmconf, 0x0004'01C8), (Datagram{0xF0, 0x00, 0x04, 0x01, 0xC8}));
  EXPECT_EQ(read_of(0x21), (Datagram{0x21, 0, 0, 0, 0}));
}

TEST(TmcSpiDatagram, AnAnswerIsStatusAndValueOrNothing) {
  const std::array<std::uint8_t, 5> heard{0x09, 0x30, 0x00, 0x00, 0x51};
  const auto answer = answer_of(heard);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, spi_status::kReset | spi_status::kStandstill);
  EXPECT_EQ(answer->value, 0x3000'0051u);
  EXPECT_FALSE(answer_of(std::span(heard).first(4)));
  EXPECT_FALSE(answer_of({}));
}

std::uint32_t value_of(const Registers& registers, std::uint8_t address) {
  for (std::size_t i = 0; i < registers.count; ++i)
    if (registers.all[i].address == address) return registers.all[i].value;
  ADD_FAILURE() << "register " << int{address} << " is not written";
  return 0;
}

TEST(TmcSpiSettings, CurrentsOfATmc5160AreNeverMoreThanAskedForAndCloseToIt) {
  for (const std::uint32_t sense : {22u, 50u, 75u, 100u})
    for (std::uint32_t ma = 300; ma <= 5000; ma += 7) {
      const GlobalScale scale = global_scale_of(ma, ma / 2, sense);
      const double full = 325'000.0 / sense;
      const auto amplitude = [&](int part) { return full * scale.scaler / 256 * (part + 1) / 32; };
      ASSERT_TRUE(scale.scaler >= 32 && scale.scaler <= 256) << "the datasheet forbids 1 to 31";
      const double least = full / 8 / 32;
      EXPECT_LE(amplitude(scale.run), std::max(ma + 1.0, least)) << ma << " mA at " << sense;
      if (ma > least * 2 && ma < full) {
        EXPECT_GT(amplitude(scale.run), ma - full / 200 - 2);
      }
      EXPECT_LE(scale.hold, scale.run);
    }
  EXPECT_EQ(global_scale_of(5000, 5000, 75).run, 31) << "the most that it can";
  EXPECT_EQ(global_scale_of(0, 0, 75).run, 0);
}

TEST(TmcSpiSettings, RegistersOfATmc5160) {
  const Registers r = tmc5160_registers({.run_ma = 2000, .hold_ma = 1000});
  EXPECT_EQ(value_of(r, reg::kGlobalScaler), 118u);  // 2000 of 4333 mA
  EXPECT_EQ(value_of(r, reg::kIholdIrun) & 0x1F1F, 31u << 8 | 15u);
  EXPECT_EQ(value_of(r, reg::kChopconf), 0x1441'00C3u)
      << "the datasheet's example, 16 microsteps, interpolated";
  EXPECT_EQ(value_of(r, reg::kGconf) & 4, 0u) << "SpreadCycle";
  EXPECT_EQ(r.chopper().address, reg::kChopconf);
  const Registers whole = tmc5160_registers({.run_ma = 5000, .hold_ma = 1000});
  EXPECT_EQ(value_of(whole, reg::kGlobalScaler), 0u) << "0 is 256";
  const Registers other = tmc5160_registers({.run_ma = 2000, .hold_ma = 1000, .sense_milliohm = 22});
  EXPECT_EQ(value_of(other, reg::kGlobalScaler), 34u);  // of 14772 mA
}

TEST(TmcSpiSettings, RegistersOfATmc2130) {
  const Registers r = tmc2130_registers({.run_ma = 2000, .hold_ma = 1000});
  // 2461 mA at 0.11 and 0.02 ohm.
  EXPECT_EQ(value_of(r, reg::kIholdIrun) & 0x1F1F, 25u << 8 | 12u);
  EXPECT_EQ(value_of(r, reg::kChopconf), 0x1401'00C3u);
  EXPECT_EQ(value_of(tmc2130_registers({.run_ma = 1000, .hold_ma = 500}), reg::kChopconf), 0x1403'00C3u)
      << "VSENSE";
}

TEST(TmcSpiSettings, StealthChopAndStallGuardAsTheyAreAskedFor) {
  const Registers stealth = tmc5160_registers({.run_ma = 1000, .spread_above = 24'000});
  EXPECT_EQ(value_of(stealth, reg::kGconf) & 4, 4u);
  EXPECT_EQ(value_of(stealth, reg::kTpwmthrs), 500u);
  const step::DriverSettings homing{
      .run_ma = 1000, .spread_above = 24'000, .stall_threshold = 255, .stall_above = 12'000, .homing = true};
  for (const Registers& r : {tmc5160_registers(homing), tmc2130_registers(homing)}) {
    EXPECT_EQ(value_of(r, reg::kGconf) & 4, 0u) << "StallGuard2 needs SpreadCycle";
    EXPECT_EQ(value_of(r, reg::kGconf) & (1u << 8 | 1u << 13), 1u << 8 | 1u << 13) << "DIAG1, driven high";
    EXPECT_EQ(value_of(r, reg::kCoolconf) >> 16 & 0x7F, 0x40u) << "-64: at the lightest load";
    EXPECT_GT(value_of(r, reg::kTcoolthrs), 900u);
  }
}

/// SPI and a chip that keeps what it is told; each answer one datagram late.
struct FakeSpi {
  void begin(std::size_t, const step::Exchange& exchange) {
    heard.clear();
    if (exchange.bus != step::DriverBus::kSpi) return;
    ++exchanges;
    const std::span<const std::uint8_t> said = exchange.said();
    if (!there) {
      heard.assign(5, floating);
      return;
    }
    heard = {status, 0, 0, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) heard[1 + i] = static_cast<std::uint8_t>(answer >> (24 - 8 * i));
    if (garbled > 0) --garbled, heard[3] ^= 0x20;
    status = static_cast<std::uint8_t>(gstat & 3);
    take_in(said);
  }
  void take_in(std::span<const std::uint8_t> said) {
    const std::uint8_t address = said[0] & 0x7F;
    const std::uint32_t value =
        std::uint32_t{said[1]} << 24 | std::uint32_t{said[2]} << 16 | std::uint32_t{said[3]} << 8 | said[4];
    if (address == reg::kIoin) answer = version << 24 | 0x40;
    if ((said[0] & kWrite) != 0) {
      ++writes;
      answer = value;
      if (address == reg::kGstat && version == 0x30) gstat &= ~value;
      registers[address] = value;
    } else if (address == reg::kGstat) {
      answer = gstat;
      if (version == 0x11) gstat = 0;
    } else if (address != reg::kIoin) {
      answer = registers[address];
    }
  }
  bool done() const { return true; }
  std::size_t take(std::span<std::uint8_t> bytes) const {
    const std::size_t n = std::min(bytes.size(), heard.size());
    std::copy_n(heard.begin(), n, bytes.begin());
    return n;
  }
  bool there = true;
  std::uint8_t floating = 0xFF, status = 0;
  int garbled = 0, exchanges = 0, writes = 0;
  std::uint32_t version = 0x30, gstat = 1, answer = 0;
  std::map<std::uint8_t, std::uint32_t> registers;
  std::vector<std::uint8_t> heard;
};

struct SpiChain : testing::Test {
  void run(LocalTime time) {
    for (const LocalTime end = now + time; now < end; now += 1ms) chain.serve(now);
  }
  FakeSpi wire;
  step::DriverChain<FakeSpi, 1> chain{wire};
  step::DriverSocket& driver = chain.driver(0);
  LocalTime now{0};
};

TEST_F(SpiChain, ATmc5160IsFoundAndGetsItsSettings) {
  driver.set({.run_ma = 2000, .hold_ma = 1000});
  run(60ms);
  EXPECT_TRUE(chain.settled());
  EXPECT_EQ(driver.chip().found(), 5160);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_EQ(wire.registers[reg::kGlobalScaler], 118u);
  EXPECT_EQ(wire.registers[reg::kChopconf], 0x1441'00C3u);
  EXPECT_EQ(wire.gstat, 0u);
  EXPECT_FALSE(driver.chip().lost_settings());
  const int before = wire.writes;
  driver.set({.run_ma = 2000, .hold_ma = 500});
  EXPECT_TRUE(driver.usable());
  run(20ms);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_EQ(wire.registers[reg::kIholdIrun] & 31, 7u);
  EXPECT_EQ(wire.writes, before + 1) << "what has not changed is not written";
}

TEST_F(SpiChain, ATmc2130IsFoundAndItsReadsOfGstatAreMinded) {
  wire.version = 0x11;
  driver.set({.run_ma = 1000, .hold_ma = 500});
  run(200ms);
  EXPECT_EQ(driver.chip().found(), 2130);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_FALSE(driver.chip().lost_settings()) << "the reset before the settings is of no account";
  wire.gstat = gstat::kReset;
  wire.registers.clear();
  run(200ms);
  EXPECT_TRUE(driver.chip().lost_settings());
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_EQ(wire.registers[reg::kChopconf], 0x1403'00C3u);
}

TEST_F(SpiChain, NobodyIsSilenceWhateverTheLineFloatsTo) {
  for (const std::uint8_t level : {std::uint8_t{0x00}, std::uint8_t{0xFF}}) {
    wire.there = false;
    wire.floating = level;
    driver.set_spoken_to(false);
    driver.set_spoken_to(true);
    run(100ms);
    EXPECT_TRUE(chain.settled());
    EXPECT_EQ(driver.state(), DriverState::kSilent) << int{level};
    EXPECT_EQ(driver.chip().found(), 0);
    EXPECT_FALSE(driver.usable());
  }
  const int before = wire.exchanges;
  run(2s);
  EXPECT_LT(wire.exchanges, before + 20) << "it is not asked all the time";
  wire.there = true;
  run(1s);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
}

TEST_F(SpiChain, AnotherChipIsNotTakenForOne) {
  wire.version = 0x20;
  run(2s);
  EXPECT_EQ(driver.state(), DriverState::kSilent);
  EXPECT_EQ(wire.writes, 0) << "nothing is written into it";
}

TEST_F(SpiChain, OneThatGoesSilentIsToldAndComesBackWithItsSettings) {
  run(60ms);
  for (const std::uint8_t level : {std::uint8_t{0x00}, std::uint8_t{0xFF}}) {
    wire.there = false;
    wire.floating = level;
    run(300ms);
    EXPECT_EQ(driver.state(), DriverState::kSilent);
    EXPECT_EQ(driver.chip().found(), 5160) << "it is not taken for another";
    wire.there = true;
    wire.registers.clear();
    run(1s);
    EXPECT_EQ(driver.state(), DriverState::kConfigured);
    EXPECT_EQ(wire.registers[reg::kChopconf], 0x1441'00C3u);
  }
}

TEST_F(SpiChain, GarbledAnswersAreAskedForAgain) {
  for (int garbled = 1; garbled < 4; ++garbled) {
    wire.garbled = garbled;
    run(300ms);
    EXPECT_EQ(driver.state(), DriverState::kConfigured) << garbled;
    EXPECT_EQ(driver.chip().findings(), 0);
    EXPECT_FALSE(driver.chip().lost_settings());
  }
}

TEST_F(SpiChain, ASupplyThatWasGoneIsSeenAndTheSettingsComeBack) {
  run(80ms);
  wire.gstat = gstat::kReset;
  wire.registers.clear();
  run(200ms);
  EXPECT_TRUE(driver.chip().lost_settings());
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_EQ(wire.registers[reg::kChopconf], 0x1441'00C3u);
  driver.acknowledge();
  run(200ms);
  EXPECT_FALSE(driver.chip().lost_settings());
}

TEST_F(SpiChain, WhatItFindsIsSeen) {
  run(80ms);
  const std::map<std::uint32_t, std::uint8_t> found{
      {1u << 25, step::finding::kTooHot},        {1u << 26, step::finding::kPreWarning},
      {1u << 12, step::finding::kShortToSupply}, {1u << 28, step::finding::kShortToGround},
      {1u << 30, step::finding::kOpenPhase},     {1u << 31, step::finding::kStandstill}};
  for (const auto& one : found) {
    wire.registers[reg::kDrvStatus] = one.first;
    run(100ms);
    EXPECT_EQ(driver.chip().findings(), one.second) << std::hex << one.first;
  }
  wire.gstat = gstat::kDriverError | gstat::kChargePumpLow;
  for (int i = 0; i < 60 && !driver.chip().charge_pump_low(); ++i) run(1ms);
  EXPECT_TRUE(driver.chip().charge_pump_low());
  EXPECT_TRUE(driver.chip().driver_error());
  run(100ms);
  EXPECT_FALSE(driver.chip().charge_pump_low()) << "cleared, and it has not come again";
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
}

TEST_F(SpiChain, OneThatStandsAloneIsLeftAlone) {
  driver.set_spoken_to(false);
  run(1s);
  EXPECT_EQ(wire.exchanges, 0);
  EXPECT_TRUE(driver.usable());
}

}  // namespace
}  // namespace kinebus::tmc_spi
