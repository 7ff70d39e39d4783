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
  ASSERT_TRUE(rig.gateway->run(std::make_unique<StringSource>("G10 L2 P2 X50\nG1 X0 Y0 Z10 F6000\n"), "own"));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 5s)) << rig.story();
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_NEAR(rig.pose()[kX], 4, 0.02) << "the job itself began in G54";
  rig.replace_gateway();
  EXPECT_EQ(rig.gateway->work_offsets()[0], first[0]);
  EXPECT_EQ(rig.gateway->work_offsets()[8][kY], 8);
  EXPECT_EQ(rig.gateway->work_offsets()[1][kX], 0);
  EXPECT_EQ(rig.gateway->state(), MachineState::kOff) << "nothing else is taken up";
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
