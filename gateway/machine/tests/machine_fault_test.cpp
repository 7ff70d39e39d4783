// What the machine does when something goes wrong: it stops on the path, says why, and can go on where that
// is safe.

#include <gtest/gtest.h>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/machine/tests/machine_rig.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A rig in the midst of a long straight move in X.
struct Midway : MachineRig {
  bool begin() {
    if (!make_ready()) return false;
    if (!gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X60 F1200\nG1 X0\n"), "line"}))
      return false;
    return run_until([&] { return gateway->status().machine_pose[kX] > 20; }, 30s);
  }
  bool rests() {
    run_for(300ms);
    const JointVector still = joints();
    run_for(500ms);
    return joints() == still;
  }
};

TEST(MachineFaults, MissingNodeEndsBringUpInAnAlarmThatNamesIt) {
  MachineRig rig(default_m1(), [](auto& nodes) { nodes.pop_back(); });
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 30s));
  EXPECT_TRUE(rig.told(AlarmCode::kNodeMissing)) << rig.story();
  EXPECT_NE(rig.story().find("node 3"), std::string::npos) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  EXPECT_EQ(rig.gateway->state(), MachineState::kOff);
}

TEST(MachineFaults, WrongProductIsRefused) {
  MachineDescription description = default_m1();
  description.nodes[1].product = 0x1234;
  MachineRig rig(description, [](auto& nodes) { nodes[1].node.identity.product_code = 0x5678; });
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 30s));
  EXPECT_TRUE(rig.told(AlarmCode::kWrongIdentity)) << rig.story();
}

TEST(MachineFaults, TwoNodesWithOneIdAreRefusedByTheirSerialNumbers) {
  MachineRig rig;
  // What another node 2 answers, a moment after the machine's own.
  rig.on_frame = [&](BusTime when, const CanFrame& frame) {
    if (frame.id != cob_id::kSdoReply + 2 || frame.data[0] != 0x43 || frame.data[3] != 4) return;
    CanFrame other = frame;
    other.data[4] ^= 0x40;
    rig.gateway->on_frame(when, other);
  };
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 30s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kIdTaken)) << rig.story();
  EXPECT_NE(rig.story().find("two nodes use the id 2"), std::string::npos) << rig.story();
  rig.on_frame = {};
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  EXPECT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
}

// One that answers no SDO has no serial number to be found by, and its heartbeat looks as if the machine's
// own node had been taken out of operation.
TEST(MachineFaults, ASecondNodeWithAnIdThatOnlyBeatsIsNamedByTheNextBringUp) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.gateway->on_frame(rig.now, heartbeat_frame(NmtState::kPreOperational, 2));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  rig.run_for(2s);  // the machine's own node is heard
  rig.gateway->on_frame(rig.now, heartbeat_frame(NmtState::kPreOperational, 2));
  rig.run_for(2s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.told(AlarmCode::kIdTaken); }, 5s)) << rig.story();
  EXPECT_NE(rig.story().find("two nodes use the id 2: one says"), std::string::npos) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  // Said once: without the other node the machine comes up.
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  EXPECT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
}

// A node that somebody stops and starts again is one node.
TEST(MachineFaults, ANodeThatIsStoppedAndStartedByCommandsIsNoSecondOne) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.gateway->on_frame(rig.now, nmt_frame(NmtCommand::kEnterPreOperational, 2));
  rig.gateway->on_frame(rig.now, heartbeat_frame(NmtState::kPreOperational, 2));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  rig.gateway->on_frame(rig.now, nmt_frame(NmtCommand::kStart, 2));
  rig.run_for(2s);
  rig.gateway->on_frame(rig.now, nmt_frame(NmtCommand::kEnterPreOperational, 2));
  rig.gateway->on_frame(rig.now, heartbeat_frame(NmtState::kPreOperational, 2));
  rig.gateway->on_frame(rig.now, nmt_frame(NmtCommand::kStart, 2));
  rig.run_for(2s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  EXPECT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  EXPECT_FALSE(rig.told(AlarmCode::kIdTaken)) << rig.story();
}

TEST(MachineFaults, AnotherGatewayOnTheBusIsNotJoined) {
  MachineRig rig;
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  rig.run_for(100ms);
  rig.gateway->on_frame(rig.now, CanFrame::make(cob_id::kHeartbeat + kGatewayNodeId, {5}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 1s));
  EXPECT_TRUE(rig.told(AlarmCode::kSecondGateway)) << rig.story();
}

TEST(MachineFaults, CarriageWithoutSwitchStopsAllCarriages) {
  MachineRig rig(default_m1(), [](auto& nodes) { nodes[1].axes[0].switch_input = 0; });
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 120s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kHomingSpread) || rig.told(AlarmCode::kHomingFailed)) << rig.story();
  rig.run_for(1s);
  const JointVector still = rig.joints();
  rig.run_for(2s);
  EXPECT_EQ(rig.joints(), still);
  EXPECT_FALSE(rig.gateway->status().positions_known);
  // The other carriages are not dragged on by it beyond the spread.
  const double lowest = rig.machine.joints[0].homing->switch_position - rig.machine.homing.max_spread_mm - 10;
  for (std::size_t tower = 0; tower < 4; ++tower) EXPECT_GT(rig.joints()[tower], lowest);
}

TEST(MachineFaults, SpreadBeyondTheLimitEndsHomingAtOnce) {
  MachineDescription description = default_m1();
  description.homing.max_spread_mm = 30;
  MachineRig rig(description, [](auto& nodes) { nodes[0].axes[1].switch_input = 0; });
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 120s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kHomingSpread)) << rig.story();
}

TEST(MachineFaults, StopDuringHomingStopsAllCarriagesAndHomingCanBeginAgain) {
  MachineRig rig;
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  rig.run_for(1s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 3s)) << rig.story();
  rig.run_for(500ms);
  const JointVector still = rig.joints();
  rig.run_for(1s);
  EXPECT_EQ(rig.joints(), still);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s)) << rig.story();
}

TEST(MachineFaults, LostRecordStopsOnThePathAndPositionsStayKnown) {
  Midway rig;
  ASSERT_TRUE(rig.begin()) << rig.story();
  bool lost = false;
  rig.lose_from_gateway = [&](const CanFrame& frame) {
    return frame.id == cob_id::rpdo(3, 2) && !std::exchange(lost, true);
  };
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s)) << rig.story();
  EXPECT_TRUE(rig.rests());
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() != MachineState::kStopped; }, 5s))
      << rig.story();
  EXPECT_TRUE(rig.gateway->status().positions_known);
  if (rig.gateway->state() == MachineState::kHeld) {
    ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
  }
  ASSERT_EQ(rig.gateway->state(), MachineState::kReady) << rig.story();
  const JointVector joints = rig.joints();
  const JointVector told = rig.gateway->status().joints;
  for (std::size_t tower = 0; tower < 4; ++tower) EXPECT_NEAR(joints[tower], told[tower], 0.002);
  ASSERT_TRUE(rig.run_job("G1 X10 F3000\n")) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 10, 2e-3);
}

TEST(MachineFaults, RecordsThatAnAdapterExchangesArePutRightAndToldOnce) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  std::optional<CanFrame> kept;
  int others = 0, exchanged = 0;
  rig.lose_from_gateway = [&](const CanFrame& frame) {
    const bool record = frame.id == cob_id::rpdo(3, 2);
    if (kept && (record || ++others == 8)) {
      rig.send_late(*std::exchange(kept, std::nullopt));
      exchanged += record ? 1 : 0;
    } else if (!kept && record) {
      kept = frame;
      others = 0;
      return true;
    }
    return false;
  };
  ASSERT_TRUE(rig.run_job("G1 X20 Y5 F3000\nG2 X-20 Y5 I-20 J0\nG1 X0 Y0\n")) << rig.story();
  EXPECT_GT(exchanged, 10);
  int told = 0;
  for (const MachineEvent& event : rig.events)
    if (event.words.find("in another order") != std::string::npos) ++told;
  EXPECT_EQ(told, 1) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 0, 2e-3);
}

TEST(MachineFaults, SilentNodeStopsTheMachineAndAsksForBringUp) {
  Midway rig;
  ASSERT_TRUE(rig.begin()) << rig.story();
  rig.lose_to_gateway = [](const CanFrame& frame) { return (frame.id & 0x7F) == 2; };
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 10s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kHeartbeatLost)) << rig.story();
  EXPECT_TRUE(rig.rests());
  rig.lose_to_gateway = {};
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_EQ(rig.gateway->state(), MachineState::kOff);
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  // The nodes have kept their positions: no homing is needed.
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story() << rig.gateway->status().doing;
  ASSERT_TRUE(rig.run_job("G1 X10 F3000\n")) << rig.story();
}

TEST(MachineFaults, DriveFaultStopsAllAndIsToldInWords) {
  Midway rig;
  ASSERT_TRUE(rig.begin()) << rig.story();
  rig.nodes.node(0).on_drive_fault(LocalTime{rig.now}, 0, 0x2310);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_NE(rig.story().find("over-current"), std::string::npos) << rig.story();
  EXPECT_TRUE(rig.rests());
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
}

TEST(MachineFaults, EmergencyStopInputStopsAllOnThePath) {
  MachineDescription description = default_m1();
  description.nodes[2].inputs[6] = {InputFunction::kEmergencyStop, 0};
  MachineRig rig(description);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(
      rig.gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X60 F1200\nG1 X0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 20; }, 30s)) << rig.story();
  rig.nodes.set_input(2, rig.now, 7, true);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  EXPECT_NE(rig.story().find("emergency stop"), std::string::npos) << rig.story();
  // While the button is pressed the latch cannot be lifted.
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  rig.run_for(5s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kStopped) << rig.story();
  rig.nodes.set_input(2, rig.now, 7, false);
  rig.run_for(100ms);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

CanFrame stream_status(std::uint8_t node, const StreamStatus& status) {
  CanFrame frame{.id = cob_id::tpdo(2, node), .length = 8};
  put_u64_le(frame.data, encode(status));
  return frame;
}

// A bit that is wrong in one node's memory in spite of the CRC: its axis would leave the path 0.4 s later.
TEST(MachineFaults, ARecordThatANodeTakesOtherwiseStopsTheMachineBeforeItMoves) {
  for (const unsigned bit : {9u, 18u, 25u, 35u, 43u, 55u}) {
    SCOPED_TRACE(testing::Message() << "bit " << bit);
    MachineRig rig;
    const auto kinematics = make_kinematics(rig.machine);
    ASSERT_TRUE(kinematics);
    ASSERT_TRUE(rig.make_ready()) << rig.story();
    bool wrong = false, moves = false;
    rig.nodes.set_arrival_hook([&](int station, std::vector<VirtualMachine::Arrival>& arrivals) {
      for (auto& arrival : arrivals) {
        CanFrame& frame = arrival.frame;
        const bool motion =
            frame.id == 0x401 && decode_segment(get_u64_le(frame.data)).value_or(Segment{}).duration > 0;
        if (station != 0 || !motion || !moves || std::exchange(wrong, true)) continue;
        frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1u << bit % 8));
      }
    });
    double astray_mm = 0;
    std::optional<Pose> first;
    const auto on_the_line = [&](MachineState until) {
      Pose pose = (*kinematics)->bed_reference();
      EXPECT_TRUE((*kinematics)->forward(Frame::kMachine, rig.joints(), pose));
      if (!first) first = pose;
      for (const std::size_t axis : {kY, kZ})
        astray_mm = std::max(astray_mm, std::abs(pose[axis] - (*first)[axis]));
      moves = moves || pose[kX] > 20;
      return rig.gateway->state() == until;
    };
    std::string text;
    for (int i = 0; i < 10; ++i) text += "G1 X60 F3000\nG1 X0\n";
    ASSERT_TRUE(rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(text), "lines"}));
    ASSERT_TRUE(rig.run_until([&] { return on_the_line(MachineState::kStopped); }, 60s)) << rig.story();
    EXPECT_TRUE(wrong);
    EXPECT_TRUE(rig.told(AlarmCode::kStreamLost)) << rig.story();
    EXPECT_NE(rig.story().find("the node has taken a record otherwise than it was sent, node 1"),
              std::string::npos)
        << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
    ASSERT_TRUE(rig.run_until([&] { return on_the_line(MachineState::kReady); }, 60s)) << rig.story();
    EXPECT_LT(astray_mm, 5e-3);
  }
}

TEST(MachineFaults, NodeThatLosesSynchronisationStopsTheMachine) {
  Midway rig;
  ASSERT_TRUE(rig.begin()) << rig.story();
  rig.gateway->on_frame(rig.now, stream_status(1, {.flags = StreamStatus::kRunning}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kSyncError)) << rig.story();
  EXPECT_TRUE(rig.rests());
}

TEST(MachineFaults, NodeThatRestsAtAnotherPathTimeIsAnAlarm) {
  Midway rig;
  ASSERT_TRUE(rig.begin()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  rig.run_for(200ms);
  const auto units = static_cast<std::uint32_t>(rig.gateway->path_time(rig.now).count() / 256);
  rig.gateway->on_frame(rig.now,
                        stream_status(2, {.flags = StreamStatus::kSynchronised, .path_units = units + 5}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kPathTimeDiffers)) << rig.story();
}

TEST(MachineFaults, BusFailureIsAnAlarmAndTheMachineComesBack) {
  Midway rig;
  ASSERT_TRUE(rig.begin()) << rig.story();
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kBusFailure));
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
}

TEST(MachineFaults, GatewayThatDiesLeavesTheNodesAtRestAndANewOneTakesOver) {
  Midway rig;
  ASSERT_TRUE(rig.begin()) << rig.story();
  rig.lose_from_gateway = [](const CanFrame&) { return true; };
  rig.run_for(2s);
  EXPECT_TRUE(rig.rests());
  const JointVector still = rig.joints();
  // The new one has a time epoch of its own, and learns from the nodes where they stand.
  rig.lose_from_gateway = {};
  rig.gateway = std::make_unique<Gateway>(rig.machine, Gateway::Options{.epoch = 2});
  rig.run_for(10ms);
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story() << rig.gateway->status().doing;
  // A node that is freed of a stream comes to rest on a whole count.
  for (std::size_t tower = 0; tower < 4; ++tower) EXPECT_NEAR(rig.joints()[tower], still[tower], 0.0008);
  EXPECT_GT(rig.gateway->status().machine_pose[kX], 15);
  ASSERT_TRUE(rig.run_job("G1 X10 F3000\n")) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 10, 2e-3);
}

TEST(MachineFaults, CommandsAreRefusedWithAReasonWhereTheyMakeNoSense) {
  MachineRig rig;
  const auto home = rig.gateway->carry_out(command::Home{});
  ASSERT_FALSE(home);
  EXPECT_NE(home.error().words.find("bring it up first"), std::string::npos) << home.error().words;
  EXPECT_FALSE(rig.gateway->carry_out(command::Resume{}));
  EXPECT_FALSE(rig.gateway->carry_out(command::Cancel{}));
  EXPECT_FALSE(rig.gateway->carry_out(command::SetFeedOverride{0}));
  EXPECT_FALSE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 1000}));
}

}  // namespace
}  // namespace kinebus
