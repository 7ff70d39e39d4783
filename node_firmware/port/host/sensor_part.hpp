#pragma once
// What measures a simulated heater's temperature: a thermistor or a resistance thermometer as its data sheet
// has it, on its resistor. The node's curve goes through the same sheet's points by another formula.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "node_firmware/heat/thermometry.hpp"

namespace kinebus::heat {

struct SensorPart {
  static constexpr double kKelvin = 273.15, kKelvin25 = 298.15;
  // A thermistor: ln(R / ohm_25) = (beta + bend x) x, x = 1/T - 1/298.15 K, T in K.
  double ohm_25 = 100e3, beta = 3950, bend = 0;
  double ohm_0 = 0;  ///< not 0: of platinum, so much at 0 C
  double reference_ohm = 4700;
  bool max31865 = false;  ///< measured against that resistor, not on it

  double ohm(double celsius) const {
    if (ohm_0 > 0) return callendar_van_dusen(ohm_0, celsius);
    const double x = 1 / (celsius + kKelvin) - 1 / kKelvin25;
    return ohm_25 * std::exp((beta + bend * x) * x);
  }
  /// Of the converter's reference, 0 to 1.
  double share(double resistance) const {
    return max31865 ? std::min(resistance / reference_ohm, 1.0) : resistance / (resistance + reference_ohm);
  }

  /// Through two more points of its sheet.
  static SensorPart thermistor(double ohm_25, std::array<double, 2> celsius, std::array<double, 2> ohm) {
    std::array<double, 2> x{}, slope{};
    for (std::size_t i = 0; i < 2; ++i) {
      x[i] = 1 / (celsius[i] + kKelvin) - 1 / kKelvin25;
      slope[i] = std::log(ohm[i] / ohm_25) / x[i];
    }
    SensorPart part{.ohm_25 = ohm_25};
    part.bend = (slope[1] - slope[0]) / (x[1] - x[0]);
    part.beta = slope[0] - part.bend * x[0];
    return part;
  }
  /// Through any three points.
  static SensorPart thermistor(const std::array<double, 3>& celsius, const std::array<double, 3>& ohm) {
    std::array<double, 3> x{}, l{};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = 1 / (celsius[i] + kKelvin) - 1 / kKelvin25;
      l[i] = std::log(ohm[i]);
    }
    const double first = (l[1] - l[0]) / (x[1] - x[0]), second = (l[2] - l[0]) / (x[2] - x[0]);
    SensorPart part;
    part.bend = (second - first) / (x[2] - x[1]);
    part.beta = first - part.bend * (x[0] + x[1]);
    part.ohm_25 = std::exp(l[0] - (part.beta + part.bend * x[0]) * x[0]);
    return part;
  }
};

struct NamedSensorPart {
  std::uint16_t element;  ///< its number of 6110h
  std::string_view name;  ///< in a machine file
  SensorPart part;
};
// Points of the makers' sheets, as printers' configurations give them.
inline const std::array<NamedSensorPart, 10> kSensorParts{{
    {30, "pt100", {.ohm_0 = 100}},
    {33, "pt1000", {.ohm_0 = 1000}},
    {10001, "epcos_100k", SensorPart::thermistor(100e3, {150, 250}, {1641.9, 226.15})},
    {10002, "semitec_104gt2", SensorPart::thermistor(100e3, {150, 300}, {1360, 80.65})},
    {10003, "semitec_104nt4", SensorPart::thermistor(100e3, {160, 300}, {1074, 82.78})},
    {10004, "generic_3950", SensorPart::thermistor(100e3, {150, 250}, {1770, 230})},
    {10005, "slice_450", SensorPart::thermistor(500e3, {200, 400}, {3734, 240})},
    {10006, "ntc100k_mgb18", {.beta = 4100}},
    {10007, "honeywell_100k", {.beta = 3974}},
    {10008, "tdk_ntcg104", SensorPart::thermistor(100e3, {50, 125}, {31'230, 2066})},
}};

/// None: a part of one's own.
inline std::optional<SensorPart> sensor_part(std::uint16_t element) {
  for (const NamedSensorPart& each : kSensorParts)
    if (each.element == element) return each.part;
  return std::nullopt;
}
inline std::optional<SensorPart> sensor_part(std::string_view name) {
  for (const NamedSensorPart& each : kSensorParts)
    if (each.name == name) return each.part;
  return std::nullopt;
}

}  // namespace kinebus::heat
