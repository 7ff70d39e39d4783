// What hangs on a simulated heat node is what it says it is.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "node_firmware/heat/tests/heat_node_bench.hpp"

namespace kinebus::heat {
namespace {

/// What a node that is told of `known` says of a sensor at so many C; none: it does not believe it.
std::optional<double> measured_c(const NamedSensorPart& known, const SensorPart& plugged, double celsius) {
  HeatNodeBench bench;
  bench.plant.plug(0, plugged);
  bench.plant.hot_end().begin_at(celsius);
  EXPECT_EQ(bench.write({0x220A, 1}, static_cast<std::uint16_t>(-50), 2), 0u);
  EXPECT_EQ(bench.write({0x2200, 1}, plugged.max31865 ? 1 : 0, 1), 0u);
  EXPECT_EQ(bench.write({0x2201, 1}, static_cast<std::uint32_t>(1000 * plugged.reference_ohm), 4), 0u);
  EXPECT_EQ(bench.write({0x6110, 1}, known.element, 2), 0u) << known.name;
  bench.run(0.3);
  if (bench.read({0x6150, 1}) != 0u) return std::nullopt;
  return static_cast<std::int16_t>(bench.read({0x7130, 1}).value_or(0)) / 10.0;
}

TEST(HeatPlant, EveryElementIsReadAsWhatItIsAndAnotherIsNot) {
  for (const NamedSensorPart& known : kSensorParts) {
    const double celsius = known.name == "tdk_ntcg104" ? 110 : 205;  // within its sheet
    SensorPart part = known.part;
    if (part.ohm_0 > 0) {
      part.max31865 = true;
      part.reference_ohm = 4 * part.ohm_0;
    }
    const auto right = measured_c(known, part, celsius);
    ASSERT_TRUE(right) << known.name;
    EXPECT_NEAR(*right, celsius, 0.6) << known.name;
    for (const NamedSensorPart& other : kSensorParts) {
      if (other.element == known.element) continue;
      SensorPart wrong = other.part;
      wrong.max31865 = part.max31865;
      wrong.reference_ohm = part.reference_ohm;
      const auto told = measured_c(known, wrong, celsius);
      EXPECT_TRUE(!told || std::abs(*told - celsius) > 0.3) << other.name << " as " << known.name;
    }
  }
}

TEST(HeatPlant, RefusesCommandsThatMeanNothing) {
  HeatPlant plant;
  for (const char* wrong : {"", "sensor", "sensor 1", "sensor 4 open", "sensor 1 stuck", "heater 4 open",
                            "fan 1 open", "flow", "flow x", "flow -1", "flow nan", "flow 1e9",
                            "sensor 1 open now", "flow 1 2", "sensor 4 pt100", "sensor 1 pt200"})
    EXPECT_NE(plant.command(wrong), "") << wrong;
  EXPECT_EQ(plant.command("flow 12.5"), "");
  EXPECT_EQ(plant.hot_end().flow_mm3_per_s, 12.5);
}

}  // namespace
}  // namespace kinebus::heat
