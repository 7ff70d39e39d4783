#include "node_firmware/core/linear_interpolator.hpp"

namespace kinebus {
namespace {

/// No speed is above 2^57, and no difference of two above this.
constexpr std::int64_t kMostChange = std::int64_t{1} << 58;
constexpr std::int64_t kFar = std::int64_t{1} << 61;
constexpr int kSteps = 24;  // of the search for a speed: 1/16,000,000 of the fastest

std::int64_t absolute(std::int64_t value) {
  return value < 0 ? -value : value;
}

// One copy of each of these: a small chip's image has no room for one at every call.

/// By how much a speed changes in `ticks`.
[[gnu::noinline]] std::int64_t change_in(std::int64_t acceleration, ProfileTicks ticks) {
  return ticks >= (kMostChange << 4) / acceleration ? kMostChange : (acceleration * ticks) >> 4;
}

/// The way from `speed` to rest.
[[gnu::noinline]] std::int64_t way_to_rest(std::int64_t speed, std::int64_t deceleration) {
  const std::int64_t ticks = (speed << 4) / deceleration;
  return ticks >= std::int64_t{1} << 28 ? kFar : distance_of(speed, ticks) / 2;
}

/// The highest speed, up to `fastest`, that leaves room to stop within `way` after `ticks` at it.
[[gnu::noinline]] std::int64_t speed_that_stops(std::int64_t way, ProfileTicks ticks,
                                                std::int64_t deceleration, std::int64_t fastest) {
  std::int64_t low = 0, high = fastest;
  for (int i = 0; i < kSteps; ++i) {
    const std::int64_t middle = low + (high - low) / 2;
    (distance_of(middle, ticks) + way_to_rest(middle, deceleration) <= way ? low : high) = middle;
  }
  return low;
}

}  // namespace

void LinearInterpolator::ramp(std::int64_t by, std::int64_t acceleration) {
  ramp_ = std::min(length_, (absolute(by) << 4) / acceleration);
  acceleration_ = by < 0 ? -acceleration : acceleration;
  const std::int64_t change = change_in(acceleration, ramp_);
  after_ = by < 0 ? before_ - change : before_ + change;
}

std::int64_t LinearInterpolator::go(ProfileTicks now, std::int64_t target, ProfileTicks period,
                                    const Limits& limits) {
  const ProfileState here = at(now);
  from_ = here.position;
  before_ = here.velocity;
  start_ = now;
  length_ = std::max<ProfileTicks>(period, 1);
  const std::int64_t wanted = target;
  target = std::clamp(target, from_ - kFar, from_ + kFar);
  const std::int64_t speed_up = acceleration_from(std::max<std::uint32_t>(limits.profile.acceleration, 1));
  const std::int64_t slow_down = acceleration_from(std::max<std::uint32_t>(limits.profile.deceleration, 1));
  const std::int64_t fastest = velocity_from(std::max<std::uint32_t>(limits.profile.velocity, 1));

  // What the present speed alone does not do, the ramp has to: x T - x^2 / 2a = missing, x = a * ramp.
  const std::int64_t missing = target - from_ - distance_of(before_, length_);
  const bool up = missing > 0;
  const bool faster = before_ == 0 || (before_ > 0) == up;
  std::int64_t a = faster ? speed_up : slow_down;
  if (!faster && change_in(slow_down, length_) > absolute(before_)) a = std::min(speed_up, slow_down);
  const std::int64_t way = absolute(missing);
  bool reached = way <= distance_of(change_in(a, length_), length_) / 2;
  if (reached) {
    const std::int64_t square = length_ * length_;
    // 2 way / a, ticks^2. An acceleration has up to 45 bits: the remainder takes 18 more.
    const std::int64_t twice = ((way / a) << 29) + ((((way % a) << 18) / a) << 11);
    const auto root = static_cast<ProfileTicks>(
        square_root(static_cast<std::uint64_t>(std::max<std::int64_t>(square - twice, 0))));
    const std::int64_t change = change_in(a, length_ - std::min(root, length_));
    ramp(up ? change : -change, a);
  } else {
    const std::int64_t change = change_in(a, length_);
    ramp(up ? change : -change, a);
  }

  // As fast as may be, and in time to stop: at a set-point that is not reached now, and at the limits.
  const bool positive = after_ > 0;
  const auto room = [&](std::int64_t to) {
    return std::max<std::int64_t>(positive ? to - from_ : from_ - to, 0);
  };
  std::int64_t most = fastest;
  if (!reached) {
    // A set-point that goes on by itself needs no stop: only what is faster than it has to be braked for.
    const std::int64_t way_of_target = std::clamp(target - set_point_, -kFar, kFar);
    const bool jumps = absolute(way_of_target) > distance_of(fastest, length_);
    std::int64_t own = 0;
    if (!jumps && (way_of_target > 0) == positive)
      own = velocity_over(static_cast<std::uint64_t>(absolute(way_of_target)), length_);
    const std::int64_t left = std::max<std::int64_t>(room(target) - distance_of(own, length_), 0);
    most = std::min(most, own + speed_that_stops(left, length_ * 3 / 2, slow_down, fastest));
  }
  set_point_ = target;
  const std::int64_t limit = std::clamp(positive ? limits.high : limits.low, from_ - kFar, from_ + kFar);
  if (way_to_rest(absolute(after_), slow_down) > room(limit))
    most = std::min(most, speed_that_stops(room(limit), 0, slow_down, fastest));
  if (absolute(after_) > most) {
    reached = false;
    const bool same = (before_ >= 0) == positive;
    const std::int64_t least = same ? absolute(before_) - change_in(slow_down, length_) : 0;
    const std::int64_t speed = std::max(most, least);
    const std::int64_t by = (positive ? speed : -speed) - before_;
    const bool brakes = same && speed < absolute(before_);
    ramp(by, brakes ? slow_down : same ? speed_up : std::min(speed_up, slow_down));
  }

  ramped_ = on_ramp(ramp_).position;
  const ProfileTicks rest = length_ - ramp_;
  if (reached && rest > 0) {
    const std::int64_t left = target - ramped_;
    const std::int64_t speed = velocity_over(static_cast<std::uint64_t>(absolute(left)), rest);
    after_ = left < 0 ? -speed : speed;
  }
  to_ = reached ? target : ramped_ + distance_of(after_, rest);
  const std::int64_t half = wanted / 2 - to_ / 2;  // the difference itself may be beyond 64 bits
  return reached ? 0 : std::min(absolute(half), kFar) * 2 + 1;
}

ProfileState LinearInterpolator::at(ProfileTicks time) const {
  const ProfileTicks t = std::max<ProfileTicks>(time - start_, 0);
  if (t >= length_) return {to_ + distance_of(after_, std::min(t - length_, kNever >> 34)), after_};
  if (t >= ramp_ && ramp_ < length_) return {ramped_ + distance_of(after_, t - ramp_), after_};
  return on_ramp(t);
}

ProfileState LinearInterpolator::on_ramp(ProfileTicks t) const {
  const std::int64_t change = acceleration_ == 0 ? 0 : change_in(absolute(acceleration_), t);
  const std::int64_t way = distance_of(change, t) / 2;
  const bool down = acceleration_ < 0;
  return {from_ + distance_of(before_, t) + (down ? -way : way), down ? before_ - change : before_ + change};
}

}  // namespace kinebus
