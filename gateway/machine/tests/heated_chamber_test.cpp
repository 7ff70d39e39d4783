// A printer with a heated chamber on its heat node: waited for alone, with all others, measured; and what its
// node refuses.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr HeaterId kHeatedChamber{HeaterKind::kChamber, 0};

MachineDescription printer_with_a_chamber() {
  MachineDescription machine = printer_on_the_bus();
  machine.nodes.back().functions.heaters = 3;
  machine.nodes.back().functions.sensors = 0;
  const SensorWiring wiring = machine.sensors.front().wiring;
  machine.sensors.clear();
  HeaterDescription chamber{.name = "chamber", .kind = HeaterKind::kChamber, .max_c = 70};
  chamber.place = {DevicePlace::Where::kNode, kHeatId, 3};
  chamber.wiring.sensor = wiring;
  chamber.wiring.power_w = 200;
  chamber.wiring.rise = 120s;
  machine.heaters.push_back(chamber);
  return machine;
}

class HeatedChamber : public HeatPrinter {
 protected:
  HeatedChamber() : HeatPrinter(printer_with_a_chamber()) {}
  HeaterStatus told(HeaterId heater) { return rig.gateway->status().heater(heater); }
  bool moved() { return rig.gateway->status().pose[kX] > 4.9; }
};

TEST_F(HeatedChamber, M191WaitsForIt) {
  ASSERT_TRUE(begin("M191 S36\nG1 X5 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return moved(); }, 600s)) << rig.story();
  EXPECT_NEAR(told(kHeatedChamber).actual_celsius, 36, 2.5);
  EXPECT_EQ(told(kHeatedChamber).target_celsius, 36);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

TEST_F(HeatedChamber, M116WaitsForAllThatHeat) {
  ASSERT_TRUE(begin("M141 S34\nM140 S45\nM104 S190\nM116\nG1 X5 F600\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return moved(); }, 600s)) << rig.story();
  for (const HeaterId heater : {kHeatedChamber, kFirstBed, kFirstHotend})
    EXPECT_GE(told(heater).actual_celsius, told(heater).target_celsius - 2.5);
  EXPECT_EQ(told(kHeatedChamber).target_celsius, 34);
  EXPECT_EQ(told(kFirstBed).target_celsius, 45);
  EXPECT_EQ(told(kFirstHotend).target_celsius, 190);
}

TEST_F(HeatedChamber, AJobThatWantsMoreThanItsMostIsRefused) {
  ASSERT_TRUE(begin("M141 S71\nG1 X5 F600\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_FALSE(moved());
  EXPECT_NE(rig.story().find("70 C"), std::string::npos) << rig.story();
}

}  // namespace
}  // namespace kinebus
