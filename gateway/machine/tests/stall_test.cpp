// A gateway that was not run for a while: what the nodes did without it, and how the job goes on.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr const char* kJob = "G1 X40 F1200\nG1 Y20\nG1 X0\nG1 Y0\n";

class Stall : public ::testing::TestWithParam<int> {
 protected:
  static MachineDescription that_goes_on() {
    MachineDescription d = default_m1();
    d.stop.after_stall = StopDescription::AfterStall::kGoOn;
    return d;
  }
  static bool begin(MachineRig& rig) {
    return rig.make_ready() &&
           rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(kJob), "test"}) &&
           rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 15; }, 60s);
  }
  static bool done(const MachineRig& rig) {
    return std::any_of(rig.events.begin(), rig.events.end(),
                       [](const MachineEvent& e) { return e.words == "job done: test"; });
  }
};

TEST_P(Stall, JobGoesOnByItselfWhereTheMachineFileSaysSo) {
  MachineRig rig(that_goes_on());
  ASSERT_TRUE(begin(rig)) << rig.story();
  rig.stall(std::chrono::milliseconds{GetParam()});
  ASSERT_TRUE(rig.run_until([&] { return done(rig); }, 120s)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 0, 2e-3);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kY], 0, 2e-3);
  EXPECT_NE(rig.story().find("the gateway did not run for"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Milliseconds, Stall, ::testing::Values(150, 300, 700, 1500, 3000, 20'000));

TEST_F(Stall, OtherwiseItWaitsForAPerson) {
  MachineRig rig;
  ASSERT_TRUE(begin(rig)) << rig.story();
  rig.stall(3s);
  rig.run_for(10s);
  EXPECT_FALSE(done(rig));
  EXPECT_TRUE(rig.gateway->state() == MachineState::kStopped || rig.gateway->state() == MachineState::kAlarm)
      << rig.story();
}

TEST_F(Stall, ThatBeginsAgainAndAgainStillEndsTheJob) {
  MachineRig rig(that_goes_on());
  ASSERT_TRUE(begin(rig)) << rig.story();
  for (int i = 0; i < 3; ++i) {
    rig.stall(900ms);
    rig.run_for(3s);
  }
  ASSERT_TRUE(rig.run_until([&] { return done(rig); }, 120s)) << rig.story();
}

TEST_F(Stall, ThatComesASixthTimeInAJobWaitsForAPerson) {
  MachineRig rig(that_goes_on());
  std::string job;
  for (int i = 0; i < 20; ++i) job += kJob;
  ASSERT_TRUE(rig.make_ready());
  ASSERT_TRUE(rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(job), "test"}));
  const auto runs = [&] { return rig.gateway->state() == MachineState::kRunning; };
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(rig.run_until(runs, 30s)) << i << rig.story();
    rig.run_for(2s);
    rig.stall(900ms);
    rig.run_for(2s);
  }
  rig.run_for(20s);
  EXPECT_FALSE(done(rig));
  EXPECT_EQ(rig.gateway->state(), MachineState::kStopped) << rig.story();
  EXPECT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(
      rig.run_until([&] { return rig.gateway->may(command::kind<command::Resume>).has_value(); }, 10s));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until(runs, 30s)) << rig.story();
}

TEST_F(Stall, OncesInAWhileAreNeverTooMany) {
  MachineRig rig(that_goes_on());
  std::string job;
  for (int i = 0; i < 2; ++i) job += kJob;
  job += "G4 P900000\n";
  std::string all;
  for (int i = 0; i < 7; ++i) all += job;
  ASSERT_TRUE(rig.make_ready());
  ASSERT_TRUE(rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(all), "test"}));
  const auto runs = [&] { return rig.gateway->state() == MachineState::kRunning; };
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(rig.run_until(runs, 30s)) << i << rig.story();
    rig.run_for(2s);
    rig.stall(900ms);
    rig.run_for(11min);
    ASSERT_TRUE(runs()) << i << rig.story();
  }
}

TEST_F(Stall, NothingElseThatIsWrongIsCleared) {
  MachineRig rig(that_goes_on());
  ASSERT_TRUE(begin(rig)) << rig.story();
  rig.stall(900ms);
  // Somebody stops the machine meanwhile.
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  rig.run_for(20s);
  EXPECT_FALSE(done(rig));
  EXPECT_EQ(rig.gateway->state(), MachineState::kStopped) << rig.story();
}

TEST_F(Stall, AnEmergencyStopSoonAfterOneIsNotCleared) {
  MachineDescription description = that_goes_on();
  description.nodes[2].inputs[6] = {InputFunction::kEmergencyStop, 0};
  MachineRig rig(description);
  ASSERT_TRUE(begin(rig)) << rig.story();
  rig.stall(20ms);
  rig.run_for(300ms);
  ASSERT_EQ(rig.gateway->state(), MachineState::kRunning) << "so short a one is ridden out";
  rig.nodes.set_input(2, rig.now, 7, true);
  rig.run_for(100ms);
  rig.nodes.set_input(2, rig.now, 7, false);
  rig.run_for(20s);
  EXPECT_FALSE(done(rig));
  EXPECT_EQ(rig.gateway->state(), MachineState::kStopped) << rig.story();
}

TEST_F(Stall, APersonWhoClearsHasTheMachine) {
  MachineRig rig(that_goes_on());
  ASSERT_TRUE(begin(rig)) << rig.story();
  rig.stall(900ms);
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->may(command::kind<command::Clear>).has_value(); }, 5s))
      << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  rig.run_for(20s);
  EXPECT_FALSE(done(rig));
  EXPECT_TRUE(rig.gateway->may(command::kind<command::Resume>)) << rig.story();
}

}  // namespace
}  // namespace kinebus
