// Filament that runs out, jams or slips in a print: held on the path within so many mm of it, gone on with
// from there; measured at the motors.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

MachineDescription printer_with_filament_sensors() {
  MachineDescription machine = printer_on_the_bus();
  machine.nodes[kHeat].functions.filament_sensors = 2;
  machine.filament_sensors = {{.name = "feeder",
                               .kind = FilamentSensorKind::kMotion,
                               .place = {DevicePlace::Where::kNode, kHeatId, 2}},
                              {.name = "spool",
                               .kind = FilamentSensorKind::kSwitch,
                               .place = {DevicePlace::Where::kNode, kHeatId, 1}}};
  return machine;
}

/// 120 mm of way, 4 mm/s of filament.
const std::string kFeeds = "M109 S200\nG92 E0\nG1 X60 E24 F600\nG1 X-60 E72 F600\n";

class Filament : public HeatPrinter {
 protected:
  Filament() : HeatPrinter(printer_with_filament_sensors()) {}
  double extruder() { return tool()[kE]; }
  ::testing::AssertionResult prints() {
    if (!begin(kFeeds) || !rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 900s))
      return ::testing::AssertionFailure() << rig.story();
    line = tool();
    return ::testing::AssertionSuccess();
  }
  double off_the_line() {
    const Pose pose = tool();
    return std::max(std::abs(pose[kY] - line[kY]), std::abs(pose[kZ] - line[kZ]));
  }
  /// mm of filament from now until the machine stands, and is held; on the line until it rises.
  double fed_until_held() {
    const double from = extruder();
    double furthest = from, off = 0, x = tool()[kX];
    EXPECT_TRUE(rig.run_until(
        [&] {
          furthest = std::max(furthest, extruder());
          if (std::abs(tool()[kX] - x) > 1e-4) off = std::max(off, off_the_line());
          x = tool()[kX];
          return rig.gateway->state() == MachineState::kHeld;
        },
        30s))
        << rig.story();
    EXPECT_LT(off, kOnTheLine);
    EXPECT_NEAR(tool()[kZ], line[kZ] + 5, kOnTheLine) << "lifted off the part";
    return furthest - from;
  }
  std::string doing() { return rig.gateway->status().doing.english(); }
  /// Back from above, and on the line to its end with all of its filament.
  void goes_on_to_the_end() {
    rig.events.clear();
    ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
    ASSERT_TRUE(
        rig.run_until([&] { return rig.story().find("the job part goes on") != std::string::npos; }, 60s))
        << rig.story();
    EXPECT_LT(off_the_line(), kOnTheLine);
    double off = 0;
    ASSERT_TRUE(rig.run_until(
        [&] {
          off = std::max(off, off_the_line());
          return rig.gateway->state() == MachineState::kReady;
        },
        120s))
        << rig.story();
    EXPECT_LT(off, kOnTheLine);
    EXPECT_NEAR(tool()[kX], -60, kOnTheLine);
  }

  Pose line{};
};

TEST_F(Filament, ThatRunsOutHoldsTheJobWithinHalfASecondOfIt) {
  ASSERT_TRUE(prints());
  EXPECT_EQ(rig.gateway->status().filaments.size(), 2U);
  ASSERT_EQ(breaks("filament out"), "");
  const double fed = fed_until_held();
  std::printf("out: %.2f mm at 4 mm/s\n", fed);
  EXPECT_LE(fed, 1.5);
  EXPECT_TRUE(rig.told(AlarmCode::kFilament));
  EXPECT_EQ(doing(), "filament_sensor.spool: there is no filament any more");
  EXPECT_NE(rig.story().find("the job is held at X"), std::string::npos) << rig.story();
  EXPECT_EQ(rig.gateway->status().filaments[1].condition, FilamentCondition::kOut);
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 200) << "what is put in is to melt";
  rig.run_for(20s);

  // Not put in: said again, and nothing moves.
  rig.events.clear();
  const Pose held = tool();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  rig.run_for(5s);
  EXPECT_TRUE(rig.told(AlarmCode::kFilament)) << rig.story();
  EXPECT_EQ(rig.gateway->state(), MachineState::kHeld);
  EXPECT_NEAR(tool()[kZ], held[kZ], kOnTheLine);

  ASSERT_EQ(breaks("filament ok"), "");
  rig.run_for(1s);
  goes_on_to_the_end();
}

TEST_F(Filament, ThatJamsHoldsTheJobWithinItsLength) {
  ASSERT_TRUE(prints());
  ASSERT_EQ(breaks("filament jammed"), "");
  const double fed = fed_until_held();
  std::printf("jammed: %.2f mm at 4 mm/s\n", fed);
  EXPECT_LE(fed, 7 + 2 * 2.93 + 1.5);
  EXPECT_EQ(doing(), "filament_sensor.feeder: the extruder turns and the filament stands still");
  ASSERT_EQ(breaks("filament ok"), "");
  goes_on_to_the_end();
}

TEST_F(Filament, ThatSlipsHoldsTheJob) {
  ASSERT_TRUE(prints());
  ASSERT_EQ(breaks("filament slips"), "");
  const double fed = fed_until_held();
  std::printf("slips: %.2f mm at 4 mm/s\n", fed);
  EXPECT_LE(fed, 1.25 * 30 + 1.5);
  EXPECT_EQ(doing(), "filament_sensor.feeder: less filament comes than the extruder turns for");
  ASSERT_EQ(breaks("filament ok"), "");
  goes_on_to_the_end();
}

TEST_F(Filament, ThatIsNotThereHoldsAJobBeforeItHeats) {
  ASSERT_EQ(breaks("filament out"), "");
  ASSERT_TRUE(begin(kFeeds));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 30s)) << rig.story();
  EXPECT_LT(hotend(), 40);
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s)) << rig.story();
  EXPECT_FALSE(rig.told(AlarmCode::kThermal)) << rig.story();
}

TEST_F(Filament, ThatEndsWithoutAJobStopsNothing) {
  ASSERT_TRUE(rig.make_ready());
  ASSERT_EQ(breaks("filament out"), "");
  rig.run_for(5s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
  EXPECT_EQ(rig.gateway->status().filaments[1].condition, FilamentCondition::kOut);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

}  // namespace
}  // namespace kinebus
