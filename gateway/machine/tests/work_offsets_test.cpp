// Work offsets are the machine's: the journal keeps them, whatever comes and goes.

#include <gtest/gtest.h>

#include "gateway/machine/tests/resume_rig.hpp"

namespace kinebus {
namespace {

TEST(WorkOffsets, OutliveGatewaysAndJobsWhereverTheJournalIsCut) {
  ResumeRig rig;
  ASSERT_TRUE(rig.gateway->take_line("G10 L2 P1 X4 Y-3 Z2", 1));
  rig.replace_gateway();
  const gcode::WorkOffsets first = rig.gateway->work_offsets();
  EXPECT_EQ(first[0][kX], 4);
  EXPECT_EQ(first[0][kZ], 2);
  ASSERT_TRUE(rig.gateway->take_line("G10 L2 P9 Y8", 2));
  // The last record torn: what was in force before it.
  rig.replace_gateway(5);
  EXPECT_EQ(rig.gateway->work_offsets(), first);
  ASSERT_TRUE(rig.gateway->take_line("G10 L2 P9 Y8", 3));
  // A job with offsets of its own comes, ends, and changes nothing; its own path has the machine's.
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G10 L2 P2 X50\nG1 X0 Y0 Z10 F6000\n"), "own"}));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 5s)) << rig.story();
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_NEAR(rig.pose()[kX], 4, 0.02) << "the job itself began in G54";
  rig.replace_gateway();
  EXPECT_EQ(rig.gateway->work_offsets()[0], first[0]);
  EXPECT_EQ(rig.gateway->work_offsets()[8][kY], 8);
  EXPECT_EQ(rig.gateway->work_offsets()[1][kX], 0);
  EXPECT_EQ(rig.gateway->state(), MachineState::kOff) << "nothing else is taken up";
}

TEST(WorkOffsets, ZeroHereIsWhereTheToolStandsHoweverItCameThere) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {12, -5, 3, 0, 0, 0}}));
  ASSERT_TRUE(rig.reach(MachineState::kMoving)) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  const Pose stands = rig.gateway->status().machine_pose;
  ASSERT_TRUE(rig.gateway->carry_out(command::SetWorkOffset{.system = 1, .here = true}));
  EXPECT_NEAR(rig.gateway->work_offsets()[0][kX], stands[kX], 1e-9);
  EXPECT_NEAR(rig.gateway->work_offsets()[0][kZ], stands[kZ], 1e-9);
  // Once more, with another name for the place: what was in force before plays no part.
  ASSERT_TRUE(rig.gateway->carry_out(command::SetWorkOffset{.system = 1, .offset = {5}, .here = true}));
  EXPECT_NEAR(rig.gateway->work_offsets()[0][kX], stands[kX] - 5, 1e-9);
  EXPECT_NEAR(rig.gateway->work_offsets()[0][kY], stands[kY], 1e-9);
}

TEST(WorkOffsets, AreThoseOfTheirMachine) {
  journal::State state;
  MachineDescription other = default_m1();
  other.name = "another";
  gcode::WorkOffsets offsets{};
  offsets[0][kZ] = 11;
  state.take(journal::Offsets{identity(other), offsets});
  for (int i = 0; i < 40; ++i) state.take(journal::Offsets{identity(default_m1()), {}});
  Gateway here(default_m1()), there(other);
  ASSERT_TRUE(here.recover(state, nullptr));
  ASSERT_TRUE(there.recover(state, nullptr));
  EXPECT_EQ(here.work_offsets()[0][kZ], 0);
  EXPECT_EQ(there.work_offsets()[0][kZ], 11);
  for (int i = 0; i < 40; ++i) state.take(journal::Offsets{"machine " + std::to_string(i), offsets});
  EXPECT_EQ(state.offsets.size(), journal::State::kMachines) << "bounded";
}

}  // namespace
}  // namespace kinebus
