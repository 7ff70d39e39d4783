// What each word of a node, and each silence, means for the machine.

#include "gateway/machine/node_watch.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gateway/jobs/machine_setup.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using Situation = NodeWatch::Situation;

/// Nodes 1 to 3 have axes, node 20 has none.
class NodeWatchTest : public ::testing::Test {
 protected:
  NodeWatchTest() {
    for (std::uint8_t id = 1; id <= 3; ++id) links.emplace_back(id);
    NodeFunctions none;
    none.axis_pairs = 0;
    links.emplace_back(20, none);
    for (std::size_t i = 0; i < links.size(); ++i) heard(i, now);
    watch.on_time(now, false);
  }
  void heard(std::size_t node, BusTime when, NmtState state = NmtState::kOperational) {
    links[node].on_frame(when, heartbeat_frame(state, links[node].id()));
  }
  void says(std::size_t node, const char* text, BusTime when) {
    EXPECT_TRUE(links[node].on_frame(when, *parse_frame(text)));
  }
  void asks_to_stop(std::size_t node, StopReason reason, std::uint16_t code = 0x1000) {
    CanFrame frame = encode(Emergency{.node = links[node].id(), .code = code, .error_register = 1});
    const auto stop = encode(StopRequest{reason, 0, now});
    std::copy(stop.begin(), stop.end(), frame.data.begin() + 3);
    links[node].on_frame(now, frame);
  }
  static std::string words(const NodeWatch::Verdict& v) {
    return std::string(v.stop ? "stop " : "") + (v.fault ? "fault " : "") + (v.by_absence ? "absence " : "") +
           (v.positions_lost ? "positions " : "") + (v.stream_lost ? "stream " : "");
  }
  /// As at each turn of the machine.
  std::string look(std::size_t node, const Situation& situation = {.state = MachineState::kReady}) {
    watch.on_time(now, streams);
    return words(watch.look(now, node, situation));
  }
  std::string told() {
    std::string text;
    while (const auto event = events.pop()) text += event->words.english() + "\n";
    return text;
  }
  StreamStatus status(std::uint8_t flags = StreamStatus::kSynchronised) const {
    return {.next_sequence = 0,
            .free_records = 120,
            .flags = flags,
            .path_units = static_cast<std::uint32_t>(rate.tau(now).count() / kPathTicksPerUnit)};
  }
  std::string take(const StreamStatus& status, bool stopping = false) {
    return words(watch.take_stream(now, links[0], status, stopping));
  }

  BusTime now{10s};
  bool streams = false;
  MachineDescription machine = default_m1();
  std::unique_ptr<Kinematics> kinematics = std::move(*make_kinematics(machine));
  std::vector<NodeAxes> axes = node_axes(machine);
  StreamGroup group{*kinematics, axes, stream_options(machine)};
  std::deque<NodeLink> links;
  PathRate rate;
  EventQueue events;
  MachineCounters counters;
  NodeWatch watch{machine, links, rate, group, events, counters};
};

TEST_F(NodeWatchTest, ANodeIsSilentBehindItsHeartbeatsTimeAndNotAtIt) {
  const BusTime timeout{machine.bus.heartbeat_timeout};
  const BusTime heard_at = now;
  for (const std::size_t node : {0, 3}) {
    now = heard_at + timeout;
    EXPECT_EQ(look(node), "");
    EXPECT_FALSE(watch.needs_bring_up());
    now += 1ns;
    EXPECT_EQ(look(node), "stop fault ");
    EXPECT_EQ(told(), "node " + std::to_string(links[node].id()) + " is silent\n");
    EXPECT_TRUE(watch.needs_bring_up());
    EXPECT_EQ(look(node), "") << "once";
    watch.bring_up_begins();
  }
  watch.on_stall(now);
  EXPECT_EQ(look(0), "") << "nobody listened";
  now += timeout;
  EXPECT_EQ(look(0), "");
  now += 1ns;
  EXPECT_EQ(look(0), "stop fault ");
}

TEST_F(NodeWatchTest, OneThatStreamsIsSilentSoonerIfItHasAxes) {
  streams = true;
  now += 250ms;
  EXPECT_EQ(look(0), "") << "as long as anybody may wait";
  now += 1ns;
  EXPECT_EQ(look(3), "");
  EXPECT_EQ(look(0), "stop fault ");
  watch.bring_up_begins();
  streams = false;
  EXPECT_EQ(look(0), "") << "nothing flows any more";
  // A run begins: what was not said before it counts for nothing.
  now += 200ms;
  EXPECT_EQ(look(0), "");
  streams = true;
  now += 250ms;
  EXPECT_EQ(look(0), "");
  now += 1ns;
  EXPECT_EQ(look(0), "stop fault ");
  watch.bring_up_begins();
  heard(1, now);
  EXPECT_EQ(look(1), "");
}

TEST_F(NodeWatchTest, OneThatHomesIsSilentSooner) {
  const Situation homes{.state = MachineState::kHoming, .homes = true};
  now += 250ms;
  EXPECT_EQ(look(0, homes), "");
  now += 1ns;
  EXPECT_EQ(look(0, {.state = MachineState::kHoming}), "");
  EXPECT_EQ(look(0, homes), "stop fault ");
}

TEST_F(NodeWatchTest, ARestartLosesThePositionsOfWhatHasSome) {
  heard(1, now, NmtState::kInitialising);
  heard(3, now, NmtState::kInitialising);
  EXPECT_EQ(look(1), "stop fault positions ");
  EXPECT_EQ(told(), "node 2 has restarted\n");
  EXPECT_TRUE(watch.needs_bring_up());
  watch.bring_up_begins();
  EXPECT_EQ(look(3), "stop fault ");
  EXPECT_EQ(told(), "node 20 has restarted\n");
}

TEST_F(NodeWatchTest, OneThatIsTakenOutOfOperationIsNamed) {
  for (const NmtState state : {NmtState::kStopped, NmtState::kPreOperational}) {
    heard(0, now, state);
    EXPECT_EQ(look(0), "stop fault ");
    EXPECT_EQ(told(), "node 1 was taken out of operation by an NMT command of another device\n");
    EXPECT_TRUE(watch.needs_bring_up());
    watch.bring_up_begins();
  }
}

TEST_F(NodeWatchTest, NobodyIsWatchedWhileOffInABringUpOrUntilTheNextOne) {
  heard(0, now, NmtState::kStopped);
  EXPECT_EQ(look(0, {.state = MachineState::kOff}), "");
  EXPECT_EQ(look(0, {.state = MachineState::kBringUp}), "");
  watch.lose();
  EXPECT_EQ(look(0), "");
  watch.bring_up_begins();
  EXPECT_EQ(look(0), "stop fault ");
}

constexpr const char* kFollows = "181#37163716070700";

TEST_F(NodeWatchTest, ADriveThatWasEnabledAndIsNotIsAFaultOfItsOwnAxis) {
  const Situation enabled{.state = MachineState::kHoming, .enabled = true};
  says(0, "181#50025002070700", now);
  EXPECT_EQ(look(0), "") << "nobody has enabled it";
  EXPECT_EQ(look(0, enabled), "stop fault positions stream ");
  EXPECT_EQ(told(),
            "node 1: the drive of axis 1 was switched off by another device or a fault (statusword 0250h)\n")
      << "the first of them";
  EXPECT_FALSE(watch.needs_bring_up());
  says(0, "181#37165002070700", now);
  EXPECT_EQ(look(0, enabled), "stop fault positions stream ");
  EXPECT_EQ(told().find("node 1: the drive of axis 2 was"), 0U);
  says(0, kFollows, now);
  EXPECT_EQ(look(0, enabled), "");
  EXPECT_EQ(look(1, enabled), "") << "it has told nothing yet";
}

TEST_F(NodeWatchTest, AnAxisThatFollowsIsInTheModeOfRecords) {
  says(0, "181#37163716070100", now);
  EXPECT_EQ(look(0, {.state = MachineState::kHoming, .enabled = true}), "") << "it is not asked to follow";
  EXPECT_EQ(look(0, {.state = MachineState::kReady, .enabled = true, .follows = true}), "stop fault stream ");
  EXPECT_EQ(told(), "node 1: axis 2 was set to the mode of operation 1 by another device\n");
}

TEST_F(NodeWatchTest, AnAxisMovesAtRestWhereItHasSaidSoLongEnoughBehindTheRest) {
  const auto moves = [&](BusTime since) {
    says(0, "181#37123716070700", now);
    return look(0, {.state = MachineState::kReady, .enabled = true, .follows = true, .rests_since = since});
  };
  EXPECT_EQ(moves(now), "");
  EXPECT_EQ(moves(now - 50ms), "") << "as old as a frame may be";
  EXPECT_EQ(moves(now - 50ms - 1ns), "stop fault stream ");
  EXPECT_EQ(told(), "node 1: axis 1 moves, and not by this gateway\n");
  EXPECT_EQ(look(0, {.state = MachineState::kRunning, .enabled = true, .follows = true}), "") << "in motion";
  says(0, kFollows, now);
  EXPECT_EQ(look(0, {.state = MachineState::kReady, .rests_since = 1s}), "");
}

TEST_F(NodeWatchTest, WhatANodeStopsForIsTheMachinesCause) {
  const std::pair<StopReason, const char*> table[] = {
      {StopReason::kStarved, "stop absence stream "}, {StopReason::kSequenceError, "stop stream "},
      {StopReason::kCheckpointError, "stop stream "}, {StopReason::kStreamError, "stop stream "},
      {StopReason::kEmergencyStopInput, "stop "},     {StopReason::kLimitSwitch, "stop "},
      {StopReason::kGatewayLost, "stop absence "},    {StopReason::kSyncLost, "stop absence "},
      {StopReason::kAxisFault, "stop fault "},        {StopReason::kCommand, "stop "},
      {StopReason::kPeer, "stop absence "},           {StopReason::kNone, ""},
  };
  for (const auto& [reason, verdict] : table) {
    SCOPED_TRACE(static_cast<int>(reason));
    asks_to_stop(0, reason);
    EXPECT_EQ(look(0), verdict);
    EXPECT_NE(told(), "") << "an emergency is told whatever it stops";
    asks_to_stop(0, reason);
    EXPECT_EQ(look(0, {.state = MachineState::kOff}), "");
    asks_to_stop(0, reason);
    EXPECT_EQ(look(0, {.state = MachineState::kAlarm, .bringing_up = true}), "");
    EXPECT_NE(told(), "");
    asks_to_stop(0, reason, emcy::kNoError);
    EXPECT_EQ(look(0), "") << "it is over";
    EXPECT_EQ(told(), "");
  }
}

TEST_F(NodeWatchTest, AStopIsOfAbsenceIfNothingElseWasWrong) {
  const auto both = [&](StopReason first, StopReason second) {
    asks_to_stop(0, first);
    asks_to_stop(0, second);
    return look(0);
  };
  EXPECT_EQ(both(StopReason::kGatewayLost, StopReason::kSyncLost), "stop absence ");
  EXPECT_EQ(both(StopReason::kGatewayLost, StopReason::kCommand), "stop ");
  EXPECT_EQ(both(StopReason::kCommand, StopReason::kGatewayLost), "stop ");
  EXPECT_EQ(both(StopReason::kStreamError, StopReason::kCommand), "stop stream ");
  EXPECT_EQ(both(StopReason::kAxisFault, StopReason::kSyncLost), "stop fault ");
  asks_to_stop(0, StopReason::kGatewayLost);
  heard(0, now, NmtState::kInitialising);
  EXPECT_EQ(look(0), "stop fault positions ") << "that was the cause";
  watch.bring_up_begins();
  asks_to_stop(0, StopReason::kGatewayLost);
  heard(0, now, NmtState::kStopped);
  EXPECT_EQ(look(0), "stop fault ");
  watch.bring_up_begins();
  heard(0, now);
  asks_to_stop(0, StopReason::kGatewayLost);
  says(0, "181#50025002070700", now);
  EXPECT_EQ(look(0, {.state = MachineState::kReady, .enabled = true}), "stop absence ")
      << "a node that stops switches off by itself";
  asks_to_stop(0, StopReason::kGatewayLost);
  now += BusTime{machine.bus.heartbeat_timeout} + 1ns;
  EXPECT_EQ(look(0), "stop fault ");
}

TEST_F(NodeWatchTest, AClockThatIsLostIsOfAbsence) {
  EXPECT_EQ(take(status()), "");
  EXPECT_EQ(told(), "");
  EXPECT_EQ(take(status(0)), "stop absence ");
  EXPECT_EQ(told(), "node 1 has lost the synchronisation of its clock\n");
  EXPECT_EQ(take(status(0), true), "") << "all stop already";
  EXPECT_EQ(told(), "");
}

TEST_F(NodeWatchTest, PathTimeAtRestIsTheSameEverywhere) {
  StreamStatus other = status();
  other.path_units += 3;
  EXPECT_EQ(take(other), "stop fault ");
  EXPECT_EQ(told(), "node 1 rests at another path time than the gateway: 48 us apart\n");
  EXPECT_TRUE(watch.needs_bring_up());
  rate.request(1, 2ms, now);
  now += 200ms;
  StreamStatus moving = status();
  moving.path_units += 3;
  EXPECT_EQ(take(moving), "") << "in motion nobody is at the same moment";
  rate.request(0, 2ms, now);
  now += 7ms;
  while (!rate.at_rest(now)) now += 1ms;
  StreamStatus just_rests = status();
  just_rests.path_units -= 3;
  EXPECT_EQ(take(just_rests), "") << "said before it came to rest";
  now += 50ms;
  EXPECT_EQ(take(just_rests), "stop fault ");
}

TEST_F(NodeWatchTest, FramesInAnotherOrderAreToldOnce) {
  EXPECT_EQ(take(status(StreamStatus::kSynchronised | StreamStatus::kReordered)), "");
  EXPECT_EQ(told().find("frames reach node 1 in another order than they were sent"), 0U);
  EXPECT_EQ(take(status(StreamStatus::kSynchronised | StreamStatus::kReordered)), "");
  EXPECT_EQ(told(), "");
}

TEST_F(NodeWatchTest, WhatIsWrongWithAStreamIsCountedAsWhatItIs) {
  const auto counted = [&] {
    return std::to_string(counters.sequence_errors) + std::to_string(counters.checkpoint_errors) +
           std::to_string(counters.underruns);
  };
  EXPECT_EQ(take(status(StreamStatus::kSynchronised | StreamStatus::kSequenceError)), "stop stream ");
  EXPECT_EQ(counted(), "100");
  EXPECT_NE(told(), "");
  EXPECT_EQ(take(status(StreamStatus::kSynchronised | StreamStatus::kCheckpointError)), "stop stream ");
  EXPECT_EQ(counted(), "110");
  EXPECT_EQ(take(status(StreamStatus::kSynchronised | StreamStatus::kUnderrun)), "stop absence stream ");
  EXPECT_EQ(counted(), "111");
  told();
  EXPECT_EQ(take(status(StreamStatus::kSynchronised | StreamStatus::kUnderrun), true), "stream ")
      << "in a stop it is noted alone";
  EXPECT_EQ(counted(), "111");
  EXPECT_EQ(told(), "");
}

}  // namespace
}  // namespace kinebus
