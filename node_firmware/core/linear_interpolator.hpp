#pragma once
// From set-point to set-point, one for each SYNC: cyclic synchronous position, and interpolated position with
// linear sub-mode. A set-point that goes on from SYNC to SYNC is met at the next one, by a ramp and a
// straight line, or by a motion that also ends at the set-point's speed. Every other one - a first step, one
// that has stopped, a jump - is approached as one to stop at. Never faster, and never steeper, than the
// limits.

#include <algorithm>

#include "node_firmware/core/trapezoid.hpp"

namespace kinebus {

class LinearInterpolator {
 public:
  struct Limits {
    ProfileLimits profile;
    std::int64_t low = -kPositionBound, high = kPositionBound;  ///< braked for in time
  };

  /// `profile`: the axis', which it may plan with from go() on for as long as at() is asked for.
  explicit LinearInterpolator(Trapezoid& profile) : profile_(profile) {}

  void hold(std::int64_t position);

  /// From where the axis is at `now` to `target` in `period` ticks, 100 us to 10 s. Returns how far it stays
  /// away from the target; 0: reached.
  std::int64_t go(ProfileTicks now, std::int64_t target, ProfileTicks period, const Limits& limits);

  /// After its end it goes on, for a SYNC that is late: at the same speed, but not over a limit.
  ProfileState at(ProfileTicks time) const;
  /// Stands, and will: also between set-points that are one and the same.
  bool done(ProfileTicks time) const {
    return planned_ ? speed_ == 0 && profile_.done(time) : after_ == 0 && time >= end();
  }
  ProfileTicks end() const { return start_ + length_; }
  /// In motion, and no SYNC has come for so long that it is not late but lost: one that is missing, or late
  /// by half a period, is waited for, unless the period is long.
  ProfileTicks lost_at() const { return after_ == 0 ? kNever : end() + patience(); }

  static constexpr ProfileTicks kNever = std::int64_t{1} << 62;

 private:
  struct Reach {  // the limits, and in the units of fixed_point.hpp
    const Limits& limits;
    std::int64_t fastest, speed_up, slow_down;
  };
  struct Ramp {  // of speed
    ProfileTicks start = 0, length = 0;
    ProfileState from;
    std::int64_t acceleration = 0, after = 0;  ///< after: the speed then
    ProfileState at(ProfileTicks time) const;
  };
  static Ramp never() {
    Ramp none;
    none.start = kNever;
    return none;
  }
  ProfileTicks patience() const;
  void choose(std::int64_t step, std::int64_t before, const Reach& reach);
  bool plan(std::int64_t speed, const Reach& reach);
  void take_profile(std::int64_t speed);
  bool meet(bool up, std::int64_t last, const Reach& reach);
  void ramp_to(std::int64_t speed, const Reach& reach);
  void heed_limits(const Reach& reach);

  Trapezoid& profile_;
  std::int64_t set_point_ = 0, step_ = 0;  // the last one, and its way in that period
  ProfileTicks start_ = 0, length_ = 0;
  std::int64_t to_ = 0, after_ = 0;  // position and speed at the end
  bool planned_ = false;             // by the profile, in a frame that goes along with the set-point
  std::int64_t speed_ = 0;           // of that frame
  Ramp ramp_;                        // else: a ramp, and straight on
  Ramp stop_ = never();              // where a limit is near
};

}  // namespace kinebus
