// What nodes say, or do not say any more, in each state; and what of the machine is counted and noted.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <variant>

#include "gateway/jobs/journal/journal_record.hpp"
#include "gateway/machine/tests/hand_rig.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class Watched : public HandRig {
 protected:
  void hears(const char* text) { rig.gateway->on_frame(rig.now, *parse_frame(text)); }
  ::testing::AssertionResult up_again() {
    if (!rig.reach(MachineState::kAlarm, 2s) || !asks(command::Clear{}))
      return ::testing::AssertionFailure() << rig.story();
    rig.run_for(3s);
    if (state() == MachineState::kOff && !asks(command::BringUp{}))
      return ::testing::AssertionFailure() << rig.story();
    if (!rig.run_until([&] { return state() != MachineState::kBringUp; }, 30s))
      return ::testing::AssertionFailure() << rig.story();
    if (asks(command::Cancel{})) rig.run_for(1s);
    if (state() != MachineState::kReady && state() != MachineState::kUnhomed)
      return ::testing::AssertionFailure() << rig.story();
    return ::testing::AssertionSuccess();
  }
};

constexpr const char* kOff = "182#50023716070700";     // axis 1 of node 2 is switched off
constexpr const char* kOther = "182#37163716010700";   // axis 1 in profile position mode
constexpr const char* kMoving = "182#37163712070700";  // axis 2 has not reached its target

TEST_F(Watched, ADriveThatIsSwitchedOffIsAFaultAndItsPositionIsLost) {
  const std::string words =
      "! node 2: the drive of axis 1 was switched off by another device or a fault (statusword 0250h)\n";
  ASSERT_TRUE(ready());
  rig.run_for(1s);
  hears(kOff);
  rig.run_for(20ms);
  EXPECT_EQ(told(), words + "= stopping\n");
  EXPECT_FALSE(status().positions_known);
  ASSERT_TRUE(up_again());
  ASSERT_TRUE(asks(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
  ASSERT_TRUE(runs_to(kLine, 20));
  told();
  hears(kOff);
  rig.run_for(20ms);
  EXPECT_EQ(told(), words + "= stopping\n");
  ASSERT_TRUE(up_again());
}

TEST_F(Watched, ADriveThatIsSwitchedOffIsSeenWhileAllStop) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Stop{}));
  rig.run_for(20ms);
  told();
  hears(kOff);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_EQ(told().find("! node 2: the drive of axis 1 was switched off"), 0U);
}

TEST_F(Watched, AnAxisThatIsNotAtTheGatewaysRecordsIsAFault) {
  ASSERT_TRUE(ready());
  rig.run_for(1s);
  hears(kOther);
  rig.run_for(20ms);
  EXPECT_EQ(told(), "! node 2: axis 1 was set to the mode of operation 1 by another device\n= stopping\n");
  EXPECT_FALSE(status().positions_known) << "until they are read";
  ASSERT_TRUE(up_again());
  told();
  ASSERT_TRUE(runs_to(kLine, 20));
  told();
  hears(kOther);
  rig.run_for(20ms);
  EXPECT_EQ(told(), "! node 2: axis 1 was set to the mode of operation 1 by another device\n= stopping\n");
}

TEST_F(Watched, AnAxisThatMovesAtRestIsAFaultAndInMotionItIsNone) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  told();
  hears(kMoving);
  rig.run_for(20ms);
  EXPECT_EQ(told(), "");
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  told();
  hears(kMoving);
  rig.run_for(20ms);
  EXPECT_EQ(told(), "") << "it was on its way when it was said";
  rig.run_for(1s);
  hears(kMoving);
  rig.run_for(20ms);
  EXPECT_EQ(told(), "! node 2: axis 2 moves, and not by this gateway\n= stopping\n");
}

TEST_F(Watched, SilenceIsNoticedSoonerInMotion) {
  for (const bool moves : {true, false}) {
    ASSERT_TRUE(state() == MachineState::kReady || ready());
    if (moves) {
      ASSERT_TRUE(runs_to(kLine, 20));
    }
    rig.run_for(500ms);
    rig.lose_to_gateway = [](const CanFrame& frame) { return (frame.id & 0x7F) == 2; };
    const BusTime from = rig.now;
    ASSERT_TRUE(rig.run_until([&] { return state() == MachineState::kStopping; }, 10s));
    const double after = to_seconds(rig.now - from);
    const double patience = to_seconds(BusTime{rig.machine.bus.heartbeat_timeout});
    EXPECT_LT(after, moves ? 0.3 : patience + 0.1);
    EXPECT_GT(after, moves ? 0.1 : patience - 0.6);
    rig.lose_to_gateway = {};
    ASSERT_TRUE(up_again());
  }
}

TEST_F(Watched, ARecordThatIsLostIsCountedAsWhatItIs) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  bool lost = false;
  rig.lose_from_gateway = [&](const CanFrame& frame) {
    return frame.id == cob_id::rpdo(3, 2) && !std::exchange(lost, true);
  };
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s));
  const MachineCounters c = status().counters;
  EXPECT_EQ(c.checkpoint_errors, 0U);
  EXPECT_EQ(c.underruns, 0U);
  EXPECT_FALSE(status().positions_known);
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s));
  EXPECT_TRUE(status().positions_known);
  EXPECT_TRUE(status().interrupted);
}

TEST_F(Watched, ANodeThatExpectsARecordThatWasNeverSentStopsAllAndIsCountedAsNothingElse) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  told();
  CanFrame frame{.id = cob_id::tpdo(2, 2), .length = 8};
  StreamStatus status_of_another{.next_sequence = 100, .flags = StreamStatus::kSynchronised};
  put_u64_le(frame.data, encode(status_of_another));
  rig.gateway->on_frame(rig.now, frame);
  const MachineCounters c = status().counters;
  EXPECT_EQ(told(), "! the node expects a record that was never sent (record): 100, node 2\n= stopping\n");
  EXPECT_EQ(c.sequence_errors, 0U) << "it counts those that were lost";
  EXPECT_EQ(c.checkpoint_errors, 0U);
  EXPECT_EQ(c.underruns, 0U);
  EXPECT_EQ(state(), MachineState::kStopping);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s)) << "no fault of the machine's own";
  EXPECT_FALSE(status().positions_known);
}

TEST_F(Watched, FramesThatNobodyUsesAreToldOnceUntilTheNextBringUp) {
  ASSERT_TRUE(ready());
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 5000; ++i) hears("1AC#0102");
    hears("702#R");
    const std::string text = told();
    EXPECT_NE(text.find("- another device fills the bus with frames that nobody here uses (COB-ID 1ACh)\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("- another device sends remote frames"), std::string::npos) << text;
    for (int i = 0; i < 5000; ++i) hears("1AC#0102");
    hears("702#R");
    EXPECT_EQ(told(), "");
    rig.run_for(3s);
    ASSERT_TRUE(asks(command::MotorsOff{}));
    ASSERT_TRUE(asks(command::BringUp{}));
    ASSERT_TRUE(rig.run_until([&] { return state() != MachineState::kBringUp; }, 30s));
    told();
  }
}

TEST_F(Watched, TheJournalHasAJobsBeginningHeatPlaceAndEnd) {
  use(rig.machine, {.journal = true});
  struct Noted {
    int begun = 0, heat = 0, places = 0, times = 0, ends = 0, overrides = 0, heights = 0;
    double bed = 0;
  } noted;
  std::uint64_t stored = 0;
  const auto store = [&] {
    while (const auto record = rig.gateway->next_journal_record()) {
      ++stored;
      noted.begun += std::holds_alternative<journal::JobBegin>(*record) ? 1 : 0;
      noted.places += std::holds_alternative<journal::Progress>(*record) ? 1 : 0;
      noted.times += std::holds_alternative<journal::JobTime>(*record) ? 1 : 0;
      noted.heights += std::holds_alternative<journal::Printed>(*record) ? 1 : 0;
      noted.ends += std::holds_alternative<journal::JobEnd>(*record) ? 1 : 0;
      noted.overrides += std::holds_alternative<journal::Override>(*record) ? 1 : 0;
      if (const auto* heat = std::get_if<journal::Heat>(&*record)) {
        ++noted.heat;
        noted.bed = heat->heater(kFirstBed);
      }
    }
    rig.gateway->on_journal_stored(stored);
  };
  const auto runs_and_stores = [&](BusTime duration) {
    for (const BusTime until = rig.now + duration; rig.now < until; rig.run_for(10ms)) store();
    store();
  };
  ASSERT_TRUE(ready());
  store();
  ASSERT_TRUE(asks(command::SetFeedOverride{0.9}));
  store();
  EXPECT_EQ(noted.overrides, 0) << "of no job";
  ASSERT_TRUE(runs("M140 S60\nG1 X60 F1200\nG1 X0\n"));
  while (x() < 20 && rig.now < 60s) runs_and_stores(10ms);
  EXPECT_EQ(noted.begun, 1);
  EXPECT_EQ(noted.overrides, 1);
  EXPECT_EQ(noted.bed, 60);
  const Noted then = noted;
  runs_and_stores(2s);
  EXPECT_NEAR(noted.places - then.places, 8, 1) << "four a second";
  EXPECT_EQ(noted.times - then.times, noted.places - then.places);
  EXPECT_EQ(noted.heat, then.heat) << "nothing has changed";
  ASSERT_TRUE(asks(command::SetFeedOverride{0.8}));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 70}));
  runs_and_stores(20ms);
  EXPECT_EQ(noted.overrides, 2);
  EXPECT_EQ(noted.bed, 70);
  ASSERT_TRUE(asks(command::Hold{}));
  runs_and_stores(1s);
  const Noted held = noted;
  runs_and_stores(2s);
  EXPECT_EQ(noted.places, held.places) << "nothing moves";
  EXPECT_EQ(noted.ends, 0);
  ASSERT_TRUE(asks(command::Resume{}));
  runs_and_stores(500ms);
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 0}));
  runs_and_stores(20ms);
  ASSERT_TRUE(asks(command::Stop{}));
  runs_and_stores(1s);
  ASSERT_TRUE(asks(command::Clear{}));
  runs_and_stores(1s);
  ASSERT_EQ(state(), MachineState::kHeld);
  const Noted stopped = noted;
  ASSERT_TRUE(asks(command::Resume{}));
  runs_and_stores(1s);
  EXPECT_GT(noted.places, stopped.places + 2) << "after a stop as before it";
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 50}));
  runs_and_stores(20ms);
  EXPECT_EQ(noted.bed, 50);
  runs_and_stores(10s);
  EXPECT_EQ(state(), MachineState::kReady);
  EXPECT_EQ(noted.ends, 1);
  EXPECT_EQ(noted.begun, 1);
  EXPECT_LE(noted.heights, 1) << "nothing was printed";
}

TEST_F(Watched, AHeaterThatBreaksWhileAnInterruptedJobIsHomedForIsHotAgainWhenItGoesOn) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M104 S200\nM140 S60\n" + kLine, 20));
  rig.gateway->on_frame(rig.now, *parse_frame("703#00"));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  ASSERT_TRUE(asks(command::Clear{}));
  rig.nodes.send(rig.now, *parse_frame("000#8100"));
  rig.run_for(1s);
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kHoming, 30s)) << rig.story();
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  rig.run_for(500ms);
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s)) << rig.story();
  EXPECT_TRUE(status().interrupted);
  EXPECT_EQ(hand.bed.target, 60);
  hand.hotend.broken = false;
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return !status().interrupted && x() > 30; }, 60s)) << rig.story();
  EXPECT_EQ(hand.hotend.target, 200);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
}

TEST_F(Watched, ASessionVouchesForWhatIsSent) {
  MachineDescription machine = rig.machine;
  machine.bus.trust = BusTrust::kSession;
  use(machine, {.bus_secret = {.low = 5, .high = 7}});
  int vouchers = 0, records = 0;
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    vouchers += frame.id == 0x3FF ? 1 : 0;
    records += frame.id > 0x400 && frame.id <= 0x403 ? 1 : 0;
  };
  ASSERT_TRUE(ready());
  vouchers = records = 0;
  ASSERT_TRUE(rig.run_job("G1 X10 F1200\n"));
  EXPECT_GT(records, 20);
  EXPECT_GE(vouchers, records);
}

TEST_F(Watched, NobodyIsAskedForCurrentsOfMotorsThatAreOffOrHome) {
  ASSERT_TRUE(ready());
  int asked = 0;
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    asked += frame.id > 0x600 && frame.id <= 0x603 ? 1 : 0;
  };
  const auto asks_for_currents = [&](BusTime duration) {
    asked = 0;
    for (const BusTime until = rig.now + duration; rig.now < until; rig.run_for(100ms))
      rig.gateway->watch_currents();
    return asked > 0;
  };
  EXPECT_TRUE(asks_for_currents(1s));
  ASSERT_TRUE(asks(command::MotorsOff{}));
  EXPECT_FALSE(asks_for_currents(1s));
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_FALSE(asks_for_currents(1s));
}

}  // namespace
}  // namespace kinebus
