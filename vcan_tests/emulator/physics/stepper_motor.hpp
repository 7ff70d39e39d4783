#pragma once
// A two-phase hybrid stepper: windings, back-EMF, detent torque, rotor with inertia, friction and load.
//
//   v = R i + L di/dt + e,   e_a = -K w sin(p x),  e_b = K w cos(p x)
//   J dw/dt = K (i_b cos(p x) - i_a sin(p x)) - D sin(4 p x) - B w - friction - load
//
// x: rotor angle, p: pole pairs. Currents I (cos f, sin f) pull the rotor to p x = f.

#include <array>
#include <cstdint>

namespace kinebus::emulator {

/// A NEMA 17 of low inductance, 0.45 Nm at 2.5 A, as wanted for high speed from 24 V.
struct StepperParameters {
  double resistance_ohm = 1.0;
  double inductance_h = 1.5e-3;
  double torque_nm_per_a = 0.127;  ///< also the back-EMF in V s/rad, of one phase
  int pole_pairs = 50;
  double detent_nm = 0.004;
  double inertia_kg_m2 = 12e-6;  ///< rotor 8e-6 and what it drives
  double viscous_nm_s = 2e-5;
  double coulomb_nm = 0.002;
};

class StepperMotor {
 public:
  enum class Winding : std::uint8_t { kGood, kOpen, kShorted };
  explicit StepperMotor(const StepperParameters& parameters) : p_(parameters) {}

  /// What the bridges do with the phases during a step. Floating: diodes only.
  struct Drive {
    std::array<double, 2> volts{};
    std::array<bool, 2> floating{};
  };
  /// Currents only, `dt_s` at most a PWM half period; the rotor turns at its present speed.
  /// `rail_v`: what the free-wheeling diodes hold against a floating phase.
  void step_electrical(double dt_s, const Drive& drive, double rail_v);
  /// The rotor moves on by the mean torque since the last call.
  void step_mechanical(double dt_s);

  double current_a(int phase) const { return current_[static_cast<std::size_t>(phase)]; }
  double angle_rad() const { return angle_; }
  double speed_rad_per_s() const { return speed_; }
  double torque_nm() const;  ///< of the currents, now
  double peak_current_a() const { return peak_; }
  void clear_peak() { peak_ = 0; }
  /// Sums since the beginning, J.
  struct Energy {
    double supplied = 0, heat = 0, mechanical = 0;
  };
  const Energy& energy() const { return energy_; }
  double magnetic_energy_j() const;

  void place(double angle_rad) {
    angle_ = angle_rad;
    speed_ = 0;
  }
  void set_current(int phase, double amperes) { current_[static_cast<std::size_t>(phase)] = amperes; }
  void set_speed(double rad_per_s) { speed_ = rad_per_s; }
  void set_load(double nm) { load_nm_ = nm; }  ///< against the positive direction
  void block(bool blocked) { blocked_ = blocked; }
  void set_winding(int phase, Winding winding) { winding_[static_cast<std::size_t>(phase)] = winding; }
  const StepperParameters& parameters() const { return p_; }

 private:
  double back_emf(int phase) const;
  void update_angle();

  StepperParameters p_;
  std::array<double, 2> current_{};
  double angle_ = 0, speed_ = 0, load_nm_ = 0;
  double sin_ = 0, cos_ = 1;  // of the electrical angle, as of the last mechanical step
  std::array<Winding, 2> winding_{};
  bool blocked_ = false, angle_known_ = false;
  double impulse_ = 0;  // torque integrated since the last mechanical step
  double peak_ = 0;
  Energy energy_{};
};

}  // namespace kinebus::emulator
