#include "gateway/motion/speed_ramp.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {
// Newton's method converges in four to six steps; where the speed begins at 0 halving takes over.
constexpr int kMostSteps = 80;
}  // namespace

double SpeedRamp::Stage::time_of(double distance) const {
  double low = 0, high = duration_s;
  if (!(distance > 0)) return 0;
  if (distance >= way(high)) return high;
  double t = std::min(high, distance / std::max(0.5 * (speed + speed_at(high)), 1e-300));
  for (int i = 0; i < kMostSteps; ++i) {
    const double miss = way(t) - distance;
    (miss > 0 ? high : low) = t;
    const double v = speed_at(t);
    double next = v > 0 ? t - miss / v : 0.5 * (low + high);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-15 * duration_s) return next;
    t = next;
  }
  return t;
}

SpeedRamp::SpeedRamp(double from, double to, double accel, double jerk) : from_(from), to_(to) {
  const double change = std::abs(to - from);
  if (change * jerk >= accel * accel) {
    jerk_s_ = accel / jerk;
    even_s_ = change / accel - jerk_s_;
  } else {
    jerk_s_ = std::sqrt(change / jerk);
  }
  jerk_ = to < from ? -jerk : jerk;
}

SpeedRamp::Stage SpeedRamp::stage(int index) const {
  const double accel = jerk_ * jerk_s_;
  const double gained = 0.5 * accel * jerk_s_;
  if (index == 0) return {jerk_s_, from_, 0, jerk_};
  if (index == 1) return {even_s_, from_ + gained, accel, 0};
  return {jerk_s_, to_ - gained, accel, -jerk_};
}

double SpeedRamp::speed_after(double distance) const {
  for (int i = 0; i < kStages; ++i) {
    const Stage s = stage(i);
    const double way = s.way(s.duration_s);
    if (distance <= way) return s.speed_at(s.time_of(distance));
    distance -= way;
  }
  return to_;
}

}  // namespace kinebus
