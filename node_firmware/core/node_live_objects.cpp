// Node: the objects whose values are the node's own state.

#include <utility>

#include "node_firmware/core/emergency_codes.hpp"
#include "node_firmware/core/node.hpp"

namespace kinebus {

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
      value = path_.status_flags();
      return true;
    case 0x1003:
      value = emcy_.history_length();
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
      value = static_cast<std::int64_t>(
          encode(path_.status(now_, objects_.value(slot_of(object::kTailCheck)) != 0)));
      return true;
    case 0x2112:
      value = path_.tau(now_).count();
      return true;
    case 0x2116:
      value = objects_.fingerprint();
      return true;
    case object::kSessionKey.index:
      value = session_.in_force() ? 1 : 0;
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
      value = inputs_.shown_inputs();
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
  // FFFF'FFFFh, unwatched, is more than an error can be.
  const std::int64_t window = objects_.value(slot_of_axes(object::kFollowingErrorWindow)[i]);
  const std::int64_t error = feedback_[i].following_error;
  return (error < 0 ? -error : error) > window;
}

AbortCode Node::may_fit_scale(const Node& node, int axis, std::uint8_t kind) {
  const Scale asked{.kind = kind};
  if (!asked.quadrature() && !asked.absolute()) return AbortCode::kInvalidValue;
  const auto inputs = static_cast<unsigned>(node.options_.scale_inputs[static_cast<std::size_t>(axis)]);
  const auto wanted =
      static_cast<unsigned>(asked.quadrature() ? ScaleInput::kQuadrature : ScaleInput::kAbsolute);
  if ((inputs & wanted) == 0) return AbortCode::kHardware;
  if ((inputs & wanted << 2) == 0) return AbortCode::kNone;
  return node.axis_parameter(slot_of_axes(object::kEncoderMode), axis) == 0 ? AbortCode::kNone
                                                                            : AbortCode::kDeviceState;
}

Node::Scale Node::scale(int axis) const {
  return {.kind = static_cast<std::uint8_t>(axis_parameter(slot_of_axes(object::kScaleFitted), axis)),
          .counts_per_m =
              static_cast<std::uint32_t>(axis_parameter(slot_of_axes(object::kScaleCountsPerUnit), axis))};
}

void Node::set_scale(int axis, std::int32_t counts) {
  const auto i = static_cast<std::size_t>(axis & 1);
  scale_counts_[i] = counts;
  // What an edge has met meanwhile was not what the scale said there.
  if (std::exchange(scale_lost_[i], false)) axes_[i].forget_scale();
}

void Node::lose_scale(int axis) {
  const auto i = static_cast<std::size_t>(axis & 1);
  scale_lost_[i] = true;
  axes_[i].forget_scale();
  // What it was to lead may be anywhere.
  if (axis_parameter(slot_of_axes(object::kScaleCorrectionMost), axis) == 0 || !axes_[i].moving(now_) ||
      path_.stop_latched())
    return;
  count(NodeCounter::kDriveFaults);
  path_.request_stop(StopReason::kAxisFault, axis, emcy::kIncrementalEncoder, now_);
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
      value = feedback.tune_state;
      if (base == object::kMotorCurrent) value = measures_ ? feedback.current_ma : told_current(axis);
      if (base == object::kStageTemperature) value = feedback.temperature_dc;
      return true;
    case 0x2160: {
      const int i = static_cast<int>(index);
      if (base == object::kScaleCorrection) {
        value = whole_counts(correction(now_, i));
        return true;
      }
      const auto home = axis.scale_at_home();
      const bool at_home = base == object::kScaleHomeLatch;
      if (!scale_fitted(i) || scale_lost_[index] || (at_home && !home)) return false;
      value = at_home ? *home : directed_scales()[index];
      return true;
    }
    case 0x2170:
      value = drivers_[index].state;
      if (base == object::kDriverStatus) value = drivers_[index].status;
      if (base == object::kStallGuard) value = drivers_[index].stall_guard;
      if (base == object::kDriverFound) value = drivers_[index].found;
      return true;
    case 0x6079:
      value = feedback.supply_mv;
      return true;
    case 0x2140:
      value = axis.position_known() ? 1 : 0;
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
    case 0x606B:
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
    case NodeCounter::kFramesRefused:
      return session_.refused();
    case NodeCounter::kRecordsReordered:
      return path_.stream().reordered();
    case NodeCounter::kHomingErrors:
      return axes_[0].homing_errors() + axes_[1].homing_errors();
    default:
      return counters_[static_cast<std::size_t>(counter)];
  }
}

}  // namespace kinebus
