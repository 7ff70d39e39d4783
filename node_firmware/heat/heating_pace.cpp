#include "node_firmware/heat/heating_pace.hpp"

#include <algorithm>

#include "node_firmware/heat/thermal_model.hpp"

namespace kinebus::heat {
namespace {

/// It has warmed by so much: then it has shown how fast it can. mC.
constexpr std::int32_t kClimbed = 30'000;
/// mC a tick. What is slower, a chamber, is warmed by others as well, which go on and off; a slope of it is
/// noise, too.
constexpr std::int32_t kLeastRate = 40;
constexpr std::uint32_t kInARow = 2;
/// Losses that a fan has shown are remembered for minutes.
constexpr std::int32_t kForget = 256;

}  // namespace

void HeatingPace::start() {
  const std::uint32_t step_ticks = step_ticks_;
  *this = {};
  step_ticks_ = step_ticks;
}

bool HeatingPace::step(std::int32_t measured, std::uint32_t power, std::int32_t most) {
  least_ = ticks_ == 0 ? power : std::min(least_, power);
  sum_ += measured;
  if (++ticks_ < step_ticks_) return false;
  at_ = (at_ + 1) % kSteps;
  steps_[at_] = {static_cast<std::int32_t>(sum_ / static_cast<std::int64_t>(ticks_)), least_, 0};
  lowest_ = seen_ == 0 ? steps_[at_].measured : std::min(lowest_, steps_[at_].measured);
  seen_ = std::min(seen_ + 1, kSteps);
  sum_ = 0;
  ticks_ = 0;
  return judge(most);
}

bool HeatingPace::judge(std::int32_t most) {
  if (seen_ <= 2 * kSlope) return false;
  const std::int32_t slope = before(0).measured - before(kSlope).measured;
  // A sensor that is moved in its hole jumps once.
  gain_ = std::max(gain_, std::min(slope, before(kSlope).measured - before(2 * kSlope).measured));
  const std::int32_t least = kLeastRate * static_cast<std::int32_t>(kSlope * step_ticks_);
  if (gain_ < least || before(0).measured < lowest_ + kClimbed) {
    judged_ = 0;
    return false;
  }
  // What has been given in all of the time in which heat of now may have been on its way.
  std::uint32_t given = kFullPower;
  for (std::size_t i = 0; i < seen_; ++i) given = std::min(given, before(i).least);
  const std::int64_t warmed = std::int64_t{slope} * static_cast<std::int32_t>(kFullPower) / gain_;
  const std::int32_t taken = static_cast<std::int32_t>(given) - static_cast<std::int32_t>(warmed);
  steps_[at_].taken = taken;
  if (++judged_ <= kBack) return false;
  const std::int32_t earlier = before(kBack).taken;
  usual_ = judged_ == kBack + 1 || earlier > usual_ ? earlier : usual_ + (earlier - usual_) / kForget;
  const bool missing =
      static_cast<std::int32_t>(given) > most && taken > std::max(usual_, std::int32_t{0}) + most;
  missing_ = missing ? missing_ + 1 : 0;
  return missing_ >= kInARow;
}

}  // namespace kinebus::heat
