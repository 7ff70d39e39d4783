// What a gateway takes up of the one before, and what it refuses to.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/resume_rig.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

class GoesOn : public ::testing::Test {
 protected:
  /// Nobody hears anybody for as long as the other gateway needs; then the new one is there.
  void dies(ResumeRig& rig, bool nodes_too = false) {
    rig.store();
    rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
    rig.run_for(1200ms);
    if (nodes_too) {
      rig.nodes.send(rig.now, nmt_frame(NmtCommand::kResetNode, 0));
      rig.run_for(100ms);
    }
    rig.lose_from_gateway = rig.lose_to_gateway = {};
    rig.replace_gateway();
    rig.events.clear();
  }
  static MachineDescription by_itself(ResumeDescription::Then after_power_loss) {
    MachineDescription machine = default_m1();
    machine.resume.after_restart = ResumeDescription::Then::kGoOn;
    machine.resume.after_power_loss = after_power_loss;
    return machine;
  }
  static bool says(const ResumeRig& rig, const char* words) {
    return rig.story().find(words) != std::string::npos;
  }
};

TEST_F(GoesOn, TheOverrideAndTheNameAreThoseOfTheJob) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.5));
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.5}));
  rig.run(300ms);
  dies(rig);
  const MachineStatus s = rig.gateway->status();
  EXPECT_EQ(s.feed_override, 0.5);
  EXPECT_EQ(s.job, "part");
  EXPECT_TRUE(s.interrupted);
  EXPECT_NEAR(s.remaining_s, (1 - s.progress) * (s.remaining_s * 0.5 / (1 - s.progress)) / 0.5, 0.1);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_TRUE(says(rig, "the feed is as programmed again"));
  EXPECT_EQ(rig.gateway->status().feed_override, 1);
}

TEST_F(GoesOn, AnOverrideThatNobodyMayGiveIsBroughtWithinItsLimits) {
  for (const auto& [noted, taken] : {std::pair{100., 5.}, std::pair{0.0001, 0.01}}) {
    ResumeRig rig;
    journal::State state;
    state.take(journal::JobBegin{"part", 5, 1234, {}, {}});
    state.override_ratio = noted;
    ASSERT_TRUE(rig.gateway->recover(state, std::make_unique<StringSource>("G1 X1\n")));
    EXPECT_EQ(rig.gateway->status().feed_override, taken);
  }
}

TEST_F(GoesOn, NothingIsTakenUpByAMachineThatIsInUseNorAJobThatIsNotThere) {
  ResumeRig rig;
  journal::State state;
  state.take(journal::JobBegin{"part", 5, 1234, {}, {}});
  const auto gone = rig.gateway->recover(state, nullptr);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().words.english(), "the interrupted job part is not there any more");
  EXPECT_FALSE(rig.gateway->status().interrupted);
  EXPECT_TRUE(rig.gateway->recover(journal::State{}, nullptr)) << "nothing was interrupted";
  ASSERT_TRUE(rig.make_ready());
  const auto late = rig.gateway->recover(state, std::make_unique<StringSource>("G1 X1\n"));
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().words.english(), "too late: the machine is in use already");
}

TEST_F(GoesOn, WithNodesThatKnowWhereTheyStandItGoesOnByItselfWhereTheFileSaysSo) {
  ResumeRig rig(by_itself(ResumeDescription::Then::kAsk));
  ASSERT_TRUE(rig.begin(0.8)) << rig.story();
  dies(rig);
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_TRUE(says(rig, "the job part goes on")) << rig.story();
  EXPECT_TRUE(says(rig, "job done: part")) << rig.story();
  EXPECT_FALSE(says(rig, "homing"));
}

TEST_F(GoesOn, ElseItWaitsForItsOperator) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.8)) << rig.story();
  dies(rig);
  rig.run(5s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kOff);
  EXPECT_TRUE(rig.gateway->status().interrupted);
}

TEST_F(GoesOn, AfterAPowerLossItAsksToHomeOrNotAsTheFileSays) {
  for (const auto then : {ResumeDescription::Then::kAsk, ResumeDescription::Then::kGoOn}) {
    ResumeRig rig(by_itself(then));
    ASSERT_TRUE(rig.begin(0.8)) << rig.story();
    dies(rig, true);
    if (then == ResumeDescription::Then::kAsk) {
      ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s));
      rig.run(5s);
      EXPECT_EQ(rig.gateway->state(), MachineState::kUnhomed);
      EXPECT_TRUE(says(rig, "the nodes have lost their positions: resume homes the machine and goes on"));
      ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
      EXPECT_EQ(rig.gateway->state(), MachineState::kHoming);
    }
    ASSERT_TRUE(rig.run_until([&] { return says(rig, "job done: part"); }, 200s)) << rig.story();
  }
}

TEST_F(GoesOn, AToolThatWasMovedMeanwhileIsBroughtBackOnlyByCommand) {
  ResumeRig rig(by_itself(ResumeDescription::Then::kGoOn));
  ASSERT_TRUE(rig.begin(0.8)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  rig.store();
  ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {0, 0, 3, 0, 0, 0}}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  dies(rig);
  ASSERT_TRUE(rig.run_until([&] { return says(rig, "the job does not go on: the tool was found 3.0"); }, 60s))
      << rig.story();
  EXPECT_TRUE(says(rig, "mm from its place: resume brings it back"));
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
  rig.run(2s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return says(rig, "job done: part"); }, 100s)) << rig.story();
}

TEST_F(GoesOn, TheWayBackRisesGoesOverAndComesDownSlowly) {
  MachineDescription machine = default_m1();
  machine.resume.lift_mm = 4;
  machine.resume.approach_mm_per_s = 5;
  ResumeRig rig(machine);
  ASSERT_TRUE(rig.begin(0.8)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  rig.run(300ms);
  const Pose place = rig.pose();
  ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {-15, 0, 1, 0, 0, 0}, .speed_per_s = 100}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  rig.run(300ms);
  std::vector<Pose> track;
  rig.track_ = &track;
  rig.events.clear();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  BusTime down_since{0};
  ASSERT_TRUE(rig.run_until(
      [&] {
        rig.watch();
        const Pose at = rig.pose();
        if (std::abs(at[kX] - place[kX]) > 0.02 || at[kZ] > place[kZ] + 3.9) down_since = rig.now;
        return says(rig, "goes on");
      },
      60s))
      << rig.story();
  double highest = -1e9, beside = 0;
  for (const Pose& at : track) {
    highest = std::max(highest, at[kZ]);
    if (std::abs(at[kX] - place[kX]) > 0.5 && std::abs(at[kX] - place[kX] + 15) > 0.5)
      beside = std::max(beside, std::abs(at[kZ] - place[kZ] - 4));
  }
  EXPECT_NEAR(highest, place[kZ] + 4, 0.01);
  EXPECT_LT(beside, 0.01) << "over to its place at the height of the lift";
  EXPECT_NEAR(to_seconds(rig.now - down_since), 4 / 5., 0.4);
  EXPECT_NEAR(rig.pose()[kZ], place[kZ], 0.01);
  ASSERT_TRUE(rig.finish()) << rig.story();
}

TEST_F(GoesOn, FilamentWhoseMotorWasOffIsPrimedBeforeItGoesOn) {
  MachineDescription machine = default_m1();
  machine.resume.prime_mm = 2;
  ResumeRig rig(machine);
  ASSERT_TRUE(rig.begin(0.8)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  rig.run(300ms);
  const double before = rig.pose()[kE];
  ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
  rig.events.clear();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until(
      [&] {
        rig.watch();
        return says(rig, "goes on");
      },
      60s))
      << rig.story();
  EXPECT_NEAR(rig.pose()[kE], before + 2, 0.01);
  ASSERT_TRUE(rig.finish()) << rig.story();
}

// The text is checked, and read up to its place, in many turns.
TEST_F(GoesOn, AStopOrACancelWhileItsTextIsReadLeavesItOrNot) {
  for (const int turns : {0, 2, 5}) {
    for (const bool cancels : {false, true}) {
      SCOPED_TRACE(testing::Message() << turns << cancels);
      ResumeRig rig;
      for (int i = 0; i < 4000; ++i) rig.job_text += i % 2 == 0 ? "G1 X1 F6000\n" : "G1 X0\n";
      ASSERT_TRUE(rig.begin(0.8)) << rig.story();
      dies(rig);
      ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
      ASSERT_TRUE(rig.reach(MachineState::kChecking, 30s)) << rig.story();
      for (int i = 0; i < turns; ++i) rig.run_for(1ms);
      ASSERT_EQ(rig.gateway->state(), MachineState::kChecking);
      if (cancels) {
        ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
        EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
        rig.run(1s);
        EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
        EXPECT_FALSE(rig.gateway->status().interrupted);
        EXPECT_FALSE(rig.gateway->carry_out(command::Resume{}));
        continue;
      }
      ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
      ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
      ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
      ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
      rig.run(1s);
      EXPECT_EQ(rig.gateway->state(), MachineState::kReady) << "not by itself";
      EXPECT_TRUE(rig.gateway->status().interrupted);
      ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
      ASSERT_TRUE(rig.run_until([&] { return says(rig, "the job part goes on"); }, 30s)) << rig.story();
    }
  }
}

TEST_F(GoesOn, NodesKeepWhatTheyKnowUntilItIsWrittenDown) {
  double took_s[2];
  for (const bool stores : {false, true}) {
    ResumeRig rig;
    ASSERT_TRUE(rig.begin(0.8)) << rig.story();
    dies(rig);
    const BusTime from = rig.now;
    ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
    ASSERT_TRUE(rig.run_until(
        [&] {
          if (stores) rig.store();
          return rig.gateway->state() != MachineState::kBringUp;
        },
        30s));
    took_s[stores ? 1 : 0] = to_seconds(rig.now - from);
  }
  EXPECT_NEAR(took_s[0] - took_s[1], 0.5, 0.05) << "a disk that does not answer is not waited for any longer";
}

}  // namespace
}  // namespace kinebus
