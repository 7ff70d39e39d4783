// HeatNode: what may be written, and what a write does.

#include "node_firmware/heat/heat_node.hpp"
#include "node_firmware/heat/heat_object_places.hpp"

namespace kinebus::heat {
namespace {

using namespace heat_object;

/// Cold enough to try whether a switch opens again: mC.
constexpr std::int32_t kCold = 50'000;

std::int32_t milli(std::int64_t tenths_of_a_degree) {
  return static_cast<std::int32_t>(tenths_of_a_degree) * 100;
}

bool is_sensor_setting(std::uint16_t index) {
  return (index >= kSensorPath.index && index <= kHighestPlausible.index) || index == kSensorWires.index ||
         index == kMains.index || index == kSensorType.index;
}
/// What safety rests on. Which heater the flow is of is none of it: that changes with the tool of a job, and
/// power told for a heater stays within what its own watch and limit allow.
bool is_setting(std::uint16_t index) {
  return is_sensor_setting(index) || (index >= kHeaterSensor.index && index <= kSafeTime.index) ||
         index == kFlowLead.index || (index >= kFanFunction.index && index <= kFanPulses.index) ||
         (index >= kFilamentKind.index && index <= kFilamentLeast.index) || index == kMasterLost.index ||
         index == kPinProbe.index || (index >= kProportionalBand.index && index <= kDerivativeTime.index);
}

}  // namespace

AbortCode HeatNode::write(const ObjectEntry& entry, std::int64_t to) {
  const std::uint16_t index = entry.address.index;
  if (index < 0x2000) return write_communication(entry, to);
  if (index == kFanOutput.index) {
    if (to < 0) return AbortCode::kTooLow;
    fans_[place_of(entry.address)].set_command(static_cast<std::int32_t>(to));
    return AbortCode::kNone;
  }
  if (index == kFlowPower.index) {
    flow_.set(place_of(entry.address), static_cast<std::int32_t>(to) * 10, now_);
    return AbortCode::kNone;
  }
  if (index == kFilamentCommanded.index) {
    filaments_[place_of(entry.address)].on_commanded(static_cast<std::int32_t>(to));
    return AbortCode::kNone;
  }
  if (index == kFilamentReset.index) {
    filaments_[place_of(entry.address)].reset();
    return AbortCode::kNone;
  }
  if (is_of_the_accelerometer(index))
    return vibration_ == nullptr ? AbortCode::kDeviceState : vibration_->write(entry.address, to);
  if (index == kPinCommand.index || index == kServoPulse.index) return write_pin_probe(index, to);
  if (index == kConfirmedSerial.index) return confirm(to);
  if (index == object::kSessionKey.index) {
    sync_seen_ = now_;
    // A key that comes while anything heats was vouched for with the last one: see obeys().
    return session_.write(entry.address.subindex, static_cast<std::uint32_t>(to), false);
  }
  if (entry.binding == Binding::kLive) return write_heater(index, place_of(entry.address), to);
  return check_setting(entry, to);
}

AbortCode HeatNode::write_pin_probe(std::uint16_t index, std::int64_t to) {
  if (!pin_probe_.fitted()) return AbortCode::kDeviceState;
  if (index == kPinCommand.index)
    return pin_probe_.command(now_, static_cast<PinCommand>(to)) ? AbortCode::kNone
                                                                 : AbortCode::kInvalidValue;
  constexpr std::int64_t kShortest = 500;
  if (to != 0 && to < kShortest) return AbortCode::kTooLow;
  pin_probe_.set_pulse(static_cast<std::uint16_t>(to));
  return AbortCode::kNone;
}

AbortCode HeatNode::write_communication(const ObjectEntry& entry, std::int64_t to) {
  if (PdoEngine::owns(entry.address)) return pdo_.accept(entry, to);
  switch (entry.address.index) {
    case 0x1003:
      if (to != 0) return AbortCode::kInvalidValue;
      emcy_.clear_history();
      return AbortCode::kNone;
    case 0x1005:
      // SYNC and EMCY are where they always are.
      return to == 0x80 ? AbortCode::kNone : AbortCode::kInvalidValue;
    case 0x1014:
      return (to & ~kEmcyOff) == 0x80 + node_id_ ? AbortCode::kNone : AbortCode::kInvalidValue;
    case 0x1016:
      if (watch_the_same(
              to, value(heat_slot_of(object::kConsumerHeartbeat), entry.address.subindex == 1 ? 1u : 0u)))
        return AbortCode::kIncompatible;
      communication_changed_ = true;
      return AbortCode::kNone;
    case 0x1019:
      return sync_counter_refused(to, objects_.value(entry.value_slot()),
                                  value(heat_slot_of(object::kSyncPeriod)));
    case 0x1010:
    case 0x1011:
      return command_storage(entry.address, to);
    case 0x1F51:
      return command_program(to);
    default:
      communication_changed_ = true;
      return AbortCode::kNone;
  }
}

// Settings change while nothing heats, and by no job: those run in operational.
AbortCode HeatNode::check_setting(const ObjectEntry& entry, std::int64_t to) {
  if (!is_setting(entry.address.index)) return AbortCode::kNone;
  if (nmt_.state() != NmtState::kPreOperational || any_heat()) return AbortCode::kDeviceState;
  // In its place for a moment, to be looked at with all that hangs together with it.
  const std::int64_t before = objects_.value(entry.value_slot());
  objects_.set_value(entry.value_slot(), to);
  const AbortCode refused = inconsistent(entry);
  objects_.set_value(entry.value_slot(), before);
  if (refused == AbortCode::kNone) settings_changed_ = true;
  return refused;
}

AbortCode HeatNode::inconsistent(const ObjectEntry& entry) const {
  const std::uint16_t index = entry.address.index;
  // A sensor is described first; its type, last, switches it on.
  if (is_sensor_setting(index)) {
    const std::size_t n = place_of(entry.address);
    if (value(heat_slot_of(kSensorType), n) != 0 && !has_path(n)) return AbortCode::kInvalidValue;
    const std::int64_t mains = value(heat_slot_of(kMains));
    if (mains != 50 && mains != 60) return AbortCode::kInvalidValue;
    const SensorSetup setup = sensor_setup(n);
    if (setup.kind != SensorKind::kNone && Linearisation::check(setup) != SetupError::kNone)
      return AbortCode::kInvalidValue;
  }
  for (std::size_t i = 0; i < heaters_.size(); ++i) {
    const int sensor = sensor_number(i);
    if (sensor < 0) continue;
    for (std::size_t other = 0; other < i; ++other)
      if (sensor_number(other) == sensor) return AbortCode::kInvalidValue;  // neither would be watched
    const SensorSetup setup = sensor_setup(static_cast<std::size_t>(sensor));
    if (setup.kind != SensorKind::kNone && milli(value(heat_slot_of(kLimit), i)) > setup.high_mc)
      return index == kLimit.index ? AbortCode::kTooHigh : AbortCode::kInvalidValue;
  }
  return AbortCode::kNone;
}

AbortCode HeatNode::write_heater(std::uint16_t index, std::size_t n, std::int64_t to) {
  switch (index) {
    case kSetPoint.index:
      return write_set_point(n, to);
    case kOnOff.index:
      on_[n] = to != 0;
      break;
    case kFeedForward.index:
      feed_forward_[n] = static_cast<std::int16_t>(to);
      break;
    case kTune.index:
      return begin_tuning(n, to);
    case kFaultReset.index:
      return reset_fault(n);
    default:
      return AbortCode::kNoData;
  }
  apply_targets();
  return AbortCode::kNone;
}

AbortCode HeatNode::write_set_point(std::size_t n, std::int64_t to) {
  Heater& heater = heaters_[n];
  if (to > highest_set_point(n)) return AbortCode::kTooHigh;
  if (to < 0) return AbortCode::kTooLow;
  const bool ready = confirmed_ && sensor_of(n) != nullptr && heater.fault() == HeaterFault::kNone &&
                     contactor() && !master_lost_;
  if (to != 0 && (!ready || heater.tuning())) return AbortCode::kDeviceState;
  if (to == 0 && heater.tuning()) heater.trip(HeaterFault::kNone);
  set_points_[n] = static_cast<std::int16_t>(to);
  apply_targets();
  return AbortCode::kNone;
}

AbortCode HeatNode::begin_tuning(std::size_t n, std::int64_t to) {
  Heater& heater = heaters_[n];
  const SensorInput* sensor = sensor_of(n);
  if (to > highest_set_point(n)) return AbortCode::kTooHigh;
  if (to <= 0) return AbortCode::kTooLow;
  if (!confirmed_ || sensor == nullptr || !sensor->good() || heater.fault() != HeaterFault::kNone ||
      !contactor() || master_lost_ || tuning_.running() || set_points_[n] != 0 || !on_[n])
    return AbortCode::kDeviceState;
  heater.begin_tuning(tuning_, *sensor, milli(to));
  tuned_ = static_cast<int>(n);
  tuning_taken_ = !heater.tuning();
  return heater.tuning() ? AbortCode::kNone : AbortCode::kTooLow;  // the way is too short to measure anything
}

// Two boards whose ids were exchanged have other heaters behind the same numbers: who means another one must
// not heat this.
AbortCode HeatNode::confirm(std::int64_t serial) {
  confirmed_ = serial == options_.serial;
  if (!confirmed_) switch_off();
  return confirmed_ ? AbortCode::kNone : AbortCode::kInvalidValue;
}

AbortCode HeatNode::reset_fault(std::size_t n) {
  Heater& heater = heaters_[n];
  const SensorInput* sensor = sensor_of(n);
  // The contactor closes on a cold block only: its switch may still not open.
  const bool cold = sensor != nullptr && sensor->good() && sensor->temperature() < kCold;
  if (heater.fault() == HeaterFault::kHeatUnasked && !cold) return AbortCode::kDeviceState;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    bool mine = true;  // or nobody's
    for (std::size_t h = 0; h < heaters_.size(); ++h)
      if (h != n && sensor_number(h) == static_cast<int>(i)) mine = false;
    if (mine && sensors_[i].fault() != SensorFault::kNone) sensors_[i].clear(now_);
  }
  for (Fan& fan : fans_)
    if (fan.settings().heater == n + 1) fan.clear_stall(now_);
  heater.clear_fault();
  return AbortCode::kNone;
}

AbortCode HeatNode::command_storage(ObjectAddress address, std::int64_t to) {
  const bool save = address == object::kStoreParameters;
  if (to != (save ? kSaveSignature : kLoadSignature)) return AbortCode::kCannotStore;
  // Writing flash holds up control.
  if (any_heat() || neighbours_powered_ || storing_ != Storing::kNothing) return AbortCode::kDeviceState;
  if (save)
    image_.save(objects_, node_id_, image_.node_id());
  else
    image_.clear(image_.node_id());  // the defaults come into force at the next reset
  storing_ = Storing::kWanted;
  sdo_.defer();
  return AbortCode::kNone;
}

AbortCode HeatNode::command_program(std::int64_t to) {
  if (to == 1) return AbortCode::kNone;
  if (to != 0 || options_.program_crc == 0 || any_heat() || neighbours_powered_)
    return AbortCode::kDeviceState;
  program_stop_requested_ = true;
  return AbortCode::kNone;
}

}  // namespace kinebus::heat
