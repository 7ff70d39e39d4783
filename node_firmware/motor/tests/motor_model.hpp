#pragma once
// A two-phase stepper with its rotor, for the tests of the control: average voltages, exact enough at 2.5 us.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>

#include "node_firmware/motor/axis_control.hpp"

namespace kinebus::motor {

struct TestMotor {
  double resistance = 1.2, inductance = 2.2e-3, flux = 3.0e-3;  // ohm, H, Vs
  double inertia = 5.7e-6, friction = 1e-4;                     // kg m^2, N m s
  double detent = 0, load = 0;                                  // N m
  bool open_a = false, blocked = false;
  double ia = 0, ib = 0, theta = 0, omega = 0;  // theta: mechanical, rad
  static constexpr int kPolePairs = 50;

  double electrical() const { return kPolePairs * theta; }
  double counts() const { return electrical() * 512 / std::numbers::pi; }

  void run(double va, double vb, double seconds) {
    constexpr double kStep = 2.5e-6;
    for (double t = 0; t < seconds - kStep / 2; t += kStep) {
      const double s = std::sin(electrical()), c = std::cos(electrical());
      const double speed = kPolePairs * omega;
      ia += (va - resistance * ia + flux * speed * s) / inductance * kStep;
      ib += (vb - resistance * ib - flux * speed * c) / inductance * kStep;
      if (open_a) ia = 0;
      const double torque = kPolePairs * flux * (ib * c - ia * s) - detent * std::sin(4 * electrical()) -
                            friction * omega - load;
      omega += torque / inertia * kStep;
      if (blocked) omega = 0;
      theta += omega * kStep;
    }
  }
};

/// The control and its motor, period by period, with the delays of the board: sampled at the start of a
/// period, applied in the next.
struct Bench {
  TestMotor motor;
  AxisControl control;
  double supply = 24, temperature = 25;
  std::optional<double> measured_supply;  // by a divider that is broken
  double position = 0, velocity = 0;      // command: counts, counts/s
  AxisOutputs out;
  double lost_share = 0;  // of the supply, to the dead time of a phase's half-bridges
  bool encoder_present = false;
  bool encoder_mirrored = false;
  double encoder_zero = 0;         // rad
  double encoder_noise_steps = 0;  // rms
  std::mt19937 random{1};

  explicit Bench(AxisConfig config = standard()) { static_cast<void>(control.configure(config)); }

  static AxisConfig standard() {
    AxisConfig config;
    config.motor = {1.2F, 2.2e-3F, 3.0e-3F};
    config.motor_measured = true;
    return config;
  }
  std::uint16_t encoder_frame() {
    if (!encoder_present) return 0xFFFF;
    const double sense = encoder_mirrored ? -1 : 1;
    const double turns = sense * (motor.theta + encoder_zero) / (2 * std::numbers::pi);
    const double noise = encoder_noise_steps * std::normal_distribution<>()(random);
    auto raw =
        static_cast<std::uint16_t>(static_cast<std::int64_t>(std::floor(turns * 16384 + noise)) & 0x3FFF);
    if ((std::popcount(raw) & 1) != 0) raw |= 0x8000;
    return raw;
  }
  static double quantised(double amperes) { return std::round(amperes / 0.004028) * 0.004028; }

  void period() {
    AxisInputs in;
    in.current_a = {static_cast<float>(quantised(motor.ia)), static_cast<float>(quantised(motor.ib))};
    in.supply_v = static_cast<float>(measured_supply.value_or(supply));
    in.temperature_c = static_cast<float>(temperature);
    in.position = static_cast<std::int64_t>(position * 4294967296.0);
    in.velocity = static_cast<float>(velocity);
    in.encoder_frame = encoder_frame();
    const AxisOutputs next = control.step(in);
    const bool on = out.power;
    const auto volts = [&](double duty, double amperes) {
      const double lost = lost_share * supply * std::clamp(amperes / 0.02, -1.0, 1.0);
      return on ? duty * supply - lost : 0;
    };
    motor.run(volts(out.duty.x, motor.ia), volts(out.duty.y, motor.ib), 50e-6);
    if (!on) motor.ia = motor.ib = 0;
    out = next;
    position += velocity * 50e-6;
  }
  /// The rotor is turned by hand to this place, counts.
  void turn_to(double counts) {
    motor.theta = counts / 512 * std::numbers::pi / TestMotor::kPolePairs;
    motor.omega = 0;
  }
  /// The greatest distance from `from` on the way, counts.
  double farthest(double from, double seconds) {
    double most = 0;
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 20'000)); ++i) {
      period();
      most = std::max(most, std::abs(motor.counts() - from));
    }
    return most;
  }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 20'000)); ++i) period();
  }
};

inline AxisConfig with(EncoderMode mode) {
  AxisConfig config = Bench::standard();
  config.encoder = mode;
  return config;
}

}  // namespace kinebus::motor
