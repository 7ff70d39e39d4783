// Node: the objects whose values are the node's own state, and the commands that are given by writing
// objects.

#include <algorithm>

#include "node_firmware/core/node.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

CanFrame frame_of_bits(std::int64_t bits) {
  CanFrame frame{.length = 8};
  put_u64_le(frame.data, static_cast<std::uint64_t>(bits));
  return frame;
}

AbortCode verdict_code(SegmentStream::Verdict verdict) {
  using Verdict = SegmentStream::Verdict;
  const bool good =
      verdict == Verdict::kAccepted || verdict == Verdict::kEarly || verdict == Verdict::kDuplicate;
  return good ? AbortCode::kNone : AbortCode::kInvalidValue;
}

/// Parameters on which a motion that is under way relies, and how it is stopped. Not those that the next
/// set-point takes, and not what the node tells by itself.
bool kept_in_motion(const ObjectEntry& entry) {
  const ObjectAddress base = entry.base();
  if (base == object::kAbortConnectionOption) return true;
  const bool tpdo = (base.index >= 0x1800 && base.index < 0x1C00);
  const bool of_set_point = base == object::kProfileVelocity || base == object::kProfileAcceleration ||
                            base == object::kProfileDeceleration || base == object::kInterpolationSubMode;
  return entry.binding == Binding::kParameter && !tpdo && !of_set_point;
}

bool known_mode(std::int64_t mode) {
  return mode == 0 || mode == 1 || mode == 6 || mode == 7 || mode == 8;
}

}  // namespace

AbortCode Node::read(const ObjectEntry& entry, std::int64_t& value) {
  const bool known = entry.axis < 0 ? read_node_object(entry.address, value)
                                    : read_axis_object(axes_[entry.axis == 1 ? 1 : 0], entry.base(), value);
  return known ? AbortCode::kNone : AbortCode::kNoData;
}

bool Node::read_node_object(ObjectAddress address, std::int64_t& value) {
  switch (address.index) {
    case 0x1001:
      value = emcy_.error_register();
      return true;
    case 0x1002:
      value = path_.status(now_).flags;
      return true;
    case 0x1003:
      value = address.subindex == 0 ? emcy_.history_length() : 0;
      if (address.subindex > emcy_.history_length()) return false;
      if (address.subindex > 0) value = emcy_.history(address.subindex - 1u);
      return true;
    case 0x1010:
    case 0x1011:
      value = 1;  // on command, of all parameters
      return true;
    case 0x1013:
      value = static_cast<std::uint32_t>(path_.clock().to_bus(now_).count() / 1000);
      return true;
    case 0x1018: {
      const NodeIdentity& id = options_.identity;
      const std::array<std::uint32_t, 4> fields{id.vendor_id, id.product_code, id.revision, id.serial};
      value = fields[(address.subindex - 1u) & 3u];
      return true;
    }
    case 0x1F51:
      value = 1;  // a program runs: this one
      return true;
    case 0x1F56:
      value = options_.program_crc;
      return true;
    case 0x1F57:
      value = 0;
      return true;
    case 0x2102:
      value = static_cast<std::int64_t>(encode(path_.status(now_)));
      return true;
    case 0x2112:
      value = path_.tau(now_).count();
      return true;
    case 0x2116:
      value = objects_.fingerprint();
      return true;
    case 0x2120:
      value = counter_value(static_cast<NodeCounter>(address.subindex));
      return true;
    case 0x2121: {
      const ResetReport& reset = options_.reset;
      const std::array<std::uint32_t, 7> fields{static_cast<std::uint32_t>(reset.cause),
                                                reset.reason,
                                                reset.pc,
                                                reset.lr,
                                                reset.cfsr,
                                                reset.hfsr,
                                                reset.address};
      value = fields[(address.subindex - 1u) % fields.size()];
      return true;
    }
    case 0x2133:
      value = inputs_.active_inputs();
      return true;
    default:
      return false;
  }
}

/// Without sensors a motor has the current that it is told to have.
std::int64_t Node::told_current(const DriveAxis& axis) const {
  const std::size_t i = &axis == &axes_[0] ? 0 : 1;
  if (!axis.powered()) return 0;
  return objects_.value(axis.moving(now_) ? slot_of_axes(object::kRunCurrent)[i]
                                          : slot_of_axes(object::kHoldCurrent)[i]);
}

/// Farther from where it is told to be than the following error window; of the modes that have a bit for it.
bool Node::follows_badly(const DriveAxis& axis) const {
  const std::size_t i = &axis == &axes_[0] ? 0 : 1;
  const int mode = axis.mode_display();
  if (mode != static_cast<int>(cia402::Mode::kProfilePosition) &&
      mode != static_cast<int>(cia402::Mode::kCyclicSynchronousPosition))
    return false;
  constexpr std::int64_t kUnwatched = 0xFFFF'FFFF;
  const std::int64_t window = objects_.value(slot_of_axes(object::kFollowingErrorWindow)[i]);
  const std::int64_t error = feedback_[i].following_error;
  return window != kUnwatched && (error < 0 ? -error : error) > window;
}

/// Their pins are the same, and the encoder is in use.
bool Node::encoder_takes_scale(int axis) const {
  return options_.scale_is_encoder[static_cast<std::size_t>(axis)] &&
         axis_parameter(slot_of_axes(object::kEncoderMode), axis) != 0;
}

ScaleCounts Node::directed_scales() const {
  ScaleCounts directed{};
  for (std::size_t i = 0; i < directed.size(); ++i) {
    const bool inverted = objects_.value(slot_of_axes(object::kScaleInverted)[i]) != 0;
    const auto counts = static_cast<std::uint32_t>(scale_counts_[i]);
    directed[i] = static_cast<std::int32_t>(inverted ? 0u - counts : counts);
  }
  return directed;
}

bool Node::read_axis_object(const DriveAxis& axis, ObjectAddress base, std::int64_t& value) {
  const std::size_t index = &axis == &axes_[0] ? 0 : 1;
  const DriveFeedback& feedback = feedback_[index];
  const TouchProbe& probe = probes_[index];
  switch (base.index) {
    case 0x2150:
      if (base == object::kAutoTune) value = feedback.tune_state;
      if (base == object::kMotorCurrent) value = measures_ ? feedback.current_ma : told_current(axis);
      if (base == object::kStageTemperature) value = feedback.temperature_dc;
      return true;
    case 0x2160: {
      const int i = &axis == &axes_[0] ? 0 : 1;
      if (base == object::kScaleCorrection) {
        value = whole_counts(correction(now_, i));
        return true;
      }
      const auto home = axis.scale_at_home();
      const bool at_home = base == object::kScaleHomeLatch;
      if (!scale_fitted(i) || (at_home && !home)) return false;
      value = at_home ? *home : directed_scales()[static_cast<std::size_t>(i)];
      return true;
    }
    case 0x6079:
      value = feedback.supply_mv;
      return true;
    case 0x2140:
      if (base == object::kPositionKnown) value = axis.position_known() ? 1 : 0;
      if (base == object::kStreamPosition) value = axis.position(now_);
      if (base == object::kHomeLatch) value = axis.home_latch();
      return true;
    case 0x603F:
      value = axis.error_code();
      return true;
    case 0x6041:
      value = axis.statusword(now_) | (follows_badly(axis) ? cia402::status::kFollowingError : 0);
      return true;
    case 0x6061:
      value = axis.mode_display();
      return true;
    case 0x6062:
      value = whole_counts(axis.position(now_));
      return true;
    case 0x6064:  // without encoder the motor is where it is told to be
      value = whole_counts(axis.position(now_)) - feedback.following_error;
      return true;
    case 0x606C:
      value = axis.velocity(now_);
      return true;
    case 0x60B9:
      value = probe.status();
      return true;
    case 0x60BA:
    case 0x60BB:
      value = probe.counts(base == object::kTouchProbePositive);
      return true;
    case 0x60D1:
    case 0x60D2:
      value = probe.bus_ns(base == object::kTouchProbePositiveTime);
      return true;
    case 0x60C4:
      value = base.subindex == object::kBufferPosition.subindex ? path_.stream().size()
                                                                : SegmentStream::kCapacity;
      return true;
    case 0x60F4:
      value = feedback.following_error;
      return true;
    case 0x60FD: {
      const bool a = &axis == &axes_[0];
      const auto bit = [&](SwitchFunction first, SwitchFunction second, unsigned place) {
        return inputs_.active(a ? first : second) ? 1u << place : 0u;
      };
      value =
          static_cast<std::int64_t>(bit(SwitchFunction::kNegativeLimitA, SwitchFunction::kNegativeLimitB, 0) |
                                    bit(SwitchFunction::kPositiveLimitA, SwitchFunction::kPositiveLimitB, 1) |
                                    bit(SwitchFunction::kHomeA, SwitchFunction::kHomeB, 2) |
                                    (static_cast<unsigned>(inputs_.active_inputs()) << 16));
      return true;
    }
    default:
      return false;
  }
}

std::int64_t Node::counter_value(NodeCounter counter) const {
  const PathMotion::Counters& path = path_.counters();
  const std::uint32_t own =
      counters_[std::min<std::size_t>(static_cast<std::size_t>(counter), counters_.size() - 1)];
  switch (counter) {
    case NodeCounter::kSyncLost:
      return path.sync_lost;
    case NodeCounter::kStampLost:
      return path_.clock().counters().syncs_unstamped + path_.clock().counters().stamps_unmatched;
    case NodeCounter::kClockOutOfBound:
      return path.clock_out_of_bound;
    case NodeCounter::kSequenceErrors:
      return path.sequence_errors;
    case NodeCounter::kQueueOverflows:
      return path.overflows;
    case NodeCounter::kUnderruns:
      return path.underruns;
    case NodeCounter::kCheckpointErrors:
      return path.checkpoint_errors;
    case NodeCounter::kLateRateCommands:
      return path.late_rates;
    case NodeCounter::kDuplicateFrames:
      return path.duplicates + path_.clock().counters().syncs_doubled;
    case NodeCounter::kSdoAborts:
      return sdo_.counters().aborts_sent;
    case NodeCounter::kSwitchGlitches:
      return inputs_.glitches();
    case NodeCounter::kEmergencies:
      return emcy_.sent();
    case NodeCounter::kCoordinatedStops:
      return path.stops;
    case NodeCounter::kLateStops:
      return path.late_stops;
    case NodeCounter::kRecordsReordered:
      return path_.stream().reordered();
    case NodeCounter::kHomingErrors:
      return axes_[0].homing_errors() + axes_[1].homing_errors();
    default:
      return own;
  }
}

bool Node::in_motion() const {
  return moving(now_) || (!path_.at_rest(now_) && !path_.stream().idle());
}

AbortCode Node::check(const ObjectEntry& entry, std::int64_t value) const {
  const bool good = entry.base() != object::kModeOfOperation || known_mode(value);
  return good ? AbortCode::kNone : AbortCode::kInvalidValue;
}

AbortCode Node::write(const ObjectEntry& entry, std::int64_t value) {
  if (kept_in_motion(entry) && in_motion()) return AbortCode::kDeviceState;
  if (entry.binding == Binding::kParameter) parameters_changed_ = true;
  return entry.axis < 0 ? write_node_object(entry, value) : write_axis_object(entry, value);
}

AbortCode Node::write_node_object(const ObjectEntry& entry, std::int64_t value) {
  const ObjectAddress address = entry.address;
  if (PdoEngine::owns(address)) return pdo_.accept(entry, value);
  switch (address.index) {
    case 0x1003:
      if (value != 0) return AbortCode::kInvalidValue;
      emcy_.clear_history();
      return AbortCode::kNone;
    case 0x1005:
      // The gateway sends SYNC, and where it always is.
      return value == 0x80 ? AbortCode::kNone : AbortCode::kInvalidValue;
    case 0x1014:
      return (value & ~kEmcyOff) == 0x80 + node_id_ ? AbortCode::kNone : AbortCode::kInvalidValue;
    case 0x1016: {
      const auto other = static_cast<std::uint16_t>(slot_of(object::kConsumerHeartbeat).value +
                                                    (address.subindex == 1 ? 1 : 0));
      return watch_the_same(value, objects_.value({other})) ? AbortCode::kIncompatible : AbortCode::kNone;
    }
    case 0x1019:
      return sync_counter_refused(value, objects_.value(entry.value_slot()),
                                  objects_.value(slot_of(object::kSyncPeriod)));
    case 0x1010:
    case 0x1011:
      return command_storage(address, value);
    case 0x1F51:
      if (value == 1) return AbortCode::kNone;
      // Stop. A platform on vertical rails would fall without power; the boot loader has none to give.
      if (value != 0 || options_.program_crc == 0 || board_powered()) return AbortCode::kDeviceState;
      program_stop_requested_ = true;
      return AbortCode::kNone;
    case 0x2100:
      return verdict_code(path_.on_record(static_cast<std::uint64_t>(value), now_));
    case 0x2101:
      return verdict_code(path_.on_checkpoint(static_cast<std::uint64_t>(value), now_));
    case 0x2110:
      return path_.on_rate_command(frame_of_bits(value), now_, clear_allowed()) ? AbortCode::kNone
                                                                                : AbortCode::kDeviceState;
    case 0x2111:
      path_.on_stamp(frame_of_bits(value), now_);
      return AbortCode::kNone;
    case 0x2112:
      return value >= 0 && path_.set_path_time(PathTime{value}, now_) ? AbortCode::kNone
                                                                      : AbortCode::kDeviceState;
    default:
      return AbortCode::kNone;
  }
}

AbortCode Node::write_axis_object(const ObjectEntry& entry, std::int64_t value) {
  DriveAxis& axis = axes_[entry.axis == 1 ? 1 : 0];
  const ObjectAddress base = entry.base();
  if (base == object::kControlword) {
    // A master that sends no SYNC has no rate broadcast either: its fault reset lifts a stop.
    const bool reset = (value & ~axis.controlword() & cia402::control::kFaultReset) != 0;
    if (reset && !path_.clock().synchronised() && clear_allowed()) path_.clear_stop(now_);
    axis.on_controlword(now_, static_cast<std::uint16_t>(value));
    return AbortCode::kNone;
  }
  if (base == object::kModeOfOperation) {
    axis.on_mode(now_, static_cast<int>(value));
    return AbortCode::kNone;
  }
  if (base == object::kTouchProbeFunction) {
    probes_[entry.axis == 1 ? 1 : 0].set_function(static_cast<std::uint16_t>(value));
    return AbortCode::kNone;
  }
  if (base == object::kHomingMethod)
    return value == 0 || Homing::supports(static_cast<int>(value)) ? AbortCode::kNone
                                                                   : AbortCode::kInvalidValue;
  if (base == object::kAutoTune) {
    // The motor is supplied and does not move while it is measured.
    if (value != 1 || !axis.powered() || axis.moving(now_)) return AbortCode::kDeviceState;
    tune_requested_[entry.axis == 1 ? 1 : 0] = true;
    return AbortCode::kNone;
  }
  if (base == object::kScaleFitted || base == object::kScaleInverted) {
    if (base == object::kScaleFitted && value != 0 && !options_.scale_inputs[entry.axis == 1 ? 1 : 0])
      return AbortCode::kHardware;
    if (base == object::kScaleFitted && value != 0 && encoder_takes_scale(entry.axis == 1 ? 1 : 0))
      return AbortCode::kDeviceState;
    // The same again, as a gateway says that has been started anew, does not lose where home is.
    if (value != objects_.value(entry.value_slot())) axis.forget_scale();
    return AbortCode::kNone;
  }
  if (base == object::kBufferClear) {
    if (value != 0) return AbortCode::kNone;  // 1: the buffer is in use, which it always is
    if (!path_.clear_stream(now_)) return AbortCode::kDeviceState;
    for (DriveAxis& each : axes_) each.on_stream_cleared(now_);
    // Who has the answer may read where the axes are: by then they have crept to their whole counts.
    clearing_ = axes_[0].creeping(now_) || axes_[1].creeping(now_);
    if (clearing_) sdo_.defer();
    return AbortCode::kNone;
  }
  if (base.index == 0x60C4 && entry.binding == Binding::kLive)
    return value <= SegmentStream::kCapacity ? AbortCode::kNone : AbortCode::kTooHigh;
  return AbortCode::kNone;
}

AbortCode Node::command_storage(ObjectAddress address, std::int64_t value) {
  const bool save = address == object::kStoreParameters;
  if (value != (save ? kSaveSignature : kLoadSignature)) return AbortCode::kCannotStore;
  // Writing flash holds up the processor for longer than a motor with power can wait.
  if (board_powered() || moving(now_) || storing_ != Storing::kNothing) return AbortCode::kDeviceState;
  if (save)
    image_.save(objects_, node_id_, image_.node_id());
  else
    image_.clear(image_.node_id());  // the defaults come into force at the next reset
  storing_ = Storing::kWanted;
  sdo_.defer();
  return AbortCode::kNone;
}

}  // namespace kinebus
