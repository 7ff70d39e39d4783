#include "node_firmware/core/drive_axis.hpp"

#include <algorithm>
#include <utility>

#include "node_firmware/core/emergency_codes.hpp"

namespace kinebus {
namespace {

namespace control = cia402::control;

/// An axis that waits for its turn in homing looks so often whether the other one is through.
constexpr LocalTime kTurn = std::chrono::milliseconds{1};

constexpr auto kTarget = slot_of_axes(object::kTargetPosition);
constexpr auto kSlowDown = slot_of_axes(object::kProfileDeceleration);
constexpr auto kQuickStop = slot_of_axes(object::kQuickStopDeceleration);

}  // namespace

DriveAxis::DriveAxis(int axis, ObjectDictionary& objects, PathMotion& path, const SwitchInputs& inputs)
    : index_(static_cast<std::size_t>(axis)), objects_(objects), path_(path), inputs_(inputs) {
  profile_.hold(0);
}

void DriveAxis::on_initialised() {
  power_.on_initialised();
}

void DriveAxis::on_reset(LocalTime now) {
  power_ = {};
  serve_power(now);
  mode_ = wanted_mode_ = Mode::kNone;
  word_ = 0;
  limited_ = false;
  homing_ = {};
}

void DriveAxis::on_controlword(LocalTime now, std::uint16_t word) {
  const bool start_changed = ((word ^ word_) & control::kHomingStart) != 0;
  word_ = word;
  power_.on_controlword(word, stop_options());
  serve_power(now);
  serve_stop(now);
  const bool may_move = power_.moves() && !blocked();
  if (mode_ == Mode::kProfilePosition) {
    if (may_move)
      profile_position_.on_controlword(to_ticks(now), word, next_set_point(word), profile_);
    else if (!halted_)
      profile_position_.reset(word);
  }
  if (mode_ == Mode::kHoming && start_changed && may_move)
    start_or_end_homing(now, (word & control::kHomingStart) != 0);
  on_time(now);
}

void DriveAxis::on_mode(LocalTime now, int mode) {
  wanted_mode_ = static_cast<Mode>(mode);
  on_time(now);
}

void DriveAxis::on_fault(LocalTime now, std::uint16_t code, bool power_lost) {
  if (power_.state() == cia402::State::kFault) return;
  error_code_ = code;
  emergency_ = code;
  power_.on_fault(stop_options(), power_lost);
  on_time(now);
}

void DriveAxis::on_path_stop(LocalTime now) {
  on_time(now);
  if (source_ == Source::kStream) return;
  homing_.abort();
  // Also of an axis that is halted: what waits there is not to begin later.
  profile_position_.reset(word_);
  objects_.set_value(slot_of_axes(object::kTargetVelocity)[index_], 0);
  halted_ = false;
  if (moving(now)) brake(to_ticks(now), unsigned_parameter(kQuickStop));
}

void DriveAxis::on_stream_cleared(LocalTime now) {
  creeps_ = source_ == Source::kStream;
  if (!creeps_) return;
  to_profile(to_ticks(now));
  profile_.stop(to_ticks(now), profile_.at(to_ticks(now)), unsigned_parameter(kSlowDown));
}

void DriveAxis::on_time(LocalTime now) {
  serve_motion(now);
  serve_stop(now);
  serve_power(now);
  serve_mode(now);
}

// Power on or off, enabled or not: what these changes mean for the motion.
void DriveAxis::serve_power(LocalTime now) {
  const bool enabled = power_.state() == cia402::State::kOperationEnabled;
  if (!power_.powered()) {
    // Without current the motor may be moved by anything.
    homing_.abort();
    position_known_ = false;
    to_profile(to_ticks(now));
  }
  if (enabled && !was_enabled_) {
    profile_position_.reset(word_);
    objects_.set_value(kTarget[index_], whole_counts(position(now)));
    limited_ = false;
  }
  if (!enabled && was_enabled_) {
    halted_ = false;
    // Without a ramp of its own (605Ch = 0): the motor keeps its current, and must not go on.
    if (power_.state() == cia402::State::kSwitchedOn && moving(now)) end_motion(now);
  }
  was_enabled_ = enabled;
  const bool faulty =
      power_.state() == cia402::State::kFault || power_.state() == cia402::State::kFaultReactionActive;
  if (error_code_ != 0 && !faulty) {
    cleared_fault_ = std::exchange(error_code_, std::uint16_t{0});
  }
}

void DriveAxis::end_motion(LocalTime now) {
  if (source_ == Source::kStream)
    return path_.request_stop(StopReason::kCommand, static_cast<int>(index_), node_emcy::kCommand, now);
  homing_.abort();
  profile_position_.reset(word_);
  brake(to_ticks(now), unsigned_parameter(kQuickStop));
}

void DriveAxis::on_connection_lost(LocalTime now) {
  if (!moving(now)) return;
  switch (parameter(slot_of_axes(object::kAbortConnectionOption))) {
    case 0:
      return;
    case 1:
      return on_fault(now, node_emcy::kCommand, false);
    case 2:
      return on_controlword(now, 0);
    default:
      return on_controlword(now, control::kEnableVoltage);  // without the quick stop's bit
  }
}

// The ramp that the power state machine asks for: begun once, and reported when the axis rests.
void DriveAxis::serve_stop(LocalTime now) {
  const ProfileTicks t = to_ticks(now);
  const cia402::Stop asked = power_.stop();
  if (asked != serving_) {
    serving_ = asked;
    const bool was_halted = std::exchange(halted_, power_.halted() && asked != cia402::Stop::kNone);
    if (asked == cia402::Stop::kNone) {
      const bool resumes = was_halted && power_.moves() && !blocked();
      if (resumes && mode_ == Mode::kProfilePosition) profile_position_.resume(t, profile_);
      if (resumes && mode_ == Mode::kHoming && (word_ & control::kHomingStart) != 0)
        start_or_end_homing(now, true);
    } else {
      homing_.abort();
      if (!halted_) profile_position_.reset(word_);
      // A halt does not soften the stop of all that is under way.
      const bool slow = asked == cia402::Stop::kSlowDown && !blocked();
      if (source_ != Source::kStream)
        brake(t, unsigned_parameter(slow ? kSlowDown : kQuickStop));
      else if (!path_.at_rest(now) && !path_.stream().idle())
        path_.request_stop(StopReason::kCommand, static_cast<int>(index_), node_emcy::kCommand, now);
    }
  }
  if (serving_ == cia402::Stop::kNone) return;
  const bool rests =
      source_ == Source::kStream ? path_.at_rest(now) || path_.stream().idle() : profile_.done(t);
  if (!rests) return;
  power_.on_stop_finished(stop_options());
  serving_ = power_.stop();
}

void DriveAxis::serve_motion(LocalTime now) {
  const ProfileTicks t = to_ticks(now);
  if (homing_.running()) serve_homing(now);
  // SYNC has ended in the midst of a motion: a master, or the bus, is gone.
  if (source_ == Source::kLine && t >= line_.lost_at() && !blocked())
    path_.request_stop(StopReason::kSyncLost, static_cast<int>(index_), emcy::kSyncController, now);
  if (mode_ == Mode::kProfilePosition && serving_ == cia402::Stop::kNone)
    profile_position_.on_time(t, served_until_, profile_);
  // So that a checkpoint before the first record compares with where the axis is.
  if (!moving(now)) path_.stream().set_rest_position(static_cast<int>(index_), state_at(t).position);
}

void DriveAxis::to_profile(ProfileTicks t) {
  if (source_ == Source::kStream) {
    path_.stream().set_following(static_cast<int>(index_), false);
    path_.give_up_stream(to_local(t));
  }
  profile_.hold(state_at(t).position);
  source_ = Source::kProfile;
}

void DriveAxis::brake(ProfileTicks t, std::uint32_t deceleration) {
  const ProfileState from = state_at(t);
  if (source_ == Source::kProfile && profile_.done(t)) return;
  source_ = Source::kProfile;
  profile_.stop(t, from, deceleration);
}

ProfileState DriveAxis::state_at(ProfileTicks t) const {
  switch (source_) {
    case Source::kLine:
      return line_.at(t);
    case Source::kStream:
      return {path_.stream().position(static_cast<int>(index_)), 0};
    case Source::kProfile:
      break;
  }
  return profile_.at(t);
}

std::int64_t DriveAxis::position(LocalTime at) const {
  return state_at(to_ticks(at)).position;
}

std::int64_t DriveAxis::position_ahead(LocalTime at, const SegmentStream::Preview& stream) const {
  if (source_ == Source::kStream) return stream.position(static_cast<int>(index_));
  const ProfileTicks t = to_ticks(at);
  const ProfileState state = state_at(t);
  // A motion that ends with velocity goes over into one that is not planned before that end.
  const bool goes_on = source_ == Source::kProfile && state.velocity != 0 && profile_.done(t);
  return goes_on ? state.position + distance_of(state.velocity, t - profile_.end()) : state.position;
}

std::int32_t DriveAxis::velocity(LocalTime at) const {
  if (source_ != Source::kStream) return counts_per_second(state_at(to_ticks(at)).velocity);
  const std::int64_t per_unit = path_.stream().velocity(static_cast<int>(index_));
  const std::int64_t real = ((per_unit >> 12) * static_cast<std::int64_t>(path_.rate_q32(at) >> 12)) >> 8;
  return whole_counts(real * 62'500);  // 16 us units in a second
}

bool DriveAxis::moving(LocalTime at) const {
  const ProfileTicks t = to_ticks(at);
  if (source_ == Source::kProfile) return !profile_.done(t);
  if (source_ == Source::kLine) return !line_.done(t);
  return path_.stream().moving() && path_.rate_q32(at) != 0;
}

LocalTime DriveAxis::next_deadline() const {
  const bool ends = source_ == Source::kProfile || source_ == Source::kLine;
  const bool waits_for_sync = source_ == Source::kLine && line_.end() <= served_until_;
  // Profile velocity has reached its target where a ramp ends.
  const ProfileTicks end = waits_for_sync                    ? line_.lost_at()
                           : source_ == Source::kLine        ? line_.end()
                           : mode_ == Mode::kProfileVelocity ? profile_.phase_end(served_until_)
                                                             : profile_.end();
  LocalTime deadline =
      ends && end > served_until_ && end < LinearInterpolator::kNever ? to_local(end) : LocalTime::max();
  if (homing_.polls()) deadline = std::min(deadline, to_local(served_until_) + kTurn);
  return deadline;
}

cia402::StopOptions DriveAxis::stop_options() const {
  const auto option = [&](AxisSlots slots) { return static_cast<std::int16_t>(parameter(slots)); };
  return {.quick_stop = option(slot_of_axes(object::kQuickStopOption)),
          .shutdown = option(slot_of_axes(object::kShutdownOption)),
          .disable_operation = option(slot_of_axes(object::kDisableOption)),
          .halt = option(slot_of_axes(object::kHaltOption)),
          .fault_reaction = option(slot_of_axes(object::kFaultReactionOption))};
}

std::uint16_t DriveAxis::take_emergency() {
  return std::exchange(emergency_, std::uint16_t{0});
}

std::uint16_t DriveAxis::take_cleared_fault() {
  return std::exchange(cleared_fault_, std::uint16_t{0});
}

}  // namespace kinebus
