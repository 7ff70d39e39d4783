#include "gateway/bus_nodes/heat_settings.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "gateway/description/shipped_machines.hpp"
#include "protocol/canopen/heat_units.hpp"

namespace kinebus {
namespace {

std::optional<std::int64_t> told(const MachineDescription& machine, ObjectAddress address) {
  NodeConfiguration configuration;
  add_heat_settings(machine, machine.heaters.at(0).place.node_id, configuration);
  if (address.subindex != 0) address.subindex = machine.heaters.at(0).place.channel;
  for (const ParameterWrite& write : configuration.writes)
    if (write.address == address) return write.value;
  return std::nullopt;
}

TEST(HeatSettings, AMax31865IsToldItsWiresAndTheMains) {
  MachineDescription machine = *machine_of("corexy_heat");
  EXPECT_EQ(told(machine, heat_object::kSensorPath), 0);
  EXPECT_FALSE(told(machine, heat_object::kSensorWires)) << "a node of before has no such object";
  EXPECT_FALSE(told(machine, heat_object::kMains));
  machine.heaters.at(0).wiring.sensor = {
      .element = SensorElement::kPt100, .max31865 = true, .reference_ohm = 430, .wires = 3};
  machine.thermal.mains_hz = 60;
  EXPECT_EQ(told(machine, heat_object::kSensorPath), 1);
  EXPECT_EQ(told(machine, heat_object::kReference), 430'000);
  EXPECT_EQ(told(machine, heat_object::kSensorWires), 3);
  EXPECT_EQ(told(machine, heat_object::kMains), 60);
  EXPECT_EQ(told(machine, heat_object::kSensorType), 30);
}

}  // namespace
}  // namespace kinebus
