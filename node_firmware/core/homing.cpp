#include "node_firmware/core/homing.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {

bool Homing::supports(int method) {
  return (method >= 17 && method <= 22) || method == 35 || method == 37 || by_load(method);
}

Homing::Switch Homing::switch_of(int method) {
  if (method == 17) return Switch::kNegativeLimit;
  if (method == 18) return Switch::kPositiveLimit;
  return (method >= 19 && method <= 22) || by_load(method) ? Switch::kHome : Switch::kNone;
}

void Homing::start(ProfileTicks now, const HomingConfig& config, bool switch_active, Trapezoid& motion) {
  config_ = config;
  attained_ = false;
  error_ = HomingError::kNone;
  if (!supports(config.method)) return fail(now, motion, HomingError::kMethod);
  const int method = config.method;
  direction_ = (method >= 18 && method <= 20) || method == kPositiveStop ? 1 : -1;
  entering_ = method == 20 || method == 22;
  if (switch_of(method) == Switch::kNone) {
    latched_ = motion.at(now).position;
    return finish(now, motion);
  }
  active_ = switch_active;
  second_ = false;
  if (by_load(method)) return go_free(now, motion);
  if (switch_active) return leave(now, motion);
  go(Phase::kSeek, now, motion, direction_, config.fast, config.travel);
}

void Homing::on_switch(ProfileTicks now, bool active, std::int64_t latched, Trapezoid& motion) {
  active_ = active;
  switch (phase_) {
    case Phase::kSeek:
      if (active) stop_into(Phase::kStopOn, now, motion);
      return;
    case Phase::kLeave:
      if (active) return;
      latched_ = latched;
      return stop_into(entering_ ? Phase::kStopOff : Phase::kStopLatched, now, motion);
    case Phase::kEnter:
      if (!active) return;
      latched_ = latched;
      return stop_into(Phase::kStopLatched, now, motion);
    case Phase::kStopOn:
    case Phase::kWait:
    case Phase::kStopOff:
    case Phase::kStopLatched:
    case Phase::kSettle:
      if (by_load(config_.method)) return;
      return fail(now, motion, HomingError::kBounced);
    case Phase::kPress:
      if (active) on_load(now, latched, motion);
      return;
    case Phase::kFree:
    case Phase::kDriver:
    case Phase::kStopPressed:
    case Phase::kIdle:
      return;
  }
}

void Homing::on_time(ProfileTicks now, Trapezoid& motion) {
  if (!motion.done(now)) return;
  switch (phase_) {
    case Phase::kSeek:
    case Phase::kEnter:
      return fail(now, motion, HomingError::kNoSwitch);
    case Phase::kLeave:
      return fail(now, motion, HomingError::kStuck);
    case Phase::kStopOn:
    case Phase::kWait:
      return leave(now, motion);
    case Phase::kStopOff:
      return go(Phase::kEnter, now, motion, direction_, config_.slow, config_.back_off);
    case Phase::kStopLatched:
      return finish(now, motion);
    case Phase::kSettle:
      phase_ = Phase::kIdle;
      attained_ = true;
      return;
    case Phase::kFree:
    case Phase::kDriver:
      return press(now, motion);
    case Phase::kPress:
      return fail(now, motion, second_ ? HomingError::kBounced : HomingError::kNoSwitch);
    case Phase::kStopPressed:
      return go_free(now, motion);
    case Phase::kIdle:
      return;
  }
}

void Homing::abort() {
  phase_ = Phase::kIdle;
  attained_ = false;
}

bool Homing::take_shift(std::int64_t& by) {
  by = shift_;
  return std::exchange(has_shift_, false);
}

void Homing::go(Phase phase, ProfileTicks now, Trapezoid& motion, int direction, std::uint32_t speed,
                std::uint32_t travel) {
  const ProfileState from = motion.at(now);
  const std::int64_t target =
      from.position + direction * from_counts(std::min<std::uint32_t>(travel, 1u << 29));
  const std::int64_t within = std::clamp(target, -kPositionBound, kPositionBound);
  motion.move(now, from, within, {speed, config_.acceleration, config_.acceleration});
  phase_ = phase;
}

// Leaving takes the edge of methods 17, 18, 19 and 21: slowly. For 20 and 22 it only makes way for the
// run-up.
void Homing::leave(ProfileTicks now, Trapezoid& motion) {
  if (!my_turn_) {
    phase_ = Phase::kWait;
    return;
  }
  go(Phase::kLeave, now, motion, -direction_, entering_ ? config_.fast : config_.slow, config_.back_off);
}

void Homing::stop_into(Phase phase, ProfileTicks now, Trapezoid& motion) {
  motion.stop(now, motion.at(now), config_.acceleration);
  phase_ = phase;
}

// The axis rests. Zero comes to lie at the edge plus `offset`; a rest beside a whole count creeps onto it, so
// that 32-bit objects tell the position exactly.
void Homing::finish(ProfileTicks now, Trapezoid& motion) {
  shift_ = -from_counts(config_.offset) - latched_;
  has_shift_ = true;
  motion.shift(shift_);
  stop_into(Phase::kSettle, now, motion);
}

void Homing::fail(ProfileTicks now, Trapezoid& motion, HomingError error) {
  error_ = error;
  phase_ = Phase::kIdle;
  motion.stop(now, motion.at(now), config_.acceleration);
}

}  // namespace kinebus
