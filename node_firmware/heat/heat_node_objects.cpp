// HeatNode: what the objects say whose values are the node's own state.

#include <cstdlib>

#include "node_firmware/heat/heat_node.hpp"
#include "node_firmware/heat/heat_object_places.hpp"

namespace kinebus::heat {
namespace {

using namespace heat_object;

/// At its target: mC.
constexpr std::int32_t kThere = 2'000;

std::int32_t tenths(std::int32_t mc) {
  return (mc + (mc < 0 ? -50 : 50)) / 100;
}

}  // namespace

AbortCode HeatNode::read(const ObjectEntry& entry, std::int64_t& result) {
  const std::uint16_t index = entry.address.index;
  const std::size_t n = place_of(entry.address);
  switch (index) {
    case kRatio.index:
    case kInputStatus.index:
    case kInputI16.index:
    case kInputI32.index:
      return read_sensor(index, n, result);
    case kFanSpeed.index:
      result = fans_[n].turns_per_minute();
      return AbortCode::kNone;
    case kFanOutput.index:
      result = fans_[n].command();
      return AbortCode::kNone;
    case kFlowPower.index:
      result = flow_.step(n) / 10;
      return AbortCode::kNone;
    case kFilamentCommanded.index:
    case kFilamentSeen.index:
    case kFilamentState.index:
      return read_filament(index, n, result);
    default:
      break;
  }
  const bool of_a_heater = (index >= kHeaterState.index && index <= kTuneState.index) ||
                           index == kOnOff.index || index == kSetPoint.index ||
                           index == kEffectiveOutput.index;
  return of_a_heater ? read_heater(index, n, result) : read_device(entry.address, result);
}

AbortCode HeatNode::read_device(ObjectAddress address, std::int64_t& result) const {
  if (is_of_the_accelerometer(address.index)) {
    result = 0;
    return vibration_ == nullptr ? AbortCode::kNone : vibration_->read(address, result);
  }
  switch (address.index) {
    case 0x1001:
      result = emcy_.error_register();
      return AbortCode::kNone;
    case 0x1002:
      result = master_lost_ ? 1 : 0;
      return AbortCode::kNone;
    case 0x1003:
      if (address.subindex > emcy_.history_length()) return AbortCode::kNoData;
      result = address.subindex == 0 ? emcy_.history_length() : emcy_.history(address.subindex - 1u);
      return AbortCode::kNone;
    case 0x1010:
    case 0x1011:
      result = 1;  // on command, of all parameters
      return AbortCode::kNone;
    case 0x1013:
      result = static_cast<std::uint32_t>(now_.count() / 1000);
      return AbortCode::kNone;
    case 0x1018: {
      const std::array<std::uint32_t, 4> fields{kVendorId, HeatBoard::kFacts.product_code,
                                                HeatBoard::kFacts.revision, options_.serial};
      result = fields[place_of(address) & 3u];
      return AbortCode::kNone;
    }
    case 0x1F51:
      result = 1;  // a program runs: this one
      return AbortCode::kNone;
    case 0x1F56:
      result = options_.program_crc;
      return AbortCode::kNone;
    case 0x1F57:
      result = 0;
      return AbortCode::kNone;
    case kFingerprint.index:
      result = objects_.fingerprint();
      return AbortCode::kNone;
    case kContactor.index:
      result = contactor() ? 1 : 0;
      return AbortCode::kNone;
    case kPinState.index:
      result = static_cast<std::int64_t>(pin_probe_.state());
      return AbortCode::kNone;
    case kServoPulse.index:
      result = pin_probe_.pulse();
      return AbortCode::kNone;
    case kProbeLine.index:
      result = pin_probe_.level() ? 1 : 0;
      return AbortCode::kNone;
    case kSupply.index:
      result = supply_mv_;
      return AbortCode::kNone;
    case object::kSessionKey.index:
      result = session_.in_force() ? 1 : 0;
      return AbortCode::kNone;
    case kFramesRefused.index:
      result = session_.refused();
      return AbortCode::kNone;
    case kConfirmedSerial.index:
      result = confirmed_ ? options_.serial : 0;
      return AbortCode::kNone;
    default:
      return AbortCode::kNoData;
  }
}

AbortCode HeatNode::read_sensor(std::uint16_t index, std::size_t n, std::int64_t& result) const {
  const SensorInput& sensor = sensors_[n];
  if (index == kRatio.index) {
    result = sensor.ratio();
  } else if (index == kInputStatus.index) {
    // An open thermistor is below what can be measured, an open resistance thermometer above.
    const auto kind = static_cast<SensorKind>(value(heat_slot_of(kSensorType), n));
    const bool rises = kind == SensorKind::kPt100 || kind == SensorKind::kPt1000;
    const bool open = sensor.fault() == SensorFault::kOpen, shorted = sensor.fault() == SensorFault::kShort;
    result = (sensor.configured() && sensor.good() ? 0 : 1) | ((rises ? open : shorted) ? 2 : 0) |
             ((rises ? shorted : open) ? 4 : 0);
  } else {
    result = sensor.configured() ? tenths(sensor.temperature()) : 0;
  }
  return AbortCode::kNone;
}

AbortCode HeatNode::read_filament(std::uint16_t index, std::size_t n, std::int64_t& result) const {
  const FilamentWatch& filament = filaments_[n];
  result = index == kFilamentCommanded.index ? filament.commanded()
           : index == kFilamentSeen.index    ? filament.seen()
                                             : static_cast<std::int64_t>(filament.state());
  return AbortCode::kNone;
}

std::uint8_t HeatNode::heater_state(std::size_t n) const {
  const Heater& heater = heaters_[n];
  const SensorInput* sensor = sensor_of(n);
  if (heater.fault() != HeaterFault::kNone) return 4;
  if (heater.tuning()) return 3;
  if (heater.target() == 0 || sensor == nullptr) return 0;
  return std::abs(sensor->temperature() - heater.target()) <= kThere ? 2 : 1;
}

AbortCode HeatNode::read_heater(std::uint16_t index, std::size_t n, std::int64_t& result) const {
  switch (index) {
    case kHeaterState.index:
      result = heater_state(n);
      return AbortCode::kNone;
    case kHeaterFault.index:
      result = static_cast<std::int64_t>(heaters_[n].fault());
      return AbortCode::kNone;
    case kFeedForward.index:
      result = feed_forward_[n];
      return AbortCode::kNone;
    case kTuneState.index:
      result = static_cast<int>(n) == tuned_
                   ? static_cast<int>(tuning_.state()) | static_cast<int>(tuning_.failure()) << 4
                   : 0;
      return AbortCode::kNone;
    case kOnOff.index:
      result = on_[n] ? 1 : 0;
      return AbortCode::kNone;
    case kSetPoint.index:
      result = set_points_[n];
      return AbortCode::kNone;
    case kEffectiveOutput.index:
      result = heater_output(static_cast<int>(n)) * 1000u >> 16;
      return AbortCode::kNone;
    default:
      return AbortCode::kNoData;
  }
}

}  // namespace kinebus::heat
