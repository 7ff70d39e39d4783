// DriveAxis: the modes of operation, how they are entered and left, and what they show in the statusword.

#include <algorithm>
#include <utility>

#include "node_firmware/core/drive_axis.hpp"
#include "node_firmware/core/emergency_codes.hpp"

namespace kinebus {
namespace {

namespace control = cia402::control;
namespace status = cia402::status;

constexpr auto kTargetVelocity = slot_of_axes(object::kTargetVelocity);
constexpr auto kSubMode = slot_of_axes(object::kInterpolationSubMode);

/// 60C2h as ticks: value * 10^index seconds, 100 us to 10 s.
ProfileTicks interpolation_period(std::int64_t value, std::int64_t exponent) {
  std::int64_t ticks = value * kTicksPerSecond;
  for (; exponent < 0 && ticks > 0; ++exponent) ticks /= 10;
  for (; exponent > 0 && ticks < kTicksPerSecond * 10; --exponent) ticks *= 10;
  return std::clamp<std::int64_t>(ticks, kTicksPerSecond / 10'000, kTicksPerSecond * 10);
}

}  // namespace

void DriveAxis::serve_mode(LocalTime now) {
  const bool stream_rests = path_.stream().idle();
  if (source_ == Source::kStream) {
    const bool still = wanted_mode_ == Mode::kInterpolatedPosition && parameter(kSubMode) < 0;
    if (!still && stream_rests) to_profile(to_ticks(now));
  }
  if (wanted_mode_ != mode_ && source_ != Source::kStream) {
    if (!moving(now)) {
      enter_mode(now, wanted_mode_);
    } else if (homing_.running() || source_ == Source::kLine || !leaving_) {
      // A motion that the new mode knows nothing of ends first.
      homing_.abort();
      profile_position_.reset(word_);
      brake(to_ticks(now), unsigned_parameter(slot_of_axes(object::kProfileDeceleration)));
      leaving_ = true;
    }
  }
  begin_stream(now);
  serve_velocity(now);
  served_until_ = std::max(served_until_, to_ticks(now));
}

void DriveAxis::enter_mode(LocalTime now, Mode mode) {
  to_profile(to_ticks(now));
  mode_ = mode;
  leaving_ = false;
  limited_ = false;
  homing_.abort();
  profile_position_.reset(word_);
  // What was asked for before is not to move the axis when the mode comes back.
  if (mode != Mode::kProfileVelocity) objects_.set_value(kTargetVelocity[index_], 0);
  const std::int32_t here = whole_counts(position(now));
  objects_.set_value(slot_of_axes(object::kInterpolationData)[index_], here);
  if (mode == Mode::kCyclicSynchronousPosition)
    objects_.set_value(slot_of_axes(object::kTargetPosition)[index_], here);
}

// Profile velocity: on its way to the end of where it may be, at the target velocity, until that is another
// one. What stops it by 60FFh = 0, at a limit, or in any other way is a ramp like every other.
void DriveAxis::serve_velocity(LocalTime now) {
  const bool runs = mode_ == Mode::kProfileVelocity && wanted_mode_ == mode_ && power_.moves() && !blocked();
  if (!runs) return runs_.reset();
  const std::int64_t wanted = parameter(kTargetVelocity);
  const std::int64_t fastest = unsigned_parameter(slot_of_axes(object::kMaxProfileVelocity));
  const std::int64_t asked = wanted < 0 ? -wanted : wanted, speed = std::min(asked, fastest);
  const ProfileTicks t = to_ticks(now);
  ProfilePosition::SetPoint next{.target = 0, .limits = profile_limits(static_cast<std::uint32_t>(speed))};
  if (speed != 0) next.target = within_limits(wanted < 0 ? -kPositionBound : kPositionBound);
  limited_ = speed != 0 && profile_.done(t) && runs_ == next;  // it stands where it may not go on
  if (speed != asked) limited_ = true;
  if (runs_ == next) return;
  runs_ = next;
  if (speed == 0)
    brake(t, next.limits.deceleration);
  else
    profile_.move(t, state_at(t), next.target, next.limits);
}

// The stream takes over an axis that rests, while the stream rests: both then are at the same place.
void DriveAxis::begin_stream(LocalTime now) {
  if (mode_ != Mode::kInterpolatedPosition || wanted_mode_ != mode_ || parameter(kSubMode) >= 0) return;
  if (source_ == Source::kStream || !power_.moves() || moving(now) || !path_.stream().idle()) return;
  SegmentStream& stream = path_.stream();
  const int axis = static_cast<int>(index_);
  SegmentStream::Limits limits;
  const std::int64_t fastest = unsigned_parameter(slot_of_axes(object::kMaxProfileVelocity));
  limits.velocity = fastest * kOneCount / 62'500;
  if (position_known_) {
    limits.min_position = from_counts(parameter(slot_of_axes(object::kMinPositionLimit)));
    limits.max_position = from_counts(parameter(slot_of_axes(object::kMaxPositionLimit)));
  }
  stream.set_limits(axis, limits);
  stream.set_shift(axis, static_cast<int>(parameter(slot_of_axes(object::kAccelerationShift))));
  stream.set_rest_position(axis, state_at(to_ticks(now)).position);
  stream.set_following(axis, true);
  source_ = Source::kStream;
}

void DriveAxis::on_sync(LocalTime now) {
  const bool cyclic = mode_ == Mode::kCyclicSynchronousPosition;
  const bool linear = mode_ == Mode::kInterpolatedPosition && parameter(kSubMode) == 0 &&
                      (word_ & control::kInterpolationEnable) != 0;
  const ProfileTicks t = to_ticks(now);
  // Set-points are not taken any more: the axis is not to go on as if one were late.
  if (!cyclic && !linear && source_ == Source::kLine)
    brake(t, unsigned_parameter(slot_of_axes(object::kProfileDeceleration)));
  if ((!cyclic && !linear) || wanted_mode_ != mode_ || !power_.moves() || blocked()) return;
  // An axis on the stream leaves it only when the stream rests.
  if (source_ == Source::kStream || (source_ == Source::kProfile && !profile_.done(t))) return;
  if (source_ != Source::kLine) line_.hold(state_at(t).position);
  source_ = Source::kLine;
  const std::int64_t wanted = cyclic ? parameter(slot_of_axes(object::kTargetPosition)) +
                                           parameter(slot_of_axes(object::kPositionOffset))
                                     : parameter(slot_of_axes(object::kInterpolationData));
  limited_ = false;
  const std::int64_t set_point = from_counts(std::clamp<std::int64_t>(wanted, -(1 << 30), 1 << 30));
  const std::int64_t target = within_limits(set_point);
  const ProfileTicks period = interpolation_period(parameter(slot_of_axes(object::kInterpolationPeriod)),
                                                   parameter(slot_of_axes(object::kInterpolationIndex)));
  LinearInterpolator::Limits limits;
  limits.profile = {unsigned_parameter(slot_of_axes(object::kMaxProfileVelocity)),
                    unsigned_parameter(slot_of_axes(object::kMaxAcceleration)),
                    unsigned_parameter(slot_of_axes(object::kMaxDeceleration))};
  if (position_known_) {
    limits.low = from_counts(parameter(slot_of_axes(object::kMinPositionLimit)));
    limits.high = from_counts(parameter(slot_of_axes(object::kMaxPositionLimit)));
  }
  follow(now, line_.go(t, target, period, limits));
}

/// A set-point that stays too far ahead, for too long, is none that the master has planned: all stop.
void DriveAxis::follow(LocalTime now, std::int64_t behind) {
  if (behind != 0) limited_ = true;
  // FFFF'FFFFh, unwatched, is more than a set-point can be away.
  if ((behind >> 32) < parameter(slot_of_axes(object::kFollowingErrorWindow))) {
    behind_since_ = LocalTime::max();
    return;
  }
  behind_since_ = std::min(behind_since_, now);
  const LocalTime patience{parameter(slot_of_axes(object::kFollowingErrorTimeout)) * 1'000'000};
  if (now - behind_since_ < patience) return;
  left_behind_ = true;
  path_.request_stop(StopReason::kAxisFault, static_cast<int>(index_), emcy::kFollowingError, now);
}

ProfileLimits DriveAxis::profile_limits(std::uint32_t fastest) const {
  const auto least = [&](AxisSlots a, std::uint32_t most) {
    return std::max<std::uint32_t>(std::min(unsigned_parameter(a), most), 1);
  };
  return {least(slot_of_axes(object::kMaxProfileVelocity), fastest),
          least(slot_of_axes(object::kProfileAcceleration),
                unsigned_parameter(slot_of_axes(object::kMaxAcceleration))),
          least(slot_of_axes(object::kProfileDeceleration),
                unsigned_parameter(slot_of_axes(object::kMaxDeceleration)))};
}

ProfilePosition::SetPoint DriveAxis::next_set_point(std::uint16_t word) {
  ProfilePosition::SetPoint next;
  next.limits = profile_limits(unsigned_parameter(slot_of_axes(object::kProfileVelocity)));
  const std::int64_t target = parameter(slot_of_axes(object::kTargetPosition));
  const bool relative = (word & control::kRelative) != 0;
  const std::int64_t base = relative ? whole_counts(profile_position_.base(profile_)) : 0;
  limited_ = false;
  next.target = within_limits(from_counts(std::clamp<std::int64_t>(base + target, -(1 << 30), 1 << 30)));
  return next;
}

std::int64_t DriveAxis::within_limits(std::int64_t target) {
  std::int64_t low = -kPositionBound, high = kPositionBound;
  if (position_known_) {
    low = std::max(low, from_counts(parameter(slot_of_axes(object::kMinPositionLimit))));
    high = std::min(high, from_counts(parameter(slot_of_axes(object::kMaxPositionLimit))));
  }
  const auto mine = [&](SwitchFunction a, SwitchFunction b) { return inputs_.active(index_ == 0 ? a : b); };
  const std::int64_t here = state_at(served_until_).position;
  // On a limit switch only the way back is open.
  if (mine(SwitchFunction::kPositiveLimitA, SwitchFunction::kPositiveLimitB)) high = std::min(high, here);
  if (mine(SwitchFunction::kNegativeLimitA, SwitchFunction::kNegativeLimitB)) low = std::max(low, here);
  const std::int64_t cut = low > high ? here : std::clamp(target, low, high);
  if (cut != target) limited_ = true;
  return cut;
}

HomingConfig DriveAxis::homing_config() const {
  const std::uint32_t fastest = unsigned_parameter(slot_of_axes(object::kMaxProfileVelocity));
  return {.method = static_cast<int>(parameter(slot_of_axes(object::kHomingMethod))),
          .fast = std::min(unsigned_parameter(slot_of_axes(object::kHomingFastSpeed)), fastest),
          .slow = std::min(unsigned_parameter(slot_of_axes(object::kHomingSlowSpeed)), fastest),
          .acceleration = unsigned_parameter(slot_of_axes(object::kHomingAcceleration)),
          .offset = static_cast<std::int32_t>(
              std::clamp<std::int64_t>(parameter(slot_of_axes(object::kHomeOffset)), -(1 << 29), 1 << 29)),
          .travel = unsigned_parameter(slot_of_axes(object::kHomingTravel)),
          .back_off = unsigned_parameter(slot_of_axes(object::kHomingBackOff))};
}

SwitchFunction DriveAxis::homing_function() const {
  const bool a = index_ == 0;
  switch (Homing::switch_of(static_cast<int>(parameter(slot_of_axes(object::kHomingMethod))))) {
    case Homing::Switch::kHome:
      return a ? SwitchFunction::kHomeA : SwitchFunction::kHomeB;
    case Homing::Switch::kNegativeLimit:
      return a ? SwitchFunction::kNegativeLimitA : SwitchFunction::kNegativeLimitB;
    case Homing::Switch::kPositiveLimit:
      return a ? SwitchFunction::kPositiveLimitA : SwitchFunction::kPositiveLimitB;
    case Homing::Switch::kNone:
      break;
  }
  return SwitchFunction::kNone;
}

void DriveAxis::start_or_end_homing(LocalTime now, bool start) {
  const ProfileTicks t = to_ticks(now);
  if (start) {
    const SwitchFunction function = homing_function();
    tell_homing();
    // A motion that still brakes goes over into the new one.
    homing_.start(t, homing_config(), inputs_.active(function), profile_);
    serve_homing(now);
  } else if (homing_.running()) {
    homing_.abort();
    brake(t, unsigned_parameter(slot_of_axes(object::kHomingAcceleration)));
  }
}

void DriveAxis::tell_homing() {
  homing_.set_turn(homing_turn());
  homing_.set_load(parameter(slot_of_axes(object::kStallThreshold)) == 0 ? Homing::Load::kNone : load_);
}

bool DriveAxis::homes_with(SwitchFunction function) const {
  return homing_.running() && function == homing_function();
}

void DriveAxis::on_switch(LocalTime now, const SwitchEvent& event) {
  on_time(now);
  if (!homes_with(event.function)) return;
  scale_at_edge_ = event.scales[index_];  // the last edge of a homing is the one that counts
  homing_.on_switch(to_ticks(now), event.active, event.latched[index_], profile_);
  serve_homing(now);
}

void DriveAxis::serve_homing(LocalTime now) {
  tell_homing();
  homing_.on_time(to_ticks(now), profile_);
  std::int64_t by = 0;
  if (homing_.take_shift(by)) {
    // Around the end of 64 bits and on: only differences of motor positions mean anything.
    origin_ = static_cast<std::int64_t>(static_cast<std::uint64_t>(origin_) + static_cast<std::uint64_t>(by));
    position_known_ = true;
    home_latch_ = homing_.latched();
    scale_at_home_ = std::exchange(scale_at_edge_, std::nullopt);
  }
  if (homing_.error() != HomingError::kNone) {  // it runs no more: told once
    ++homing_errors_;
    emergency_ = node_emcy::kHoming;
  }
}

std::uint16_t DriveAxis::statusword(LocalTime now) const {
  unsigned word = power_.statusword();
  if (limited_ || blocked()) word |= status::kInternalLimit;
  const bool rests = !moving(now);
  switch (mode_) {
    case Mode::kProfilePosition:
      if (halted_ ? rests : profile_position_.reached(to_ticks(now), profile_))
        word |= status::kTargetReached;
      if (profile_position_.acknowledged()) word |= status::kSetPointAcknowledged;
      break;
    case Mode::kProfileVelocity:
      if (halted_ || parameter(kTargetVelocity) == 0 ? rests : profile_.cruises(to_ticks(now)) && !limited_)
        word |= status::kTargetReached;
      if (rests) word |= status::kStands;
      break;
    case Mode::kHoming:
      if (rests && !homing_.running()) word |= status::kTargetReached;
      if (homing_.waiting()) word |= status::kHomingWaits;
      if (homing_.attained()) word |= status::kHomingAttained;
      if (homing_.error() != HomingError::kNone) word |= status::kHomingError;
      // With the error: the switch, or the load, came where it must not.
      if (homing_.error() == HomingError::kBounced || homing_.error() == HomingError::kStuck)
        word |= status::kHomingWaits;
      break;
    case Mode::kInterpolatedPosition:
      if (source_ == Source::kStream ? path_.stream().resting() : rests) word |= status::kTargetReached;
      if (source_ == Source::kStream || (source_ == Source::kLine && power_.moves()))
        word |= status::kInterpolationActive;
      break;
    case Mode::kCyclicSynchronousPosition:
      if (rests) word |= status::kTargetReached;
      if (source_ == Source::kLine && power_.moves()) word |= status::kFollowsCommand;
      if (left_behind_) word |= status::kFollowingError;
      break;
    case Mode::kNone:
      break;
  }
  return static_cast<std::uint16_t>(word);
}

}  // namespace kinebus
