#pragma once
// A change of speed with limited acceleration and jerk, in closed form: from one speed to another, without
// acceleration at both ends. Three stages at most: jerk, constant acceleration, jerk the other way. It is
// symmetric about its middle, so that its length is its duration times the mean of both speeds.

namespace kinebus {

class SpeedRamp {
 public:
  /// One stage, from its start: speed + accel t + jerk t^2 / 2.
  struct Stage {
    double duration_s = 0, speed = 0, accel = 0, jerk = 0;
    double speed_at(double t) const { return speed + t * (accel + 0.5 * jerk * t); }
    double way(double t) const { return t * (speed + t * (0.5 * accel + jerk * t * (1.0 / 6))); }
    /// Time at which way(t) is `distance`, 0 to way(duration_s); to the last bits.
    double time_of(double distance) const;
  };
  static constexpr int kStages = 3;

  SpeedRamp() = default;
  /// from, to: >= 0; accel, jerk: greatest values, > 0. As fast as these allow.
  SpeedRamp(double from, double to, double accel, double jerk);

  double from() const { return from_; }
  double to() const { return to_; }
  double duration_s() const { return 2 * jerk_s_ + even_s_; }
  double length() const { return duration_s() * 0.5 * (from_ + to_); }
  /// Stage 0, 1 or 2; its duration may be 0.
  Stage stage(int index) const;
  /// Speed after `distance` of the ramp, 0 to length().
  double speed_after(double distance) const;

 private:
  double from_ = 0, to_ = 0;
  double jerk_s_ = 0, even_s_ = 0;  // each of the outer stages, and the one between them
  double jerk_ = 0;                 // of the first stage: negative when slowing down
};

}  // namespace kinebus
