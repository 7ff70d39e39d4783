#include "gateway/run/tap_spindle.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

constexpr BusTime kTellPeriod = std::chrono::milliseconds{4};
/// Half of the period, and what the spindle takes to hear of it.
constexpr double kTellAhead_s = 3e-3;
/// An angle that is wrong is caught up as fast, 1/s.
constexpr double kTapCatchUp = 40;
/// Braking begins as much earlier than the even brake would: its beginning is not missed.
constexpr double kEarly_s = 2e-3;

}  // namespace

void TapSpindle::begin(const TapTurn& turn, double rpm) {
  *this = {};
  turn_ = turn;
  rpm_ = rpm;
}

/// As planned, t after the brake began; behind the stand the same the other way.
double TapSpindle::speed_at(double t) const {
  if (t > stands_s()) return -speed_at(std::max(0.0, 2 * stands_s() - t));
  const double eased = t < ease_s_ ? t * t / (2 * ease_s_) : t - ease_s_ / 2;
  return from_per_s_ - brake_per_s2_ * eased;
}

double TapSpindle::left_at(double t) const {
  const double stands = stands_s();
  if (t > 2 * stands) return left_ + (t - 2 * stands) * from_per_s_;
  if (t > stands) t = 2 * stands - t;
  const double even = std::max(0.0, t - ease_s_), eased = std::min(t, ease_s_);
  const double lost = ease_s_ > 0 ? eased * eased * eased / (6 * ease_s_) : 0;
  return left_ - from_per_s_ * t + brake_per_s2_ * (lost + even * (ease_s_ + even) / 2);
}

std::optional<double> TapSpindle::look(BusTime now, double left, double turns_per_s) {
  if (!braked_) {
    const double even = turns_per_s * turns_per_s / (2 * turn_.turns_per_s2);
    ease_s_ = std::min(TapTurn::kEase_s, turns_per_s / turn_.turns_per_s2);
    if (!(turns_per_s > 0) || left > even + turns_per_s * (ease_s_ / 2 + kEarly_s)) return std::nullopt;
    braked_ = now;
    from_per_s_ = turns_per_s;
    left_ = std::max(left, even / 2);
    // left = v^2 / 2 a + v e / 2 - a e^2 / 24
    brake_per_s2_ = turn_.turns_per_s2;
    for (int i = 0; i < 4; ++i) {
      const double for_even = left_ - turns_per_s * ease_s_ / 2 + brake_per_s2_ * ease_s_ * ease_s_ / 24;
      brake_per_s2_ = turns_per_s * turns_per_s / (2 * std::max(for_even, even / 2));
    }
    of_told_ = std::clamp(turns_per_s / turn_.turns_per_s, 0.5, 1.2);
  } else if (done_ || now - told_at_ < kTellPeriod) {
    return std::nullopt;
  }
  told_at_ = now;
  const double t = to_seconds(now - *braked_);
  const double speed = speed_at(t + kTellAhead_s) + kTapCatchUp * (left - left_at(t));
  done_ = t >= 2 * stands_s();
  if (done_) return -rpm_;
  return rpm_ * std::clamp(speed / (of_told_ * turn_.turns_per_s), -1.0, 1.0);
}

}  // namespace kinebus
