// The EBB's TMC2209: settings by its wire, and every fault that it tells, at the emulated pins.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/tests/ebb_bench.hpp"

namespace kinebus::emulator {
namespace {

std::unique_ptr<Chip> board_with_a_silent_driver(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<EbbBoard>(image, options);
  board->tmc().set_answers(false);
  return board;
}
std::unique_ptr<Chip> board_without_motor_supply(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<EbbBoard>(image, options);
  board->tmc().set_supply(false);
  return board;
}

struct EbbDriver : testing::Test {
  explicit EbbDriver(BoardMaker make = &make_board<EbbBoard>) : node({}, make) {}
  ~EbbDriver() override {
    EXPECT_EQ(node.board.usart().misused(), 0u);
    EXPECT_TRUE(node.board.strange_accesses().empty());
    EXPECT_TRUE(node.board.lost_accesses().empty());
    EXPECT_EQ(node.board.resets(), 0u);
  }
  Tmc2209& chip() { return node.board.tmc(); }
  bool enabled() { return node.board.driver().enabled(); }
  bool faulty() { return (node.bench.statusword(kId, 0) & 0x4F) == 0x08; }
  bool told(std::uint16_t code, std::size_t from = 0) {
    const auto codes = node.bench.emergencies(kId, from);
    return std::ranges::find(codes, code) != codes.end();
  }
  bool stands() {
    node.board.clear_edges();
    node.bench.run(100ms);
    return node.board.driver().edges().empty();
  }
  void start_moving() {
    node.write(0x607F, 0, 4, 400'000);
    node.bench.enable(kId, 0, 1);
    node.bench.move(kId, 0, 4'000'000, 50'000, 800'000);
    node.bench.run(200ms);
    EXPECT_GT(node.board.driver().steps(), 200);
  }
  void switch_on() {
    node.write(0x6060, 0, 1, 1);
    for (const int word : {0x80, 0x06, 0x07}) node.write(0x6040, 0, 2, word);
    node.bench.run(50ms);
  }
  void reset_and_enable() {
    for (const int word : {0x80, 0x00}) node.write(0x6040, 0, 2, word);
    node.bench.enable(kId, 0, 1);
  }
  /// What takes the axis' power within 0.5 s, is told by `code`, and can be reset when it has gone.
  template <typename Begin, typename End>
  void expect_fault(std::uint16_t code, Begin begin, End end) {
    start_moving();
    const std::size_t from = node.bench.seen.size();
    begin(chip());
    node.bench.run(500ms);
    EXPECT_TRUE(faulty());
    EXPECT_TRUE(told(code, from));
    EXPECT_EQ(node.read(0x603F), code);
    EXPECT_FALSE(enabled());
    end(chip());
    node.bench.run(1500ms);
    reset_and_enable();
    EXPECT_TRUE(enabled());
  }
  OneEbb node;
};

TEST_F(EbbDriver, HasItsSettingsByItsWireBeforeItsNodeIsHeard) {
  const std::uint64_t writes = chip().writes();
  EXPECT_GE(writes, 11u);
  EXPECT_EQ(node.read(0x2170, 5), 2) << "configured";
  EXPECT_EQ(node.read(0x2170, 9), 2209);
  EXPECT_EQ(chip().microsteps(), 16);
  EXPECT_TRUE(chip().interpolates());
  EXPECT_FALSE(chip().stealth());
  // 2140h:2 and :3 are 1500 and 1000 mA; a step is 78 mA.
  EXPECT_NEAR(chip().run_amperes(), 1.46, 0.04);
  EXPECT_NEAR(chip().hold_amperes(), 0.96, 0.04);
  node.bench.run(1s);
  EXPECT_EQ(chip().read_register(1), 0u) << "GSTAT";
  EXPECT_EQ(chip().writes(), writes);
  EXPECT_EQ(chip().bad_datagrams(), 0u);
  EXPECT_TRUE(node.bench.emergencies(kId).empty());
}

TEST_F(EbbDriver, CurrentsActAtOnceAlsoWithPower) {
  for (const bool powered : {false, true}) {
    if (powered) node.bench.enable(kId, 0, 1);
    node.write(0x2140, 2, 2, powered ? 600 : 900);
    node.write(0x2140, 3, 2, powered ? 300 : 500);
    node.bench.run(60ms);
    EXPECT_NEAR(chip().run_amperes(), powered ? 0.58 : 0.88, 0.03);
    EXPECT_NEAR(chip().hold_amperes(), powered ? 0.28 : 0.48, 0.03);
  }
  EXPECT_EQ(chip().bad_datagrams(), 0u);
}

// The torque is the current's: what 1.5 A turn, 0.3 A do not.
TEST_F(EbbDriver, TooLittleCurrentForTheLoadLosesSteps) {
  chip().set_load(0.25);
  node.bench.enable(kId, 0, 1);
  node.bench.move(kId, 0, 64'000, 100'000, 1'000'000);
  node.bench.run(1s);
  EXPECT_NEAR(node.board.true_counts(0), 64'000, 300);
  node.write(0x2140, 2, 2, 300);
  node.bench.run(60ms);
  node.bench.move(kId, 0, 128'000, 100'000, 1'000'000);
  node.bench.run(1s);
  EXPECT_LT(node.board.true_counts(0), 66'000);
}

TEST_F(EbbDriver, StealthChopBelowAVelocityWhereItIsAskedFor) {
  node.write(0x2170, 2, 4, 100'000);
  node.bench.run(60ms);
  EXPECT_TRUE(chip().stealth());
  node.write(0x607F, 0, 4, 400'000);
  node.bench.enable(kId, 0, 1);
  node.bench.move(kId, 0, 4'000'000, 300'000, 3'200'000);
  node.bench.run(300ms);
  EXPECT_FALSE(chip().stealth()) << "faster than that";
}

TEST_F(EbbDriver, AFewGarbledAnswersAreNoFault) {
  start_moving();
  for (int i = 0; i < 5; ++i) {
    chip().garble(3);
    node.bench.run(400ms);
  }
  EXPECT_EQ(node.read(0x2170, 5), 2);
  EXPECT_TRUE(node.bench.emergencies(kId).empty());
}

TEST_F(EbbDriver, ThatGoesSilentStopsAllOnThePathAndKeepsItsPower) {
  start_moving();
  chip().set_answers(false);
  node.bench.run(500ms);
  EXPECT_TRUE(told(emcy::kDriverSilent));
  EXPECT_TRUE(enabled());
  EXPECT_TRUE(stands());
  // Without power it does not get it again.
  node.write(0x6040, 0, 2, 0);
  node.bench.run(50ms);
  switch_on();
  EXPECT_TRUE(faulty());
  EXPECT_FALSE(enabled());
}

TEST_F(EbbDriver, ItsPreWarningStopsAllOnThePathAndTooMuchHeatTakesThePower) {
  start_moving();
  chip().set_temperature(125);
  node.bench.run(500ms);
  EXPECT_TRUE(told(emcy::kDriveTemperature));
  EXPECT_TRUE(enabled());
  EXPECT_TRUE(stands());
  chip().set_temperature(155);
  node.bench.run(300ms);
  EXPECT_TRUE(faulty());
  EXPECT_FALSE(enabled());
}

TEST_F(EbbDriver, AShortIsAFault) {
  expect_fault(
      emcy::kShortToGround, [](Tmc2209& chip) { chip.short_to_ground(true); },
      [](Tmc2209& chip) { chip.short_to_ground(false); });
}

TEST_F(EbbDriver, AnOpenPhaseIsAFault) {
  expect_fault(
      emcy::kPhaseOpen, [](Tmc2209& chip) { chip.open_phase(true); },
      [](Tmc2209& chip) { chip.open_phase(false); });
}

// The motor supply dips: the settings are gone, and with them microsteps and current.
TEST_F(EbbDriver, ThatHasLostItsSettingsIsAFaultAndGetsThemAgain) {
  expect_fault(
      emcy::kDriverReset,
      [](Tmc2209& chip) {
        chip.set_supply(false);
        chip.set_supply(true);
        EXPECT_EQ(chip.microsteps(), 8);
      },
      [](Tmc2209& chip) { EXPECT_EQ(chip.microsteps(), 16); });
}

// The wire costs no interrupt, and a main loop that is busy with steps has time for it.
TEST_F(EbbDriver, IsAskedAtFullSpeedAndTellsItsHeatInTime) {
  node.write(0x607F, 0, 4, 3'200'000);
  node.bench.enable(kId, 0, 1);
  node.board.cpu().clear_costs();
  node.bench.move(kId, 0, 8'000'000, 3'200'000, 32'000'000);
  node.bench.run(400ms);
  const double share = node.board.cpu().cost(kControl).worst_cycles / kControlClocks;
  const double pass = seconds_of(node.board.cpu().longest_pass());
  fmt::print("control interrupt {:.1f} %, main loop {:.0f} us at most\n", 100 * share, 1e6 * pass);
  EXPECT_LE(share, 0.6);
  EXPECT_LE(pass, kLongestPass);
  node.expect_good_driver();
  chip().set_temperature(125);
  node.bench.run(200ms);
  EXPECT_TRUE(told(emcy::kDriveTemperature));
  EXPECT_EQ(chip().bad_datagrams(), 0u);
}

TEST_F(EbbDriver, ItsPreWarningStopsAStreamOnThePath) {
  StreamFeed feed{.id = kId};
  node.bench.bring_up({kId});
  node.write(0x2115, 0, 2, 5);
  node.write(0x607F, 0, 4, 3'200'000);
  node.bench.enable(kId, 0, 7);
  node.bench.rate(1);
  node.bench.run(300ms);
  node.bench.send(feed.start(node.bench.read_long(kId, 0x2112) / kPathTicksPerUnit + 62'500));
  for (int i = 0; i < 8; ++i)
    for (const int sign : {1, -1, -1, 1}) node.bench.send(feed.segment(1250, sign * 1'912'345, 0));
  node.bench.send(feed.end());
  node.bench.run(1200ms);
  EXPECT_GT(node.board.driver().edges().size(), 500u) << "in the midst of it";
  const std::size_t from = node.bench.seen.size();
  chip().set_temperature(125);
  node.bench.run(500ms);
  const auto codes = node.bench.emergencies(kId, from);
  EXPECT_EQ(codes, (std::vector<std::uint16_t>{emcy::kDriveTemperature}));
  EXPECT_TRUE(enabled());
  EXPECT_TRUE(stands());
  EXPECT_NEAR(node.board.true_counts(0), static_cast<double>(node.read(0x6064)), 32);
  node.expect_good_driver();
}

// DIAG leads to no pin: an input that it should be on reads as if the stop were met.
TEST_F(EbbDriver, DoesNotHomeAtAStop) {
  node.bench.write(kId, 0x2130, 1, 1, static_cast<int>(SwitchFunction::kHomeA));
  node.write(0x6098, 0, 1, -4);
  node.write(0x6099, 1, 4, 60'000);
  node.write(0x609A, 0, 4, 600'000);
  node.write(0x2140, 9, 4, 90'000);
  node.write(0x2140, 10, 4, 8'000);
  node.write(0x607F, 0, 4, 400'000);
  node.write(0x2170, 3, 1, 75);
  node.write(0x2170, 4, 4, 30'000);
  node.bench.enable(kId, 0, 6);
  for (const int word : {0x0F, 0x1F}) node.write(0x6040, 0, 2, word);
  node.bench.run(500ms);
  EXPECT_NE(node.bench.statusword(kId, 0) & cia402::status::kHomingError, 0);
  EXPECT_EQ(node.board.driver().steps(), 0);
}

struct EbbWithASilentDriver : EbbDriver {
  EbbWithASilentDriver() : EbbDriver(&board_with_a_silent_driver) {}
};

TEST_F(EbbWithASilentDriver, ItIsToldAndItsAxisIsNotEnabledUntilItAnswers) {
  EXPECT_EQ(node.read(0x1003, 1) & 0xFFFF, emcy::kDriverSilent);
  EXPECT_EQ(node.read(0x2170, 5), 4);
  for (int i = 0; i < 2; ++i) {
    switch_on();
    EXPECT_TRUE(faulty());
    EXPECT_EQ(node.read(0x603F), emcy::kDriverSilent);
    EXPECT_FALSE(enabled());
  }
  chip().set_answers(true);
  node.bench.run(1s);
  reset_and_enable();
  EXPECT_TRUE(enabled());
  EXPECT_EQ(chip().microsteps(), 16);
}

// 2170h:1 = 0: it is left to its pins, which say 8 microsteps: a step is twice as far.
TEST_F(EbbWithASilentDriver, ThatIsToStandAloneIsEnabled) {
  node.write(0x2170, 1, 1, 0);
  node.bench.run(20ms);
  EXPECT_EQ(node.read(0x2170, 5), 0);
  node.bench.enable(kId, 0, 1);
  EXPECT_TRUE(enabled());
  const double from = node.board.true_counts(0);
  node.bench.move(kId, 0, 32'000, 100'000, 1'000'000);
  node.bench.run(1s);
  EXPECT_NEAR(node.board.true_counts(0) - from, 64'000, 300);
}

struct EbbWithoutMotorSupply : EbbDriver {
  EbbWithoutMotorSupply() : EbbDriver(&board_without_motor_supply) {}
};

TEST_F(EbbWithoutMotorSupply, ItsDriverIsSilentUntilItHasPowerAndHasItsSettingsThen) {
  EXPECT_EQ(node.read(0x2170, 5), 4);
  EXPECT_EQ(node.read(0x2170, 9), 0);
  chip().set_supply(true);
  node.bench.run(700ms);
  EXPECT_EQ(node.read(0x2170, 5), 2);
  EXPECT_EQ(node.read(0x2170, 9), 2209);
  EXPECT_NEAR(chip().run_amperes(), 1.46, 0.04);
  reset_and_enable();
  EXPECT_TRUE(enabled());
}

}  // namespace
}  // namespace kinebus::emulator
