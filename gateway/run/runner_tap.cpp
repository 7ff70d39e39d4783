// Taps: the spindle is turned back at the bottom of the hole, and the tool is where its angle says, in,
// through the turn, and out. Path time goes on all the while: where the plan slows down, turns back and is
// fast again it goes at the rate at which plan and spindle do so together.

#include <algorithm>
#include <cmath>

#include "gateway/run/runner.hpp"
#include "gateway/run/thread_control.hpp"

namespace kinebus {
namespace {

constexpr double kOfTapSpeed = 1e-4;  // rounding of the planner
/// The corner is looked for in such steps of path time, and found within the second.
constexpr PathTime kCornerStep = std::chrono::milliseconds{2};
constexpr PathTime kPlace = std::chrono::microseconds{1};
/// Path time that goes to a place on the way is looked for from so much before to so much behind.
constexpr PathTime kPlaceBefore = std::chrono::milliseconds{60},
                   kPlaceBehind = std::chrono::milliseconds{120};
constexpr double kTurned_mm_per_s = 1e-6;

double onward(const PosePoint& a, const PosePoint& b, const Pose& way) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (b.x[i] - a.x[i]) * way[i];
  return sum;
}
double between(const PosePoint& a, const PosePoint& b) {
  return std::hypot(a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]);
}
double tap_speed(const PosePoint& point) {
  return std::hypot(point.x1[0], point.x1[1], point.x1[2]);
}

}  // namespace

void Runner::begin_tap(const canonical::SpindleSync& sync) {
  tap_ = {};
  tap_.deep_mm = sync.turns_back_mm;
  if (!(sync.rpm > 0)) return;
  tap_.pitch_mm = sync.feed_per_s * 60 / sync.rpm;
  tap_.feed_per_s = sync.feed_per_s;
  tap_.told_rpm = heat_.spindle().target_rpm;
  tap_.spindle.begin(TapTurn(machine_, std::abs(tap_.told_rpm)), tap_.told_rpm);
}

/// Turned back, the encoder counts down.
void Runner::look_at_spindle() {
  const SpindleStatus spindle = heat_.spindle();
  follower_.look(spindle.angle, tap_.deep_mm > 0 && spindle.actual_rpm * tap_.told_rpm < 0);
}

std::optional<PosePoint> Runner::tap_point(PathTime tau) const {
  Frame frame{};
  std::uint32_t line = 0;
  return feed_.pose(tau, frame, line);
}

/// As far as the plan is known.
void Runner::find_corner() {
  const auto turned_back = [this](const PosePoint& point) {
    return onward(tap_.start, point, point.x1) < -kTurned_mm_per_s;
  };
  while (!tap_.corner) {
    const auto point = tap_point(tap_.looked + kCornerStep);
    if (!point) return;
    if (!turned_back(*point)) {
      tap_.looked += kCornerStep;
      continue;
    }
    PathTime from = tap_.looked, to = tap_.looked + kCornerStep;
    while (to - from > kPlace) {
      const PathTime middle = from + (to - from) / 2;
      (turned_back(*tap_point(middle)) ? to : from) = middle;
    }
    tap_.corner = to;
    tap_.ground = *tap_point(to);
  }
}

/// Of the tool on its way in and out, mm from its start.
double Runner::tap_way(PathTime tau) const {
  const auto point = tap_point(tau);
  if (!point) return 0;
  if (!tap_.corner || tau <= *tap_.corner) return between(tap_.start, *point);
  return tap_.deep_mm + between(tap_.ground, *point);
}

/// Where the spindle's angle wants it then.
double Runner::tap_goal(BusTime at) const {
  const double depth =
      std::min(tap_.deep_mm, tap_.pitch_mm * follower_.turned(at) - tap_.run_in_mm.value_or(0));
  const bool out = tap_.spindle.turns_back() && follower_.turns_per_s(at) < 0;
  return out ? 2 * tap_.deep_mm - depth : depth;
}

/// When the plan is there; the way grows with path time.
PathTime Runner::tap_place(double way, PathTime near) const {
  const auto known = PathTime{std::llround(group_.sampler().end_s() * 16e6)};
  PathTime from = std::max(group_.run_start(), near - kPlaceBefore);
  PathTime to = std::min(group_.run_start() + known, near + kPlaceBehind);
  while (to - from > kPlace) {
    const PathTime middle = from + (to - from) / 2;
    (tap_way(middle) < way ? from : to) = middle;
  }
  return from + (to - from) / 2;
}

void Runner::turn_spindle_back(BusTime now) {
  const double left =
      (tap_.deep_mm - tap_.pitch_mm * follower_.turned(now) + *tap_.run_in_mm) / tap_.pitch_mm;
  if (const auto rpm = tap_.spindle.look(now, left, follower_.turns_per_s(now)))
    heat_.execute(canonical::Spindle{*rpm});
}

void Runner::follow_tap(BusTime now) {
  if (!(tap_.deep_mm > 0)) return;
  find_corner();
  if (tap_.run_in_mm) return turn_spindle_back(now);
  const PathTime tau = rate_.tau(now + ThreadControl::kAhead);
  const auto point = tap_point(tau);
  if (!point || tap_speed(*point) <= tap_.feed_per_s * (1 - kOfTapSpeed)) return;
  tap_.run_in_mm = tap_.feed_per_s * to_seconds(tau - follower_.start_tau()) - tap_way(tau);
}

std::optional<double> Runner::tap_rate(BusTime now) {
  const BusTime then = now + ThreadControl::kAhead;
  const PathTime tau = rate_.tau(then);
  const auto point = tap_point(tau);
  if (!point) return std::nullopt;
  const bool fast = tap_speed(*point) > tap_.feed_per_s * (1 - kOfTapSpeed);
  const bool out = tap_.corner && tau > *tap_.corner;
  // Out of the hole, on its way to rest.
  if (tap_.fast_out && !fast) return std::nullopt;
  tap_.fast_out = tap_.fast_out || (out && fast);
  const double error = (tap_goal(then) - tap_way(tau)) / tap_.pitch_mm;
  if (std::abs(error) > ThreadControl::kLost_turns) {
    lose_thread(error);
    return std::nullopt;
  }
  const PathTime wanted = tap_place(tap_goal(then), tau);
  const auto missing = to_seconds(wanted - tau) / ThreadControl::kCatchUp_s;
  if (tap_.fast_out) return -follower_.ratio(then + ThreadControl::kPeriod) + missing;
  // The mean about where the ramp to it ends.
  const BusTime about = then + ThreadControl::kPeriod, half = ThreadControl::kPeriod / 2;
  const PathTime goes = tap_place(tap_goal(about + half), tau) - tap_place(tap_goal(about - half), tau);
  return to_seconds(goes) / to_seconds(ThreadControl::kPeriod) + missing;
}

}  // namespace kinebus
