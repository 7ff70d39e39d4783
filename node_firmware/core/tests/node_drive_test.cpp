// One axis at a time, by SDO: profile position, homing, stops, faults. Set-points of SYNC:
// node_cyclic_test.cpp.

#include "node_firmware/core/tests/drive_bench.hpp"

namespace kinebus::testing_bench {
namespace {

TEST_F(DriveTest, ProfilePositionMovesWithinLimitsAndAcknowledges) {
  bench.enable(kId, 0, 1);
  target(60'000);
  EXPECT_TRUE(status() & (1 << 12));
  EXPECT_FALSE(status() & (1 << 10));
  watch(800ms, 128'000, 1'280'000);
  EXPECT_TRUE(status() & (1 << 10));
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 60'000);
  control(0x0F);
  EXPECT_FALSE(status() & (1 << 12));
  // Relative, and buffered behind it an absolute one.
  bench.write(kId, 0x607A, 0, 4, -10'000);
  control(0x5F);
  control(0x0F);
  bench.write(kId, 0x607A, 0, 4, 55'000);
  control(0x1F);
  watch(1s, 128'000, 1'280'000);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 55'000);
}

TEST_F(DriveTest, ANewSetPointAtOnceTurnsRoundWithoutAStep) {
  bench.enable(kId, 0, 1);
  target(90'000);
  watch(300ms, 128'000, 1'280'000);
  bench.write(kId, 0x607A, 0, 4, 1'000);
  control(0x0F);
  control(0x3F);
  watch(1500ms, 128'000, 1'280'000);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 1'000);
}

TEST_F(DriveTest, ChangeOnSetPointPassesTheFirstTargetAtSpeed) {
  bench.enable(kId, 0, 1);
  target(30'000);
  control(0x0F);
  bench.write(kId, 0x607A, 0, 4, 80'000);
  control(0x21F);
  double slowest_in_between = 1e9, last = counts();
  bench.run(1200ms, 1ms, [&] {
    const double here = counts();
    if (here > 25'000 && here < 70'000)
      slowest_in_between = std::min(slowest_in_between, (here - last) * 1000);
    last = here;
  });
  EXPECT_GT(slowest_in_between, 120'000);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 80'000);
}

TEST_F(DriveTest, HaltStopsAndLetsGoOnToTheTarget) {
  bench.enable(kId, 0, 1);
  target(90'000);
  watch(200ms, 128'000, 1'280'000);
  control(0x11F);
  watch(300ms, 128'000, 1'280'000);
  const double there = counts();
  EXPECT_LT(there, 89'000);
  EXPECT_TRUE(status() & (1 << 10));
  watch(100ms, 1, 1);
  control(0x1F);
  watch(1s, 128'000, 1'280'000);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 90'000);
}

TEST_F(DriveTest, QuickStopUsesItsRampAndHolds) {
  bench.enable(kId, 0, 1);
  target(90'000);
  watch(300ms, 128'000, 1'280'000);
  const double from = counts();
  control(0x0B);
  watch(200ms, 128'000, 6'400'000);
  EXPECT_LT(counts() - from, 128'000 * 0.003 + 128'000.0 * 128'000 / 2 / 6.4e6 + 2);
  EXPECT_EQ(status() & 0x6F, 0x07);
  EXPECT_TRUE(bench.node().drive(0).power);
  control(0x0F);
  EXPECT_EQ(status() & 0x6F, 0x27);
  watch(200ms, 1, 1);  // the set-point of before is gone
}

TEST_F(DriveTest, DisablingSlowsDownFirst) {
  bench.enable(kId, 0, 1);
  target(90'000);
  watch(300ms, 128'000, 1'280'000);
  control(0x07);
  EXPECT_EQ(status() & 0x6F, 0x27);
  watch(300ms, 128'000, 1'280'000);
  EXPECT_EQ(status() & 0x6F, 0x23);
}

struct HomingCase {
  int method;
  bool above;
};
class NodeHoming : public testing::TestWithParam<HomingCase> {};

TEST_P(NodeHoming, FindsTheSwitchByStandardObjects) {
  const auto [method, above] = GetParam();
  AxisPlantOptions plant{.start_counts = above ? 0 : 200'000,
                         .switch_input = 2,
                         .switch_counts = 100'000,
                         .active_above = above,
                         .active_low = true};
  Bench bench({{.id = kId, .plant = {AxisPlantOptions{}, plant}}});
  bench.write(kId, 0x2130, 2, 1, method == 17 ? 6 : method == 18 ? 4 : 2);
  bench.write(kId, 0x2131, 2, 1, 1);
  bench.write(kId, 0x687C, 0, 4, 12'345);
  bench.write(kId, 0x6898, 0, 1, method);
  bench.run(10ms);
  bench.enable(kId, 1, 6);
  EXPECT_EQ(bench.read(kId, 0x2940, 6), 0);
  bench.write(kId, 0x6840, 0, 2, 0x1F);
  EXPECT_EQ(bench.statusword(kId, 1) & 0x3400, 0x0000);
  std::int64_t last = bench.position(0, 1);
  bench.run(8s, 1ms, [&] {
    const std::int64_t here = bench.position(0, 1);
    EXPECT_LE(std::abs(here - last), from_counts(39));  // the motor knows nothing of the new zero
    last = here;
  });
  EXPECT_EQ(bench.statusword(kId, 1) & 0x3400, 0x1400);
  EXPECT_EQ(bench.read(kId, 0x2940, 6), 1);
  // Where the carriage is on its rail, and where the node thinks it is: zero lies 12345 above the edge.
  const double carriage =
      static_cast<double>(plant.start_counts) + std::ldexp(static_cast<double>(last), -32);
  EXPECT_NEAR(static_cast<double>(bench.read(kId, 0x6864, 0)), carriage - 100'000 - 12'345, 0.6);
}
INSTANTIATE_TEST_SUITE_P(AllMethods, NodeHoming,
                         testing::Values(HomingCase{17, false}, HomingCase{18, true}, HomingCase{19, true},
                                         HomingCase{20, true}, HomingCase{21, false}, HomingCase{22, false}));

TEST_F(DriveTest, HomingOnThePlaceTakesTheOffset) {
  bench.write(kId, 0x607C, 0, 4, 500);
  bench.write(kId, 0x6098, 0, 1, 37);
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(5ms);
  EXPECT_EQ(status() & 0x3400, 0x1400);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), -500);
  EXPECT_EQ(bench.position(0, 0), 0);
}

TEST_F(DriveTest, HomingEndsWithinAFrameWhenItsStartBitFalls) {
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  watch(500ms, 38'400, 1'280'000);
  control(0x0F);
  watch(100ms, 38'400, 1'280'000);
  EXPECT_EQ(status() & 0x3400, 0x0400);
  watch(100ms, 1, 1);
}

TEST_F(DriveTest, HomingIsOverWhenTheDriveIsDisabledAndDoesNotGoOnByItself) {
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  watch(500ms, 38'400, 1'280'000);
  control(0x17);
  watch(500ms, 38'400, 1'280'000);
  EXPECT_EQ(status() & 0x6F, 0x23);
  control(0x1F);
  watch(500ms, 1, 1);
  EXPECT_EQ(status() & 0x1400, 0x0400) << "at rest, and not at home";
  control(0x0F);
  control(0x1F);
  bench.run(8s);
  EXPECT_EQ(status() & 0x3400, 0x1400) << "asked for again, it homes";
}

TEST_F(DriveTest, HomingWithoutASwitchTellsAnErrorAndAnEmergency) {
  bench.plant_on = false;
  bench.write(kId, 0x2140, 9, 4, 20'000);
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  watch(1500ms, 38'400, 1'280'000);
  EXPECT_EQ(status() & 0x3400, 0x2400);
  ASSERT_TRUE(bench.last(0x081));
  EXPECT_EQ(text_of(*bench.last(0x081)).substr(0, 8), "081#10FF");
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 20'000);
}

TEST_F(DriveTest, ChangingTheModeInMotionSlowsDownFirst) {
  bench.enable(kId, 0, 1);
  target(90'000);
  watch(300ms, 128'000, 1'280'000);
  bench.write(kId, 0x6060, 0, 1, 8);
  EXPECT_EQ(bench.read(kId, 0x6061, 0), 1);
  watch(300ms, 128'000, 1'280'000);
  EXPECT_EQ(bench.read(kId, 0x6061, 0), 8);
  EXPECT_LT(counts(), 90'000);
}

TEST_F(DriveTest, SoftwareLimitsHoldOnceThePositionIsKnown) {
  bench.write(kId, 0x607D, 2, 4, 5'000);
  bench.write(kId, 0x6098, 0, 1, 37);
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(5ms);
  bench.write(kId, 0x6060, 0, 1, 1);
  target(9'000);
  EXPECT_TRUE(status() & (1 << 11));
  bench.run(500ms);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 5'000);
}

TEST_F(DriveTest, AHardwareFaultCutsPowerTellsItsCodeAndIsResetWhenItsCauseIsGone) {
  bench.enable(kId, 0, 1);
  bench.node().on_drive_fault(bench.local(), 0, 0x2310);
  bench.run(5ms);
  EXPECT_FALSE(bench.node().drive(0).power);
  EXPECT_EQ(status() & 0x4F, 0x08);
  EXPECT_EQ(bench.read(kId, 0x603F, 0), 0x2310);
  EXPECT_EQ(text_of(*bench.last(0x081)).substr(0, 8), "081#1023");
  control(0x80);
  EXPECT_EQ(status() & 0x4F, 0x08);
  control(0x00);
  bench.node().on_drive_fault_gone(bench.local(), 0);
  control(0x80);
  EXPECT_EQ(status() & 0x4F, 0x40);
  EXPECT_EQ(bench.read(kId, 0x1001, 0), 0);
}

TEST_F(DriveTest, TheEmergencyStopInputStopsMotionOfItsOwnAndFaultResetLiftsItWithoutAGateway) {
  bench.write(kId, 0x2130, 7, 1, 7);
  bench.enable(kId, 0, 1);
  target(90'000);
  watch(300ms, 128'000, 1'280'000);
  bench.node().on_switch(bench.local(), 6, true);
  watch(200ms, 128'000, 6'400'000);
  EXPECT_LT(counts(), 60'000);
  EXPECT_EQ(text_of(*bench.last(0x081)).substr(0, 8), "081#06FF");
  EXPECT_EQ(status() & 0x6F, 0x27);  // holds, powered
  target(0);
  watch(100ms, 1, 1);
  control(0x8F);  // still pressed
  control(0x0F);
  target(0);
  watch(100ms, 1, 1);
  bench.node().on_switch(bench.local(), 6, false);
  bench.run(5ms);
  control(0x8F);
  target(0);
  bench.run(1s);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 0);
}

TEST_F(DriveTest, ALimitSwitchStopsAndOnlyTheWayBackIsOpen) {
  bench.write(kId, 0x2130, 1, 1, 3);  // positive limit of A
  bench.enable(kId, 0, 1);
  target(150'000);
  watch(1500ms, 128'000, 6'400'000);
  const double there = counts();
  EXPECT_GT(there, 100'000);
  EXPECT_LT(there, 102'000);
  control(0x8F);
  control(0x0F);
  target(150'000);
  watch(200ms, 1, 1);
  target(50'000);
  bench.run(1500ms);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 50'000);
}

}  // namespace
}  // namespace kinebus::testing_bench
