// Ramps of path time on a machine with a limit of jerk: smooth where all nodes follow such ramps, straight
// where one does not, and a stop is straight at any moment.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/machine/tests/machine_rig.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using Kind = RateCommand::Kind;

MachineDescription gentle_m1() {
  MachineDescription machine = default_m1();
  machine.path.tool_jerk_mm_per_s3 = 100'000;
  return machine;
}

/// Counts what the gateway asks of path time.
struct Heard {
  explicit Heard(MachineRig& rig) {
    rig.on_frame = [this](BusTime when, const CanFrame& frame) {
      if (frame.id != kRateCobId) return;
      const auto command = decode_rate_command(frame, when);
      if (!command || last_ == command->counter) return;
      last_ = command->counter;
      smooth += command->kind == Kind::kSmooth ? 1 : 0;
      straight_holds += command->kind == Kind::kRate && command->rate_q15 == 0 ? 1 : 0;
    };
  }
  void forget() { smooth = straight_holds = 0; }

  int smooth = 0, straight_holds = 0;

 private:
  int last_ = -1;
};

bool moves(MachineRig& rig) {
  return rig.gateway->carry_out(
             command::Run{std::make_unique<StringSource>("G1 X60 F1200\nG1 X0\n"), "line"}) &&
         rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 20; }, 30s);
}

/// Holds, goes on with half of the speed and then the whole.
void hold_and_go_on(MachineRig& rig, Heard& heard) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(moves(rig)) << rig.story();
  heard.forget();
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1500ms)) << rig.story();
  rig.run_for(200ms);
  const JointVector still = rig.joints();
  rig.run_for(500ms);
  EXPECT_EQ(rig.joints(), still);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.5}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  rig.run_for(300ms);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{1}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 0, 2e-3);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST(SmoothRamps, AreTakenByNodesThatFollowThem) {
  MachineRig rig(gentle_m1());
  Heard heard(rig);
  hold_and_go_on(rig, heard);
  EXPECT_GE(heard.smooth, 3);
  EXPECT_EQ(heard.straight_holds, 1) << "behind the job's end";
  EXPECT_EQ(rig.story().find("smooth"), std::string::npos) << rig.story();
}

TEST(SmoothRamps, AreNotForMachinesWithoutALimitOfJerk) {
  MachineRig rig;
  Heard heard(rig);
  hold_and_go_on(rig, heard);
  EXPECT_EQ(heard.smooth, 0);
}

// A node whose program does not have 2118h takes a smooth ramp's frame for a malformed one: it would run on
// while the others hold.
TEST(SmoothRamps, AreNotAskedOfAMachineOneOfWhoseNodesDoesNotKnowThem) {
  for (const bool told_without : {false, true}) {
    SCOPED_TRACE(told_without ? "2118h without bit 0" : "no 2118h");
    MachineRig rig(gentle_m1());
    Heard heard(rig);
    rig.nodes.set_arrival_hook([&](int station, std::vector<VirtualMachine::Arrival>& arrivals) {
      for (auto& arrival : arrivals) {
        CanFrame& frame = arrival.frame;
        if (station == VirtualMachine::kGatewayStation && frame.id == cob_id::kSdoReply + 2 &&
            sdo::address_in(frame) == object::kStreamFunctions) {
          put_u32_le(std::span(frame.data).subspan(4),
                     told_without ? 2 : static_cast<std::uint32_t>(AbortCode::kNoObject));
          if (!told_without) frame.data[0] = 0x80;
        }
        // As the second node has it.
        if (station == 1 && frame.id == kRateCobId && frame.data[0] >> 4 == static_cast<int>(Kind::kSmooth))
          frame.data[7] ^= 1;
      }
    });
    hold_and_go_on(rig, heard);
    EXPECT_EQ(heard.smooth, 0);
    EXPECT_GE(heard.straight_holds, 2);
    EXPECT_NE(rig.story().find("the program of node 2 does not know smooth ramps"), std::string::npos)
        << rig.story();
  }
}

// Whatever path time does, a stop takes the machine's stop ramp, from the lead of a command on.
TEST(SmoothRamps, AStopInTheMidstOfOneTakesNoLongerThanItsRamp) {
  for (const BusTime after : {5ms, 60ms, 120ms, 200ms, 280ms, 350ms}) {
    SCOPED_TRACE(testing::Message() << to_seconds(after) << " s after the command");
    for (const bool resuming : {false, true}) {
      MachineRig rig(gentle_m1());
      ASSERT_TRUE(rig.make_ready()) << rig.story();
      ASSERT_TRUE(moves(rig)) << rig.story();
      ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
      if (resuming) {
        ASSERT_TRUE(rig.reach(MachineState::kHeld, 1500ms)) << rig.story();
        ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
      }
      rig.run_for(after);
      const PathTime from = rig.gateway->path_time(rig.now);
      ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
      constexpr BusTime kLead = 5ms;
      const BusTime rests = rig.now + kLead + rig.machine.stop.ramp + 1ms;
      rig.run_for(rests - rig.now);
      const PathTime stands = rig.gateway->path_time(rig.now);
      const JointVector still = rig.joints();
      rig.run_for(1s);
      EXPECT_EQ(rig.gateway->path_time(rig.now), stands);
      EXPECT_EQ(rig.joints(), still) << "resuming: " << resuming;
      EXPECT_LE(to_seconds(stands - from),
                to_seconds(kLead) + to_seconds(BusTime{rig.machine.stop.ramp}) / 2 + 1e-3);
      ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
      ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() != MachineState::kStopped; }, 5s));
      EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
    }
  }
}

}  // namespace
}  // namespace kinebus
