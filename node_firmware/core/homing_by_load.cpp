// Homing at a mechanical stop, which the motor's driver tells by its load.

#include <algorithm>

#include "node_firmware/core/homing.hpp"

namespace kinebus {
namespace {

/// A load that comes at full speed comes within a few full steps. Where the field has slipped past the motor
/// by an electrical turn (1024 counts), positions are no longer what they were.
constexpr std::int64_t kAgreement = from_counts(512);
/// The field turns on by so much after the load has come: a quarter of a full step.
constexpr std::uint64_t kStopWay = 64;

/// That ends a motion within kStopWay.
std::uint32_t on_the_spot(std::uint32_t speed, std::uint32_t least) {
  const std::uint64_t needed = std::uint64_t{speed} * speed / (2 * kStopWay);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(needed, least, 0x7FFF'FFFF));
}

/// At full speed to where the second meeting is no longer the first one's, and there it brakes.
std::uint32_t past_the_first(std::uint32_t speed, std::uint32_t acceleration) {
  const std::uint64_t brakes = std::uint64_t{speed} * speed / (2 * std::max<std::uint64_t>(acceleration, 1));
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(brakes + static_cast<std::uint64_t>(kAgreement / kOneCount), 1u << 28));
}

}  // namespace

/// Away from the stop. An input that is active before anything moves tells no load: nothing is led to it.
void Homing::go_free(ProfileTicks now, Trapezoid& motion) {
  if (load_ == Load::kNone) return fail(now, motion, HomingError::kNoLoad);
  if (active_ && !second_) return fail(now, motion, HomingError::kStuck);
  go(Phase::kFree, now, motion, -direction_, config_.fast, config_.back_off);
}

void Homing::press(ProfileTicks now, Trapezoid& motion) {
  if (load_ == Load::kNone) return fail(now, motion, HomingError::kNoLoad);
  if (active_) return fail(now, motion, HomingError::kStuck);
  if (load_ == Load::kBusy) {
    phase_ = Phase::kDriver;
    return;
  }
  pressed_from_ = motion.at(now).position;
  constexpr std::uint32_t kMost = 1u << 28;
  const std::uint32_t more = second_ ? past_the_first(config_.fast, config_.acceleration) : config_.travel;
  go(Phase::kPress, now, motion, direction_, config_.fast,
     std::min(config_.back_off, kMost) + std::min(more, kMost));
}

/// The axis has just come this way freely: a load in the first half of it is no stop.
void Homing::on_load(ProfileTicks now, std::int64_t latched, Trapezoid& motion) {
  const std::int64_t way = (latched - pressed_from_) * direction_;
  const bool apart = second_ && (latched > latched_ + kAgreement || latched < latched_ - kAgreement);
  if (way < from_counts(config_.back_off) / 2 || apart) return fail(now, motion, HomingError::kBounced);
  latched_ = latched;
  motion.stop(now, motion.at(now), on_the_spot(config_.fast, config_.acceleration));
  phase_ = second_ ? Phase::kStopLatched : Phase::kStopPressed;
  second_ = true;
}

}  // namespace kinebus
