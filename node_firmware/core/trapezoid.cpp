#include "node_firmware/core/trapezoid.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

namespace kinebus {
namespace {

// Acceleration and deceleration never take shorter than this: the velocity that the whole-tick durations give
// differs a little from the wanted one, and has to be reached without a step. 100 us.
constexpr ProfileTicks kShortest = 1600;

/// A motion in the positive direction: accelerate (or slow down) from `v0` to `peak`, cruise, decelerate to
/// rest.
struct Durations {
  ProfileTicks first = 0;
  ProfileTicks cruise = 0;
  ProfileTicks last = 0;
  std::int64_t peak = 0;
};

struct Problem {
  std::uint64_t distance = 0;  // 32 fractional bits
  std::int64_t v0 = 0;         // >= 0
  std::int64_t vmax = 1;
  std::int64_t acceleration = 1;
  std::int64_t deceleration = 1;
  bool to_rest = true;
};

// Plans aim a little below the limits (1/1024), so that a plan made anew in the middle of a motion, after
// rounding, still finds that its target can be reached within them.
constexpr std::int64_t nominal(std::int64_t limit) {
  return std::max<std::int64_t>(limit - (limit >> 10), 1);
}

[[gnu::noinline]] constexpr ProfileTicks ticks_for(std::int64_t change, std::int64_t acceleration) {
  return divide_up(change * 16, acceleration);  // 60 - 56 fractional bits
}

/// Certainly: the mean velocity that remains for `distance` in `sum` is further below v0 than `first` lets it
/// fall. As in most attempts at a stop; found without a division.
bool too_slow(const Problem& p, ProfileTicks first, std::uint64_t distance, ProfileTicks sum) {
  // So short that neither product overflows.
  if (first >= ProfileTicks{1} << 18 || sum >= ProfileTicks{1} << 29) return false;
  const std::int64_t least_peak = p.v0 - ((p.deceleration * first) >> 4);
  return least_peak > 0 && distance < static_cast<std::uint64_t>(distance_of((least_peak + 1) / 2, sum));
}

/// Peak velocity that makes the durations cover the distance exactly. False: not within the limits.
[[gnu::noinline]] bool solve_peak(const Problem& p, Durations& d) {
  const auto fixed = static_cast<std::uint64_t>(distance_of(p.v0, d.first)) / 2;
  if (fixed >= p.distance) return false;
  // distance = (v0 + peak)/2 first + peak cruise + peak/2 last
  const ProfileTicks sum = d.first + 2 * d.cruise + d.last;
  if (too_slow(p, d.first, p.distance - fixed, sum)) return false;
  // Faster than 64 bits hold.
  if (((p.distance - fixed) >> 39) >= static_cast<std::uint64_t>(sum)) return false;
  const std::int64_t half = velocity_over(p.distance - fixed, sum);
  if (half > std::max(p.vmax, p.v0) / 2) return false;
  d.peak = half * 2;
  const std::int64_t change = d.peak - p.v0;
  const bool change_ok =
      change >= 0 ? change <= (p.acceleration * d.first) >> 4 : -change <= (p.deceleration * d.first) >> 4;
  const bool last_ok = !p.to_rest || d.peak <= (p.deceleration * d.last) >> 4;
  return change_ok && last_ok;
}

[[gnu::noinline]] ProfileTicks last_for(const Problem& p, std::int64_t peak) {
  return p.to_rest ? std::max(ticks_for(peak, nominal(p.deceleration)), kShortest) : 0;
}

/// Half of `velocity` over `ticks`: the way of a ramp. nullopt: more than 64 bits hold, and so than there is
/// room for.
[[gnu::noinline]] std::optional<std::uint64_t> ramp_way(std::int64_t velocity, ProfileTicks ticks) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 63;
  const auto speed = static_cast<std::uint64_t>(velocity >> 24) + 1,
             length = static_cast<std::uint64_t>(ticks);
  // A division takes a small processor long: hardly ever is it that near.
  if (std::bit_width(speed) + std::bit_width(length) > 63 && length > kMost / speed) return std::nullopt;
  return static_cast<std::uint64_t>(distance_of(velocity, ticks)) / 2;
}

bool solve_trapezoid(const Problem& p, Durations& d) {
  const std::int64_t change = p.vmax - p.v0;
  const std::int64_t limit = nominal(change >= 0 ? p.acceleration : p.deceleration);
  d.last = last_for(p, p.vmax);
  d.first = std::max(ticks_for(change >= 0 ? change : -change, limit), kShortest);
  // Tiny limits: the small rest of velocity change that rounding leaves needs longer.
  for (int attempt = 0; attempt < 8; ++attempt, d.first *= 2) {
    const auto of_v0 = ramp_way(p.v0, d.first), of_vmax = ramp_way(p.vmax, d.first + d.last);
    if (!of_v0 || !of_vmax || *of_v0 + *of_vmax >= p.distance) return false;
    const std::uint64_t ramps = *of_v0 + *of_vmax;
    // Ticks at vmax for the rest, rounded up: the peak then comes out at or just below vmax.
    d.cruise = velocity_over(p.distance - ramps, p.vmax) + 1;
    if (solve_peak(p, d)) return true;
  }
  return false;
}

/// Peak velocity without a cruise, by energy: peak^2 = (2 distance a d + d v0^2) / (a + d). An estimate, low
/// by up to 1/16 counts/s and a 1/1000.
std::int64_t estimate_peak(const Problem& p) {
  // Accelerations back to counts/s^2: 4503.6 of their units.
  const auto a = std::max<std::uint64_t>(static_cast<std::uint64_t>(nominal(p.acceleration)) / 4504, 1);
  const auto d = std::max<std::uint64_t>(static_cast<std::uint64_t>(nominal(p.deceleration)) / 4504, 1);
  const std::uint64_t mean = p.to_rest ? std::max<std::uint64_t>(a * d / (a + d), 1) : a;
  const std::uint64_t share_q16 = p.to_rest ? (d << 16) / (a + d) : 1u << 16;
  // Velocities in 1/16 counts/s, so squares are in 1/256 and so is the distance.
  const auto v0 = static_cast<std::uint64_t>((p.v0 >> 24) * (kTicksPerSecond * 16) >> 32);
  constexpr std::uint64_t kMost = std::uint64_t{1} << 60;
  if (p.distance >> 23 > kMost / mean) return p.vmax;
  // A part of a count has few bits left after that shift.
  const bool tiny = p.distance < kOneCount;
  const std::uint64_t twice = tiny ? p.distance * mean >> 23 : (p.distance >> 23) * mean;
  const std::uint64_t peak = square_root(twice + (v0 * v0 >> 16) * share_q16);
  return std::min(static_cast<std::int64_t>(peak) * ((std::int64_t{1} << 52) / kTicksPerSecond),
                  std::max(p.vmax, p.v0));
}

bool solve_triangle(const Problem& p, Durations& d) {
  const std::int64_t peak = estimate_peak(p);
  const std::int64_t change = peak - p.v0;
  const std::int64_t limit = nominal(change >= 0 ? p.acceleration : p.deceleration);
  d.first = std::max(ticks_for(change >= 0 ? change : -change, limit), kShortest);
  d.last = last_for(p, peak);
  d.cruise = 0;
  // The estimate may be off: from rest, slower is always possible. 1.0625^30 = 6.2.
  for (int attempt = 0; attempt < 30; ++attempt) {
    if (solve_peak(p, d)) return true;
    d.first += d.first / 16 + 1;
    if (p.to_rest) d.last += d.last / 16 + 1;
  }
  return false;
}

/// One even deceleration over the whole distance: what remains when the target is just as far as braking
/// takes.
bool solve_even(const Problem& p, Durations& d) {
  if (p.v0 == 0 || !p.to_rest) return false;
  const ProfileTicks whole = velocity_over(p.distance, p.v0) * 2;
  if (whole < 2) return false;
  d.first = std::min(kShortest, whole / 2);
  d.last = whole - d.first;
  return solve_peak(p, d);
}

bool solve(const Problem& p, Durations& d) {
  if (p.distance == 0 || p.v0 < 0) return false;
  return solve_trapezoid(p, d) || solve_triangle(p, d) || solve_even(p, d);
}

Problem problem_from(ProfileState from, std::int64_t target, const ProfileLimits& limits, bool to_rest) {
  const bool up = target >= from.position;
  const auto a = static_cast<std::uint64_t>(from.position);
  const auto b = static_cast<std::uint64_t>(target);
  return {.distance = up ? b - a : a - b,
          .v0 = up ? from.velocity : -from.velocity,
          .vmax = velocity_from(std::max<std::uint32_t>(limits.velocity, 1)),
          .acceleration = acceleration_from(limits.acceleration),
          .deceleration = acceleration_from(limits.deceleration),
          .to_rest = to_rest};
}

}  // namespace

void Trapezoid::hold(std::int64_t position) {
  count_ = 0;
  end_ = {position, 0};
  end_time_ = std::numeric_limits<ProfileTicks>::min();
}

void Trapezoid::begin(ProfileTicks start) {
  count_ = 0;
  end_time_ = start;
}

void Trapezoid::add(ProfileTicks length, std::int64_t position, std::int64_t velocity,
                    std::int64_t end_velocity) {
  if (length <= 0) return;
  // As many fractional bits as the change of velocity leaves free: slow ramps are long, and their error grows
  // with the square of time.
  const std::int64_t change = end_velocity - velocity;
  const auto size = static_cast<std::uint64_t>(change < 0 ? -change : change);
  const int shift = std::countl_zero(size | 1) - 2;
  phases_[static_cast<std::size_t>(count_++)] = {.start = end_time_,
                                                 .position = position,
                                                 .velocity = velocity,
                                                 .acceleration = change * (std::int64_t{1} << shift) / length,
                                                 .shift = shift};
  end_time_ += length;
}

ProfileState Trapezoid::brake(ProfileState from, std::int64_t deceleration) {
  const std::int64_t speed = from.velocity < 0 ? -from.velocity : from.velocity;
  if (speed == 0) return from;  // no division in the main loop of a small processor
  const ProfileTicks length = ticks_for(speed, deceleration);
  add(length, from.position, from.velocity, 0);
  return {from.position + distance_of(from.velocity, length) / 2, 0};
}

void Trapezoid::run(ProfileTicks start, ProfileState from, std::int64_t target, const ProfileLimits& limits,
                    bool to_rest) {
  begin(start);
  Durations d;
  Problem problem = problem_from(from, target, limits, to_rest);
  if (!solve(problem, d)) {
    from = brake(from, problem.deceleration);
    problem = problem_from(from, target, limits, true);
    // Where it stands is where it goes: found at once, not by all that is tried in vain.
    if (!solve(problem, d)) return hold_after(from);
  }
  const std::int64_t sign = target >= from.position ? 1 : -1;
  const std::int64_t v0 = sign * problem.v0;
  const std::int64_t peak = sign * d.peak;
  const std::int64_t ramp = (distance_of(v0, d.first) + distance_of(peak, d.first)) / 2;
  add(d.first, from.position, v0, peak);
  add(d.cruise, from.position + ramp, peak, peak);
  add(d.last, target - distance_of(peak, d.last) / 2, peak, 0);
  end_ = {target, problem.to_rest ? 0 : peak};
}

void Trapezoid::hold_after(ProfileState at_rest) {
  end_ = {at_rest.position, 0};
}

void Trapezoid::move(ProfileTicks start, ProfileState from, std::int64_t target,
                     const ProfileLimits& limits) {
  run(start, from, target, limits, true);
}

void Trapezoid::pass(ProfileTicks start, ProfileState from, std::int64_t target,
                     const ProfileLimits& limits) {
  run(start, from, target, limits, false);
}

void Trapezoid::stop(ProfileTicks start, ProfileState from, std::uint32_t deceleration) {
  const std::int64_t speed = from.velocity < 0 ? -from.velocity : from.velocity;
  const std::int64_t needed = distance_of(speed, ticks_for(speed, acceleration_from(deceleration))) / 2;
  constexpr std::int64_t kFraction = kOneCount - 1;
  std::int64_t target = 0;
  if (from.velocity > 0)
    target = (from.position + needed + kFraction) & ~kFraction;
  else if (from.velocity < 0)
    target = (from.position - needed) & ~kFraction;
  else
    target = from_counts(whole_counts(from.position));
  const auto present = static_cast<std::uint32_t>(counts_per_second(speed) + 1);
  move(start, from, target, {std::max(present, kCreepSpeed), deceleration, deceleration});
}

void Trapezoid::shift(std::int64_t by) {
  for (Phase& phase : phases_) phase.position += by;
  end_.position += by;
}

ProfileTicks Trapezoid::phase_end(ProfileTicks time) const {
  for (int i = 0; i < count_; ++i)
    if (const ProfileTicks next = phases_[static_cast<std::size_t>(i)].start; next > time) return next;
  return end_time_;
}

const Trapezoid::Phase& Trapezoid::phase_at(ProfileTicks time) const {
  std::size_t i = count_ > 0 ? static_cast<std::size_t>(count_) - 1 : 0;
  while (i > 0 && time < phases_[i].start) --i;
  return phases_[i];
}

ProfileState Trapezoid::at(ProfileTicks time) const {
  if (time >= end_time_ || count_ == 0) return end_;
  const Phase& phase = phase_at(time);
  const ProfileTicks into = std::max<ProfileTicks>(time - phase.start, 0);
  const std::int64_t gained = phase.acceleration * into;
  return {phase.position + distance_of(phase.velocity + (gained >> (phase.shift + 1)), into),
          phase.velocity + (gained >> phase.shift)};
}

}  // namespace kinebus
