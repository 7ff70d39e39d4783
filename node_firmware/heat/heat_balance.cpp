#include "node_firmware/heat/heat_balance.hpp"

#include <algorithm>

namespace kinebus::heat {
namespace {

/// Of one tick's measurement, rms: mC. A thermistor at 210 C with 12 bits.
constexpr std::int64_t kNoise = 20;
/// What noise may make of the share, rms: 3 % of full power.
constexpr std::int64_t kShareOfNoise = 33;

}  // namespace

void HeatBalance::configure(const ThermalModel& model) {
  // The second difference of means over n ticks, 4 n apart, has sqrt(6 / n) of the noise; undoing the lag
  // multiplies it by lag / (4 n)^2.
  const auto lag = static_cast<std::int64_t>(model.parameters().lag_ms) / kTickMs;
  const std::int64_t rate =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(model.parameters().rate_mc_per_s) * kTickMs / 1000);
  const std::int64_t wanted = kNoise * kShareOfNoise * lag / rate;  // of 16 n^2 sqrt(n / 6)
  const auto enough = [&](std::int64_t n) { return 128 * n * n * n * n * n / 3 >= wanted * wanted; };
  ticks_ = 1;
  while (ticks_ <= kMostTicks && !enough(ticks_)) ++ticks_;
  if (ticks_ > kMostTicks) ticks_ = 0;
  start();
}

bool HeatBalance::step(std::int32_t measured, const ThermalModel& model) {
  if (ticks_ == 0) return false;
  const std::int32_t power = model.arriving_power();
  if (in_step_ == 0) {
    measured_sum_ = expected_sum_ = power_sum_ = 0;
    now_.least = now_.most = power;
  }
  measured_sum_ += measured;
  expected_sum_ += model.expected_gain();
  power_sum_ += power;
  now_.least = std::min(now_.least, power);
  now_.most = std::max(now_.most, power);
  if (++in_step_ < ticks_) return false;
  in_step_ = 0;
  const auto mean = [&](std::int64_t sum) { return static_cast<std::int32_t>(sum / ticks_); };
  now_.measured = mean(measured_sum_ * 16);
  now_.expected = mean(expected_sum_);
  now_.power = mean(power_sum_);
  now_.disturbance = model.disturbance();
  at_ = (at_ + 1) & (kKept - 1);
  steps_[at_] = now_;
  if (seen_ < kKept) ++seen_;
  if (seen_ < kKept) return false;
  judge(model);
  return true;
}

void HeatBalance::judge(const ThermalModel& model) {
  constexpr auto span = static_cast<std::int64_t>(kSpan);
  const auto at = [&](std::size_t steps) { return std::int64_t{before(steps).measured}; };
  const auto ticks = static_cast<std::int64_t>(ticks_) * span;
  // Gained in the middle of two spans, and what the lag still hides of it: 8 fractional bits, a tick.
  const std::int64_t gained = (at(kSpan / 2) - at(kSpan / 2 + kSpan)) * 16 / ticks;
  const std::int64_t bend = (at(0) - 2 * at(kSpan) + at(2 * kSpan)) * 16 / ticks;
  const std::int64_t hidden = bend * model.parameters().lag_ms / (kTickMs * ticks);
  std::int64_t expected = 0, power = 0;
  for (std::size_t i = kSpan / 2; i < kSpan / 2 + kSpan; ++i) {
    expected += before(i).expected;
    power += before(i).power;
  }
  std::int32_t least = before(0).least, most = before(0).most;
  for (std::size_t i = 1; i < 3 * kSpan; ++i) {
    least = std::min(least, before(i).least);
    most = std::max(most, before(i).most);
  }
  share_ = {.unexplained = model.share_of_rise(gained + hidden - expected / span),
            .before = before(3 * kSpan).disturbance,
            .power = static_cast<std::int32_t>(power / span),
            .spread = most - least};
}

}  // namespace kinebus::heat
