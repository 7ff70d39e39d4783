// What holds a job that could go on: heat, filament, a spindle, its host; and how it goes on.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/held_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class HeldJobs : public HeldRig {};

TEST_F(HeldJobs, AHeaterThatBreaksHoldsItOffThePartUntilThatIsMended) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  const double on_part = z();
  told();
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.run_until([&] { return state() == MachineState::kHolding; }, 1s));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s));
  const double held_x = x();
  EXPECT_NEAR(z(), on_part + 5, 5e-3) << "thermal.lift_mm";
  EXPECT_EQ(hand.bed.target, 60) << "the bed keeps the part";
  EXPECT_EQ(hand.spindle_rpm, 0);
  EXPECT_EQ(status().doing.english(), "heater.hotend: the sensor is open");
  EXPECT_TRUE(status().interrupted);
  EXPECT_TRUE(rests());
  const std::string text = told();
  EXPECT_EQ(text.find("! heater.hotend: the sensor is open\n= holding\n- the job is held at X"), 0U) << text;
  EXPECT_NE(text.find(": mend what is wrong, then resume heats and goes on\n= held\n"), std::string::npos)
      << text;

  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(state(), MachineState::kHeld);
  rig.run_for(3s);
  EXPECT_EQ(told(), "") << "its node is given time to say so";
  rig.run_for(1s);
  EXPECT_EQ(told(), "! heater.hotend: the sensor is open\n");
  EXPECT_EQ(state(), MachineState::kHeld);
  EXPECT_NEAR(z(), on_part + 5, 5e-3);

  hand.hotend.broken = false;
  ASSERT_TRUE(goes_on_to_the_end(on_part));
  EXPECT_GT(held_x, 20);
  EXPECT_EQ(hand.hotend.target, 200);
}

TEST_F(HeldJobs, OneThatBreaksInAHoldOrOnTheWayAsideHoldsItThere) {
  for (const bool aside : {false, true}) {
    SCOPED_TRACE(aside);
    ASSERT_TRUE(state() == MachineState::kReady || ready());
    ASSERT_TRUE(prints_to(20));
    ASSERT_TRUE(asks(command::Hold{}));
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
    const double on_part = z();
    if (aside) {
      ASSERT_TRUE(asks(command::StepAside{}));
      rig.run_for(500ms);
    }
    told();
    hand.hotend.broken = true;
    ASSERT_TRUE(rig.run_until([&] { return state() != MachineState::kHeld; }, aside ? 0s : 1s));
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s));
    EXPECT_EQ(told().find("! heater.hotend: the sensor is open\n"), 0U);
    EXPECT_GT(z(), on_part + 4.9);
    hand.hotend.broken = false;
    ASSERT_TRUE(goes_on_to_the_end(on_part)) << told_until_now;
  }
}

TEST_F(HeldJobs, ACancelWhileItIsHeldEndsItAndNothingHasToBeCleared) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s));
  ASSERT_TRUE(asks(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_FALSE(status().interrupted);
  EXPECT_EQ(status().job, "");
  EXPECT_NE(status().doing.english(), "heater.hotend: the sensor is open");
  hand.hotend.broken = false;
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
}

TEST_F(HeldJobs, AHeaterThatBreaksWithoutAJobIsAnAlarmAndABedThatIsInOrderKeepsItsHeat) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_EQ(told(), "! heater.hotend: the sensor is open\n= stopping\n= alarm\n");
  EXPECT_EQ(hand.bed.target, 60);
  hand.hotend.broken = false;
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  hand.bed.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
}

TEST_F(HeldJobs, AHeaterThatBreaksWhileOffOrHomingStopsNothing) {
  hand.hotend.broken = true;
  rig.run_for(1s);
  EXPECT_EQ(state(), MachineState::kOff);
  EXPECT_EQ(told(), "! heater.hotend: the sensor is open\n");
  hand.hotend = {};
  rig.run_for(1s);
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 180}));
  ASSERT_TRUE(asks(command::Home{}));
  rig.run_for(500ms);
  told();
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
  EXPECT_EQ(told(), "! heater.hotend: the sensor is open\n. homed\n= ready\n");
  EXPECT_EQ(hand.bed.target, 60);
}

TEST_F(HeldJobs, FilamentThatEndsHoldsItWithItsHeat) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  const double on_part = z();
  told();
  hand.filament = FilamentCondition::kOut;
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s));
  EXPECT_EQ(told().find("! filament_sensor.spool: there is no filament any more\n= holding\n"), 0U);
  EXPECT_EQ(hand.hotend.target, 200);
  EXPECT_NEAR(z(), on_part + 5, 5e-3);
  ASSERT_TRUE(asks(command::Resume{}));
  rig.run_for(4s);
  EXPECT_EQ(told(), "! filament_sensor.spool: there is no filament any more\n");
  hand.filament = FilamentCondition::kInOrder;
  ASSERT_TRUE(goes_on_to_the_end(on_part));
}

TEST_F(HeldJobs, FilamentThatEndsWithoutOneOrWhileItIsHeldStopsNothing) {
  ASSERT_TRUE(ready());
  hand.filament = FilamentCondition::kOut;
  rig.run_for(1s);
  ASSERT_TRUE(asks(command::Jog{.delta = {10, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_EQ(told(), "= moving\n. move done\n= ready\n");
  hand.filament = FilamentCondition::kInOrder;
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  told();
  hand.filament = FilamentCondition::kOut;
  rig.run_for(2s);
  EXPECT_EQ(told(), "");
}

TEST_F(HeldJobs, AHotEndThatIsTurnedDownIsNotFedThrough) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  EXPECT_EQ(why_not(command::SetTemperature{kFirstHotend, 150}),
            "the job feeds filament, which needs at least 170 C: hold it first");
  EXPECT_EQ(why_not(command::SetTemperature{kFirstHotend, 170}), "");
  EXPECT_EQ(why_not(command::SetTemperature{kFirstBed, 30}), "");
  const double on_part = z();
  told();
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 0})) << "off is off at any time";
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s));
  EXPECT_EQ(told().find("! heater.hotend: it is set to 0 C and filament is to be fed: at least 170 C is "
                        "needed\n= holding\n"),
            0U);
  const std::string refused = why_not(command::Resume{});
  EXPECT_EQ(refused, "the hotend is set to 0 C: set it to at least 170 C, then resume");
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(goes_on_to_the_end(on_part));
}

TEST_F(HeldJobs, AMoveByHandThatFeedsColdIsEnded) {
  ASSERT_TRUE(ready());
  EXPECT_EQ(why_not(command::Jog{.delta = {0, 0, 0, 0, 0, 5}}),
            "the hotend is too cold to feed filament: 20 C");
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(asks(command::Jog{.delta = {0, 0, 0, 0, 0, 50}, .speed_per_s = 5}));
  rig.run_for(1s);
  const double before = status().machine_pose[kE];
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 0}));
  told();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_EQ(told(),
            "- heater.hotend: it is set to 0 C and filament is to be fed: at least 170 C is needed\n"
            "= cancelling\n- cancelled: positions are known\n= ready\n");
  EXPECT_LT(status().machine_pose[kE], before + 3);
  ASSERT_TRUE(asks(command::Jog{.delta = {0, 0, 0, 0, 0, -5}})) << "backwards is no feed";
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
}

TEST_F(HeldJobs, TheSpindleTurnsAgainBeforeAHeldJobGoesOn) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M3 S5000\n" + kLine, 20));
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  EXPECT_EQ(hand.spindle_rpm, 0);
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s));
  const double at = x();
  hand.spindle_lags = true;
  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(hand.spindle_rpm, 5000);
  rig.run_for(2s);
  EXPECT_EQ(state(), MachineState::kHeld);
  EXPECT_NEAR(x(), at, 1e-3) << "nothing cuts with a spindle that stands";
  hand.spindle_lags = false;
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 1s));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_EQ(hand.spindle_rpm, 0);
}

TEST_F(HeldJobs, ASpindleThatWasAskedForInAnEarlierHoldLetsNothingGo) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M3 S5000\n" + kLine, 20));
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(asks(command::Stop{}));
    ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
    ASSERT_TRUE(asks(command::Clear{}));
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s));
    hand.spindle_lags = true;
    if (i == 0) {
      ASSERT_TRUE(asks(command::Resume{}));
    }
    rig.run_for(500ms);
  }
  hand.spindle_lags = false;
  rig.run_for(2s);
  EXPECT_EQ(state(), MachineState::kHeld);
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
}

TEST_F(HeldJobs, ADeviceThatIsStillBrokenKeepsAnInterruptedJobFromGoingOn) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  ASSERT_TRUE(asks(command::Clear{}));
  hand.hotend.broken = true;
  rig.run_for(200ms);
  told();
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  rig.run_for(2s);
  EXPECT_EQ(told(),
            "= bring-up\n= ready\n"
            ". the job does not go on: heater.hotend: the sensor is open -> put right what is said, then "
            "resume\n");
  EXPECT_EQ(state(), MachineState::kReady);
  EXPECT_TRUE(status().interrupted);
  hand.hotend.broken = false;
  ASSERT_TRUE(asks(command::Resume{})) << "and that clears it";
  ASSERT_TRUE(rig.run_until([&] { return !status().interrupted && x() > 25; }, 60s));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(HeldJobs, AHostMayEndAWaitForHeatAndItsLinesGoOn) {
  ASSERT_TRUE(ready());
  hand.hotend.lags = true;
  ASSERT_TRUE(asks(command::OpenLines{"host"}));
  ASSERT_TRUE(rig.gateway->take_line("M109 S200", 1));
  ASSERT_TRUE(rig.gateway->take_line("G1 X10 F3000", 2));
  rig.run_for(5s);
  EXPECT_NEAR(x(), 0, 2e-3);
  EXPECT_FALSE(rig.gateway->lines_idle());
  rig.gateway->skip_heating();
  rig.run_for(2s);
  EXPECT_NEAR(x(), 10, 2e-3);
  EXPECT_TRUE(rig.gateway->lines_idle());
  EXPECT_EQ(rig.gateway->line_room(), Gateway::kLineRoom);
}

TEST_F(HeldJobs, LinesOfAHostAreHeldAndGivenUpWithIt) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::OpenLines{"host"}));
  EXPECT_EQ(state(), MachineState::kRunning);
  ASSERT_TRUE(rig.gateway->take_line("G1 X60 F1200", 1));
  ASSERT_TRUE(rig.run_until([&] { return x() > 20; }, 10s));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  EXPECT_EQ(why_not(command::StepAside{}), "no job is held that could be set aside");
  ASSERT_TRUE(asks(command::Resume{}));
  told();
  rig.gateway->leave_lines();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
  const std::string text = told();
  EXPECT_TRUE(text ==
                  "- the lines' host has gone: what is left of them is given up\n= cancelling\n"
                  "- cancelled: positions are known\n= ready\n" ||
              text == ". all lines done: host\n= ready\n")
      << text;
  ASSERT_TRUE(asks(command::OpenLines{"host"}));
  ASSERT_TRUE(rig.gateway->take_line("G1 X0", 2));
  rig.gateway->close_lines();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
  EXPECT_EQ(told(), "= running\n. all lines done: host\n= ready\n");
}

TEST_F(HeldJobs, WhatIsMendedIsNotTheReasonOfTheNextHold) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s));
  hand.hotend.broken = false;
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return !status().interrupted && x() > 30; }, 60s));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s));
  EXPECT_EQ(status().doing.english().find("heater"), std::string::npos);
  told();
  ASSERT_TRUE(asks(command::Resume{}));
  rig.run_for(100ms);
  EXPECT_EQ(told(), "= running\n");
}

TEST_F(HeldJobs, AHeaterIsMeasuredByWhoeverNamesIt) {
  ASSERT_TRUE(ready());
  const auto why = [&](const char* line) {
    const auto reply = rig.gateway->text_line(line);
    return reply ? std::string() : reply.error().words.english().substr(0, 15);
  };
  for (const char* line :
       {"M303 S200", "M303 E0 S200", "M303 H1 S200", "M303 T0 S200", "M303 P0 S200", "M303 H S200"})
    EXPECT_EQ(why(line), "heater.hotend: ") << line;
  for (const char* line : {"M303 E-1 S60", "M303 H0 S60"}) EXPECT_EQ(why(line), "heater.bed: it ") << line;
  for (const char* line : {"M303 E-2 S60", "M303 E1 S60", "M303 E254 S60"})
    EXPECT_EQ(why(line), "this machine ha") << line;
  for (const char* line : {"M303 E0.5", "M303 E-3", "M303 E255"})
    EXPECT_EQ(why(line), "M303 names a he") << line;
}

}  // namespace
}  // namespace kinebus
