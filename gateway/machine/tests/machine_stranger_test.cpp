// What another device on the bus can do to a machine: it is told who did what, nothing moves apart, and the
// operator can go on. And what the machine does to itself: no stop ends in a complaint about positions.

#include <gtest/gtest.h>

#include "gateway/machine/tests/stranger_rig.hpp"
#include "protocol/bytes.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/emcy.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

CanFrame text_frame(std::string_view text) {
  const auto frame = parse_frame(text);
  EXPECT_TRUE(frame) << text;
  return frame.value_or(CanFrame{});
}

using Stranger = StrangerOf<VirtualMachine>;

TEST(Stranger, CancelAndReferenceAgainAndAgainFindsEveryNodeWhereTheGatewayBelieves) {
  Stranger rig;
  cancel_and_reference(rig, rounds(60));
}

TEST(Stranger, LostRecordAndResumeAgainAndAgainFindsEveryNodeWhereTheGatewayBelieves) {
  Stranger rig;
  lose_record_and_resume(rig, rounds(40));
}

TEST(Stranger, AHomingThatWasStoppedIsNoChangeOfParameters) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kHoming, 5s)) << rig.story();
  rig.run_for(500ms);
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  const auto others_ask = [&] {
    for (const char* request : {"601#4000100000000000", "602#4000100000000000", "603#4000100000000000"})
      rig.stranger_sends(text_frame(request));
    rig.run_for(2s);
  };
  others_ask();
  EXPECT_FALSE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.run_until(
      [&] {
        return rig.gateway->state() == MachineState::kReady || rig.gateway->state() == MachineState::kUnhomed;
      },
      5s))
      << rig.story();
  others_ask();
  EXPECT_FALSE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
  rig.stranger_sends(text_frame("602#2B15210033000000"));
  ASSERT_TRUE(rig.run_until([&] { return rig.told(AlarmCode::kNodeChanged); }, 2s)) << "it is watched again";
}

TEST(Stranger, NmtStopOfAllIsNamedAndBringUpStartsTheNodesAgain) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.stranger_sends(text_frame("000#0200"));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
  EXPECT_TRUE(rig.says("taken out of operation by an NMT command")) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.run_until(
      [&] {
        return rig.gateway->state() == MachineState::kReady || rig.gateway->state() == MachineState::kUnhomed;
      },
      30s))
      << rig.story();
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady) << "the drives kept their power: positions are known";
}

TEST(Stranger, NmtStopInMotionStopsAllOnThePathAndTheMachineComesUpAgain) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  rig.run_for(300ms);
  rig.stranger_sends(text_frame("000#0200"));
  ASSERT_TRUE(rig.run_until([&] { return rig.told(AlarmCode::kNodeChanged); }, 5s)) << rig.story();
  EXPECT_TRUE(rig.says("another device has sent all nodes an NMT command (02h)")) << rig.story();
  EXPECT_TRUE(rig.says("taken out of operation by an NMT command")) << rig.story();
  EXPECT_TRUE(rig.rests());
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 30s)) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

TEST(Stranger, AMotorThatIsMadeFreeAtRestIsNoLongerReady) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.run_for(1s);
  rig.stranger_sends(text_frame("202#00000F000000"));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s)) << rig.story();
  EXPECT_TRUE(rig.says("another device has sent node 2 a controlword")) << rig.story();
  EXPECT_FALSE(rig.gateway->status().positions_known);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s)) << rig.story();
}

// Nobody was heard to do it: the statusword alone tells.
TEST(Stranger, AStatuswordAtRestOfADriveWithoutPowerIsNoLongerReady) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.run_for(1s);
  rig.stranger_sends(text_frame("182#50023702070700"));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s)) << rig.story();
  EXPECT_TRUE(rig.says("node 2: the drive of axis 1 was switched off")) << rig.story();
  EXPECT_FALSE(rig.gateway->status().positions_known);
}

TEST(Stranger, AMoveOfAnotherMasterAtRestIsSeenAndStoppedAndPositionsAreReadAgain) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.run_for(1s);
  const JointVector before = rig.joints();
  rig.stranger_sends(text_frame("201#0F000F000107"));  // axis 1: profile position
  rig.stranger_sends(text_frame("601#237A600000E01E00"));
  rig.stranger_sends(text_frame("201#1F000F000107"));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s)) << rig.story();
  EXPECT_TRUE(rig.says("node 1: axis 1 was set to the mode of operation 1 by another device")) << rig.story();
  EXPECT_TRUE(rig.rests());
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
  const JointVector after = rig.joints(), told = rig.gateway->status().joints;
  EXPECT_NE(after, before);
  for (std::size_t tower = 0; tower < 4; ++tower) EXPECT_NEAR(after[tower], told[tower], 0.002);
}

TEST(Stranger, ParametersThatAreChangedAtRestAreNamedAndWrittenAnew) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.stranger_sends(text_frame("602#4041600000000000"));  // who only reads changes nothing
  rig.run_for(2s);
  ASSERT_EQ(rig.gateway->state(), MachineState::kReady) << rig.story();
  rig.stranger_sends(text_frame("602#2B13210002000000"));  // stop ramp 2 ms
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
  EXPECT_TRUE(rig.says("node 2: another device has changed its parameters")) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  rig.events.clear();
  rig.stranger_sends(text_frame("602#4041600000000000"));
  rig.run_for(2s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady) << rig.story();
}

TEST(Stranger, ParametersAreNotChangedInMotionAndTheJobGoesOn) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  rig.run_for(300ms);
  int refused = 0;
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    if (frame.id == cob_id::kSdoReply + 2 && frame.data[0] == 0x80 &&
        get_u32_le(frame.bytes().subspan(4)) == 0x0800'0022)
      ++refused;
  };
  for (const char* write : {"602#2B13210002000000", "602#2F40210401000000", "602#2B40210200000000"}) {
    rig.stranger_sends(text_frame(write));
    rig.run_for(20ms);
  }
  EXPECT_EQ(refused, 3);
  for (const char* object : {"2113h:0", "2140h:4", "2140h:2"})
    EXPECT_TRUE(rig.says("another device writes object " + std::string(object) +
                         " of node 2 while the machine moves"))
        << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

// A device that writes to everything, all the time: the log stays one that a person reads.
TEST(Stranger, ManyWritesInMotionAreNotToldOneByOne) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  rig.run_for(300ms);
  rig.events.clear();
  for (int i = 0; i < 200; ++i) {
    CanFrame write = text_frame("602#2B13210002000000");
    write.data[1] = static_cast<std::uint8_t>(i);
    rig.stranger_sends(write);
    rig.run_for(10ms);
  }
  const auto told = std::count_if(rig.events.begin(), rig.events.end(), [](const MachineEvent& e) {
    return e.words.find("another device writes") != std::string::npos;
  });
  EXPECT_GE(told, 12);
  EXPECT_LE(told, 18);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

TEST(Stranger, ARecordThatTheGatewayHasNotSentStopsAllAndIsNamed) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  rig.run_for(300ms);
  rig.stranger_sends(text_frame("402#4001000000000000"));
  rig.run_for(20ms);
  EXPECT_TRUE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
  EXPECT_TRUE(rig.says("another device has sent node 2 a record of motion (COB-ID 402h)")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s)) << rig.story();
  EXPECT_TRUE(rig.rests());
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(
      rig.run_until([&] { return static_cast<bool>(rig.gateway->carry_out(command::Resume{})); }, 20s))
      << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

TEST(Stranger, RemoteFramesStopNobodyAndAreToldOnce) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  for (const char* poll : {"77F#R", "1FF#R8", "080#R", "2FF#R8", "701#R", "181#R", "081#R8"}) {
    rig.stranger_sends(text_frame(poll));
    rig.run_for(50ms);
  }
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
  EXPECT_TRUE(rig.says("remote frames (COB-ID 77Fh)")) << rig.story();
  EXPECT_FALSE(rig.says("remote frames (COB-ID 1FFh)")) << rig.story();
}

TEST(Stranger, AStopOfAnUnknownDeviceHasACauseAndTheJobGoesOnAfterIt) {
  Stranger rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  rig.run_for(300ms);
  CanFrame forged = encode(Emergency{.node = 44, .code = 0x1000, .error_register = 1});
  const auto stop = encode(StopRequest{StopReason::kCommand, 0, rig.now});
  std::copy(stop.begin(), stop.end(), forged.data.begin() + 3);
  rig.stranger_sends(forged);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  EXPECT_TRUE(rig.says("node 44, which the machine file does not name, has asked all to stop"))
      << rig.story();
  EXPECT_TRUE(rig.rests());
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

}  // namespace
}  // namespace kinebus
