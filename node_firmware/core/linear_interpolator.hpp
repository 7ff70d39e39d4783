#pragma once
// From set-point to set-point, one for each SYNC: cyclic synchronous position, and interpolated position with
// linear sub-mode. Each way is a ramp from the speed of before to the one that reaches the set-point at the
// next SYNC, and a straight line after it: never faster, and never steeper, than the limits. A set-point that
// cannot be reached so is approached as one to stop at.

#include <algorithm>

#include "node_firmware/core/trapezoid.hpp"

namespace kinebus {

class LinearInterpolator {
 public:
  struct Limits {
    ProfileLimits profile;
    std::int64_t low = -kPositionBound, high = kPositionBound;  ///< braked for in time
  };

  void hold(std::int64_t position) {
    *this = {};
    set_point_ = from_ = ramped_ = to_ = position;
  }

  /// From where the axis is at `now` to `target` in `period` ticks, 100 us to 10 s. Returns how far it stays
  /// away from the target; 0: reached.
  std::int64_t go(ProfileTicks now, std::int64_t target, ProfileTicks period, const Limits& limits);

  /// After its end it goes on at the same speed, for a SYNC that is late.
  ProfileState at(ProfileTicks time) const;
  /// Stands, and will: also between set-points that are one and the same.
  bool done(ProfileTicks time) const {
    return after_ == 0 && (time >= end() || (before_ == 0 && from_ == to_));
  }
  ProfileTicks end() const { return start_ + length_; }
  /// In motion, and no SYNC has come for so long that it is not late but lost: one that is missing, or late
  /// by half a period, is waited for, unless the period is long.
  ProfileTicks lost_at() const {
    constexpr ProfileTicks most = kTicksPerSecond / 50;
    return after_ == 0 ? kNever : end() + std::max(length_ / 2, std::min(length_ * 3 / 2, most));
  }

  static constexpr ProfileTicks kNever = std::int64_t{1} << 62;

 private:
  /// The ramp that changes the speed by `by` (2^-56 counts a tick), as far as `acceleration` allows.
  void ramp(std::int64_t by, std::int64_t acceleration);
  ProfileState on_ramp(ProfileTicks t) const;  ///< `t` after the start

  std::int64_t set_point_ = 0;          // the last one
  std::int64_t from_ = 0, before_ = 0;  // at the start: position and speed
  std::int64_t acceleration_ = 0;       // of the ramp, with its sign
  ProfileTicks start_ = 0, ramp_ = 0, length_ = 0;
  std::int64_t ramped_ = 0, after_ = 0, to_ = 0;  // position and speed after the ramp; position at the end
};

}  // namespace kinebus
