// A heater's fault while the machine probes or homes: the move ends where it would have ended, without heat,
// and positions stay known.

#include <gtest/gtest.h>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kLiftedBy = 5;  // mm

MachineDescription with_a_probe() {
  MachineDescription machine = printer_on_the_bus();
  machine.probe.present = true;
  machine.probe.place = {DevicePlace::Where::kNode, machine.nodes[2].id, 5};
  machine.nodes[2].inputs[4].function = InputFunction::kProbe;
  return machine;
}

class HeatWhileProbing : public HeatPrinter {
 protected:
  HeatWhileProbing() : HeatPrinter(with_a_probe()) {}
  void touches(bool yes) { rig.nodes.set_input(2, rig.now, 5, yes); }
  /// On the way down, at Z 12.
  ::testing::AssertionResult probes() {
    if (!begin("M104 S80\nM109 S80\nG0 X10 Z15\nG38.2 Z5 F60\nM104 S90\nG1 X30 F600\n") ||
        !rig.run_until([&] { return rig.gateway->status().pose[kX] > 9 && tool()[kZ] < 12; }, 900s))
      return ::testing::AssertionFailure() << rig.story();
    return ::testing::AssertionSuccess();
  }
};

TEST_F(HeatWhileProbing, AFaultTakesTheHeatAndTheJobIsHeldAtTheContact) {
  ASSERT_TRUE(probes());
  ASSERT_EQ(breaks("sensor 1 open"), "");
  rig.run_for(1s);
  EXPECT_TRUE(rig.told(AlarmCode::kThermal)) << rig.story();
  EXPECT_EQ(power(0), 0);
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  EXPECT_EQ(rig.gateway->state(), MachineState::kRunning) << rig.story();
  touches(true);
  const double contact = tool()[kZ];
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  EXPECT_TRUE(rig.gateway->status().positions_known);
  EXPECT_NEAR(tool()[kX], 10, kOnTheLine);
  EXPECT_NEAR(tool()[kZ], contact + kLiftedBy, 0.05);
  EXPECT_EQ(rig.gateway->status().doing.english(), "heater.hotend: a temperature sensor or its wire is open");
  touches(false);
  rig.run_for(20s);
  EXPECT_EQ(power(0), 0);

  breaks("sensor 1 ok");
  rig.run_for(1s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 900s)) << rig.story();
  EXPECT_NEAR(tool()[kX], 30, kOnTheLine);
  EXPECT_NEAR(tool()[kZ], contact, 0.05);
  EXPECT_GT(hotend(), 76);
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 90) << "said behind the contact";
}

TEST_F(HeatWhileProbing, CancelInItGivesTheJobUpWhereItStands) {
  ASSERT_TRUE(probes());
  ASSERT_EQ(breaks("sensor 1 open"), "");
  rig.run_for(1s);
  ASSERT_EQ(rig.gateway->state(), MachineState::kRunning) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() != MachineState::kCancelling; }, 5s));
  EXPECT_TRUE(rig.gateway->status().positions_known);
  EXPECT_FALSE(rig.gateway->status().interrupted);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kZ], tool()[kZ], kOnTheLine);
  EXPECT_EQ(power(0), 0);
}

TEST_F(HeatWhileProbing, HomingGoesOnToKnownPositionsWithoutHeat) {
  ASSERT_TRUE(rig.make_ready());
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 80}));
  ASSERT_TRUE(rig.run_until([&] { return hotend() > 60; }, 300s));
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  rig.run_for(1s);
  ASSERT_EQ(rig.gateway->state(), MachineState::kHoming);
  ASSERT_EQ(breaks("sensor 1 short"), "");
  rig.run_for(500ms);
  EXPECT_TRUE(rig.told(AlarmCode::kThermal)) << rig.story();
  EXPECT_EQ(power(0), 0);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 300s)) << rig.story();
  EXPECT_TRUE(rig.gateway->status().positions_known);
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);

  breaks("sensor 1 ok");
  rig.run_for(1s);
  ASSERT_TRUE(rig.run_job("M109 S60\nG1 X0 F3000\n", 300s)) << rig.story();
}

}  // namespace
}  // namespace kinebus
