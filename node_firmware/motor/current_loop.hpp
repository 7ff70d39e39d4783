#pragma once
// The two phase currents of a stepper as one vector, controlled in the frame that turns with the commanded
// angle: there the references stand still, so that a PI controller has no error at any speed. Feed-forward of
// inductance and back-EMF; voltage limit with anti-windup; output angle advanced by the delay of
// sampling and PWM.

#include <algorithm>
#include <cmath>

#include "node_firmware/motor/sine.hpp"

namespace kinebus::motor {

inline constexpr float kControlPeriodS = 1.0F / 20'000;
/// From the sampling instant to the middle of the period in which its voltage is applied.
inline constexpr float kOutputDelayS = 1.5F * kControlPeriodS;
/// Of the supply, for both half-bridges of a phase: leaves the current amplifiers quiet around each edge.
inline constexpr float kLargestDuty = 0.96F;

struct MotorModel {
  float resistance_ohm = 1.5F;
  float inductance_h = 2.5e-3F;
  float flux_vs = 0;  ///< peak phase back-EMF / electrical angular frequency
};

struct CurrentGains {
  float proportional_v_per_a = 0;
  float integral_v_per_a = 0;  ///< each control period

  /// The pole of the winding is cancelled: closed loop of first order with that bandwidth.
  static CurrentGains of(const MotorModel& motor, float bandwidth_hz) {
    const float omega = 6.2831853F * bandwidth_hz;
    return {motor.inductance_h * omega, motor.resistance_ohm * omega * kControlPeriodS};
  }
};

/// Phase A and B; or d (along the commanded angle) and q (90 degrees electrical ahead).
struct Vector {
  float x = 0, y = 0;
};
inline Vector turn(const Vector& v, const SineCosine& by) {
  return {v.x * by.cosine - v.y * by.sine, v.x * by.sine + v.y * by.cosine};
}
inline Vector turn_back(const Vector& v, const SineCosine& by) {
  return {v.x * by.cosine + v.y * by.sine, v.y * by.cosine - v.x * by.sine};
}

class CurrentLoop {
 public:
  struct Command {
    float current_a = 0;  ///< along the angle
    Angle angle = 0;      ///< at the sampling instant
    float omega_rad_per_s = 0;
  };

  void configure(const MotorModel& motor, const CurrentGains& gains) {
    motor_ = motor;
    gains_ = gains;
    unwind_ = gains.integral_v_per_a / gains.proportional_v_per_a;
  }
  void reset() { integral_ = {}; }

  /// Phase voltages for `measured` phase currents. Cost: about 90 floating-point operations, one square root
  /// and one division when the voltage is limited.
  Vector step(const Vector& measured, const Command& command, float supply_v) {
    return step(measured, command, sine_cosine(command.angle), supply_v);
  }
  /// `at`: of the command's angle.
  Vector step(const Vector& measured, const Command& command, const SineCosine& at, float supply_v) {
    const Vector current = turn_back(measured, at);
    const Vector error{command.current_a - current.x, -current.y};
    integral_.x += gains_.integral_v_per_a * error.x;
    integral_.y += gains_.integral_v_per_a * error.y;
    const float omega = command.omega_rad_per_s;
    const float ahead_q = omega * (motor_.inductance_h * command.current_a + motor_.flux_vs);
    Vector voltage{gains_.proportional_v_per_a * error.x + integral_.x,
                   gains_.proportional_v_per_a * error.y + integral_.y + ahead_q};
    const float limit = supply_v * kLargestDuty;
    const float square = voltage.x * voltage.x + voltage.y * voltage.y;
    limited_ = square > limit * limit;
    if (limited_) {
      const float scale = limit / std::sqrt(square);
      // What cannot be applied is taken out of the integrals with their own time constant (back-calculation).
      integral_.x -= unwind_ * (1 - scale) * voltage.x;
      integral_.y -= unwind_ * (1 - scale) * voltage.y;
      voltage.x *= scale;
      voltage.y *= scale;
    }
    direct_v_ = voltage.x;
    measured_ = current;
    return turn(voltage, sine_cosine(command.angle + angle_from(omega * kOutputDelayS)));
  }

  /// Of `current_a`, what the supply can drive at that speed against inductance and back-EMF, with what
  /// control and a load's angle need besides; at least a fifth of it. More would only be cut off, and turn
  /// the current away from its angle.
  float reachable(float current_a, float omega_rad_per_s, float supply_v) const {
    constexpr float kUsable = 0.92F * kLargestDuty, kLeastShare = 0.2F;
    const float omega = std::fabs(omega_rad_per_s);
    const float left_v = kUsable * supply_v - omega * motor_.flux_vs;
    const float ohm = omega * motor_.inductance_h;
    if (ohm * current_a <= left_v) return current_a;
    return std::max(left_v / ohm, kLeastShare * current_a);
  }

  bool limited() const { return limited_; }
  float direct_v() const { return direct_v_; }          ///< applied along the angle
  const Vector& measured() const { return measured_; }  ///< d, q

 private:
  MotorModel motor_;
  CurrentGains gains_;
  Vector integral_, measured_;
  float unwind_ = 0;
  float direct_v_ = 0;
  bool limited_ = false;
};

/// Voltage that a half-bridge loses to its dead time, given back: by the sign of the current, evenly through
/// zero.
inline float dead_time_volts(float current_a, float lost_v) {
  constexpr float kFullAt = 0.15F;
  return lost_v * std::clamp(current_a * (1 / kFullAt), -1.0F, 1.0F);
}

}  // namespace kinebus::motor
