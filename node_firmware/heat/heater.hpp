#pragma once
// One heater: its sensor's word, its control, its watch, its tuning, and the power that goes out. A fault
// takes the power and stays until it is cleared.

#include <cstdint>

#include "node_firmware/heat/heat_control.hpp"
#include "node_firmware/heat/heat_tuning.hpp"
#include "node_firmware/heat/heater_watch.hpp"
#include "node_firmware/heat/sensor_input.hpp"

namespace kinebus::heat {

enum class ControlKind : std::uint8_t { kPid = 0, kModel = 1 };
/// What switches the heater: a MOSFET by fast PWM, or a relay for mains, on or off for a whole tick.
enum class OutputKind : std::uint8_t { kPwm = 0, kWholeTicks = 1 };

struct HeaterSettings {
  ControlKind control = ControlKind::kModel;
  OutputKind output = OutputKind::kPwm;
  std::uint8_t most_power = 100;  ///< per cent
  std::uint16_t nominal_mv = 24'000;
  std::uint32_t nominal_mw = 40'000;
  ModelParameters model{};  ///< not usable(): never measured, then PID and plain rules
  PidParameters pid{};
  WatchSettings watch{};
};

class Heater {
 public:
  void configure(const HeaterSettings& settings);
  const HeaterSettings& settings() const { return settings_; }

  /// mC; 0: off.
  void set_target(std::int32_t mc) { target_ = mc; }
  std::int32_t target() const { return target_; }
  /// Power that something takes which the model does not know, such as filament: mW, signed. It is given on
  /// top, and the model counts both as one: no heat. `quiet`: see HeaterWatch::step().
  void set_feed_forward(std::int32_t mw, bool quiet = false);
  /// The tuning is lent by the node: one runs at a time.
  void begin_tuning(HeatTuning& tuning, const SensorInput& sensor, std::int32_t target);
  bool tuning() const { return tuning_ != nullptr; }

  /// Once a tick. `supply_mv` 0: not measured, taken as nominal.
  void step(const SensorInput& sensor, std::uint32_t supply_mv);
  /// Something outside says so, too.
  void trip(HeaterFault fault);
  void clear_fault();
  HeaterFault fault() const { return fault_; }

  /// What the output is to do now: parts of kFullPower; at every sample, for a suspect one takes it at once,
  /// and so does a target of 0.
  std::uint32_t output(const SensorInput& sensor) const {
    const bool asked = target_ != 0 || tuning_ != nullptr;
    return asked && fault_ == HeaterFault::kNone && sensor.good() ? duty_ : 0;
  }
  /// The same as effective share of full power in the last tick.
  std::uint32_t power() const { return given_; }
  bool measured_model() const { return has_model_; }
  const ThermalModel& model() const { return model_; }

 private:
  std::uint32_t wanted(std::int32_t measured, std::uint32_t most);
  void set_duty(std::uint32_t power);
  void follow_supply(std::uint32_t supply_mv);

  HeaterSettings settings_{};
  bool has_model_ = false, started_ = false;
  std::int32_t target_ = 0;
  std::int32_t feed_forward_ = 0, given_forward_ = 0;  // parts of kFullPower: now, and in the last tick
  bool quiet_ = false;
  std::int32_t asked_ = 0;  // the target before the fault
  std::uint32_t most_ = kFullPower;
  HeaterFault fault_ = HeaterFault::kNone;
  ThermalModel model_;
  ModelControl by_model_;
  PidControl by_pid_;
  HeaterWatch watch_;
  HeatTuning* tuning_ = nullptr;

  std::uint32_t supply_mv_ = 0;
  std::uint32_t strength_ = kFullPower, weakness_ = kFullPower;  // (V / nominal)^2 and its reciprocal
  std::uint32_t duty_ = 0, given_ = 0, owed_ = 0;
};

/// The fault that a sensor's is to its heater.
HeaterFault heater_fault(SensorFault fault);

}  // namespace kinebus::heat
