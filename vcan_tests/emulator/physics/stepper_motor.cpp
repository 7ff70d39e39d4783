#include "vcan_tests/emulator/physics/stepper_motor.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::emulator {
namespace {
// A short between the motor's wires: what is left is the cable and the board's filter.
constexpr double kShortOhm = 0.05, kShortHenry = 10e-6;
}  // namespace

void StepperMotor::update_angle() {
  sin_ = std::sin(p_.pole_pairs * angle_);
  cos_ = std::cos(p_.pole_pairs * angle_);
  angle_known_ = true;
}

double StepperMotor::back_emf(int phase) const {
  return p_.torque_nm_per_a * speed_ * (phase == 0 ? -sin_ : cos_);
}

double StepperMotor::torque_nm() const {
  return p_.torque_nm_per_a * (current_[1] * cos_ - current_[0] * sin_);
}

double StepperMotor::magnetic_energy_j() const {
  return 0.5 * p_.inductance_h * (current_[0] * current_[0] + current_[1] * current_[1]);
}

void StepperMotor::step_electrical(double dt_s, const Drive& drive, double rail_v) {
  if (!angle_known_) update_angle();
  double torque_impulse = 0;
  for (std::size_t phase = 0; phase < 2; ++phase) {
    double& i = current_[phase];
    if (winding_[phase] == Winding::kOpen) {
      i = 0;
      continue;
    }
    const bool shorted = winding_[phase] == Winding::kShorted;
    const double r = shorted ? kShortOhm : p_.resistance_ohm;
    const double l = shorted ? kShortHenry : p_.inductance_h;
    const double e = shorted ? 0 : back_emf(static_cast<int>(phase));
    double v = drive.volts[phase];
    if (drive.floating[phase]) {
      if (i == 0 && std::abs(e) <= rail_v) continue;
      // The diodes lead the current back into the supply; a back-EMF above the rails drives one by itself.
      v = i > 0 || (i == 0 && e < 0) ? -rail_v : rail_v;
    }
    // Exact for constant v and e: i runs to (v - e) / R with time constant L / R. decay by series: dt << L /
    // R mostly.
    const double x = dt_s * r / l;
    const double gain = x < 1e-3 ? x * (1 - x * (0.5 - x / 6)) : -std::expm1(-x);
    const double goal = (v - e) / r;
    const double before = i;
    i += (goal - i) * gain;
    if (drive.floating[phase] && before != 0 && before * i < 0) i = 0;  // the diodes block
    const double mean = 0.5 * (before + i);
    const double square = (before * before + before * i + i * i) / 3;
    energy_.supplied += v * mean * dt_s;
    energy_.heat += r * square * dt_s;
    peak_ = std::max(peak_, std::abs(i));
    if (!shorted) torque_impulse += p_.torque_nm_per_a * (phase == 0 ? -sin_ : cos_) * mean * dt_s;
  }
  impulse_ += torque_impulse;
  energy_.mechanical += torque_impulse * speed_;
}

void StepperMotor::step_mechanical(double dt_s) {
  const double impulse = impulse_;
  impulse_ = 0;
  if (blocked_) {
    speed_ = 0;
    return;
  }
  if (!angle_known_) update_angle();
  const double detent =
      -p_.detent_nm * 4 * sin_ * cos_ * (cos_ * cos_ - sin_ * sin_);  // sin(4 x) of the doubled angles
  const double momentum = impulse + dt_s * (detent - load_nm_ - p_.viscous_nm_s * speed_);
  double speed = speed_ + momentum / p_.inertia_kg_m2;
  const double friction = p_.coulomb_nm * dt_s / p_.inertia_kg_m2;
  speed = std::abs(speed) <= friction ? 0 : speed - std::copysign(friction, speed);
  speed_ = speed;
  angle_ += speed_ * dt_s;
  update_angle();
}

}  // namespace kinebus::emulator
