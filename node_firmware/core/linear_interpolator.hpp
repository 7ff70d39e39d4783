#pragma once
// Straight lines from set-point to set-point, one for each SYNC: cyclic synchronous position, and
// interpolated position with linear sub-mode.

#include <algorithm>

#include "node_firmware/core/trapezoid.hpp"

namespace kinebus {

class LinearInterpolator {
 public:
  void hold(std::int64_t position) {
    from_ = to_ = position;
    length_ = 0;
  }

  /// From where the axis is at `now` to `target` in `period` ticks, not faster than `max_speed` (counts/s):
  /// false when that keeps it from reaching the target.
  bool go(ProfileTicks now, std::int64_t target, ProfileTicks period, std::uint32_t max_speed) {
    from_ = at(now).position;
    start_ = now;
    length_ = std::max<ProfileTicks>(period, 1);
    const std::int64_t most = distance_of(velocity_from(max_speed), length_);
    to_ = std::clamp(target, from_ - most, from_ + most);
    const std::int64_t way = to_ > from_ ? to_ - from_ : from_ - to_;
    velocity_ = velocity_over(static_cast<std::uint64_t>(way), length_) * (to_ > from_ ? 1 : -1);
    return to_ == target;
  }

  /// Stands at the last set-point when no new one has come in time.
  ProfileState at(ProfileTicks time) const {
    if (time >= start_ + length_) return {to_, 0};
    return {from_ + distance_of(velocity_, std::max<ProfileTicks>(time - start_, 0)), velocity_};
  }
  bool done(ProfileTicks time) const { return time >= start_ + length_; }
  ProfileTicks end() const { return start_ + length_; }
  std::int64_t target() const { return to_; }

 private:
  std::int64_t from_ = 0, to_ = 0, velocity_ = 0;
  ProfileTicks start_ = 0, length_ = 0;
};

}  // namespace kinebus
