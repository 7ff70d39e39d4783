// A BLTouch on a printer: its pin is out for the contact and in before anything else moves; and what happens
// when it is not.

#include <gtest/gtest.h>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kTip_mm = 2.6;  // of the pin, out, below the nozzle

MachineDescription with_a_bltouch() {
  MachineDescription machine = printer_on_the_bus();
  machine.probe.present = machine.probe.bltouch = true;
  machine.probe.place = {DevicePlace::Where::kNode, machine.nodes[2].id, 5};
  machine.probe.servo_node = kHeatId;
  machine.probe.offset_mm = {24, -7, -kTip_mm};
  machine.probe.sim_z_mm = 0.15;
  machine.nodes[2].inputs[4].function = InputFunction::kProbe;
  machine.mesh.points_x = 3;
  machine.mesh.points_y = 2;
  machine.mesh.x_mm = {-30, 30};
  machine.mesh.y_mm = {-20, 20};
  return machine;
}

class Bltouch : public HeatPrinter {
 protected:
  Bltouch() : HeatPrinter(with_a_bltouch()) { rig.nodes.set_probe(*virtual_probe_of(rig.machine)); }
  heat::PinProbePlant& pin() { return rig.nodes.heat_plant(kHeat).pin_probe(); }
  /// Until the job is over, and the pin was never out while the tool went aside.
  bool ends(MachineState state, BusTime limit = 600s) {
    return rig.run_until(
        [&] {
          const Pose at = tool();
          const double aside = std::hypot(at[kX] - last_[kX], at[kY] - last_[kY]);
          if (pin().out() && aside > kOnTheLine) went_aside_with_it_out_ = true;
          if (!pin().out() || aside > kOnTheLine) last_ = at;
          return rig.gateway->state() == state;
        },
        limit);
  }
  bool told(const std::string& words) { return rig.story().find(words) != std::string::npos; }
  Pose last_{};
  bool went_aside_with_it_out_ = false;
};

TEST_F(Bltouch, IsOutForTheContactAndInBehindIt) {
  ASSERT_TRUE(begin("G0 X10 Z15\nG38.2 Z1 F300\nG1 X30 F600\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 60s));
  ASSERT_TRUE(ends(MachineState::kReady)) << rig.story();
  EXPECT_TRUE(rig.told(MachineEvent::Kind::kFinished)) << rig.story();
  EXPECT_EQ(pin().deployed(), 1u);
  EXPECT_FALSE(pin().out());
  EXPECT_FALSE(went_aside_with_it_out_);
  EXPECT_NEAR(tool()[kX], 30, kOnTheLine);
  EXPECT_NEAR(tool()[kZ], kTip_mm + 0.15, 0.2) << "where it touched, and as far on as it took to stop";
}

TEST_F(Bltouch, MeasuresAMeshWithAPinOutForEveryPoint) {
  ASSERT_TRUE(begin("G29\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 60s));
  ASSERT_TRUE(ends(MachineState::kReady)) << rig.story();
  EXPECT_EQ(pin().deployed(), 6u) << rig.story();
  EXPECT_FALSE(pin().out());
  EXPECT_FALSE(went_aside_with_it_out_);
  ASSERT_TRUE(rig.gateway->status().positions_known);
}

TEST_F(Bltouch, APinThatStaysInStopsBeforeAnythingMoves) {
  ASSERT_EQ(breaks("probe in"), "");
  ASSERT_TRUE(begin("G0 X10 Z15\nG38.2 Z1 F300\nG1 X30 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return told("the probe"); }, 600s)) << rig.story();
  rig.run_for(5s);
  EXPECT_TRUE(told("the probe is in alarm, after a reset, too") || told("the probe's pin has not come out"))
      << rig.story();
  EXPECT_NEAR(tool()[kZ], 15, 0.01);
  EXPECT_NEAR(tool()[kX], 10, 0.01);
}

TEST_F(Bltouch, APinThatIsJammedOutEndsTheJobAboveTheBed) {
  ASSERT_TRUE(begin("G0 X10 Z15\nG38.2 Z1 F300\nG1 X30 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return pin().out(); }, 600s)) << rig.story();
  ASSERT_EQ(breaks("probe out"), "");
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 600s)) << rig.story();
  EXPECT_TRUE(told("the probe has not touched before the end of its move")) << rig.story();
  EXPECT_NEAR(tool()[kX], 10, 0.01);
  EXPECT_GT(tool()[kZ], 0.9);
}

TEST_F(Bltouch, AnAlarmBehindTheContactStopsBeforeAnythingMovesOn) {
  ASSERT_TRUE(begin("G0 X10 Z15\nG38.2 Z1 F300\nG1 X30 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return pin().out(); }, 600s)) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return !pin().out(); }, 60s)) << rig.story();
  ASSERT_EQ(breaks("probe alarm"), "");
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 60s)) << rig.story();
  EXPECT_TRUE(told("the probe is in alarm, after a reset, too")) << rig.story();
  EXPECT_NEAR(tool()[kX], 10, 0.01);
}

TEST_F(Bltouch, AnAlarmThatComesBackStopsBeforeAnythingMoves) {
  ASSERT_EQ(breaks("probe alarm"), "");
  ASSERT_TRUE(begin("G0 X10 Z15\nG38.2 Z1 F300\nG1 X30 F600\n")) << rig.story();
  EXPECT_TRUE(told("the probe is in alarm, after a reset, too")) << "at bring-up already";
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 600s)) << rig.story();
  EXPECT_NEAR(tool()[kZ], 15, 0.01);
}

TEST_F(Bltouch, AMagnetThatHoldsNothingEndsTheJobBeforeTheNextPoint) {
  ASSERT_TRUE(begin("G29\nG1 X30 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return pin().deployed() == 2; }, 600s)) << rig.story();
  ASSERT_EQ(breaks("probe falls"), "");
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 60s)) << rig.story();
  EXPECT_TRUE(told("the probe's pin has not gone in")) << rig.story();
  EXPECT_LE(pin().deployed(), 2u);
  EXPECT_GT(tool()[kZ], kTip_mm + 1);
}

TEST_F(Bltouch, AMagnetThatHoldsNothingIsFoundBehindTheLastPointToo) {
  ASSERT_TRUE(begin("G30\nG1 X30 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return pin().deployed() == 1; }, 600s)) << rig.story();
  ASSERT_EQ(breaks("probe falls"), "");
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 60s)) << rig.story();
  EXPECT_TRUE(told("the probe's pin has not gone in")) << rig.story();
  EXPECT_LT(tool()[kX], 1);
}

TEST_F(Bltouch, WordsOfAJobMoveThePinAtRest) {
  ASSERT_TRUE(begin("G1 X10 Z30 F600\nM401\nG1 X20\nM280 P0 S90\nG1 X30\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return pin().out(); }, 600s)) << rig.story();
  EXPECT_NEAR(tool()[kX], 10, kOnTheLine);
  ASSERT_TRUE(rig.run_until([&] { return tool()[kX] > 19.9; }, 60s)) << rig.story();
  EXPECT_TRUE(pin().out()) << "as long as the job leaves it out";
  ASSERT_TRUE(rig.run_until([&] { return tool()[kX] > 20.5; }, 60s)) << rig.story();
  EXPECT_FALSE(pin().out());
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(tool()[kX], 30, kOnTheLine);
}

TEST_F(Bltouch, AWordThatThePinDoesNotFollowEndsTheJob) {
  ASSERT_EQ(breaks("probe in"), "");
  ASSERT_TRUE(begin("G1 X10 Z30 F600\nM401\nG1 X20\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 60s)) << rig.story();
  EXPECT_TRUE(told("the probe")) << rig.story();
  EXPECT_NEAR(tool()[kX], 10, kOnTheLine);
}

TEST_F(Bltouch, MovesByHandAndSaysWhereItIs) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->take_line("M401", 1)) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return told("the probe's pin is out"); }, 10s)) << rig.story();
  EXPECT_TRUE(pin().out());
  ASSERT_TRUE(rig.gateway->take_line("M280 P0 S90", 1));
  ASSERT_TRUE(rig.run_until([&] { return told("the probe's pin is in"); }, 10s)) << rig.story();
  EXPECT_FALSE(pin().out());
  EXPECT_FALSE(rig.gateway->take_line("M280 P0 S30", 1)) << "no angle that it knows";
  // In alarm, it says so; a reset ends it.
  pin().alarm(false);
  ASSERT_TRUE(rig.gateway->take_line("M280 P0 S160", 1));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().probe_pin == ContactProbe::Pin::kIn; }, 10s));
  ASSERT_EQ(breaks("probe in"), "");
  ASSERT_TRUE(rig.gateway->carry_out(command::MovePin{ContactProbe::PinOrder::kOut}));
  ASSERT_TRUE(rig.run_until([&] { return told("the probe is in alarm") || told("has not come out"); }, 10s))
      << rig.story();
  EXPECT_EQ(rig.gateway->status().probe_pin, ContactProbe::Pin::kFailed);
}

TEST_F(Bltouch, AStopWhileItProbesDrawsThePinIn) {
  ASSERT_TRUE(begin("G0 X10 Z15\nG38.2 Z1 F60\nG1 X30 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return pin().out() && tool()[kZ] < 12; }, 600s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  rig.run_for(5s);
  EXPECT_FALSE(pin().out()) << rig.story();
}

}  // namespace
}  // namespace kinebus
