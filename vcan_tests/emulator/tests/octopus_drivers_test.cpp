// The Octopus' TMC2209s: settings by their wires, and every fault that they tell, at the emulated pins.

#include <gtest/gtest.h>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/tests/octopus_drivers.hpp"

namespace kinebus::emulator {
namespace {

std::unique_ptr<Chip> board_without_driver_3(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<OctopusBoard>(image, options);
  board->tmc(3).set_answers(false);
  return board;
}

struct OctopusDrivers : OctopusDriverRig {
  explicit OctopusDrivers(BoardMaker make = &make_board<OctopusBoard>) : OctopusDriverRig(make) {}
  template <typename Begin, typename End>
  void expect_fault_of_1(std::uint16_t code, Begin begin, End end) {
    expect_fault(1, octopus.board.tmc(1), code, begin, end);
  }
};

TEST_F(OctopusDrivers, EachHasItsSettingsByItsWireBeforeItsNodeIsHeard) {
  octopus.bench.run(300ms);
  for (int axis = 0; axis < 8; ++axis) {
    const Tmc2209& chip = octopus.board.tmc(axis);
    EXPECT_EQ(driver_object(axis, 5), 2) << "axis " << axis;
    EXPECT_EQ(chip.microsteps(), 16);
    EXPECT_TRUE(chip.interpolates());
    EXPECT_FALSE(chip.stealth());
    // 2140h:2 and :3 are 1500 and 1000 mA; a step is 78 mA.
    EXPECT_NEAR(chip.run_amperes(), 1.46, 0.04);
    EXPECT_NEAR(chip.hold_amperes(), 0.96, 0.04);
    EXPECT_EQ(chip.read_register(1), 0u) << "GSTAT";
    EXPECT_EQ(chip.bad_datagrams(), 0u);
    EXPECT_TRUE(octopus.bench.emergencies(id_of(axis)).empty());
  }
  EXPECT_EQ(octopus.board.wire_fights(), 0u);
  EXPECT_TRUE(octopus.board.strange_accesses().empty());
  EXPECT_TRUE(octopus.board.lost_accesses().empty());
}

TEST_F(OctopusDrivers, CurrentsActAtOnceAlsoWithPower) {
  octopus.enable(2, 1);
  for (const int axis : {2, 3}) {
    octopus.write(axis, 0x2140, 2, 2, 600);
    octopus.write(axis, 0x2140, 3, 2, 300);
  }
  octopus.bench.run(60ms);
  for (const int axis : {2, 3}) {
    EXPECT_NEAR(octopus.board.tmc(axis).run_amperes(), 0.58, 0.03);
    EXPECT_NEAR(octopus.board.tmc(axis).hold_amperes(), 0.28, 0.03);
  }
}

// The torque is the current's: what 1.5 A turn, 0.3 A do not.
TEST_F(OctopusDrivers, TooLittleCurrentForTheLoadLosesSteps) {
  octopus.board.tmc(0).set_load(0.25);
  octopus.enable(0, 1);
  octopus.move(0, 64'000, 100'000, 1'000'000);
  octopus.bench.run(1s);
  EXPECT_NEAR(octopus.board.true_counts(0), 64'000, 300);
  octopus.write(0, 0x2140, 2, 2, 300);
  octopus.bench.run(60ms);
  octopus.move(0, 128'000, 100'000, 1'000'000);
  octopus.bench.run(1s);
  EXPECT_LT(octopus.board.true_counts(0), 66'000);
}

TEST_F(OctopusDrivers, StealthChopBelowAVelocityWhereItIsAskedFor) {
  octopus.bench.write(id_of(4), 0x2170, 2, 4, 100'000);
  octopus.bench.run(60ms);
  EXPECT_TRUE(octopus.board.tmc(4).stealth());
  EXPECT_FALSE(octopus.board.tmc(5).stealth());
  octopus.write(4, 0x607F, 0, 4, 400'000);
  octopus.enable(4, 1);
  octopus.move(4, 4'000'000, 300'000, 3'200'000);
  octopus.bench.run(300ms);
  EXPECT_FALSE(octopus.board.tmc(4).stealth()) << "faster than that";
}

TEST_F(OctopusDrivers, AFewGarbledAnswersAreNoFault) {
  start_moving(0);
  for (int i = 0; i < 5; ++i) {
    octopus.board.tmc(0).garble(3);
    octopus.bench.run(400ms);
  }
  EXPECT_EQ(driver_object(0, 5), 2);
  EXPECT_TRUE(octopus.bench.emergencies(id_of(0)).empty());
}

TEST_F(OctopusDrivers, OneThatGoesSilentStopsAllOnThePathAndKeepsItsPower) {
  start_moving(0);
  start_moving(5);
  octopus.board.tmc(0).set_answers(false);
  octopus.bench.run(500ms);
  EXPECT_TRUE(told(0, emcy::kDriverSilent));
  EXPECT_TRUE(octopus.board.driver(0).enabled());
  octopus.board.clear_edges();
  octopus.bench.run(100ms);
  EXPECT_TRUE(octopus.board.driver(0).edges().empty());
  EXPECT_TRUE(octopus.board.driver(5).edges().empty()) << "all";
  // Without power it does not get it again.
  octopus.write(0, 0x6040, 0, 2, 0);
  octopus.bench.run(50ms);
  for (const int word : {0x80, 0x06, 0x07}) octopus.write(0, 0x6040, 0, 2, word);
  octopus.bench.run(50ms);
  EXPECT_TRUE(faulty(0));
  EXPECT_FALSE(octopus.board.driver(0).enabled());
}

TEST_F(OctopusDrivers, ThePreWarningStopsAllOnThePathAndTooMuchHeatTakesThePower) {
  start_moving(1);
  octopus.board.tmc(1).set_temperature(125);
  octopus.bench.run(500ms);
  EXPECT_TRUE(told(1, emcy::kDriveTemperature));
  EXPECT_TRUE(octopus.board.driver(1).enabled());
  octopus.board.clear_edges();
  octopus.bench.run(100ms);
  EXPECT_TRUE(octopus.board.driver(1).edges().empty());
  octopus.board.tmc(1).set_temperature(155);
  octopus.bench.run(300ms);
  EXPECT_TRUE(faulty(1));
  EXPECT_FALSE(octopus.board.driver(1).enabled());
}

TEST_F(OctopusDrivers, AShortIsAFault) {
  expect_fault_of_1(
      emcy::kShortToGround, [](Tmc2209& chip) { chip.short_to_ground(true); },
      [](Tmc2209& chip) { chip.short_to_ground(false); });
}

TEST_F(OctopusDrivers, AnOpenPhaseIsAFault) {
  expect_fault_of_1(
      emcy::kPhaseOpen, [](Tmc2209& chip) { chip.open_phase(true); },
      [](Tmc2209& chip) { chip.open_phase(false); });
}

// The motor supply dips: the settings are gone, and with them microsteps and current.
TEST_F(OctopusDrivers, ADriverThatHasLostItsSettingsIsAFaultAndGetsThemAgain) {
  expect_fault_of_1(
      emcy::kDriverReset,
      [](Tmc2209& chip) {
        chip.set_supply(false);
        chip.set_supply(true);
        EXPECT_EQ(chip.microsteps(), 8);
      },
      [](Tmc2209& chip) { EXPECT_EQ(chip.microsteps(), 16); });
}

struct OctopusWithoutADriver : OctopusDrivers {
  OctopusWithoutADriver() : OctopusDrivers(&board_without_driver_3) {}
};

TEST_F(OctopusWithoutADriver, ItIsToldAndItsAxisIsNotEnabledUntilItAnswers) {
  EXPECT_EQ(octopus.bench.read(id_of(3), 0x1003, 1) & 0xFFFF, emcy::kDriverSilent);
  EXPECT_EQ(driver_object(3, 5), 4);
  octopus.enable(2, 1);
  octopus.write(3, 0x6060, 0, 1, 1);
  for (const int word : {0x06, 0x07}) octopus.write(3, 0x6040, 0, 2, word);
  octopus.bench.run(50ms);
  EXPECT_TRUE(faulty(3));
  EXPECT_EQ(octopus.read(3, 0x603F), emcy::kDriverSilent);
  EXPECT_FALSE(octopus.board.driver(3).enabled());
  EXPECT_TRUE(octopus.board.driver(2).enabled());
  for (const int word : {0x80, 0x06, 0x07}) octopus.write(3, 0x6040, 0, 2, word);
  octopus.bench.run(50ms);
  EXPECT_FALSE(octopus.board.driver(3).enabled());
  octopus.board.tmc(3).set_answers(true);
  octopus.bench.run(1s);
  for (const int word : {0x80, 0x00}) octopus.write(3, 0x6040, 0, 2, word);
  octopus.enable(3, 1);
  EXPECT_TRUE(octopus.board.driver(3).enabled());
}

// 2170h:1 = 0: a driver that is left to its jumpers, as any other kind.
TEST_F(OctopusWithoutADriver, OneThatIsToStandAloneIsEnabled) {
  octopus.bench.write(id_of(3), 0x2970, 1, 1, 0);
  octopus.bench.run(20ms);
  octopus.enable(3, 1);
  EXPECT_TRUE(octopus.board.driver(3).enabled());
}

}  // namespace
}  // namespace kinebus::emulator
