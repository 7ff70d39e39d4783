// A job that is set aside or left alone: where the tool goes, what stays hot, and how it goes on.

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "gateway/machine/tests/held_rig.hpp"
#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class SetAside : public HeldRig {};

TEST_F(SetAside, OneThatIsSetAsideParksAndIsTheOperators) {
  ASSERT_TRUE(ready());
  EXPECT_EQ(why_not(command::StepAside{}), "cannot set the job aside while the machine is ready");
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  const double on_part = z(), at_x = x();
  told();
  ASSERT_TRUE(asks(command::StepAside{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
  EXPECT_EQ(
      told(),
      "= holding\n- the job is set aside: jog, heat and extrude, then resume goes on with it\n= ready\n");
  EXPECT_NEAR(x(), -40, 5e-3);
  EXPECT_NEAR(status().machine_pose[kY], 30, 5e-3);
  EXPECT_NEAR(z(), on_part + 12, 5e-3);
  EXPECT_EQ(hand.spindle_rpm, 0);
  EXPECT_EQ(hand.hotend.target, 200);
  EXPECT_TRUE(status().interrupted);
  ASSERT_TRUE(asks(command::Jog{.delta = {10, 0, 0, 0, 0, 0}, .speed_per_s = 50}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_EQ(status().job, "part") << "a jog forgets it not";
  told();
  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(state(), MachineState::kRunning);
  EXPECT_FALSE(status().interrupted);
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 2s));
  EXPECT_EQ(why_not(command::StepAside{}), "the tool is on its way: resume or cancel first");
  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(state(), MachineState::kRunning);
  ASSERT_TRUE(rig.run_until([&] { return !status().interrupted && x() > at_x + 1; }, 60s));
  EXPECT_NEAR(z(), on_part, 5e-3);
  EXPECT_EQ(hand.spindle_rpm, 5000);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(SetAside, M600SetsItAsideUnloadedAndM0HoldsIt) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs("M104 S200\nG1 X20 E6 F1200\nM600\nG1 X30 E8\nM0\nG1 X0 E9\n"));
  ASSERT_TRUE(
      rig.run_until([&] { return status().filament_change && state() == MachineState::kReady; }, 30s));
  EXPECT_NE(told().find("- change the filament: load, purge, then resume goes on with the job\n= ready\n"),
            std::string::npos);
  EXPECT_TRUE(status().filament_change);
  EXPECT_NEAR(status().machine_pose[kE], 6 - 7, 0.01);
  using What = command::MoveFilament::What;
  for (const auto& [what, e_mm, seconds] :
       {std::tuple{What::kLoad, -1 + 5., 5 / 5.}, std::tuple{What::kPurge, 4 + 20., 20 / 2.5},
        std::tuple{What::kUnload, 24 - 7., 7 / 20.}}) {
    const BusTime from = rig.now;
    ASSERT_TRUE(asks(command::MoveFilament{what}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
    EXPECT_NEAR(status().machine_pose[kE], e_mm, 0.01);
    EXPECT_NEAR(to_seconds(rig.now - from), seconds, 0.6);
  }
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 30s));
  EXPECT_FALSE(status().filament_change);
  EXPECT_NEAR(x(), 30, 2e-3);
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(SetAside, FilamentIsMovedHotAndByWhatTheFileSays) {
  ASSERT_TRUE(ready());
  EXPECT_EQ(why_not(command::MoveFilament{}), "the hotend is too cold to feed filament: 20 C");
  MachineDescription machine = that_parks();
  machine.pause.load_mm = machine.pause.unload_mm = machine.pause.purge_mm = 0;
  use(machine);
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 200}));
  using What = command::MoveFilament::What;
  EXPECT_EQ(why_not(command::MoveFilament{What::kLoad}), "pause.load_mm is 0 in the machine file");
  EXPECT_EQ(why_not(command::MoveFilament{What::kUnload}), "pause.unload_mm is 0 in the machine file");
  EXPECT_EQ(why_not(command::MoveFilament{What::kPurge}), "pause.purge_mm is 0 in the machine file");
}

TEST_F(SetAside, AHotEndThatWaitsForLongStandsByAndTheJobIsSetAside) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  const double on_part = z();
  rig.run_for(19s);
  EXPECT_EQ(state(), MachineState::kHeld);
  EXPECT_EQ(hand.hotend.target, 200);
  rig.run_for(8s);
  EXPECT_EQ(state(), MachineState::kReady);
  EXPECT_EQ(hand.hotend.target, 120);
  EXPECT_EQ(hand.bed.target, 60);
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 190}));
  rig.run_for(19s);
  EXPECT_EQ(hand.hotend.target, 190) << "who wants it hot has it hot, as long again";
  rig.run_for(2s);
  EXPECT_EQ(hand.hotend.target, 120);
  ASSERT_TRUE(goes_on_to_the_end(on_part));
  EXPECT_EQ(hand.hotend.target, 190);
}

TEST_F(SetAside, NothingIsLeftHotForLong) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  rig.run_for(119s);
  EXPECT_EQ(hand.bed.target, 60);
  ASSERT_TRUE(asks(command::Jog{.delta = {10, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  told();
  rig.run_for(119s);
  EXPECT_EQ(hand.bed.target, 60) << "it has moved meanwhile";
  rig.run_for(2s);
  EXPECT_EQ(hand.bed.target, 0);
  EXPECT_EQ(told(), "- the heaters are off: nothing has moved for 2 minutes\n");
  EXPECT_EQ(state(), MachineState::kReady);
}

TEST_F(SetAside, AHeldJobIsStoppedWithItsHeatAndHeatsBeforeItGoesOn) {
  MachineDescription machine = that_parks();
  machine.pause.standby_c = 0;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  const double on_part = z();
  rig.run_for(118s);
  EXPECT_EQ(hand.bed.target, 60);
  told();
  rig.run_for(4s);
  EXPECT_EQ(hand.bed.target, 0);
  EXPECT_EQ(told(), "- the heaters are off: nothing has moved for 2 minutes\n= stopping\n= stopped\n");
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s));
  ASSERT_TRUE(goes_on_to_the_end(on_part));
  EXPECT_EQ(hand.bed.target, 60);
}

TEST_F(SetAside, AChangeOfFilamentThatWasStoppedIsStillOne) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs("M104 S200\nG1 X20 E6 F1200\nM600\nG1 X0 E9\n"));
  ASSERT_TRUE(rig.run_until([&] { return status().filament_change && z() > 21; }, 30s));
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s));
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 200}));
  told();
  ASSERT_TRUE(asks(command::StepAside{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
  EXPECT_EQ(told(),
            "= holding\n- change the filament: load, purge, then resume goes on with the job\n= ready\n");
}

TEST_F(SetAside, OneIsParkedWithoutALiftAndLiftedWithoutAPark) {
  for (const bool parks : {true, false}) {
    SCOPED_TRACE(parks);
    MachineDescription machine = that_parks();
    machine.pause.park = parks;
    if (parks) machine.pause.lift_mm = 0;
    use(machine);
    ASSERT_TRUE(asks(command::BringUp{}));
    ASSERT_TRUE(rig.run_until([&] { return state() != MachineState::kBringUp; }, 30s));
    if (state() == MachineState::kUnhomed) {
      ASSERT_TRUE(asks(command::Home{}));
    }
    ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
    ASSERT_TRUE(prints_to(20));
    ASSERT_TRUE(asks(command::Hold{}));
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
    const Pose on_part = status().machine_pose;
    ASSERT_TRUE(asks(command::StepAside{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
    EXPECT_NEAR(x(), parks ? -40 : on_part[kX], 5e-3);
    EXPECT_NEAR(z(), on_part[kZ] + (parks ? 0 : 12), 5e-3);
    ASSERT_TRUE(goes_on_to_the_end(on_part[kZ]));
  }
}

TEST_F(SetAside, WhereItCannotBeParkedItIsSaidAndTheToolIsLiftedAlone) {
  MachineDescription machine = that_parks();
  machine.pause.park_x_mm = 1000;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  const Pose on_part = status().machine_pose;
  told();
  ASSERT_TRUE(asks(command::StepAside{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
  EXPECT_EQ(told().find("= holding\n- the tool is not parked: X is "), 0U);
  EXPECT_NEAR(x(), on_part[kX], 5e-3);
  EXPECT_NEAR(z(), on_part[kZ] + 12, 5e-3);
}

TEST_F(SetAside, OneThatAStopInterruptedStandsByToo) {
  MachineDescription machine = that_parks();
  machine.thermal.on_stop = ThermalDescription::After::kKeep;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M104 S200\nM140 S60\nG1 X60 E6 F1200\nG1 X0 E12\n", 20));
  const double on_part = z();
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  hand.hotend.target = hand.hotend.actual = 200;
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  EXPECT_TRUE(status().interrupted);
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 200}));
  rig.run_for(19s);
  EXPECT_EQ(hand.hotend.target, 200);
  rig.run_for(2s);
  EXPECT_EQ(hand.hotend.target, 120);
  EXPECT_EQ(state(), MachineState::kReady);
  ASSERT_TRUE(goes_on_to_the_end(on_part));
  EXPECT_EQ(hand.hotend.target, 200);
}

TEST_F(SetAside, AHotEndStandsByInPlaceWhereTheRunIsGoneAndItsHeatWasLeft) {
  MachineDescription machine = that_parks();
  machine.thermal.on_stop = ThermalDescription::After::kKeep;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M104 S200\nM140 S60\nG1 X60 E6 F1200\nG1 X0 E12\n", 20));
  const double on_part = z();
  rig.gateway->on_frame(rig.now, *parse_frame("402#4001000000000000"));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  EXPECT_EQ(hand.hotend.target, 200);
  ASSERT_TRUE(asks(command::MotorsOff{}));
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  EXPECT_EQ(hand.hotend.target, 200);
  rig.run_for(22s);
  EXPECT_EQ(hand.hotend.target, 120);
  ASSERT_TRUE(goes_on_to_the_end(on_part));
  EXPECT_EQ(hand.hotend.target, 200) << "what the job wants";
}

TEST_F(SetAside, AHeaterThatBreaksOnTheWayBackHoldsItThereAndItGoesOnWhenThatIsMended) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  const double on_part = z();
  ASSERT_TRUE(asks(command::StepAside{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return x() > -20; }, 20s));
  told();
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 10s));
  EXPECT_EQ(told().find("! heater.hotend: the sensor is open\n= holding\n- the job is held at X"), 0U);
  EXPECT_TRUE(rests());
  EXPECT_LT(x(), 19) << "where it was on its way";
  EXPECT_TRUE(status().interrupted);
  hand.hotend.broken = false;
  ASSERT_TRUE(goes_on_to_the_end(on_part)) << told_until_now;
}

TEST_F(SetAside, AHeaterThatBreaksOnTheWayToAJobsBeginningIsAnAlarm) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {50, 0, 0, 0, 0, 0}, .speed_per_s = 100}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  ASSERT_TRUE(runs("G1 X-20 F1200\n"));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 2s));
  rig.run_for(50ms);
  hand.filament = FilamentCondition::kOut;
  rig.run_for(50ms);
  EXPECT_EQ(state(), MachineState::kRunning) << "nothing is fed yet";
  hand.filament = FilamentCondition::kInOrder;
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_FALSE(status().interrupted);
}

TEST_F(SetAside, FilamentThatNobodyHasMovedIsNotPrimed) {
  MachineDescription machine = that_parks();
  machine.resume.prime_mm = 2;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(prints_to(20));
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  const double e_mm = status().joints[5];
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s));
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return !status().interrupted; }, 30s));
  EXPECT_NEAR(status().joints[5], e_mm, 0.02);
}

TEST_F(SetAside, AMachineWithoutAHotEndMovesNoFilament) {
  MachineDescription machine = that_parks();
  machine.heaters.clear();
  use(machine);
  ASSERT_TRUE(ready());
  EXPECT_EQ(why_not(command::MoveFilament{}), "nothing here feeds filament");
}

}  // namespace
}  // namespace kinebus
