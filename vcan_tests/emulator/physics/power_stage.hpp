#pragma once
// Four half-bridges between a timer's outputs and a motor, switching edge by edge: dead time by the current's
// direction, a driver enable, an over-current comparator on the break input.

#include <array>
#include <functional>

#include "vcan_tests/emulator/peripherals/timer.hpp"
#include "vcan_tests/emulator/physics/stepper_motor.hpp"

namespace kinebus::emulator {

struct PowerStageParameters {
  double dead_time_s = 150e-9;
  double switch_ohm = 0.02;  ///< a MOSFET and half a shunt
  double diode_v = 0.8;
  double trip_a = 7.0;
  double trip_delay_s = 200e-9;
};

class PowerStage {
 public:
  PowerStage(Timer& timer, StepperMotor& motor, const PowerStageParameters& parameters);

  /// Follows the outputs up to `to`; they have not changed since the last call but by the timer's own
  /// counting.
  void advance(Cycle to);
  void set_enabled(bool enabled, Cycle now);
  void set_supply(double volts, Cycle now);
  double supply_v() const { return supply_v_; }
  /// In the line of half-bridge +, at the time of the last advance().
  double current_a(int phase) const { return motor_.current_a(phase); }
  /// The comparator's output: high while the current is within its window.
  bool comparator_high() const { return !tripped_; }

  /// Told when the comparator changes, after the fact by at most half a PWM period; the stage itself has
  /// acted at once.
  std::function<void(bool high, Cycle now)> on_comparator;

 private:
  enum class Level : std::uint8_t { kLow, kHigh };
  struct HalfBridge {
    Level commanded = Level::kLow, effective = Level::kLow;
    Cycle follows_at = kNever;  // when the effective level becomes the commanded one
  };
  void integrate(Cycle from, Cycle to, bool off);
  void command(HalfBridge& bridge, Level level, double out_a, Cycle now);

  Timer& timer_;
  StepperMotor& motor_;
  PowerStageParameters p_;
  std::array<HalfBridge, 4> bridges_{};
  Cycle now_ = 0, mechanics_at_ = 0;
  Cycle trips_at_ = kNever;
  bool enabled_ = false, tripped_ = false, cut_ = false;
  double supply_v_ = 24;
};

}  // namespace kinebus::emulator
