#include "node_firmware/heat/heater_watch.hpp"

#include <algorithm>
#include <utility>

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kHotTicks = 3;      // the noise of a mean of 8 samples is far below
constexpr std::uint32_t kModelTicks = 8;    // the observer has its own patience
constexpr std::int32_t kTakenTicks = 100;   // to be forgotten
constexpr std::int32_t kLeastRise = 2'000;  // mC
constexpr std::int32_t kAway = 15'000;      // mC
constexpr std::uint32_t kAwayTicks = 50;
constexpr std::uint32_t kTicksPerSecond = 10;
/// A block that was switched off goes on warming by what is on its way.
constexpr std::uint32_t kStillWarming = 60 * kTicksPerSecond;

std::int32_t per_cent(std::uint8_t share) {
  return static_cast<std::int32_t>(kFullPower) * share / 100;
}

// Ticks in a row; what comes and goes is no fault.
bool lasts(std::uint32_t& ticks, bool now, std::uint32_t limit) {
  ticks = now ? ticks + 1 : 0;
  return ticks >= limit;
}

}  // namespace

void HeaterWatch::start() {
  const WatchSettings kept = settings_;
  *this = {};
  settings_ = kept;
}

HeaterFault HeaterWatch::step(std::int32_t measured, std::uint32_t power, std::int32_t target,
                              const ThermalModel* model, std::int32_t taken) {
  if (lasts(hot_, measured > settings_.limit_mc, kHotTicks)) return HeaterFault::kTooHot;
  return model != nullptr ? by_model(measured, *model, taken) : by_rules(measured, power, target);
}

// Parts of full power by which the sensor rose more than it should have over the last ticks; 0 as long as
// there is no telling. The observer follows what is missing only after its own lag; this sees a heater that
// came loose as soon as the sensor can, and needs a model that is right about dead time and lag, as a
// measured one is.
std::int32_t HeaterWatch::rise_unexplained(std::int32_t measured, const ThermalModel& model) {
  const std::int32_t gained = measured - measured_[at_];
  if (seen_ == 0) expected_sum_ = 0;
  if (seen_ < kRiseTicks) expected_[at_] = 0;
  expected_sum_ += model.expected_rise() - expected_[at_];
  measured_[at_] = measured;
  expected_[at_] = model.expected_rise();
  at_ = (at_ + 1) & (kRiseTicks - 1);
  ++seen_;
  // Until the heat from before the start has come through, it is not known.
  if (++known_ <= model.response_ticks() || seen_ <= kRiseTicks) return 0;
  const std::int64_t unexplained = static_cast<std::int64_t>(gained) * 256 - expected_sum_;
  return model.share_of_rise(unexplained / static_cast<std::int64_t>(kRiseTicks));
}

HeaterFault HeaterWatch::by_model(std::int32_t measured, const ThermalModel& model, std::int32_t taken) {
  // What was told to be taken shows as long as the observer remembers it.
  taken_ = std::max({taken, taken_ - taken_ / kTakenTicks - 1, std::int32_t{0}});
  const bool less = rise_unexplained(measured, model) < -per_cent(settings_.most_missing);
  if (lasts(rising_less_, less, kModelTicks)) return HeaterFault::kHeatMissing;
  const std::int32_t share = model.disturbance();
  if (lasts(missing_, share < -per_cent(settings_.most_missing), kModelTicks))
    return HeaterFault::kHeatMissing;
  if (lasts(unasked_, share > per_cent(settings_.most_unasked) + taken_, kModelTicks))
    return HeaterFault::kHeatUnasked;
  return HeaterFault::kNone;
}

HeaterFault HeaterWatch::by_rules(std::int32_t measured, std::uint32_t power, std::int32_t target) {
  if (target != std::exchange(last_target_, target)) {
    reached_ = false;
    away_ticks_ = 0;
  }
  // Heating: full power that does not warm.
  if (power < kFullPower / 2 || rise_ticks_ == 0 || measured >= rise_from_ + kLeastRise) {
    rise_from_ = measured;
    rise_ticks_ = 1;
  } else if (++rise_ticks_ > settings_.rise_s * kTicksPerSecond) {
    return HeaterFault::kHeatMissing;
  }
  // Holding.
  if (target != 0 && measured > target - kAway / 3 && measured < target + kAway / 3) reached_ = true;
  if (lasts(away_ticks_, reached_ && target != 0 && measured < target - kAway, kAwayTicks))
    return HeaterFault::kHeatMissing;
  // Off: what was on its way has long come, and it warms.
  off_ticks_ = power == 0 ? off_ticks_ + 1 : 0;
  if (off_ticks_ <= kStillWarming || measured < lowest_off_) lowest_off_ = measured;
  if (off_ticks_ > kStillWarming && measured > lowest_off_ + kAway) return HeaterFault::kHeatUnasked;
  return HeaterFault::kNone;
}

}  // namespace kinebus::heat
