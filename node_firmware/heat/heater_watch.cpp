#include "node_firmware/heat/heater_watch.hpp"

#include <algorithm>
#include <cstdlib>

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kHotTicks = 3;    // the noise of a mean of 8 samples is far below
constexpr std::uint32_t kModelTicks = 8;  // the observer has its own patience
constexpr std::uint32_t kBalanceSteps = 2;
constexpr std::uint32_t kQuiet = 3;  // responses of the sensor: then the observer knows what a fan takes
constexpr std::int32_t kUsualTicks = 64;
/// A part of what it gave may still come, and a part of what changed meanwhile be counted at a wrong time.
constexpr std::int32_t kOneIn = 4;
constexpr auto kLeastGiven = static_cast<std::int32_t>(kFullPower / 8);
constexpr auto kUnsure = static_cast<std::int32_t>(kFullPower / 8);
constexpr std::int32_t kTakenTicks = 100;  // to be forgotten

std::int32_t per_cent(std::uint8_t share) {
  return static_cast<std::int32_t>(kFullPower) * share / 100;
}

// Ticks in a row; what comes and goes is no fault.
bool lasts(std::uint32_t& ticks, bool now, std::uint32_t limit) {
  ticks = now ? ticks + 1 : 0;
  return ticks >= limit;
}

}  // namespace

void HeaterWatch::configure(const WatchSettings& settings, const ThermalModel* model) {
  settings_ = settings;
  if (model != nullptr) balance_.configure(*model);
  plain_.configure(settings.rise_s);
}

void HeaterWatch::start() {
  const WatchSettings kept = settings_;
  const HeatBalance balance = balance_;
  const PlainWatch plain = plain_;
  *this = {};
  settings_ = kept;
  balance_ = balance;
  plain_ = plain;
  balance_.start();
  plain_.start();
}

HeaterFault HeaterWatch::step(std::int32_t measured, std::uint32_t power, std::int32_t target,
                              const ThermalModel* model, std::int32_t taken, bool quiet) {
  if (lasts(hot_, measured > settings_.limit_mc, kHotTicks)) return HeaterFault::kTooHot;
  // What was told to be taken shows as long as the observer remembers it.
  taken_ = std::max({taken, taken_ - taken_ / kTakenTicks - 1, std::int32_t{0}});
  // What was told may be wrong by half of what has changed.
  usual_ += (taken * 256 - usual_) / kUsualTicks;
  doubt_ = std::max(std::abs(taken - usual_ / 256) / 2, doubt_ - doubt_ / kUsualTicks);
  quiet_ = quiet ? quiet_ + 1 : 0;
  if (model != nullptr) return by_model(measured, *model);
  switch (plain_.step({measured, power, target, taken_ + doubt_, quiet_})) {
    case PlainWatch::Found::kMissing:
      return HeaterFault::kHeatMissing;
    case PlainWatch::Found::kUnasked:
      return HeaterFault::kHeatUnasked;
    default:
      return HeaterFault::kNone;
  }
}

// What a loose heater takes away at once is all that it gave. Where fans and filament are known to be as they
// were, nothing else takes so much.
HeaterFault HeaterWatch::by_balance(const HeatBalance::Share& share, std::uint32_t response) {
  const std::int32_t given = share.power - share.power / kOneIn, unsure = share.spread / kOneIn / 2;
  const bool quiet = quiet_ > kQuiet * response;
  const std::int32_t fresh = share.unexplained - std::min(share.before, std::int32_t{0});
  const bool less = share.unexplained < -per_cent(settings_.most_missing) - unsure ||
                    (quiet && share.power > kLeastGiven && fresh < -given - unsure - doubt_);
  if (lasts(less_, less, kBalanceSteps)) return HeaterFault::kHeatMissing;
  const bool more = share.unexplained > per_cent(settings_.most_unasked) + kUnsure + taken_ + unsure;
  return lasts(more_, more, kBalanceSteps) ? HeaterFault::kHeatUnasked : HeaterFault::kNone;
}

HeaterFault HeaterWatch::by_model(std::int32_t measured, const ThermalModel& model) {
  // Until the heat from before the start has come through, it is not known.
  if (known_ <= model.response_ticks()) ++known_;
  if (balance_.step(measured, model) && known_ > model.response_ticks()) {
    const HeaterFault found = by_balance(balance_.share(), model.response_ticks());
    if (found != HeaterFault::kNone) return found;
  }
  const std::int32_t share = model.disturbance();
  if (lasts(missing_, share < -per_cent(settings_.most_missing), kModelTicks))
    return HeaterFault::kHeatMissing;
  if (lasts(unasked_, share > per_cent(settings_.most_unasked) + taken_, kModelTicks))
    return HeaterFault::kHeatUnasked;
  return HeaterFault::kNone;
}

}  // namespace kinebus::heat
