#include "gateway/bus_nodes/node_configuration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gateway/bus_nodes/heat_settings.hpp"
#include "gateway/calibration/joint_map.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "protocol/canopen/object_dictionary.hpp"
#include "protocol/canopen/sync.hpp"

namespace kinebus {
namespace {

/// A dictionary without a device behind it.
struct NoDevice : ObjectOwner {
  AbortCode read(const ObjectEntry&, std::int64_t& value) override {
    value = 0;
    return AbortCode::kNone;
  }
  AbortCode write(const ObjectEntry&, std::int64_t) override { return AbortCode::kNone; }
};

// The node guards what it is told with these; the gateway keeps to the exact limits. The margins are for
// rounding to counts and for the carriage's run-out behind its switch.
constexpr double kSpeedMargin = 1.02;
constexpr double kAccelerationMargin = 1.05;
constexpr double kTravelMargin = 2;  // mm or rad
// A node brakes by its own crystal, which may be 100 ppm fast: its deceleration counts twice that more.
constexpr double kCrystalShare = 0.9995;
constexpr double kStreamSubMode = -1;  // 60C0h

class Writer {
 public:
  explicit Writer(std::uint8_t node_id) : dictionary_(device_, node_id) {}
  void set(ObjectAddress address, double value) {
    const int slot = find_object(address);
    if (slot < 0) return;
    const ObjectEntry& entry = kNodeObjects[static_cast<std::size_t>(slot)];
    double low = is_signed(entry.type) ? -std::ldexp(1.0, 8 * entry.size() - 1) : 0;
    double high = std::ldexp(1.0, 8 * entry.size() - (is_signed(entry.type) ? 1 : 0)) - 1;
    if (entry.limited) {
      low = static_cast<double>(entry.low());
      high = static_cast<double>(entry.high());
    }
    dictionary_.set_value(entry.value_slot(), std::llround(std::clamp(value, low, high)));
  }
  void set_axis(int axis, ObjectAddress base, double value) {
    set(on_axis(base, static_cast<std::size_t>(axis)), value);
  }
  void set_element(ObjectAddress first, std::size_t n, double value) {
    set({first.index, static_cast<std::uint8_t>(first.subindex + n)}, value);
  }
  const ObjectDictionary& dictionary() const { return dictionary_; }

 private:
  NoDevice device_;
  NodeDictionary dictionary_;
};

double milliseconds(std::chrono::milliseconds time) {
  return static_cast<double>(time.count());
}

SwitchFunction function_of(const SwitchInput& input) {
  switch (input.function) {
    case InputFunction::kNone:
      return SwitchFunction::kNone;
    case InputFunction::kHome:
      return input.axis == 0 ? SwitchFunction::kHomeA : SwitchFunction::kHomeB;
    case InputFunction::kPositiveLimit:
      return input.axis == 0 ? SwitchFunction::kPositiveLimitA : SwitchFunction::kPositiveLimitB;
    case InputFunction::kNegativeLimit:
      return input.axis == 0 ? SwitchFunction::kNegativeLimitA : SwitchFunction::kNegativeLimitB;
    case InputFunction::kEmergencyStop:
      return SwitchFunction::kEmergencyStop;
    case InputFunction::kProbe:
      return SwitchFunction::kProbe;
  }
  return SwitchFunction::kNone;
}

void set_node(Writer& writer, const MachineDescription& machine, const NodeDescription& node) {
  using namespace object;
  writer.set(kConsumerHeartbeat, kGatewayNodeId * 65536.0 + milliseconds(machine.bus.heartbeat_timeout));
  writer.set(kProducerHeartbeat, milliseconds(machine.bus.heartbeat_period));
  writer.set(kStopRamp, milliseconds(machine.stop.ramp));
  writer.set(kSyncLossTimeout, milliseconds(machine.bus.sync_timeout));
  for (std::size_t i = 0; i < node.inputs.size(); ++i) {
    writer.set_element(kSwitchFunction, i, static_cast<double>(function_of(node.inputs[i])));
    writer.set_element(kSwitchPolarity, i, node.inputs[i].active_low ? 1 : 0);
    writer.set_element(kSwitchDebounce, i, static_cast<double>(node.inputs[i].debounce.count()));
  }
}

// Following errors come so often from a node that has an encoder: 16 frames/s of a bus of 7400.
constexpr double kFollowingPeriod_ms = 60;
constexpr ObjectAddress kFollowingPdo{0x1803, 1}, kFollowingPdoTimer{0x1803, 5};

void set_motor(Writer& writer, int axis, const MotorDescription& motor, const DriveTrain& drive) {
  using namespace object;
  writer.set_axis(axis, kPhaseResistance, 1e3 * motor.resistance_ohm);
  writer.set_axis(axis, kPhaseInductance, 1e3 * motor.inductance_mh);
  // Vs of flux linkage: a full step is a quarter of an electrical turn.
  const double pole_pairs = drive.full_steps_per_turn / 4.0;
  writer.set_axis(axis, kFluxLinkage, 1e6 * motor.torque_nm_per_a / pole_pairs);
  writer.set_axis(axis, kEncoderMode, static_cast<int>(motor.encoder) + (motor.encoder_reversed ? 4 : 0));
  writer.set_axis(axis, kEncoderOffset, motor.encoder_offset_counts);
}

void set_joint(Writer& writer, const JointDescription& joint) {
  using namespace object;
  const int axis = joint.axis & 1;
  const double counts = std::abs(joint.drive.counts_per_unit());
  const double slope = joint.drive.counts_per_unit() / (1 + joint.calibration.scale);
  writer.set_axis(axis, kRunCurrent, joint.run_current_ma);
  writer.set_axis(axis, kHoldCurrent, joint.hold_current_ma);
  writer.set_axis(axis, kCountsPerUnit, 1000 * counts);
  if (joint.driver) {
    writer.set_axis(axis, kDriverKind, joint.driver->stands_alone ? 0 : 1);
    writer.set_axis(axis, kSenseResistor, joint.driver->sense_resistor_mohm.value_or(0));
    writer.set_axis(axis, kSpreadCycleAbove, joint.driver->stealthchop_below_per_s * counts);
  }
  if (joint.motor) set_motor(writer, axis, *joint.motor, joint.drive);
  if (joint.has_encoder()) {
    writer.set(kFollowingPdo, 0x4000'0480u + joint.node_id);
    writer.set(kFollowingPdoTimer, kFollowingPeriod_ms);
  }
  if (joint.travel.limited()) {
    const double a = (joint.travel.min - kTravelMargin) * slope;
    const double b = (joint.travel.max + kTravelMargin) * slope;
    writer.set_axis(axis, kMinPositionLimit, std::min(a, b));
    writer.set_axis(axis, kMaxPositionLimit, std::max(a, b));
  }
  writer.set_axis(axis, kMaxProfileVelocity, kSpeedMargin * joint.speed_per_s * counts);
  writer.set_axis(axis, kMaxAcceleration, kAccelerationMargin * joint.accel_per_s2 * counts);
  writer.set_axis(axis, kMaxDeceleration, kAccelerationMargin * joint.accel_per_s2 * counts);
  writer.set_axis(axis, kQuickStopDeceleration, kCrystalShare * joint.stop_accel_per_s2 * counts);
  writer.set_axis(axis, kProfileVelocity, joint.speed_per_s * counts / 4);
  writer.set_axis(axis, kProfileAcceleration, joint.accel_per_s2 * counts / 4);
  writer.set_axis(axis, kProfileDeceleration, joint.accel_per_s2 * counts / 4);
  writer.set_axis(axis, kHomeOffset, -static_cast<double>(home_counts(joint)));
  writer.set_axis(axis, kInterpolationSubMode, kStreamSubMode);
  if (!joint.homing) {
    writer.set_axis(axis, kHomingMethod, 37);
    return;
  }
  const HomingDescription& homing = *joint.homing;
  writer.set_axis(axis, kHomingMethod, homing.node_method(joint.drive));
  writer.set_axis(axis, kHomingFastSpeed, homing.fast_per_s * counts);
  writer.set_axis(axis, kHomingSlowSpeed, homing.slow_per_s * counts);
  writer.set_axis(axis, kHomingAcceleration, homing.accel_per_s2 * counts);
  writer.set_axis(axis, kHomingTravel, homing.max_search * counts);
  // The carriage leaves the switch within a few times the distance that it backs off.
  writer.set_axis(axis, kHomingBackOff, (homing.by_load() ? 1 : 10) * homing.back_off * counts);
  writer.set_axis(axis, kStallThreshold, homing.stall_threshold.value_or(0));
  writer.set_axis(axis, kStallAbove, homing.stall_above_per_s * counts);
}

/// As 2160h:1 counts them.
int kind_of(const ScaleDescription& scale) {
  if (!scale.absolute_bits) return 1;
  return static_cast<int>(*scale.absolute_bits) + (scale.gray_code ? 32 : 0);
}

/// Both axes of a node that has a scale.
std::vector<ParameterWrite> scale_settings(const MachineDescription& machine, std::uint8_t node_id) {
  std::array<const JointDescription*, 2> scales{};
  for (const JointDescription& joint : machine.joints)
    if (joint.node_id == node_id && joint.scale) scales[joint.axis & 1u] = &joint;
  if (scales[0] == nullptr && scales[1] == nullptr) return {};
  const ScaleDescription none{};
  std::vector<ParameterWrite> writes;
  for (std::size_t axis = 0; axis < scales.size(); ++axis) {
    const auto write = [&](ObjectAddress base, std::uint8_t size, std::int64_t value) {
      writes.push_back({on_axis(base, axis), size, value});
    };
    const ScaleDescription& scale = scales[axis] == nullptr ? none : *scales[axis]->scale;
    write(object::kScaleCountsPerUnit, 4, std::llround(1000 * scale.pulses_per_mm));
    write(object::kScaleInverted, 1, scale.inverted ? 1 : 0);
    write(object::kScaleFitted, 1, scales[axis] == nullptr ? 0 : kind_of(scale));
    if (scales[axis] == nullptr || scale.correction_mm == 0) {
      write(object::kScaleCorrectionMost, 4, 0);
      continue;
    }
    // What calibration knows of the screw already is in the command.
    const double counts_per_mm =
        scales[axis]->drive.counts_per_unit() / (1 + scales[axis]->calibration.scale);
    write(object::kScaleMotorRatio, 4, std::llround(65536 * counts_per_mm / scale.pulses_per_mm));
    write(object::kScaleCorrectionRate, 4, std::llround(std::abs(counts_per_mm) * scale.correction_mm_per_s));
    write(object::kScaleCorrectionMost, 4, std::llround(std::abs(counts_per_mm) * scale.correction_mm));
  }
  return writes;
}

}  // namespace

std::int32_t home_counts(const JointDescription& joint) {
  if (!joint.homing) return 0;
  const JointCalibration& c = joint.calibration;
  const double slope = joint.drive.counts_per_unit() / (1 + c.scale);
  const double drive = JointMap(c).to_drive(joint.homing->switch_position + c.offset);
  return static_cast<std::int32_t>(
      std::lround(slope * (drive + joint.homing->edge_direction() * c.backlash / 2)));
}

std::optional<Sentence> load_sensor_missing(const MachineDescription& machine, std::uint8_t node_id,
                                            ObjectAddress sensor, std::int64_t state) {
  constexpr std::int64_t kStandsAlone = 0, kSilent = 4;
  if (state != kStandsAlone && state != kSilent) return std::nullopt;
  std::string name;
  for (const JointDescription& joint : machine.joints)
    if (joint.node_id == node_id && on_axis(object::kDriverState, joint.axis & 1u) == sensor)
      name = joint.name;
  if (state == kSilent)
    return say(
        "%1 is to home by its driver's load, and the driver does not answer node %2: look at the motor "
        "supply and the jumpers in its socket, or home it at a switch",
        name, node_id);
  return say(
      "%1 is to home by its driver's load, and node %2 has no driver there that tells it (TMC2209, "
      "TMC5160, TMC2130): home it at a switch, method 17 to 22",
      name, node_id);
}

ParameterWrite homing_speed(const JointDescription& joint, double per_s) {
  const std::size_t axis = joint.axis & 1u;
  Writer writer(joint.node_id);
  writer.set_axis(static_cast<int>(axis), object::kHomingFastSpeed,
                  per_s * std::abs(joint.drive.counts_per_unit()));
  const ObjectAddress address = on_axis(object::kHomingFastSpeed, axis);
  const ObjectEntry& entry = kNodeObjects[static_cast<std::size_t>(find_object(address))];
  return {address, static_cast<std::uint8_t>(entry.size()), writer.dictionary().value(entry.value_slot())};
}

NodeConfiguration configure_node(const MachineDescription& machine, std::uint8_t node_id) {
  const NodeDescription* described = machine.node(node_id);
  if (described != nullptr && !described->functions.has_axes()) {
    const auto heartbeats =
        (std::int64_t{kGatewayNodeId} << 16) + std::int64_t{machine.bus.heartbeat_timeout.count()};
    NodeConfiguration configuration;
    configuration.writes = {{object::kConsumerHeartbeat, 4, heartbeats},
                            {object::kProducerHeartbeat, 2, machine.bus.heartbeat_period.count()},
                            {object::kSyncCounterOverflow, 1, kinebus::kSyncCounterOverflow}};
    if (machine.carries_heat(node_id)) add_heat_settings(machine, node_id, configuration);
    return configuration;
  }
  Writer writer(node_id);
  // 1006h stays 0: 1019h can be written then, and what a node makes of a lost SYNC is said by 2114h.
  writer.set(object::kSyncCounterOverflow, kinebus::kSyncCounterOverflow);
  if (const NodeDescription* node = machine.node(node_id)) set_node(writer, machine, *node);
  for (const JointDescription& joint : machine.joints)
    if (joint.node_id == node_id) set_joint(writer, joint);

  NodeConfiguration configuration;
  configuration.fingerprint = writer.dictionary().fingerprint();
  for (const ObjectEntry& entry : kNodeObjects) {
    const bool following = entry.address == kFollowingPdo || entry.address == kFollowingPdoTimer;
    const bool pdo = entry.address.index >= 0x1400 && entry.address.index < 0x1C00 && !following;
    const bool cob_id = entry.address == object::kSyncCobId || entry.address == object::kEmcyCobId;
    if (entry.binding != Binding::kParameter || !entry.writable() || pdo || cob_id) continue;
    configuration.writes.push_back(
        {entry.address, entry.size(), writer.dictionary().value(entry.value_slot())});
  }
  configuration.settings = scale_settings(machine, node_id);
  for (const JointDescription& joint : machine.joints)
    if (joint.node_id == node_id && joint.homing && joint.homing->by_load())
      configuration.load_sensors.push_back(on_axis(object::kDriverState, joint.axis & 1u));
  return configuration;
}

}  // namespace kinebus
