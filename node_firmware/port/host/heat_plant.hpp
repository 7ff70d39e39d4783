#pragma once
// What hangs on a simulated heat node: a hot end, a bed, a chamber, two fans, filament and its
// sensors, and what can break of them. No clock and no input or output; the numbers are not those that the
// node assumes.
//
//   heater 1, sensor 1   hot end of 44 W          fan 1   the hot end's own, with tacho
//   heater 2, sensor 2   bed of 250 W             fan 2   cools the print, and the hot end a little
//   heater 3, sensor 3   chamber of 200 W         filament sensor 1   a switch
//                                                 filament sensor 2   a wheel, an edge every 2.93 mm
//   an accelerometer on the tool

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "node_firmware/heat/heat_node.hpp"
#include "node_firmware/port/host/accelerometer_plant.hpp"
#include "node_firmware/port/host/filament_plant.hpp"
#include "node_firmware/port/host/pin_probe_plant.hpp"
#include "node_firmware/port/host/thermal_plant.hpp"

namespace kinebus::heat {

class HeatPlant {
 public:
  static constexpr LocalTime kPeriod = SensorInput::kSamplePeriod;
  static constexpr std::uint16_t kSupplyMv = 24'000;

  explicit HeatPlant(std::uint32_t seed = 1);

  /// One kPeriod goes by under what `node` puts out; then its sensors and tachos tell it.
  void step(HeatNode& node, LocalTime now);
  /// The same without a node: nothing has power.
  void rest();

  /// Breaks or mends something, one of:
  ///
  ///     sensor N open | short | loose | silent | frozen | ok | ELEMENT
  ///     heater N loose | open | stuck | ok
  ///     fan N stalled | ok
  ///     flow MM3_PER_S
  ///     filament out | jammed | slips | ok
  ///     probe in | out | falls | alarm | ok
  ///     shake HZ MM_PER_S2
  ///     accelerometer silent | ok
  ///
  /// Sensors are 1 to 3, the chamber's can be open, short and ok; heaters 1 to 3, fans 1 and 2. A stuck
  /// heater's MOSFET is always on. ELEMENT plugs another sensor in, by its name in a machine file. A probe's
  /// pin stays in, or out, or falls out by itself. Flow is that of filament through the hot end, 0 to 100.
  /// Empty: done. Otherwise what is wrong with the command, and what there is.
  std::string command(std::string_view text);

  /// Where the extruder's gears have turned to, mm of filament; before step(). Without it the filament goes
  /// as the master tells the node.
  void turn_extruder(double mm) { extruder_mm_ = mm; }

  FilamentPlant& filament() { return filament_; }
  PinProbePlant& pin_probe() { return pin_probe_; }
  AccelerometerPlant& accelerometer() { return accelerometer_; }
  ThermalPlant& hot_end() { return places_[0]; }
  ThermalPlant& bed() { return places_[1]; }
  static constexpr int kSensors = 3;
  /// What is plugged into that input, from 0 on.
  void plug(int input, const SensorPart& part) { places_[static_cast<std::size_t>(input)].part = part; }

 private:
  struct Turning {
    double speed = 0;   ///< of full
    double turned = 0;  ///< pulses that the tacho has not given yet
    bool stalled = false;
  };
  bool break_sensor(int number, std::string_view how);
  bool break_heater(int number, std::string_view how);
  bool break_fan(int number, std::string_view how);
  bool set_flow(std::string_view mm3_per_s);
  bool break_filament(std::string_view how);
  bool break_probe(std::string_view how);
  bool break_accelerometer(std::string_view how);
  bool shake(std::string_view hz, std::string_view mm_per_s2);

  std::array<ThermalPlant, 3> places_;
  std::array<Turning, 2> fans_;
  FilamentPlant filament_;
  PinProbePlant pin_probe_;
  AccelerometerPlant accelerometer_;
  VibrationMeter vibration_{38'246, AccelerometerPlant::kRange};
  std::optional<double> extruder_mm_;
};

}  // namespace kinebus::heat
