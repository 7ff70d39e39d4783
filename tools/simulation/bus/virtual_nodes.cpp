#include "tools/simulation/bus/virtual_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>

#include "gateway/calibration/joint_map.hpp"

namespace kinebus {
namespace {

/// A scale on the joint itself: behind screw, belt and play. Where it counts from is anybody's guess.
std::function<std::int32_t(double)> scale_of(const JointDescription& joint) {
  if (!joint.scale) return {};
  return [plant = JointPlant(joint), scale = *joint.scale,
          from = std::optional<double>()](double counts) mutable {
    const double at = plant.at(counts);
    if (!from) from = at;
    const auto whole = static_cast<std::int32_t>(std::floor((at - *from) * scale.pulses_per_mm));
    return scale.inverted ? -whole : whole;
  };
}

// Vendor id 0 is not assigned by CiA: fine for simulated boards unless the machine file asks for another.
NodeIdentity identity_of(const NodeDescription& node) {
  NodeIdentity identity;
  identity.vendor_id = node.vendor.value_or(0);
  identity.product_code = node.product.value_or(0x4B42);
  identity.revision = 1;
  identity.serial = node.serial.value_or(1000u + node.id);
  return identity;
}

VirtualAxis axis_of(const JointDescription& joint, const NodeDescription& node, double start) {
  const double counts_per_unit = joint.drive.counts_per_unit();
  VirtualAxis axis;
  axis.start_counts = start * counts_per_unit;
  axis.scale = scale_of(joint);
  axis.max_counts_per_s = 2 * std::abs(joint.speed_per_s * counts_per_unit);
  if (joint.homing && joint.homing->switch_input != 0) {
    const HomingDescription& homing = *joint.homing;
    axis.switch_input = homing.switch_input;
    // The edge is met by the joint; the motor then stands where the joint's true errors put it.
    const JointCalibration& truth = joint.calibration;
    const double drive = JointMap(truth).to_drive(homing.switch_position + truth.offset) +
                         homing.edge_direction() * truth.backlash / 2;
    axis.switch_counts = drive / (1 + truth.scale) * counts_per_unit;
    axis.active_above = homing.towards_positive() != joint.drive.inverted;
    axis.active_low = node.inputs[static_cast<std::size_t>(homing.switch_input - 1)].active_low;
  }
  return axis;
}

/// The motor that alone moves when filament is fed.
std::optional<VirtualExtruder> extruder_of(const MachineDescription& machine) {
  const auto kinematics = make_kinematics(machine);
  if (machine.filament_sensors.empty() || !kinematics) return std::nullopt;
  Pose pose = (*kinematics)->bed_reference();
  JointVector before{}, after{};
  static_cast<void>((*kinematics)->inverse(Frame::kMachine, pose, before));
  pose[kE] += 1;
  static_cast<void>((*kinematics)->inverse(Frame::kMachine, pose, after));
  for (std::size_t j = 0; j < machine.joints.size(); ++j)
    for (std::size_t n = 0; n < machine.nodes.size(); ++n) {
      const JointDescription& joint = machine.joints[j];
      if (std::abs(after[j] - before[j]) > 0.5 && machine.nodes[n].id == joint.node_id)
        return VirtualExtruder{static_cast<int>(n), joint.axis, 1 / joint.drive.counts_per_unit()};
    }
  return std::nullopt;
}

heat::SensorPart part_of(const SensorWiring& wiring) {
  heat::SensorPart part{.ohm_25 = wiring.nominal_ohm, .beta = static_cast<double>(wiring.beta_k)};
  if (const auto known = heat::sensor_part(static_cast<std::uint16_t>(wiring.element))) part = *known;
  if (wiring.element == SensorElement::kPoints)
    part = heat::SensorPart::thermistor(wiring.points_c, wiring.points_ohm);
  part.reference_ohm = wiring.reference_ohm;
  part.max31865 = wiring.max31865;
  return part;
}

/// What the builder has plugged into a heat node, by the file's word for it.
void plug_sensors(const MachineDescription& machine, std::uint8_t node_id, VirtualNodeOptions& options) {
  const NodeDescription* node = machine.node(node_id);
  // Inputs are the heaters' first.
  const std::size_t heaters = node != nullptr ? node->functions.heaters : 0;
  const auto plug = [&](const DevicePlace& place, std::size_t first, const SensorWiring& wiring) {
    const std::size_t input = first + place.channel - 1u;
    if (place.on_node() && place.node_id == node_id && input < options.sensors.size())
      options.sensors[input] = part_of(wiring);
  };
  for (const HeaterDescription& heater : machine.heaters) plug(heater.place, 0, heater.wiring.sensor);
  for (const SensorDescription& sensor : machine.sensors) plug(sensor.place, heaters, sensor.wiring);
}

}  // namespace

std::vector<VirtualNodeOptions> virtual_nodes_of(const MachineDescription& machine,
                                                 const VirtualClocks& clocks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<VirtualNodeOptions> nodes;
  const auto count = machine.nodes.size();
  const auto extruder = extruder_of(machine);
  for (std::size_t n = 0; n < count; ++n) {
    const NodeDescription& node = machine.nodes[n];
    VirtualNodeOptions options;
    options.node = {.identity = identity_of(node),
                    .node_id = node.id,
                    .scale_inputs = {ScaleInput::kQuadrature + ScaleInput::kAbsolute,
                                     ScaleInput::kQuadrature + ScaleInput::kAbsolute},
                    .may_fit_scale = &Node::may_fit_scale};
    options.heat = !node.functions.has_axes() && machine.carries_heat(node.id);
    if (options.heat) {
      options.extruder = extruder;
      plug_sensors(machine, node.id, options);
    }
    options.clock_drift_ppm =
        count > 1 ? clocks.drift_ppm * (2.0 * static_cast<double>(n) / static_cast<double>(count - 1) - 1)
                  : 0;
    options.clock_offset =
        BusTime{static_cast<std::int64_t>(unit(random) * static_cast<double>(clocks.offset_max.count()))};
    options.latency_max = clocks.latency_max;
    for (const JointDescription& joint : machine.joints) {
      if (joint.node_id != node.id) continue;
      double start = 0;
      if (joint.travel.min < joint.travel.max)
        start = joint.travel.min + 0.4 * (joint.travel.max - joint.travel.min) +
                (joint.rotary ? 0 : 6 * unit(random) - 3);
      // Nothing finds these: where they stand at power-up is their zero, or what the file says of it.
      if (!joint.homing) start = 0;
      if (joint.homing && joint.homing->method >= 35) start = joint.homing->switch_position;
      options.axes[joint.axis] = axis_of(joint, node, start);
    }
    nodes.push_back(options);
  }
  return nodes;
}

std::optional<VirtualProbe> virtual_probe_of(const MachineDescription& machine) {
  const ProbeDescription& probe = machine.probe;
  if (!probe.present || !probe.place.on_node()) return std::nullopt;
  auto made = make_kinematics(machine);
  if (!made) return std::nullopt;
  VirtualProbe found;
  struct Motor {
    std::size_t node, axis;
    JointPlant plant;
  };
  std::vector<Motor> motors;
  for (const JointDescription& joint : machine.joints)
    for (std::size_t n = 0; n < machine.nodes.size(); ++n)
      if (machine.nodes[n].id == joint.node_id) motors.push_back({n, joint.axis, JointPlant(joint)});
  for (std::size_t n = 0; n < machine.nodes.size(); ++n)
    if (machine.nodes[n].id == probe.place.node_id) found.node = static_cast<int>(n);
  found.input = probe.place.channel;
  for (std::size_t n = 0; n < machine.nodes.size(); ++n)
    if (probe.bltouch && machine.nodes[n].id == probe.servo_node) found.pin_node = static_cast<int>(n);
  const auto input = static_cast<std::size_t>(found.input - 1);
  found.active_low = machine.nodes[static_cast<std::size_t>(found.node)].inputs[input].active_low;
  std::shared_ptr<const Kinematics> kinematics = std::move(*made);
  const Pose reference = kinematics->bed_reference();
  found.gap_mm = [probe, motors, kinematics, reference,
                  pose = reference](const std::vector<std::array<double, 2>>& counts) mutable {
    JointVector joints{};
    for (std::size_t j = 0; j < motors.size(); ++j)
      joints[j] = motors[j].plant.at(counts[motors[j].node][motors[j].axis]);
    // As before homing, when carriages stand anywhere.
    constexpr double kNoPose_mm = 100;
    if (!kinematics->forward(Frame::kPart, joints, pose)) {
      pose = reference;
      return kNoPose_mm;
    }
    const double x = pose[kX] + probe.offset_mm[0], y = pose[kY] + probe.offset_mm[1];
    return pose[kZ] + probe.offset_mm[2] - probe.sim_surface_mm(x, y);
  };
  return found;
}

std::unique_ptr<VirtualMachine> virtual_machine_of(const MachineDescription& machine,
                                                   const VirtualClocks& clocks, std::uint64_t seed) {
  auto virtual_machine = std::make_unique<VirtualMachine>(virtual_nodes_of(machine, clocks, seed), seed);
  if (auto probe = virtual_probe_of(machine)) virtual_machine->set_probe(std::move(*probe));
  return virtual_machine;
}

double JointPlant::at(double counts) {
  const double drive = counts / drive_.counts_per_unit() * (1 + truth_.scale);
  const double half = truth_.backlash / 2;
  contact_ = std::clamp(met_ ? contact_ : drive, drive - half, drive + half);
  met_ = true;
  return map_.to_joint(contact_);
}

double joint_from_counts(const JointDescription& joint, double counts) {
  return counts / joint.drive.counts_per_unit();
}

}  // namespace kinebus
