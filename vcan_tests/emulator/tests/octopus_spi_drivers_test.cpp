// The Octopus with drivers behind SPI in some of its sockets: found, told their settings, and every fault
// that they tell, at the emulated pins.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/tests/octopus_drivers.hpp"

namespace kinebus::emulator {
namespace {

// TMC5160s in sockets 0 and 1, TMC2130s in 2 and 3, TMC2209s in the others.
constexpr std::array k5160{0, 1}, k2130{2, 3};
constexpr std::array k2209{4, 5, 6, 7};
constexpr std::array kBySpi{0, 1, 2, 3};

std::unique_ptr<OctopusBoard> mixed_octopus(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<OctopusBoard>(image, options);
  for (const int axis : k5160) board->plug(axis, {});
  for (const int axis : k2130) board->plug(axis, tmc2130_parameters());
  return board;
}
std::unique_ptr<Chip> make_mixed_octopus(const ElfImage& image, const BoardOptions& options) {
  return mixed_octopus(image, options);
}
template <int kFloating>
std::unique_ptr<Chip> without_answers_of_1(const ElfImage& image, const BoardOptions& options) {
  auto board = mixed_octopus(image, options);
  board->spi_driver(1).set_answers(false);
  board->driver_spi().floating = kFloating;
  return board;
}
std::unique_ptr<Chip> eight_tmc5160(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<OctopusBoard>(image, options);
  for (int axis = 0; axis < 8; ++axis) board->plug(axis, {});
  return board;
}

struct OctopusSpiDrivers : OctopusDriverRig {
  explicit OctopusSpiDrivers(BoardMaker make = &make_mixed_octopus) : OctopusDriverRig(make) {}
  TmcSpiChip& chip(int axis) { return octopus.board.spi_driver(axis); }
  void expect_good_spi() {
    for (const int axis : kBySpi) EXPECT_EQ(chip(axis).bad_datagrams(), 0u) << "axis " << axis;
    EXPECT_EQ(octopus.board.driver_spi().fights(), 0u);
    EXPECT_EQ(octopus.board.wire_fights(), 0u);
    EXPECT_TRUE(octopus.board.strange_accesses().empty());
    EXPECT_TRUE(octopus.board.lost_accesses().empty());
  }
};

TEST_F(OctopusSpiDrivers, EachIsFoundAndHasItsSettingsBeforeItsNodeIsHeard) {
  octopus.bench.run(300ms);
  for (const int axis : kBySpi) {
    EXPECT_EQ(driver_object(axis, 5), 2) << "axis " << axis;
    EXPECT_EQ(driver_object(axis, 9), axis < 2 ? 5160 : 2130);
    EXPECT_EQ(chip(axis).microsteps(), 16);
    EXPECT_TRUE(chip(axis).interpolates());
    EXPECT_FALSE(chip(axis).stealth());
    // 2140h:2 and :3 are 1500 and 1000 mA.
    EXPECT_NEAR(chip(axis).run_amperes(), 1.46, 0.041);
    EXPECT_NEAR(chip(axis).hold_amperes(), 0.96, 0.041);
    EXPECT_EQ(chip(axis).read_register(1), 0u) << "GSTAT";
    EXPECT_TRUE(octopus.bench.emergencies(id_of(axis)).empty());
  }
  for (const int axis : k2209) {
    EXPECT_EQ(driver_object(axis, 5), 2) << "axis " << axis;
    EXPECT_EQ(driver_object(axis, 9), 2209);
    EXPECT_EQ(octopus.board.tmc(axis).bad_datagrams(), 0u);
  }
  expect_good_spi();
}

TEST_F(OctopusSpiDrivers, CurrentsAndTheSenseResistorActAtOnceAlsoWithPower) {
  octopus.enable(0, 1);
  octopus.enable(3, 1);
  for (const int axis : {0, 3}) {
    octopus.write(axis, 0x2140, 2, 2, 600);
    octopus.write(axis, 0x2140, 3, 2, 300);
  }
  octopus.bench.run(60ms);
  for (const int axis : {0, 3}) {
    EXPECT_NEAR(chip(axis).run_amperes(), 0.59, 0.03);
    EXPECT_NEAR(chip(axis).hold_amperes(), 0.28, 0.03);
  }
  octopus.write(0, 0x2170, 8, 2, 150);
  octopus.bench.run(60ms);
  EXPECT_NEAR(chip(0).run_amperes(), 1.19, 0.03) << "resistors twice as large would make 0.6 A of it";
  EXPECT_EQ(octopus.bench.emergencies(id_of(0)).size(), 0u);
  expect_good_spi();
}

// The torque is the current's: what 1.5 A turn, 0.3 A do not.
TEST_F(OctopusSpiDrivers, TooLittleCurrentForTheLoadLosesSteps) {
  for (const int axis : {0, 2}) {
    chip(axis).rotor().set_load(0.25);
    octopus.enable(axis, 1);
    octopus.move(axis, 64'000, 100'000, 1'000'000);
    octopus.bench.run(1s);
    EXPECT_NEAR(octopus.board.true_counts(axis), 64'000, 300);
    octopus.write(axis, 0x2140, 2, 2, 300);
    octopus.write(axis, 0x2140, 3, 2, 300);
    octopus.bench.run(60ms);
    octopus.move(axis, 128'000, 100'000, 1'000'000);
    octopus.bench.run(1s);
    EXPECT_LT(octopus.board.true_counts(axis), 66'000);
  }
}

TEST_F(OctopusSpiDrivers, StealthChopBelowAVelocityWhereItIsAskedFor) {
  for (const int axis : {0, 2}) {
    octopus.bench.write(id_of(axis), 0x2170, 2, 4, 100'000);
    octopus.bench.run(60ms);
    EXPECT_TRUE(chip(axis).stealth());
    EXPECT_FALSE(chip(axis + 1).stealth());
    octopus.write(axis, 0x607F, 0, 4, 400'000);
    octopus.enable(axis, 1);
    octopus.move(axis, 4'000'000, 300'000, 3'200'000);
    octopus.bench.run(300ms);
    EXPECT_FALSE(chip(axis).stealth()) << "faster than that";
  }
}

TEST_F(OctopusSpiDrivers, AFewGarbledAnswersAreNoFault) {
  for (const int axis : {0, 2}) {
    start_moving(axis);
    for (int i = 0; i < 5; ++i) {
      chip(axis).garble(3);
      octopus.bench.run(400ms);
    }
    EXPECT_EQ(driver_object(axis, 5), 2);
    EXPECT_TRUE(octopus.bench.emergencies(id_of(axis)).empty());
  }
}

TEST_F(OctopusSpiDrivers, OneThatGoesSilentStopsAllOnThePathAndKeepsItsPower) {
  start_moving(0);
  start_moving(5);
  chip(0).set_answers(false);
  octopus.bench.run(500ms);
  EXPECT_TRUE(told(0, emcy::kDriverSilent));
  EXPECT_EQ(driver_object(0, 5), 4);
  EXPECT_TRUE(octopus.board.driver(0).enabled());
  octopus.board.clear_edges();
  octopus.bench.run(100ms);
  EXPECT_TRUE(octopus.board.driver(0).edges().empty());
  EXPECT_TRUE(octopus.board.driver(5).edges().empty()) << "all";
  // Without power it does not get it again.
  disable(0);
  for (const int word : {0x80, 0x06, 0x07}) octopus.write(0, 0x6040, 0, 2, word);
  octopus.bench.run(50ms);
  EXPECT_TRUE(faulty(0));
  EXPECT_FALSE(octopus.board.driver(0).enabled());
}

TEST_F(OctopusSpiDrivers, ThePreWarningStopsAllOnThePathAndTooMuchHeatTakesThePower) {
  start_moving(2);
  chip(2).set_temperature(125);
  octopus.bench.run(500ms);
  EXPECT_TRUE(told(2, emcy::kDriveTemperature));
  EXPECT_TRUE(octopus.board.driver(2).enabled());
  octopus.board.clear_edges();
  octopus.bench.run(100ms);
  EXPECT_TRUE(octopus.board.driver(2).edges().empty());
  chip(2).set_temperature(155);
  octopus.bench.run(300ms);
  EXPECT_TRUE(faulty(2));
  EXPECT_FALSE(octopus.board.driver(2).enabled());
}

/// A TMC5160's axis, and a TMC2130's.
struct EachSpiDriver : OctopusSpiDrivers, testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Chips, EachSpiDriver, testing::Values(1, 2));

TEST_P(EachSpiDriver, AShortIsAFault) {
  expect_fault(
      GetParam(), chip(GetParam()), emcy::kShortToGround,
      [](TmcSpiChip& chip) { chip.short_to_ground(true); },
      [](TmcSpiChip& chip) { chip.short_to_ground(false); });
  expect_good_spi();
}

TEST_P(EachSpiDriver, AnOpenPhaseIsAFault) {
  expect_fault(
      GetParam(), chip(GetParam()), emcy::kPhaseOpen, [](TmcSpiChip& chip) { chip.open_phase(true); },
      [](TmcSpiChip& chip) { chip.open_phase(false); });
}

TEST_P(EachSpiDriver, ALowChargePumpIsAFault) {
  expect_fault(
      GetParam(), chip(GetParam()), emcy::kUnderVoltage,
      [](TmcSpiChip& chip) { chip.set_charge_pump_low(true); },
      [](TmcSpiChip& chip) { chip.set_charge_pump_low(false); });
}

// The motor supply dips: the settings are gone, and with them microsteps and current.
TEST_P(EachSpiDriver, ThatHasLostItsSettingsIsAFaultAndGetsThemAgain) {
  expect_fault(
      GetParam(), chip(GetParam()), emcy::kDriverReset,
      [](TmcSpiChip& chip) {
        chip.set_supply(false);
        chip.set_supply(true);
        EXPECT_EQ(chip.microsteps(), 256);
      },
      [](TmcSpiChip& chip) { EXPECT_EQ(chip.microsteps(), 16); });
  expect_good_spi();
}

TEST_F(OctopusSpiDrivers, AShortToTheSupplyIsAFault) {
  expect_fault(
      1, chip(1), emcy::kShortToSupply, [](TmcSpiChip& chip) { chip.short_to_supply(true); },
      [](TmcSpiChip& chip) { chip.short_to_supply(false); });
}

// The carriage meets its end: DIAG1 leads to the stop beside the driver, as a home switch.
TEST_P(EachSpiDriver, FindsTheEndOfTheWayByStallGuard2WhileItHomesAndOnlyThen) {
  const int axis = GetParam();
  octopus.board.wire_diag(axis);
  octopus.board.set_input(axis, false);
  chip(axis).rotor().set_load(0.05);
  chip(axis).rotor().set_end_stop(40'000, true);
  octopus.write(axis, 0x2170, 3, 1, 160);
  octopus.write(axis, 0x2170, 4, 4, 20'000);
  octopus.write(axis, 0x6098, 0, 1, 20);
  octopus.write(axis, 0x6099, 1, 4, 60'000);
  octopus.enable(axis, 6);
  octopus.bench.run(60ms);
  EXPECT_EQ(chip(axis).read_register(0) & 0x2104, 0x2100u) << "DIAG1 and SpreadCycle while it homes";
  octopus.write(axis, 0x6040, 0, 2, 0x1F);
  bool told = false;
  for (int i = 0; i < 2000 && !told; ++i) {
    octopus.bench.run(1ms);
    told = chip(axis).diag();
  }
  EXPECT_TRUE(told);
  EXPECT_NEAR(octopus.board.true_counts(axis), 40'000, 1'100) << "an electrical turn, by which it slips";
  disable(axis);
  octopus.write(axis, 0x6060, 0, 1, 1);
  octopus.bench.run(60ms);
  EXPECT_EQ(chip(axis).read_register(0) & 0x2104, 0u);
}

template <int kFloating>
struct OctopusWithoutAnSpiDriver : OctopusSpiDrivers {
  OctopusWithoutAnSpiDriver() : OctopusSpiDrivers(&without_answers_of_1<kFloating>) {}
  void expect_told_and_not_enabled() {
    EXPECT_EQ(octopus.bench.read(id_of(1), 0x1003, 1) & 0xFFFF, emcy::kDriverSilent);
    EXPECT_EQ(driver_object(1, 5), 4);
    EXPECT_EQ(driver_object(1, 9), 0);
    octopus.enable(0, 1);
    octopus.write(1, 0x6060, 0, 1, 1);
    for (const int word : {0x06, 0x07}) octopus.write(1, 0x6040, 0, 2, word);
    octopus.bench.run(50ms);
    EXPECT_TRUE(faulty(1));
    EXPECT_EQ(octopus.read(1, 0x603F), emcy::kDriverSilent);
    EXPECT_FALSE(octopus.board.driver(1).enabled());
    EXPECT_TRUE(octopus.board.driver(0).enabled());
    EXPECT_EQ(chip(1).writes(), 0u);
    // It is there after all, as when the motor supply comes later.
    chip(1).set_answers(true);
    octopus.bench.run(1200ms);
    EXPECT_EQ(driver_object(1, 9), 5160);
    for (const int word : {0x80, 0x00}) octopus.write(1, 0x6040, 0, 2, word);
    octopus.enable(1, 1);
    EXPECT_TRUE(octopus.board.driver(1).enabled());
    expect_good_spi();
  }
};
using OctopusWithALineThatFloatsHigh = OctopusWithoutAnSpiDriver<0xFF>;
using OctopusWithALineThatFloatsLow = OctopusWithoutAnSpiDriver<0x00>;

TEST_F(OctopusWithALineThatFloatsHigh, ItIsToldAndItsAxisIsNotEnabledUntilItAnswers) {
  expect_told_and_not_enabled();
}
TEST_F(OctopusWithALineThatFloatsLow, ItIsToldAndItsAxisIsNotEnabledUntilItAnswers) {
  expect_told_and_not_enabled();
}

struct OctopusWithEightBySpi : OctopusSpiDrivers {
  OctopusWithEightBySpi() : OctopusSpiDrivers(&eight_tmc5160) {}
};

// As OctopusNodes, SixAxesMakeTwoHundredThousandStepsASecondEach, with a datagram in each pass.
TEST_F(OctopusWithEightBySpi, AreAskedInTimeAtTheMostStepsAndAFullBus) {
  for (int axis = 0; axis < 8; ++axis) {
    EXPECT_EQ(driver_object(axis, 5), 2) << "axis " << axis;
    EXPECT_EQ(driver_object(axis, 9), 5160);
    octopus.write(axis, 0x607F, 0, 4, 3'200'000);
    octopus.enable(axis, 1);
  }
  for (int axis = 0; axis < 6; ++axis) octopus.move(axis, 1'600'000, 3'200'000, 32'000'000);
  auto strangers = strangers_on(octopus);
  const OctopusLoad load = load_of(octopus, strangers);
  chip(5).set_temperature(125);
  octopus.bench.run(200ms, 200us, strangers);
  EXPECT_TRUE(told(5, emcy::kDriveTemperature)) << "six datagrams for each of eight, one in each pass";
  fmt::print(
      "eight drivers by SPI: control interrupt {:.1f} %, processor awake {:.0f} %, main loop {:.1f} ms at "
      "most\n",
      100 * load.control, 100 * load.awake, load.longest_pass_ms);
  expect_within_budget(load);
  for (int axis = 0; axis < 8; ++axis) EXPECT_EQ(chip(axis).bad_datagrams(), 0u) << "axis " << axis;
  octopus.expect_good_drivers();
}

}  // namespace
}  // namespace kinebus::emulator
