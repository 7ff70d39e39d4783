// A job that is set aside in its middle: by command, by M600, by having waited for long; measured at the
// motors.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kBesideIt = 5e-3;  // mm: on the way up and over

MachineDescription printer_that_parks() {
  MachineDescription machine = printer_on_the_bus();
  machine.pause.lift_mm = 12;
  machine.pause.park = true;
  machine.pause.park_x_mm = -40;
  machine.pause.park_y_mm = 30;
  machine.pause.standby_c = 120;
  machine.pause.standby_after = 120s;
  machine.pause.unload_mm = 70;
  machine.pause.load_mm = 55;
  machine.pause.purge_mm = 25;
  return machine;
}

const std::string kBefore = "M104 S200\nM109 S200\nG92 E0\nG1 X60 E6 F600\n";
const std::string kAfter = "G1 X-60 E18\n";

class Aside : public HeatPrinter {
 protected:
  Aside() : HeatPrinter(printer_that_parks()) {}
  double extruder() { return tool()[kE]; }
  ::testing::AssertionResult prints(const std::string& job) {
    if (!begin(job) || !rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 900s))
      return ::testing::AssertionFailure() << rig.story();
    line = tool();
    return ::testing::AssertionSuccess();
  }
  ::testing::AssertionResult held() {
    if (!rig.gateway->carry_out(command::Hold{}) || !rig.reach(MachineState::kHeld, 5s))
      return ::testing::AssertionFailure() << rig.story();
    return ::testing::AssertionSuccess();
  }
  ::testing::AssertionResult parks() {
    if (!rig.reach(MachineState::kReady, 60s)) return ::testing::AssertionFailure() << rig.story();
    const Pose at = tool();
    const MachineStatus s = rig.gateway->status();
    if (std::abs(at[kX] + 40) > kBesideIt || std::abs(at[kY] - 30) > kBesideIt)
      return ::testing::AssertionFailure() << "at " << at[kX] << " " << at[kY] << rig.story();
    if (std::abs(at[kZ] - line[kZ] - 12) > kBesideIt) return ::testing::AssertionFailure() << "Z " << at[kZ];
    if (!s.interrupted || s.job != "part") return ::testing::AssertionFailure() << "the job is lost";
    return ::testing::AssertionSuccess();
  }
  /// Back over its place, down, and on the line to its end.
  ::testing::AssertionResult goes_on_to_the_end(double x_mm) {
    const auto failure = [&] { return ::testing::AssertionFailure() << rig.story(); };
    rig.events.clear();
    if (!rig.gateway->carry_out(command::Resume{})) return failure() << "resume is refused";
    if (!rig.run_until([&] { return rig.story().find("the job part goes on") != std::string::npos; }, 900s))
      return failure() << "it does not go on";
    const Pose back = tool();
    if (std::abs(back[kX] - x_mm) > kOnTheLine || off_the_line() > kOnTheLine)
      return failure() << "it goes on at X " << back[kX];
    const double from_e = extruder();
    double off = 0, fed = 0;
    if (!rig.run_until(
            [&] {
              off = std::max(off, off_the_line());
              fed = std::max(fed, extruder() - from_e);
              if (const auto shown = rig.gateway->status().job_filament_mm) last_job_filament = *shown;
              return rig.gateway->state() == MachineState::kReady;
            },
            120s))
      return failure() << "the job does not end";
    if (off > kOnTheLine) return failure() << off << " mm off the line";
    if (std::abs(tool()[kX] + 60) > kOnTheLine) return failure() << tool()[kX];
    fed_at_last = fed;
    return ::testing::AssertionSuccess();
  }
  double off_the_line() {
    const Pose pose = tool();
    return std::max(std::abs(pose[kY] - line[kY]), std::abs(pose[kZ] - line[kZ]));
  }
  void move_filament(command::MoveFilament::What what) {
    const auto done = rig.gateway->carry_out(command::MoveFilament{what});
    ASSERT_TRUE(done) << done.error().words.english();
    ASSERT_TRUE(rig.reach(MachineState::kMoving, 1s));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  }

  Pose line{};
  double fed_at_last = 0, last_job_filament = 0;
};

/// What is shown of E, and of what the job has fed.
struct ShownFilament {
  explicit ShownFilament(const MachineStatus& s)
      : e_mm(s.machine_pose[kE]), tool_e_mm(s.pose[kE]), job_mm(s.job_filament_mm.value_or(-1)) {}
  double e_mm, tool_e_mm, job_mm;
};

TEST_F(Aside, AJobThatIsHeldIsParkedAndJoggedAndGoesOnFromItsExactPlace) {
  ASSERT_TRUE(prints(kBefore + kAfter));
  const auto refused = rig.gateway->carry_out(command::StepAside{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().words.english(), "cannot set the job aside while the machine is running");
  ASSERT_TRUE(held());
  const double x_mm = tool()[kX], e_mm = extruder();
  const ShownFilament before(rig.gateway->status());
  EXPECT_NEAR(before.job_mm, x_mm / 10, 0.05) << "on the way out";
  ASSERT_FALSE(rig.gateway->carry_out(command::Jog{.delta = {5, 0, 0, 0, 0, 0}}));
  ASSERT_TRUE(rig.gateway->carry_out(command::StepAside{}));
  ASSERT_TRUE(parks());
  EXPECT_NEAR(hotend(), 200, 4) << "heat stays";
  EXPECT_FALSE(rig.gateway->status().filament_change);
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {15, -4, 3, 0, 0, 0}, .speed_per_s = 30}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  EXPECT_NEAR(tool()[kX], -25, kBesideIt);
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {0, 0, 0, 0, 0, 8}}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  EXPECT_NEAR(extruder() - e_mm, 8, 0.01);
  const ShownFilament beside(rig.gateway->status());
  EXPECT_NEAR(beside.e_mm - before.e_mm, 8, 0.01) << "the hand's move is shown";
  EXPECT_NEAR(beside.job_mm, before.job_mm, 1e-3) << "and not taken for the job's";
  ASSERT_TRUE(goes_on_to_the_end(x_mm));
  const ShownFilament at_end(rig.gateway->status());
  EXPECT_NEAR(at_end.e_mm - before.e_mm, fed_at_last, 0.05) << "E goes on from the job's value";
  EXPECT_NEAR(at_end.tool_e_mm, at_end.e_mm, 1e-9);
  EXPECT_NEAR(last_job_filament, 18, 0.1);
  // To 60 and back: what was extruded by hand is not taken for the job's.
  const double left_e = 18 - (6 * (x_mm + 0) / 60);
  EXPECT_NEAR(fed_at_last, left_e, 0.05);
}

TEST_F(Aside, M600ParksUnloadsLoadsPurgesAndGoesOn) {
  ASSERT_TRUE(prints(kBefore + "M600\n" + kAfter));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() == MachineState::kHolding; }, 60s))
      << rig.story();
  const double e_mm = extruder();
  ASSERT_TRUE(parks());
  EXPECT_TRUE(rig.gateway->status().filament_change);
  EXPECT_NEAR(extruder() - e_mm, -70, 0.01) << "unloaded";
  EXPECT_NE(rig.story().find("change the filament: load, purge"), std::string::npos) << rig.story();
  move_filament(command::MoveFilament::What::kLoad);
  EXPECT_NEAR(extruder() - e_mm, -15, 0.01);
  move_filament(command::MoveFilament::What::kPurge);
  EXPECT_NEAR(extruder() - e_mm, 10, 0.01);
  ASSERT_TRUE(goes_on_to_the_end(60));
  EXPECT_NEAR(fed_at_last, 12, 0.05);
  EXPECT_FALSE(rig.gateway->status().filament_change);
}

TEST_F(Aside, FilamentIsNotMovedColdAndNotByWhatTheFileDoesNotSay) {
  rig.machine.pause.load_mm = 0;
  rig.gateway = std::make_unique<Gateway>(rig.machine);
  ASSERT_TRUE(rig.make_ready());
  const auto cold = rig.gateway->carry_out(command::MoveFilament{});
  ASSERT_FALSE(cold);
  EXPECT_NE(cold.error().words.english().find("too cold"), std::string::npos);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(rig.run_until([&] { return hotend() > 195; }, 600s));
  const auto none = rig.gateway->carry_out(command::MoveFilament{command::MoveFilament::What::kLoad});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().words.english(), "pause.load_mm is 0 in the machine file");
}

TEST_F(Aside, AHotEndThatWaitsStandsByAndIsHotAgainBeforeTheJobGoesOn) {
  ASSERT_TRUE(prints(kBefore + kAfter));
  ASSERT_TRUE(held());
  const double x_mm = tool()[kX];
  rig.run_for(110s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kHeld);
  EXPECT_NEAR(hotend(), 200, 4);
  rig.run_for(20s);
  ASSERT_TRUE(parks());
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 120);
  rig.run_for(300s);
  EXPECT_NEAR(hotend(), 120, 5);
  // Who wants it hot has it hot, for as long again.
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 180}));
  rig.run_for(100s);
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 180);
  rig.run_for(40s);
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 120);
  ASSERT_TRUE(goes_on_to_the_end(x_mm));
  EXPECT_NEAR(hotend(), 180, 5) << "what the operator has set in the pause is the job's from there on";
}

TEST_F(Aside, AFaultOnTheWayAsideHoldsTheJobAsEver) {
  ASSERT_TRUE(prints(kBefore + kAfter));
  ASSERT_TRUE(held());
  ASSERT_TRUE(rig.gateway->carry_out(command::StepAside{}));
  ASSERT_EQ(breaks("sensor 1 open"), "");
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 60s)) << rig.story();
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  // Set aside it may be, too: the tool is off the part.
  ASSERT_TRUE(rig.gateway->carry_out(command::StepAside{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
  EXPECT_TRUE(rig.gateway->status().interrupted);
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  EXPECT_FALSE(rig.gateway->status().interrupted);
}

}  // namespace
}  // namespace kinebus
