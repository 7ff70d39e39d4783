#include "gateway/run/spindle_follower.hpp"

#include <cmath>

namespace kinebus {
namespace {

/// How fast the estimate of angle, speed and acceleration follows the encoder.
constexpr double kPerSecond = 60;
/// Some times that: the estimate holds.
constexpr BusTime kSettle = std::chrono::milliseconds{150};

}  // namespace

void SpindleFollower::follow(double rpm) {
  planned_per_s_ = rpm / 60;
  first_.reset();
}

/// All three errors die away by exp(-kPerSecond t), whatever the times between two looks.
void SpindleFollower::look(const std::optional<SpindleAngle>& angle, bool back) {
  if (!angle) return first_.reset();
  const double dt = to_seconds(angle->at - at_);
  // The first look, or one after a hold in which the spindle may have stood.
  if (!first_ || angle->at - at_ > kSettle) {
    first_ = at_ = angle->at;
    turns_ = told_ = angle->turns;
    counted_down_ = 0;
    per_s_ = planned_per_s_;
    per_s2_ = 0;
    return;
  }
  if (!(dt > 0)) return;
  const double stays = std::exp(-kPerSecond * dt), goes = 1 - stays;
  if (back) counted_down_ += angle->turns - told_;
  told_ = angle->turns;
  const double error = told_ - 2 * counted_down_ - turns_at(angle->at);
  turns_ = turns_at(angle->at) + (1 - stays * stays * stays) * error;
  per_s_ = per_s_at(angle->at) + 1.5 * goes * goes * (1 + stays) * error / dt;
  per_s2_ += goes * goes * goes * error / (dt * dt);
  at_ = angle->at;
}

std::optional<BusTime> SpindleFollower::next_index(BusTime now, BusTime lead) const {
  if (!first_ || now - *first_ < kSettle || !(per_s_ > 0)) return std::nullopt;
  const double from = turns_at(now + lead);
  const double wait_s = (std::ceil(from) - from) / per_s_;
  if (wait_s >= to_seconds(kPatience)) return std::nullopt;
  return now + lead + BusTime{std::llround(wait_s * 1e9)};
}

void SpindleFollower::start(BusTime index, PathTime tau) {
  start_ = index;
  start_turns_ = std::round(turns_at(index));
  start_tau_ = tau;
}

double SpindleFollower::ratio(BusTime at) const {
  return per_s_at(at) / planned_per_s_;
}

std::optional<double> SpindleFollower::ratio_if_known(BusTime at) const {
  if (!first_ || at - *first_ < kSettle) return std::nullopt;
  return ratio(at);
}

double SpindleFollower::behind(BusTime at, PathTime tau) const {
  return turns_at(at) - start_turns_ - to_seconds(tau - start_tau_) * planned_per_s_;
}

}  // namespace kinebus
