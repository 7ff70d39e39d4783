#include "node_firmware/heat/plain_watch.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "node_firmware/heat/thermal_model.hpp"

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kTicksPerSecond = 10;
constexpr std::int32_t kLeastRise = 2'000;  // mC
constexpr std::int32_t kNear = 5'000;       // mC
constexpr std::int32_t kAway = 15'000;      // mC: fan and filament at once draw a healthy one no farther
constexpr std::uint32_t kFarTicks = 50;
/// A block that was switched off goes on warming by what is on its way.
constexpr std::uint32_t kStillWarming = 60 * kTicksPerSecond;
/// Control asks for so much at least when the block falls away from it.
constexpr std::uint32_t kControlTries = kFullPower * 3 / 10;

// What holds the target is known by half a minute within kAt of it.
constexpr std::int32_t kAt = 2'000, kBelow = 3'000, kWarms = 1'000;  // mC
constexpr std::uint32_t kHeldTicks = 300, kMeanTicks = 256;
/// A draught, a lid that is opened and control's own swing stay below one and a half of it.
constexpr std::int32_t kSwing = static_cast<std::int32_t>(kFullPower / 16);

/// More than fan, filament and draught take together of a heater that can hold its target with them; and
/// more than a draught alone.
constexpr auto kMost = static_cast<std::int32_t>(kFullPower * 6 / 10);
constexpr auto kMostQuiet = static_cast<std::int32_t>(kFullPower / 4);

bool lasts(std::uint32_t& ticks, bool now, std::uint32_t limit) {
  ticks = now ? ticks + 1 : 0;
  return ticks >= limit;
}

}  // namespace

void PlainWatch::configure(std::uint16_t rise_s) {
  rise_ticks_ = rise_s * kTicksPerSecond;
  pace_.configure(rise_s);
}

void PlainWatch::start() {
  const std::uint32_t rise_ticks = rise_ticks_;
  const HeatingPace pace = pace_;
  *this = {};
  rise_ticks_ = rise_ticks;
  pace_ = pace;
  pace_.start();
}

PlainWatch::Found PlainWatch::step(const Tick& tick) {
  if (tick.target != std::exchange(last_target_, tick.target)) {
    reached_ = false;
    away_ = far_away_ = 0;
  }
  if (tick.target != 0 && std::abs(tick.measured - tick.target) < kNear) reached_ = true;
  const bool quiet = tick.quiet > rise_ticks_ * 3 / 2;
  const std::int32_t most = quiet ? std::min(kMostQuiet + tick.taken, kMost) : kMost;
  bool missing = pace_.step(tick.measured, tick.power, most);
  // Each of them keeps what it has seen, whatever another one says.
  missing |= rises_not(tick);
  missing |= goes_on_falling(tick);
  missing |= takes_more(tick);
  missing |= is_away(tick);
  if (missing) return Found::kMissing;
  return warms_by_itself(tick) ? Found::kUnasked : Found::kNothing;
}

// Far below a target control gives nearly all, and that warms. (Measuring a heater has no target.)
bool PlainWatch::rises_not(const Tick& tick) {
  const bool close = tick.target != 0 && tick.measured >= tick.target - kAway;
  const bool rises = tick.measured >= rise_from_ + kLeastRise;
  const bool begins = close || rises || tick.power < kFullPower / 2 || risen_not_ == 0;
  risen_not_ = begins ? 1 : risen_not_ + 1;
  // One that was cooling goes on with it until the first heat has come.
  rise_from_ = begins ? tick.measured : std::min(rise_from_, tick.measured);
  return risen_not_ > rise_ticks_;
}

// What is drawn by more than it is given falls ever slower as control gives more; without heat it does not.
bool PlainWatch::goes_on_falling(const Tick& tick) {
  const bool near = tick.target == 0 || tick.measured >= tick.target - kNear;
  if (near || tick.power < kControlTries) {
    half_from_ = tick.measured;
    half_ = 0;
    fell_ = 0;
    return false;
  }
  if (++half_ < rise_ticks_ / 2) return false;
  half_ = 0;
  const std::int32_t before = std::exchange(fell_, half_from_ - tick.measured);
  half_from_ = tick.measured;
  return before >= kLeastRise && fell_ >= kLeastRise && fell_ >= before - before / 5;
}

// Where fans and filament are as they were, what held the target a moment ago does so now.
bool PlainWatch::takes_more(const Tick& tick) {
  if (tick.quiet <= rise_ticks_ * 3 / 2 || !reached_ || tick.target == 0) {
    held_ = more_ = 0;
    return false;
  }
  const std::int32_t own = static_cast<std::int32_t>(tick.power) - tick.taken;
  if (std::abs(tick.measured - tick.target) < kAt) {
    held_ = std::min(held_ + 1, kHeldTicks);
    usual_ =
        held_ == 1 ? own : usual_ + (own - usual_) / static_cast<std::int32_t>(std::min(held_, kMeanTicks));
  }
  const bool more = held_ >= kHeldTicks && tick.measured < tick.target - kBelow &&
                    own > usual_ + std::max(usual_, std::int32_t{0}) / 2 + kSwing;
  const bool begins = !more || more_ == 0 || tick.measured > more_from_ + kWarms;
  more_from_ = begins ? tick.measured : std::min(more_from_, tick.measured);
  more_ = !more ? 0 : begins ? 1 : more_ + 1;
  return more_ > rise_ticks_ / 2;
}

// It was at its target. A strong heater behind a long dead time swings so far for a moment.
bool PlainWatch::is_away(const Tick& tick) {
  const bool holds = reached_ && tick.target != 0;
  const bool away = lasts(away_, holds && tick.measured < tick.target - kAway, rise_ticks_ / 2);
  return lasts(far_away_, holds && tick.measured < tick.target - 2 * kAway, kFarTicks) || away;
}

// Off: what was on its way has long come, and it warms.
bool PlainWatch::warms_by_itself(const Tick& tick) {
  off_ = tick.power == 0 ? off_ + 1 : 0;
  if (off_ <= kStillWarming || tick.measured < lowest_off_) lowest_off_ = tick.measured;
  return off_ > kStillWarming && tick.measured > lowest_off_ + kAway;
}

}  // namespace kinebus::heat
