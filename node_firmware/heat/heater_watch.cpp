#include "node_firmware/heat/heater_watch.hpp"

#include <utility>

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kHotTicks = 3;      // the noise of a mean of 8 samples is far below
constexpr std::uint32_t kModelTicks = 8;    // the observer has its own patience
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
                              const ThermalModel* model) {
  if (lasts(hot_, measured > settings_.limit_mc, kHotTicks)) return HeaterFault::kTooHot;
  return model != nullptr ? by_model(*model) : by_rules(measured, power, target);
}

HeaterFault HeaterWatch::by_model(const ThermalModel& model) {
  const std::int32_t share = model.disturbance();
  if (lasts(missing_, share < -per_cent(settings_.most_missing), kModelTicks))
    return HeaterFault::kHeatMissing;
  if (lasts(unasked_, share > per_cent(settings_.most_unasked), kModelTicks))
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
