#include "node_firmware/core/linear_interpolator.hpp"

#include <utility>

namespace kinebus {
namespace {

/// No speed is above 2^57, and no difference of two above this.
constexpr std::int64_t kMostChange = std::int64_t{1} << 58;
constexpr std::int64_t kFar = std::int64_t{1} << 61;
constexpr ProfileTicks kLongest = ProfileTicks{1} << 28;  // 16 s
constexpr std::int64_t kLeastSpeed = velocity_from(1);

// One copy of each of these: a small chip's image has no room for one at every call.

[[gnu::noinline]] std::int64_t absolute(std::int64_t value) {
  return value < 0 ? -value : value;
}
[[gnu::noinline]] std::int64_t with_sign_of(std::int64_t sign, std::int64_t value) {
  return sign < 0 ? -value : value;
}
[[gnu::noinline]] bool opposed(std::int64_t a, std::int64_t b) {
  return a != 0 && b != 0 && (a < 0) != (b < 0);
}

/// By how much a speed changes in `ticks`.
[[gnu::noinline]] std::int64_t change_in(std::int64_t acceleration, ProfileTicks ticks) {
  return ticks >= (kMostChange << 4) / acceleration ? kMostChange : (acceleration * ticks) >> 4;
}

/// The way from `speed` to rest.
[[gnu::noinline]] std::int64_t way_to_rest(std::int64_t speed, std::int64_t deceleration) {
  const std::int64_t ticks = (speed << 4) / deceleration;
  return ticks >= std::int64_t{1} << 28 ? kFar : distance_of(speed, ticks) / 2;
}

/// The speed that covers `way` in `ticks`, or `most`.
[[gnu::noinline]] std::int64_t speed_over(std::int64_t way, ProfileTicks ticks, std::int64_t most) {
  if (way >= distance_of(most, ticks)) return most;
  return velocity_over(static_cast<std::uint64_t>(way), ticks);
}

}  // namespace

ProfileState LinearInterpolator::Ramp::at(ProfileTicks time) const {
  const ProfileTicks t = std::clamp<ProfileTicks>(time - start, 0, kLongest), part = std::min(t, length);
  // Nothing is multiplied for a line without acceleration: an Octopus with a full bus has no time for it.
  const std::int64_t change = acceleration == 0 ? 0 : change_in(absolute(acceleration), part);
  const std::int64_t way =
      distance_of(from.velocity, part) + with_sign_of(acceleration, distance_of(change, part) / 2);
  if (t < length) return {from.position + way, from.velocity + with_sign_of(acceleration, change)};
  return {from.position + way + distance_of(after, t - part), after};
}

void LinearInterpolator::hold(std::int64_t position) {
  set_point_ = to_ = position;
  step_ = after_ = speed_ = 0;
  start_ = length_ = 0;
  planned_ = false;
  ramp_ = {.from = {position, 0}};
  stop_.start = kNever;
}

ProfileTicks LinearInterpolator::patience() const {
  constexpr ProfileTicks most = kTicksPerSecond / 50;
  return std::max(length_ / 2, std::min(length_ * 3 / 2, most));
}

/// To `speed`, and on at it; to rest first where that is the other way.
void LinearInterpolator::ramp_to(std::int64_t speed, const Reach& reach) {
  const std::int64_t before = ramp_.from.velocity;
  if (opposed(speed, before)) speed = 0;
  const std::int64_t by = speed - before;
  const std::int64_t a = absolute(speed) < absolute(before) ? reach.slow_down : reach.speed_up;
  ramp_.length = std::min(length_, (absolute(by) << 4) / a);
  ramp_.acceleration = with_sign_of(by, a);
  ramp_.after = after_ = before + with_sign_of(by, change_in(a, ramp_.length));
  to_ = ramp_.at(end()).position;
}

/// By a ramp and a line to the set-point, which leaves the speed there open: it has to be near `last`, so
/// that the next set-point can be met too. False: not within the limits; then by a ramp towards it.
bool LinearInterpolator::meet(bool up, std::int64_t last, const Reach& reach) {
  const std::int64_t before = ramp_.from.velocity;
  const std::int64_t least = std::max<std::int64_t>(last - change_in(reach.speed_up, length_) / 2, 0);
  const std::int64_t most =
      std::min(last + change_in(reach.slow_down, length_) / 4, reach.fastest + kLeastSpeed);
  const std::int64_t sign = up ? 1 : -1;
  // What the present speed alone does not do, the ramp has to: x T - x^2 / 2a = missing, x = a * ramp.
  const std::int64_t missing = set_point_ - ramp_.from.position - distance_of(before, length_);
  const std::int64_t way = absolute(missing);
  const std::int64_t a = opposed(missing, before) ? reach.slow_down : reach.speed_up;
  const std::int64_t whole = change_in(a, length_);
  if (way <= distance_of(whole, length_) / 2 && !opposed(before, sign)) {
    // 2 way / a, ticks^2. An acceleration has up to 45 bits: the remainder takes 18 more.
    const std::int64_t twice = ((way / a) << 29) + ((((way % a) << 18) / a) << 11);
    const auto root = static_cast<ProfileTicks>(
        square_root(static_cast<std::uint64_t>(std::max<std::int64_t>(length_ * length_ - twice, 0))));
    const std::int64_t speed =
        before + with_sign_of(missing, change_in(a, length_ - std::min(root, length_)));
    const std::int64_t along = with_sign_of(sign, speed);
    if (least <= along && along <= most) {
      ramp_to(speed, reach);
      // Exactly: the straight part makes up for what rounding has left.
      if (const ProfileTicks rest = length_ - ramp_.length; rest > 0) {
        const std::int64_t left = set_point_ - to_ + distance_of(after_, rest);
        ramp_.after = after_ =
            with_sign_of(left, velocity_over(static_cast<std::uint64_t>(absolute(left)), rest));
      }
      to_ = set_point_;
      return true;
    }
  }
  ramp_to(with_sign_of(sign, opposed(missing, sign) ? last : most), reach);
  return false;
}

/// To the set-point, and to `speed` there, planned in a frame that goes along at that speed. False: it would
/// turn round in that frame, where the limits of acceleration then change places.
bool LinearInterpolator::plan(std::int64_t speed, const Reach& reach) {
  const ProfileState& from = ramp_.from;
  const std::int64_t goal = set_point_ - distance_of(speed, length_);
  const std::int64_t way = goal - from.position, own = from.velocity - speed;
  ProfileLimits limits = reach.limits.profile;
  std::int64_t most = reach.fastest;
  if (speed != 0) {
    const bool ahead = opposed(way, speed);
    if ((opposed(own, way) && absolute(own) > kLeastSpeed) || opposed(from.velocity, speed) ||
        way_to_rest(absolute(own), ahead ? reach.speed_up : reach.slow_down) > absolute(way))
      return false;
    most = ahead ? absolute(speed) : most - absolute(speed);
    if (ahead) std::swap(limits.acceleration, limits.deceleration);
  }
  limits.velocity = static_cast<std::uint32_t>(counts_per_second(most));
  profile_.move(start_, {from.position, own}, goal, limits);
  take_profile(speed);
  return true;
}

void LinearInterpolator::take_profile(std::int64_t speed) {
  const ProfileState last = profile_.at(end());
  planned_ = true;
  speed_ = speed;
  after_ = last.velocity + speed;
  to_ = last.position + distance_of(speed, length_);
}

void LinearInterpolator::choose(std::int64_t step, std::int64_t before, const Reach& reach) {
  const std::int64_t size = absolute(step);
  // A jump: farther than its fastest, and not by rounding.
  const std::int64_t farthest = distance_of(reach.fastest, length_);
  const bool goes_on = step != 0 && before != 0 && !opposed(step, before) && size - (size >> 10) <= farthest;
  // Its speed at the end if it goes on to change as it does: a master brakes to a standstill within a third
  // of the way of the period before.
  const std::int64_t three = goes_on ? std::max<std::int64_t>(size * 3 - absolute(before), 0) : 0;
  const std::int64_t last = speed_over(three / 2, length_, reach.fastest), speed = with_sign_of(step, last);
  const bool planned = plan(speed, reach);
  if (last == 0 || (planned && size < absolute(before) && profile_.end() <= end())) return;
  if (!meet(step > 0, last, reach) && planned) return take_profile(speed);
  planned_ = false;
}

std::int64_t LinearInterpolator::go(ProfileTicks now, std::int64_t target, ProfileTicks period,
                                    const Limits& limits) {
  const ProfileState here = at(now);
  const std::int64_t wanted = target;
  target = std::clamp(target, here.position - kFar, here.position + kFar);
  std::int64_t step = std::clamp(target - set_point_, -kFar, kFar);
  // Where SYNC was missing it is the way of several periods.
  if (const ProfileTicks since = now - start_; length_ > 0 && since > length_ + length_ / 2)
    step /= (since + length_ / 2) / length_;
  const std::int64_t before = std::exchange(step_, step);
  set_point_ = target;
  start_ = now;
  length_ = std::max<ProfileTicks>(period, 1);
  if (planned_ && speed_ == 0 && profile_.target() == target) {
    take_profile(0);  // on its way to stop there it goes on with what is planned
  } else {
    ramp_.start = now;
    ramp_.from = here;
    stop_.start = kNever;
    const Reach reach{.limits = limits,
                      .fastest = velocity_from(std::max<std::uint32_t>(limits.profile.velocity, 1)),
                      .speed_up = acceleration_from(limits.profile.acceleration),
                      .slow_down = acceleration_from(limits.profile.deceleration)};
    choose(step, before, reach);
    heed_limits(reach);
  }
  const std::int64_t half = wanted / 2 - to_ / 2;  // the difference itself may be beyond 64 bits
  return to_ == wanted ? 0 : std::min(absolute(half), kFar) * 2 + 1;
}

/// What does not end at rest must be able to stop in time, also where the next SYNC is late or does not come.
void LinearInterpolator::heed_limits(const Reach& reach) {
  if ((planned_ && speed_ == 0) || after_ == 0) return;
  const std::int64_t wall = after_ > 0 ? reach.limits.high : reach.limits.low;
  // How far it may go on before it brakes.
  const auto room = [&](const ProfileState& from) {
    const std::int64_t limit = std::clamp(wall, from.position - kFar, from.position + kFar);
    return with_sign_of(from.velocity, limit - from.position) -
           way_to_rest(absolute(from.velocity), reach.slow_down);
  };
  stop_.from = {to_, after_};
  stop_.start = end();
  std::int64_t left = room(stop_.from);
  if (left < 0) {  // too fast at the end: no faster than it is
    planned_ = false;
    ramp_to(ramp_.from.velocity, reach);
    stop_.from = ramp_.from;
    stop_.start = start_;
    left = std::max<std::int64_t>(room(stop_.from), 0);
  }
  const std::int64_t speed = absolute(stop_.from.velocity);
  if (left >= distance_of(speed, kLongest)) {
    stop_.start = kNever;
    return;
  }
  // Whole ticks: 24 bits less than a velocity has.
  const ProfileTicks ticks = speed == 0 ? 0 : velocity_over(static_cast<std::uint64_t>(left), speed);
  stop_.start += ticks;
  stop_.from.position += with_sign_of(stop_.from.velocity, distance_of(speed, ticks));
  stop_.acceleration = with_sign_of(-stop_.from.velocity, reach.slow_down);
  stop_.length = (speed << 4) / reach.slow_down;
  const ProfileState last = at(end());
  to_ = last.position;
  after_ = last.velocity;
}

ProfileState LinearInterpolator::at(ProfileTicks time) const {
  if (time >= stop_.start) return stop_.at(time);
  const bool rests = planned_ && speed_ == 0;
  const ProfileTicks t = std::clamp<ProfileTicks>(time - start_, 0, length_ + kLongest);
  if (t >= length_ && !rests) return {to_ + distance_of(after_, t - length_), after_};
  if (!planned_) return ramp_.at(time);
  const ProfileState own = profile_.at(time);
  return {own.position + distance_of(speed_, t), own.velocity + speed_};
}

}  // namespace kinebus
