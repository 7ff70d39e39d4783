// The way back to an interrupted job's place, with what the job has printed so far on the table.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/resume_rig.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A wall 40 mm high over the table's middle, then slowly along beside it.
std::string wall_and_line() {
  std::string job = "G21 G90 M83\nG1 X-5 Y0 Z0.5 F12000\n";
  for (int i = 1; i <= 80; ++i)
    job += "G1 Z" + std::to_string(0.5 * i) + "\nG1 X" + (i % 2 == 0 ? "-5" : "5") + " E0.5\n";
  return job + "G1 Z60\nG1 X0 Y60\nG1 Z10\nG1 X20 F300\nG1 Z20 F6000\n";
}

/// Homing spares parts of up to `mm`.
MachineDescription sparing(double mm) {
  MachineDescription machine = default_m1();
  machine.homing.spared_part_mm = mm;
  return machine;
}

class WayBack : public ::testing::Test {
 protected:
  explicit WayBack(double spared_mm = 250) : rig(sparing(spared_mm)) {}
  /// The job is interrupted at Y 60, Z 10, and the machine may be moved.
  void SetUp() override {
    ASSERT_TRUE(rig.make_ready()) << rig.story();
    ASSERT_TRUE(
        rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(wall_and_line()), "wall"}));
    ASSERT_TRUE(
        rig.run_until([&] { return at(kY) > 59.9 && at(kZ) < 10.1 && at(kX) > 2 && at(kX) < 15; }, 120s))
        << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
    ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s)) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
    ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
    ASSERT_TRUE(rig.gateway->may(command::kind<command::Resume>)) << rig.story();
  }
  void jog(const Pose& delta) {
    const auto done = rig.gateway->carry_out(command::Jog{.delta = delta, .speed_per_s = 100});
    ASSERT_TRUE(done) << done.error().words;
    ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  }
  double at(PoseAxis axis) { return rig.gateway->status().machine_pose[axis]; }

  MachineRig rig;
};

TEST_F(WayBack, ThroughWhatIsPrintedIsRefusedAndAroundItIsGone) {
  jog({0, 0, 50, 0, 0, 0});
  jog({0, -120, 0, 0, 0, 0});
  jog({0, 0, -50, 0, 0, 0});
  const auto through = rig.gateway->carry_out(command::Resume{});
  ASSERT_FALSE(through) << "the wall is between the tool and its place";
  EXPECT_EQ(
      through.error().words,
      "on the way back to the job's place nozzle and part on the table would touch: move the tool clear "
      "by hand, then resume");
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
  // It is the job's, and homing forgets no part of a job that is to go on.
  const auto down = rig.gateway->carry_out(command::Jog{.delta = {0, 60, 0, 0, 0, 0}, .speed_per_s = 100});
  ASSERT_FALSE(down);
  EXPECT_EQ(down.error().words,
            "nozzle and part on the table would touch: what was printed is taken to stand on the table until "
            "the next job begins, or the machine is homed with no job interrupted");
  jog({0, 0, 50, 0, 0, 0});
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until(
      [&] { return rig.gateway->state() == MachineState::kReady && !rig.gateway->status().interrupted; },
      120s))
      << rig.story();
  EXPECT_NEAR(at(kX), 20, 0.01);
  EXPECT_NEAR(at(kZ), 20, 0.01);
}

// A stop in a move by hand leaves the job held, the wall between the tool and its place.
TEST_F(WayBack, RefusedWhileItIsHeldLeavesAMachineThatCanBeMovedByHand) {
  jog({0, 0, 50, 0, 0, 0});
  jog({0, -120, 0, 0, 0, 0});
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {0, 0, -50, 0, 0, 0}, .speed_per_s = 20}));
  ASSERT_TRUE(rig.run_until([&] { return at(kZ) < 15; }, 20s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s)) << rig.story();
  ASSERT_FALSE(rig.gateway->may(command::kind<command::Jog>));

  const auto through = rig.gateway->carry_out(command::Resume{});
  ASSERT_FALSE(through);
  EXPECT_NE(through.error().words.find("move the tool clear by hand"), std::string::npos)
      << through.error().words;
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
  MachineStatus s = rig.gateway->status();
  EXPECT_TRUE(s.interrupted);
  EXPECT_TRUE(s.positions_known);
  for (std::size_t n = 0; n < 2; ++n) EXPECT_EQ(s.nodes[n].statusword[0] & 0x6F, 0x27) << "drives hold";
  ASSERT_FALSE(rig.gateway->carry_out(command::Resume{})) << "the wall is there still";

  jog({0, 0, 45, 0, 0, 0});
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until(
      [&] { return rig.gateway->state() == MachineState::kReady && !rig.gateway->status().interrupted; },
      120s))
      << rig.story();
  EXPECT_NEAR(at(kX), 20, 0.01);
  EXPECT_NEAR(at(kZ), 20, 0.01);
}

TEST_F(WayBack, FromItsOwnPlaceAndFromAboveItGoesOn) {
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 10s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  jog({0, 0, 80, 0, 0, 0});
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 10s)) << rig.story();
}

TEST_F(WayBack, CancelledOnItItEndsThereAndNothingGoesOn) {
  jog({0, 0, 80, 0, 0, 0});
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 10s)) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return at(kZ) < 80; }, 20s)) << rig.story();
  EXPECT_LT(rig.gateway->status().elapsed_s, 200) << "the job's time, not the computer's";
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{})) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s)) << rig.story();
  const double z_mm = at(kZ);
  rig.run_for(20s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady) << rig.story();
  EXPECT_NEAR(at(kZ), z_mm, 1e-6);
  EXPECT_FALSE(rig.gateway->status().interrupted);
  EXPECT_EQ(rig.gateway->status().job, "");
  EXPECT_EQ(rig.story().find("goes on"), std::string::npos) << rig.story();
}

class PartTooHighToHome : public WayBack {
 protected:
  PartTooHighToHome() : WayBack(30) {}
};

TEST_F(PartTooHighToHome, IsNamedInTheCheckAndKeepsTheMachineFromHomingUntilTheJobIsGivenUp) {
  EXPECT_NE(rig.story().find("warning: the part becomes higher than the 30 mm that homing spares"),
            std::string::npos)
      << rig.story();
  const auto home = rig.gateway->carry_out(command::Home{});
  ASSERT_FALSE(home);
  EXPECT_EQ(
      home.error().words,
      "the part of the interrupted job is 40 mm high and homing spares 30 mm: cancel the job and take the "
      "part off the table, then home");
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{})) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  EXPECT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

// The tool is at Z 10 when the power goes, and the wall 40 mm high.
TEST(WayBackAfterPowerLoss, APartThatIsHigherThanTheToolsPlaceIsNotHomedOver) {
  for (const double spared_mm : {30.0, 60.0}) {
    ResumeRig rig(sparing(spared_mm));
    rig.job_text = wall_and_line();
    ASSERT_TRUE(rig.begin(0)) << rig.story();
    ASSERT_TRUE(rig.run_until(
        [&] {
          rig.store();
          const Pose at = rig.gateway->status().machine_pose;
          return at[kY] > 59.9 && at[kZ] < 10.1 && at[kX] > 2;
        },
        120s))
        << rig.story();
    rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
    rig.run_for(1s);
    rig.nodes.send(rig.now, nmt_frame(NmtCommand::kResetNode, 0));
    rig.run_for(100ms);
    rig.lose_from_gateway = rig.lose_to_gateway = {};
    // The second gateway has only what the first one that came after the power loss has written down.
    rig.replace_gateway();
    rig.replace_gateway();
    ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
    ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
    const auto home = rig.gateway->carry_out(command::Home{});
    if (spared_mm > 40) {
      EXPECT_TRUE(home) << home.error().words;
      continue;
    }
    ASSERT_FALSE(home);
    EXPECT_EQ(home.error().words,
              "the part of the interrupted job is 40 mm high and homing spares 30 mm: cancel the job and "
              "take the part off the table, then home");
    ASSERT_FALSE(rig.gateway->carry_out(command::Resume{}));
    ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{})) << rig.story();
    EXPECT_TRUE(rig.gateway->carry_out(command::Home{}));
  }
}

// What the sentence says: the way that is refused is free when the job is given up and the machine homed.
TEST_F(WayBack, HomingForgetsThePartWhenNoJobIsInterrupted) {
  const Pose through{0, -100, 0, 0, 0, 0};
  const auto refused = rig.gateway->carry_out(command::Jog{.delta = through, .speed_per_s = 100});
  ASSERT_FALSE(refused);
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{})) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  EXPECT_FALSE(rig.gateway->carry_out(command::Jog{.delta = through, .speed_per_s = 100}))
      << "the part stands there still";
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::GoToReference{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  jog({0, 60, -10, 0, 0, 0});
  jog(through);
}

}  // namespace
}  // namespace kinebus
