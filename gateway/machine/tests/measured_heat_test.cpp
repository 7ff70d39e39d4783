// A heater that is measured, from outside: what it waits for, what is told, what ends it.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/hand_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class MeasuredHeat : public HandRig {
 protected:
  MeasuredHeat() {
    rig.machine.thermal.idle_off = 20s;
    use(rig.machine);
    hand.hotend.tuning = HeaterTuning{};
    hand.bed.tuning = HeaterTuning{};
  }
  std::string tells(HeaterTuning tuning, Hand::OfHeater& heater) {
    heater.tuning = tuning;
    rig.run_for(200ms);
    const std::string first = told();
    rig.run_for(1s);
    EXPECT_EQ(told(), "") << "once";
    return first;
  }
};

TEST_F(MeasuredHeat, EachStageIsToldInWords) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::TuneHeater{kFirstHotend, 210}));
  EXPECT_EQ(tells({TuningStage::kBegins, 210, {}, {}}, hand.hotend), "");
  EXPECT_EQ(tells({TuningStage::kHeats, 210, {}, {}}, hand.hotend),
            "- heater.hotend is measured, to be good at 210 C: full power for half of the way\n");
  EXPECT_EQ(tells({TuningStage::kCools, 210, {}, {}}, hand.hotend),
            "- heater.hotend: the power is off, its curve is followed\n");
  EXPECT_EQ(tells({TuningStage::kFits, 0, {}, {}}, hand.hotend), "");
  const HeaterModel model{
      .power_w = 40, .capacity_j_per_k = 12.5, .loss_w_per_k = 0.1234, .lag_s = 2, .dead_s = 1.25};
  EXPECT_EQ(tells({TuningStage::kDone, 210, model, {}}, hand.hotend),
            "- heater.hotend: at 40.0 W it has 12.5 J/K, a dead time of 1.25 s, a lag of 2.00 s, and loses "
            "0.123 W/K\n");
  EXPECT_EQ(tells({TuningStage::kHeats, 0, {}, {}}, hand.hotend), "") << "nobody has asked for that one";

  hand.hotend.tuning = HeaterTuning{};
  ASSERT_TRUE(asks(command::TuneHeater{kFirstBed, 60}));
  const std::string done = tells({TuningStage::kDone, 0, model, say("not kept")}, hand.bed);
  EXPECT_EQ(done.find("- heater.bed: at 40.0 W"), 0U) << done;
  EXPECT_NE(done.find("\n- heater.bed: not kept\n"), std::string::npos) << done;

  hand.bed.tuning = HeaterTuning{};
  ASSERT_TRUE(asks(command::TuneHeater{kFirstBed, 60}));
  EXPECT_EQ(tells({TuningStage::kFailed, 0, {}, say("it does not rise")}, hand.bed),
            "- heater.bed was not measured: it does not rise\n");
  ASSERT_TRUE(asks(command::TuneHeater{kFirstBed, 60}));
  EXPECT_EQ(tells({TuningStage::kFailed, 0, {}, say("it does not rise")}, hand.bed),
            "- heater.bed was not measured: it does not rise\n")
      << "each time";
}

TEST_F(MeasuredHeat, NothingMovesMeanwhileAndAStopEndsItWhateverTheFileSays) {
  rig.machine.thermal.on_stop = ThermalDescription::After::kKeep;
  use(rig.machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::TuneHeater{kFirstHotend, 210}));
  EXPECT_EQ(why_not(command::Jog{}), "cannot jog while heater.hotend is measured: a target of 0 ends that");
  EXPECT_EQ(why_not(command::Home{}), "cannot home while heater.hotend is measured: a target of 0 ends that");
  EXPECT_EQ(why_not(command::SetFan{0.5}), "") << "that moves nothing";
  EXPECT_EQ(why_not(command::TuneHeater{kFirstBed, 60}),
            "cannot measure a heater while heater.hotend is measured: a target of 0 ends that");
  rig.run_for(40s);
  EXPECT_EQ(told(), "") << "it takes its time, and is not idle";
  EXPECT_TRUE(hand.hotend.tuning->runs());
  ASSERT_TRUE(asks(command::Stop{}));
  EXPECT_EQ(told(), "- the heaters are off: stop by command\n- stop by command\n= stopping\n");
}

TEST_F(MeasuredHeat, NotWhileAJobWaits) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  rig.gateway->on_bus_failure(rig.now, "gone");
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  EXPECT_EQ(why_not(command::TuneHeater{kFirstHotend, 210}),
            "an interrupted job waits: cancel it, or resume it, before a heater is measured");
  ASSERT_TRUE(asks(command::Cancel{}));
  EXPECT_EQ(why_not(command::TuneHeater{kFirstHotend, 210}), "");
}

TEST_F(MeasuredHeat, OneThatWasNeverMeasuredIsToldOfEachTimeItIsToHeat) {
  ASSERT_TRUE(ready());
  const std::string words =
      "- heater.bed was never measured: a heater or sensor that has slipped half out of its hole may stay "
      "unseen. Measure it: tune, or M303\n";
  hand.bed.measured = Measured::kNotYet;
  rig.run_for(300ms);
  EXPECT_EQ(told(), "") << "it is off";
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
    rig.run_for(300ms);
    EXPECT_EQ(told(), words);
    ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 0}));
    rig.run_for(300ms);
  }
  hand.bed.measured = Measured::kYes;
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 60}));
  rig.run_for(300ms);
  EXPECT_EQ(told(), "") << "one is measured, of the other nothing is told";
}

TEST_F(MeasuredHeat, WhatIsLeftHotGoesOffWhereverTheMachineRests) {
  rig.machine.thermal.idle_off = 6s;
  use(rig.machine);
  const std::string off = "- the heaters are off: nothing has moved for 0 minutes\n";
  const auto heats = [&] {
    ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
    rig.run_for(5900ms);
    EXPECT_EQ(hand.bed.target, 60);
    told();
    rig.run_for(200ms);
    EXPECT_EQ(hand.bed.target, 0);
    EXPECT_EQ(told(), off);
    rig.run_for(7s);
    EXPECT_EQ(told(), "") << "once";
  };
  heats();  // off
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s));
  heats();
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  heats();
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 2s));
  ASSERT_TRUE(asks(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
  heats();
}

TEST_F(MeasuredHeat, AHostWhoseLinesAreDoneLeavesNothingHotAndOneThatWorksDoes) {
  rig.machine.thermal.idle_off = 3s;
  use(rig.machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::OpenLines{"host"}));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  rig.run_for(2900ms);
  EXPECT_EQ(hand.bed.target, 60);
  rig.run_for(200ms);
  EXPECT_EQ(hand.bed.target, 0);
  ASSERT_TRUE(rig.gateway->take_line("G4 P8000", 1));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  rig.run_for(6s);
  EXPECT_EQ(hand.bed.target, 60);
}

}  // namespace
}  // namespace kinebus
