#pragma once
// A trapezoidal motion to a target, or to a standstill, from any position and velocity: what profile
// position, homing, halt and quick stop are made of. Evaluated on demand; continuous in position and
// velocity; velocity and acceleration never above their limits.

#include <array>
#include <cstdint>

#include "node_firmware/core/fixed_point.hpp"

namespace kinebus {

/// counts/s and counts/s^2. 0 is taken as 1.
struct ProfileLimits {
  std::uint32_t velocity = 1;
  std::uint32_t acceleration = 1;
  std::uint32_t deceleration = 1;
  friend bool operator==(const ProfileLimits&, const ProfileLimits&) = default;
};

/// In the units of fixed_point.hpp.
struct ProfileState {
  std::int64_t position = 0;
  std::int64_t velocity = 0;
};

class Trapezoid {
 public:
  /// Stands still at `position`.
  void hold(std::int64_t position);
  /// From `from` at time `start` to rest at `target`. Moving too fast, or the wrong way: brakes first, then
  /// returns. Faster than limits.velocity: slows down at `deceleration`.
  void move(ProfileTicks start, ProfileState from, std::int64_t target, const ProfileLimits& limits);
  /// Like move(), but passes `target` at end() with the velocity that was reached, for the next motion to
  /// take over. Falls back to move() when that needs a return.
  void pass(ProfileTicks start, ProfileState from, std::int64_t target, const ProfileLimits& limits);
  /// To a standstill on the nearest whole count that `deceleration` allows, without getting faster than the
  /// present speed or kCreepSpeed.
  void stop(ProfileTicks start, ProfileState from, std::uint32_t deceleration);
  /// The same path in another coordinate system: home was found.
  void shift(std::int64_t by);

  /// At any time; before the start it is the start, after the end the end.
  ProfileState at(ProfileTicks time) const;
  ProfileTicks end() const { return end_time_; }
  bool done(ProfileTicks time) const { return time >= end_time_; }
  std::int64_t target() const { return end_.position; }
  /// When what it does at `time` ends: a ramp, a cruise.
  ProfileTicks phase_end(ProfileTicks time) const;
  /// Cruises: the speed does not change.
  bool cruises(ProfileTicks time) const { return !done(time) && phase_at(time).acceleration == 0; }

  static constexpr std::uint32_t kCreepSpeed = 1000;  ///< counts/s: 0.8 mm/s on a carriage

 private:
  struct Phase {
    ProfileTicks start = 0;
    std::int64_t position = 0;
    std::int64_t velocity = 0;
    std::int64_t acceleration =
        0;  // that of fixed_point.hpp, with `shift` more fractional bits than the velocity
    int shift = 0;
  };
  const Phase& phase_at(ProfileTicks time) const;
  void begin(ProfileTicks start);
  void run(ProfileTicks start, ProfileState from, std::int64_t target, const ProfileLimits& limits,
           bool to_rest);
  void hold_after(ProfileState at_rest);
  ProfileState brake(ProfileState from, std::int64_t deceleration);
  void add(ProfileTicks length, std::int64_t position, std::int64_t velocity, std::int64_t end_velocity);

  std::array<Phase, 4> phases_{};  // brake, then accelerate, cruise, decelerate
  int count_ = 0;
  ProfileTicks end_time_ = 0;
  ProfileState end_;
};

}  // namespace kinebus
