#include "node_firmware/heat/heat_tuning.hpp"

#include <algorithm>

#include "node_firmware/heat/elementary.hpp"

namespace kinebus::heat {
namespace {

constexpr double kTickSeconds = 0.1;
constexpr std::int32_t kRise = 2'000;  // mC: surely above the noise
/// The search ends when a step of this share finds nothing better.
constexpr double kFirstStep = 0.5, kLastStep = 0.01;
constexpr double kLeastTime = 0.05;  // s

}  // namespace

void HeatTuning::begin(std::int32_t measured, std::int32_t target, std::int32_t limit) {
  failure_ = Failure::kNone;
  ticks_ = off_at_ = peak_at_ = rise_at_ = 0;
  count_ = 0;
  ticks_a_sample_ = 1;
  in_sample_ = 0;
  power_sum_ = 0;
  result_ = {};
  residual_mc_ = 0;
  if (target - measured < kLeastWay) {
    fail(Failure::kTargetTooNear);
    return;
  }
  state_ = State::kHeating;
  start_ = measured;
  // What is under way when power goes off is not known yet: it is measured here.
  switch_off_ = measured + (target - measured) / 2;
  limit_ = limit;
  record(measured, 0);
}

std::uint32_t HeatTuning::fail(Failure failure) {
  failure_ = failure;
  state_ = State::kFailed;
  return 0;
}

void HeatTuning::record(std::int32_t measured, std::uint32_t power) {
  power_sum_ += power;
  if (count_ != 0 && ++in_sample_ < ticks_a_sample_) return;
  if (count_ == kSamples) {
    // Every second one stays, and the next take twice as long. The first stays the first.
    for (std::size_t i = 1; 2 * i < kSamples; ++i) {
      measured_[i] = measured_[2 * i];
      power_[i] = (power_[2 * i] + power_[2 * i - 1]) / 2;
    }
    count_ = kSamples / 2;
    ticks_a_sample_ *= 2;
    // The last old sample and the one that has just ended are the next new one.
    power_sum_ += static_cast<std::uint64_t>(power_[kSamples - 1]) * in_sample_;
    in_sample_ = ticks_a_sample_;
  }
  measured_[count_] = measured;
  power_[count_] = static_cast<std::uint32_t>(power_sum_ / std::max<std::uint32_t>(in_sample_, 1));
  ++count_;
  in_sample_ = 0;
  power_sum_ = 0;
}

std::uint32_t HeatTuning::step(std::int32_t measured, std::uint32_t power) {
  if (!running()) return 0;
  ++ticks_;
  if (state_ == State::kFitting) {
    search();
    return 0;
  }
  record(measured, power);
  if (ticks_ > kLongest) return fail(Failure::kTooLong);
  if (measured > limit_) return fail(Failure::kTooHot);
  if (rise_at_ == 0 && measured > start_ + kRise) rise_at_ = ticks_;
  if (state_ == State::kHeating) {
    if (rise_at_ == 0 && ticks_ > kNoRiseAfter) return fail(Failure::kNoRise);
    if (measured < switch_off_) return kFullPower;
    state_ = State::kCoasting;
    off_at_ = ticks_;
    peak_ = measured;
    peak_at_ = ticks_;
    return 0;
  }
  if (measured > peak_) {
    peak_ = measured;
    peak_at_ = ticks_;
  }
  // Half as long again as the rise, and past the peak: enough of the way down for the loss.
  if (ticks_ >= off_at_ + off_at_ / 2 + 50 && ticks_ > 2 * peak_at_ - off_at_ + 20) begin_search();
  return 0;
}

// With dead time and lag given, ts - start = rate * integral(delayed and lagged power) - loss * integral(ts -
// room): two unknowns, straight.
HeatTuning::Trial HeatTuning::fit(double dead_s, double lag_s) const {
  Trial trial{.dead_s = dead_s, .lag_s = lag_s};
  const double dt = kTickSeconds * ticks_a_sample_;
  const double stays = exponential(-dt / lag_s);
  const double whole = dead_s / dt;
  const auto shift = static_cast<std::size_t>(whole);
  const double part = whole - static_cast<double>(shift);
  const auto power_at = [&](std::size_t i, std::size_t back) {
    return i > back ? power_[i - back] * (1.0 / kFullPower) : 0.0;
  };
  double lagged = 0, heat = 0, warmth = 0;
  double hh = 0, hw = 0, ww = 0, hy = 0, wy = 0, yy = 0;
  double before = (start_ - kRoom) / 1000.0;
  for (std::size_t i = 1; i < count_; ++i) {
    const double power = power_at(i, shift) * (1 - part) + power_at(i, shift + 1) * part;
    heat += power * dt + (lagged - power) * lag_s * (1 - stays);
    lagged = power + (lagged - power) * stays;
    const double above = (measured_[i] - kRoom) / 1000.0;
    warmth += (above + before) / 2 * dt;
    before = above;
    const double y = (measured_[i] - start_) / 1000.0;
    hh += heat * heat;
    hw += heat * warmth;
    ww += warmth * warmth;
    hy += heat * y;
    wy += warmth * y;
    yy += y * y;
  }
  const double determinant = hh * ww - hw * hw;
  if (determinant <= 1e-9 * hh * ww) return trial;
  trial.rate = (hy * ww - wy * hw) / determinant;
  trial.loss = (hy * hw - wy * hh) / determinant;
  if (trial.loss < 0) {
    trial.loss = 0;
    trial.rate = hy / hh;
  }
  trial.residual = (yy - 2 * trial.rate * hy + 2 * trial.loss * wy + trial.rate * trial.rate * hh -
                    2 * trial.rate * trial.loss * hw + trial.loss * trial.loss * ww) /
                   static_cast<double>(count_);
  return trial;
}

void HeatTuning::begin_search() {
  state_ = State::kFitting;
  // From switching off to the peak is about dead time and lag together.
  const double both = std::max(static_cast<double>(peak_at_ - off_at_) * kTickSeconds, 0.5);
  best_ = fit(both / 3, both / 2);
  step_ = kFirstStep;
  direction_ = 0;
  improved_ = false;
}

void HeatTuning::search() {
  const double factor = (direction_ & 1) == 0 ? 1 + step_ : 1 / (1 + step_);
  double dead = best_.dead_s, lag = best_.lag_s;
  // Of one alone, and of both against each other: a little more dead time looks much like a little more lag.
  switch (direction_ / 2) {
    case 0:
      dead *= factor;
      break;
    case 1:
      lag *= factor;
      break;
    default:
      lag = std::max(lag + dead * (1 - factor), kLeastTime);
      dead *= factor;
      break;
  }
  const Trial trial = fit(std::clamp(dead, kLeastTime, 12.0), std::clamp(lag, kLeastTime, 60.0));
  if (trial.residual < best_.residual) {
    best_ = trial;
    improved_ = true;
  }
  if (++direction_ < 6) return;
  direction_ = 0;
  if (!improved_) step_ /= 2;
  improved_ = false;
  if (step_ < kLastStep) finish();
}

void HeatTuning::finish() {
  const auto rounded = [](double value) { return nearest_whole(std::clamp(value, 0.0, 1e9)); };
  result_ = {.rate_mc_per_s = rounded(best_.rate * 1000),
             .loss_ppm_per_s = rounded(best_.loss * 1e6),
             .lag_ms = std::max<std::uint32_t>(rounded(best_.lag_s * 1000), 100),
             .dead_ms = rounded(best_.dead_s * 1000)};
  residual_mc_ = rounded(square_root(best_.residual) * 1000);
  // A curve of another kind: half a degree and 2 % of the rise are noise and the lumps that the model leaves
  // out.
  const std::uint32_t allowed = 500 + static_cast<std::uint32_t>(peak_ - start_) / 50;
  if (!result_.usable() || residual_mc_ > allowed) {
    fail(Failure::kNoModel);
    return;
  }
  state_ = State::kDone;
}

}  // namespace kinebus::heat
