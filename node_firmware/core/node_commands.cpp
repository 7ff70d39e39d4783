// Node: the commands that are given by writing objects, and what may not be written now.

#include <algorithm>

#include "node_firmware/core/node.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

/// Two years at full rate. Path time has 51 bits: what is beyond them would wrap around.
constexpr std::int64_t kMostPathTime = std::int64_t{1} << 50;

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
  return mode == 0 || mode == 1 || mode == 3 || mode == 6 || mode == 7 || mode == 8;
}

}  // namespace

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
    case 0x100C:
    case 0x100D:
      parameters_changed_ = true;
      return AbortCode::kNone;
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
      if (value < 0 || value > kMostPathTime) return AbortCode::kTooHigh;
      return path_.set_path_time(PathTime{value}, now_) ? AbortCode::kNone : AbortCode::kDeviceState;
    case object::kSessionKey.index:
      return session_.write(address.subindex, static_cast<std::uint32_t>(value), in_motion());
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
    if (base == object::kScaleFitted && value != 0) {
      if (options_.may_fit_scale == nullptr) return AbortCode::kHardware;
      const AbortCode no =
          options_.may_fit_scale(*this, entry.axis == 1 ? 1 : 0, static_cast<std::uint8_t>(value));
      if (no != AbortCode::kNone) return no;
    }
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
