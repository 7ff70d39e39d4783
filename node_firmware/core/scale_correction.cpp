#include "node_firmware/core/scale_correction.hpp"

#include <algorithm>
#include <chrono>

namespace kinebus {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 32;
/// 2^32 / 1e6: counts a second as 32 fractional bits a microsecond.
constexpr std::int64_t kQ32PerUs = 4295;
/// An error is followed with a time constant of 128 looks: 1.3 s.
constexpr std::int64_t kLooks = 128;
/// Faster than this many counts of the scale in a look (10 mm/s at 0.01 mm), what is read is the motion's
/// lag.
constexpr std::int64_t kSlowPulses = 10;
/// A scale stands when it has not counted on a way of so many of its counts, the play of the drive included.
constexpr std::int64_t kStandsPulses = 20;
/// Far beyond what either can be: no product leaves 64 bits.
constexpr std::int64_t kFarthest = std::int64_t{1} << 30;

constexpr std::int64_t magnitude(std::int64_t v) {
  return v < 0 ? -v : v;
}

}  // namespace

std::int64_t ScaleCorrection::at(LocalTime when) const {
  const std::int64_t way = target_q32_ - from_q32_;
  if (way == 0 || when <= since_) return from_q32_;
  constexpr std::int64_t kLong_us = 10'000'000;
  const std::int64_t us = std::min<std::int64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(when - since_).count(), kLong_us);
  const std::int64_t gone = slope_q32_per_us_ * us;
  if (gone >= magnitude(way)) return target_q32_;
  return way < 0 ? from_q32_ - gone : from_q32_ + gone;
}

void ScaleCorrection::aim(LocalTime now, std::int64_t target_q32, std::int64_t counts_per_s) {
  from_q32_ = at(now);
  since_ = now;
  target_q32_ = target_q32;
  slope_q32_per_us_ = std::clamp<std::int64_t>(counts_per_s, 0, 100'000) * kQ32PerUs;
}

void ScaleCorrection::hold(LocalTime now) {
  if (!running()) return;
  last_.reset();
  aim(now, at(now), 0);
}

ScaleCorrection::Finding ScaleCorrection::look(const Settings& settings, const Seen& seen) {
  if (!last_) {
    last_ = counted_ = seen;
    home_q32_ = at(seen.now);
    return Finding::kGood;
  }
  const std::int64_t moved = magnitude(seen.command - last_->command);
  if (seen.scale != counted_->scale) counted_ = seen;
  const std::int64_t silent = magnitude(seen.command - counted_->command);
  last_ = seen;
  const auto motor_counts = [&](std::int64_t pulses) {
    return (std::clamp(pulses, -kFarthest, kFarthest) * settings.ratio_q16) >> 16;
  };
  if (moved != 0 && silent > settings.most_counts + magnitude(motor_counts(kStandsPulses)))
    return Finding::kStands;
  if (moved > magnitude(motor_counts(kSlowPulses))) {
    // What was aimed at before the axis became fast is no longer known to be right.
    aim(seen.now, at(seen.now), 0);
    return Finding::kGood;
  }
  const std::int64_t lags =
      std::clamp(seen.command - motor_counts(seen.scale), -kFarthest / 2, kFarthest / 2);
  const std::int64_t led_q32 = at(seen.now) - home_q32_;
  const std::int64_t drift = led_q32 / kOne + lags;
  const std::int64_t most_q32 = std::min(settings.most_counts, kFarthest / 2) * kOne;
  // Less than half a count of the scale is nothing that it says.
  const std::int64_t least = magnitude(motor_counts(1)) / 2;
  if (magnitude(lags) <= least) {
    aim(seen.now, at(seen.now), 0);
  } else {
    const std::int64_t wanted = led_q32 + lags * (kOne / kLooks);
    aim(seen.now, home_q32_ + std::clamp(wanted, -most_q32, most_q32), settings.counts_per_s);
  }
  return magnitude(drift) > settings.most_counts && moved != 0 ? Finding::kFarAway : Finding::kGood;
}

}  // namespace kinebus
