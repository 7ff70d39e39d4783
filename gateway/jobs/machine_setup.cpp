#include "gateway/jobs/machine_setup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gateway/gcode/letters.hpp"

namespace kinebus {

MotionLimits motion_limits(const MachineDescription& machine) {
  MotionLimits limits;
  limits.tool_speed_mm_per_s = machine.path.tool_speed_mm_per_s;
  limits.tool_accel_mm_per_s2 = machine.path.tool_accel_mm_per_s2;
  const auto limit = [](double value) { return value > 0 ? value : kUnlimited; };
  limits.tool_jerk_mm_per_s3 = limit(machine.path.tool_jerk_mm_per_s3);
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
    limits.axis_speed_per_s[axis] = limit(machine.path.axis_speed_per_s[axis]);
    limits.axis_accel_per_s2[axis] = limit(machine.path.axis_accel_per_s2[axis]);
  }
  limits.joint_speed_per_s.fill(kUnlimited);
  limits.joint_accel_per_s2.fill(kUnlimited);
  for (std::size_t joint = 0; joint < machine.joints.size() && joint < kMaxJoints; ++joint) {
    const JointDescription& j = machine.joints[joint];
    const JointReserve reserve = reserve_for(j.calibration, j.speed_per_s, j.accel_per_s2);
    limits.joint_speed_per_s[joint] = limit(reserve.speed_per_s);
    limits.joint_accel_per_s2[joint] = limit(reserve.accel_per_s2);
    limits.joint_jerk_per_s3[joint] = joint_jerk_limit(machine, j);
  }
  limits.blend_tolerance_mm = machine.tolerances.blend_mm;
  limits.merge_tolerance_mm = machine.tolerances.merge_mm;
  limits.traverse_mm_per_s = limit(machine.gcode.traverse_mm_per_s);
  return limits;
}

PathShaper::Shapers axis_shapers(const VibrationDescription& vibration) {
  PathShaper::Shapers shapers;
  for (std::size_t i = 0; i < shapers.size(); ++i) {
    const AxisVibration& axis = vibration.axis(i);
    const double made_for_hz =
        frequency_for_rates(axis.shaper, axis.frequency_hz, axis.damping_ratio, vibration.slowest_rate);
    shapers[i] = make_shaper(axis.shaper, made_for_hz, axis.damping_ratio);
  }
  return shapers;
}

namespace {

// No kinematics' joints bend more sharply over the workspace than with this radius of curvature, mm.
constexpr double kJointRadius_mm = 100;
constexpr double kMostReserve = 0.5;

/// A shaped pose is an average of poses of half the shaper's duration before and after it. Joints that follow
/// the tool in a straight line stay within any limit that held for each of them; others differ by how much
/// the kinematics changes on the way.
double bent_reserve(const MachineDescription& machine, double duration_s) {
  const auto* cartesian = std::get_if<CartesianGeometry>(&machine.kinematics);
  const bool straight = (cartesian != nullptr && !cartesian->has_table) ||
                        std::holds_alternative<CoreXyGeometry>(machine.kinematics);
  if (straight) return 0;
  return std::min(kMostReserve, 0.5 * machine.path.tool_speed_mm_per_s * duration_s / kJointRadius_mm);
}

}  // namespace

MotionLimits limits_before_shaping(const MachineDescription& machine, const VibrationDescription& vibration) {
  MotionLimits limits = motion_limits(machine);
  if (!vibration.shapes()) return limits;
  const PathShaper::Shapers shapers = axis_shapers(vibration);
  double duration_s = 0, variance_s2 = 0;
  for (const InputShaper& shaper : shapers) {
    duration_s = std::max(duration_s, shaper.duration_s());
    variance_s2 = std::max(variance_s2, shaper.variance_s2());
  }
  if (vibration.deviation_mm > 0)
    limits.tool_accel_mm_per_s2 =
        std::min(limits.tool_accel_mm_per_s2, 2 * vibration.deviation_mm / variance_s2);
  double share = 1 - bent_reserve(machine, duration_s);
  // Shaped apart, X may still brake from the move before a corner while Y begins the one after it: a joint
  // that follows both then feels the sum.
  const bool apart = shapers[0] != shapers[1] || shapers[1] != shapers[2];
  if (apart && !std::holds_alternative<CartesianGeometry>(machine.kinematics)) share *= std::sqrt(0.5);
  for (std::size_t joint = 0; joint < machine.joints.size() && joint < kMaxJoints; ++joint) {
    if (machine.joints[joint].name == "E") continue;
    limits.joint_speed_per_s[joint] *= share;
    limits.joint_accel_per_s2[joint] *= share;
    limits.joint_jerk_per_s3[joint] *= share;
  }
  return limits;
}

FilamentLimits limits_before_advance(const MachineDescription& machine, const VibrationDescription& vibration,
                                     const AdvanceModel& model, const AdvanceWindow& window) {
  // Of the extruder's speed, for what the advance adds.
  constexpr double kShare = 0.4;
  FilamentLimits filament;
  if (!window.acts()) return filament;
  const MotionLimits limits = motion_limits(machine);
  double speed = limits.axis_speed_per_s[kE], accel = limits.axis_accel_per_s2[kE], jerk = kUnlimited;
  for (std::size_t joint = 0; joint < machine.joints.size() && joint < kMaxJoints; ++joint) {
    if (machine.joints[joint].name != "E") continue;
    speed = std::min(speed, limits.joint_speed_per_s[joint]);
    accel = std::min(accel, limits.joint_accel_per_s2[joint]);
    jerk = std::min(jerk, limits.joint_jerk_per_s3[joint]);
  }
  // 2 %, as the planner leaves joints, for what comes after planning; and what cubics may be off: of the
  // flow, its advance, and at both ends of the window.
  speed *= 0.98;
  accel = std::max(0.98 * accel - 3 * PathShaper::kAccelTolerance, 0.5 * accel);
  filament.speed_mm_per_s = (1 - kShare) * speed;
  filament.accel_mm_per_s2 = accel;
  // While A'(0) = K is steepest and the flow accelerates by at most a, the mean over a window w moves by at
  // most K a, and the melt's term by 2 K T a / w. Filament alone is not under way then (`pause_before`).
  const double steepest_s = model.steepest_s(), melt = window.melt_s / window.smooth_s;
  filament.flow_accel_mm_per_s2 =
      std::min(kShare * speed / (steepest_s * (1 + 2 * melt)), accel / model.most_gain());
  if (jerk < kUnlimited) {
    // The same for the jerk. Where A is bent, the flow's acceleration adds to it by its square: half for
    // that.
    const double bends = model.most_bend_s2_per_mm() * (2 + 4 * melt) / window.smooth_s;
    if (bends > 0)
      filament.flow_accel_mm_per_s2 = std::min(filament.flow_accel_mm_per_s2, std::sqrt(0.5 * jerk / bends));
    const double flow_accel = filament.flow_accel_mm_per_s2;
    filament.flow_jerk_mm_per_s3 = (jerk - bends * flow_accel * flow_accel) / model.most_gain();
  }
  // With shapers of their own one axis still brakes while another speeds up.
  const VibrationDescription& v = vibration;
  if (!(v.axis(0) == v.axis(1) && v.axis(1) == v.axis(2))) {
    filament.flow_accel_mm_per_s2 *= 0.5;
    filament.flow_jerk_mm_per_s3 *= 0.5;
  }
  filament.rests = true;
  return filament;
}

double joint_jerk_limit(const MachineDescription& machine, const JointDescription& joint) {
  if (!(machine.path.tool_jerk_mm_per_s3 > 0)) return kUnlimited;
  if (joint.jerk_per_s3 > 0) return joint.jerk_per_s3;
  return machine.path.tool_jerk_mm_per_s3 * joint.accel_per_s2 / machine.path.tool_accel_mm_per_s2;
}

namespace {

// Beside the square in a round reach, and its edges.
constexpr double kMeshShare = 0.95;

/// What the machine file leaves open follows from where the tool may be.
gcode::MeshOptions mesh_options(const MachineDescription& machine) {
  const MeshDescription& mesh = machine.mesh;
  gcode::MeshOptions options;
  options.points = {mesh.points_x, mesh.points_y};
  options.lift_mm = mesh.lift_mm;
  options.depth_mm = mesh.depth_mm;
  PoseLimits reach;
  if (const PoseLimits* limits = pose_limits(machine.kinematics)) reach = *limits;
  std::visit(
      [&](const auto& geometry) {
        if constexpr (requires { geometry.x_mm; }) {
          reach.x_mm = geometry.x_mm;
          reach.y_mm = geometry.y_mm;
          reach.z_mm = geometry.z_mm;
        }
      },
      machine.kinematics);
  const double half_mm = reach.radius_mm > 0 ? kMeshShare * reach.radius_mm * std::sqrt(0.5) : 0;
  const auto side = [&](const Interval& stated, Interval limits, std::size_t axis) {
    if (half_mm > 0 && (!limits.limited() || limits.max - limits.min > 2 * half_mm))
      limits = {-half_mm, half_mm};
    if (stated.limited()) limits = stated;
    if (limits.limited()) {
      options.from_mm[axis] = limits.min;
      options.to_mm[axis] = limits.max;
    }
  };
  side(mesh.x_mm, reach.x_mm, 0);
  side(mesh.y_mm, reach.y_mm, 1);
  if (reach.z_mm.limited()) options.depth_mm = std::min(options.depth_mm, -reach.z_mm.min);
  return options;
}

}  // namespace

gcode::Options interpreter_options(const MachineDescription& machine, const Pose& start, const Pose& home) {
  gcode::Options options;
  options.start = start;
  options.home = home;
  options.default_feed_mm_per_s = machine.gcode.initial_feed_mm_per_min / 60;
  options.block_delete = machine.gcode.block_delete;
  options.arc_radius_tolerance_mm = machine.gcode.arc_radius_tolerance_mm;
  options.spindle = machine.spindle.present;
  options.traverse_uses_feed = !machine.spindle.present;  // on a mill F is for cutting alone (RS274/NGC)
  options.dialect = machine.gcode.dialect;
  using DwellUnit = GcodeDescription::DwellUnit;
  options.dwell_p_unit = machine.gcode.dwell_p_unit == DwellUnit::kSeconds ? gcode::DwellUnit::kSeconds
                         : machine.gcode.dwell_p_unit == DwellUnit::kMilliseconds
                             ? gcode::DwellUnit::kMilliseconds
                             : gcode::DwellUnit::kByDialect;
  options.hotends = machine.tools();
  options.tools = std::max(options.hotends, 1 + static_cast<int>(machine.gcode.tool_length_mm.size()));
  // On a mill the operator puts in whatever tool is asked for.
  if (options.spindle) options.tools = 100'000;
  options.spindle_encoder = options.spindle && machine.spindle.encoder_counts > 0;
  options.tap_rpm_per_s = options.spindle_encoder ? machine.spindle.tap_rpm_per_s : 0;
  options.spindle_min_rpm = machine.spindle.min_rpm;
  options.spindle_max_rpm = machine.spindle.max_rpm;
  options.tool_length_mm = machine.gcode.tool_length_mm;
  options.tool_diameter_mm = machine.gcode.tool_diameter_mm;
  options.tool_orientation = machine.gcode.tool_orientation;
  options.retract_length_mm = machine.gcode.retract_mm;
  options.retract_mm_per_s = options.recover_mm_per_s = machine.gcode.retract_mm_per_s;
  options.retract_lift_mm = machine.gcode.retract_lift_mm;
  for (const MacroDescription& macro : machine.macros)
    options.macros.push_back({gcode::in_lower_case(macro.name), macro.gcode});
  if (machine.probe.present)
    options.probe =
        machine.probe.place.on_node() ? gcode::ProbeFitted::kFitted : gcode::ProbeFitted::kSimulated;
  options.probe_pin = machine.probe.bltouch;
  options.probe_mm_per_s = machine.probe.speed_mm_per_s;
  options.probe_offset_mm = machine.probe.offset_mm;
  options.mesh = mesh_options(machine);
  if (const PoseLimits* limits = pose_limits(machine.kinematics);
      limits != nullptr && limits->a_rad.limited()) {
    options.a_min_rad = limits->a_rad.min;
    options.a_max_rad = limits->a_rad.max;
  }
  return options;
}

namespace {

// A table's error moves the tip by its lever. Within the radius of 100 mm that M1 prints in, it shall not
// move it farther than a carriage's half microstep does (0.39 um); half a microstep of the table would be 2
// um.
constexpr double kRotaryToleranceRad = 3.9e-6;

double segment_tolerance(const MachineDescription& machine, const JointDescription& joint) {
  const double counts = machine.tolerances.segment_counts;
  if (!joint.rotary) return counts;
  return std::min(counts, 2 * counts * kRotaryToleranceRad * std::abs(joint.drive.counts_per_unit()));
}

}  // namespace

std::vector<NodeAxes> node_axes(const MachineDescription& machine) {
  std::vector<NodeAxes> nodes;
  for (const NodeDescription& node : machine.nodes)
    if (node.functions.has_axes()) nodes.push_back({.node_id = node.id, .axes = {}});
  std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.node_id < b.node_id; });
  for (std::size_t joint = 0; joint < machine.joints.size(); ++joint) {
    const JointDescription& j = machine.joints[joint];
    for (NodeAxes& node : nodes) {
      if (node.node_id != j.node_id) continue;
      node.axes[j.axis & 1u] = {.joint = static_cast<int>(joint),
                                .counts_per_unit = std::abs(j.drive.counts_per_unit()),
                                .reversed = j.drive.inverted,
                                .scale_correction = j.calibration.scale,
                                .offset = 0,
                                .tolerance_counts = segment_tolerance(machine, j),
                                .acceleration_limit = j.accel_per_s2};
      AxisScaling& axis = node.axes[j.axis & 1u];
      if (j.homing) axis.home_side = j.homing->edge_direction();
      if (j.calibration.linear()) continue;
      const JointReserve reserve = reserve_for(j.calibration, j.speed_per_s, j.accel_per_s2);
      axis.map = std::make_shared<JointMap>(j.calibration);
      axis.gap = j.calibration.backlash;
      axis.take_up_per_s2 = reserve.take_up_per_s2;
    }
  }
  return nodes;
}

StreamGroup::Options stream_options(const MachineDescription& machine) {
  StreamGroup::Options options;
  options.budget.share = machine.bus.budget;
  options.budget.stop_way = std::chrono::duration_cast<SegmentUnits>(machine.stop.ramp) / 2;
  return options;
}

std::optional<Sentence> wrong_spindle_speed(const SpindleDescription& spindle, double rpm) {
  if (rpm == 0) return std::nullopt;
  if (!spindle.present) return say("this machine has no spindle");
  if (rpm < 0 && !spindle.reversible) return say("the spindle turns one way only: use M3");
  const double speed = std::abs(rpm);
  if (speed >= spindle.min_rpm && speed <= spindle.max_rpm) return std::nullopt;
  return say("spindle speed %1 rpm; allowed are %2 to %3 rpm", printed("%.6g", speed),
             printed("%.6g", spindle.min_rpm), printed("%.6g", spindle.max_rpm));
}

std::optional<HeaterId> heater_of(const canonical::Thermal& thermal) {
  using What = canonical::Thermal::What;
  const auto index = static_cast<std::uint8_t>(thermal.index);
  switch (thermal.what) {
    case What::kHotend:
      return HeaterId{HeaterKind::kHotend, index};
    case What::kBed:
      return HeaterId{HeaterKind::kBed, index};
    case What::kChamber:
      return HeaterId{HeaterKind::kChamber, index};
    case What::kFan:
    case What::kOutput:
      break;
  }
  return std::nullopt;
}

Sentence heater_words(HeaterId id) {
  switch (id.kind) {
    case HeaterKind::kHotend:
      return id.index == 0 ? say("hotend") : say("hotend T%1", int{id.index});
    case HeaterKind::kBed:
      return id.index == 0 ? say("bed") : say("bed %1", int{id.index});
    case HeaterKind::kChamber:
      return id.index == 0 ? say("chamber") : say("chamber %1", int{id.index});
  }
  return {};
}

std::optional<Sentence> wrong_device_command(const MachineDescription& machine,
                                             const canonical::Thermal& thermal) {
  const auto celsius = [](double value) { return printed("%.6g C", value); };
  if (thermal.what == canonical::Thermal::What::kOutput) {
    const bool there = std::any_of(machine.outputs.begin(), machine.outputs.end(),
                                   [&](const OutputDescription& o) { return o.index == thermal.index; });
    return there ? std::nullopt : std::optional(say("this machine has no output %1", thermal.index));
  }
  const auto id = heater_of(thermal);
  if (!id) return std::nullopt;
  const HeaterDescription* heater = machine.heater(*id);
  const Sentence name = heater_words(*id);
  if (heater == nullptr && thermal.value > 0) return say("this machine has no %1 heater", name);
  if (heater == nullptr) return std::nullopt;
  if (!(thermal.value >= 0 && thermal.value <= heater->max_c))
    return say("%1 temperature %2; allowed are 0 to %3", name, celsius(thermal.value),
               celsius(heater->max_c));
  if (thermal.wait && thermal.wait_cooling && thermal.value > 0 && thermal.value < machine.thermal.ambient_c)
    return say("%1 would wait forever: %2 is below the room's %3", name, celsius(thermal.value),
               celsius(machine.thermal.ambient_c));
  return std::nullopt;
}

std::optional<Sentence> missing_input(const MachineDescription& machine, const canonical::AwaitInput& wait) {
  const bool there = std::any_of(machine.inputs.begin(), machine.inputs.end(),
                                 [&](const InputDescription& i) { return i.index == wait.index; });
  if (there) return std::nullopt;
  return say("this machine has no input %1: the machine file names inputs by [input.NAME]", wait.index);
}

std::optional<Sentence> missing_fan(const MachineDescription& machine, const canonical::Thermal& thermal) {
  if (thermal.what != canonical::Thermal::What::kFan || thermal.value == 0) return std::nullopt;
  for (const FanDescription& fan : machine.fans)
    if (fan.index == thermal.index) return std::nullopt;
  return say("this machine has no fan %1: M106 has no effect", thermal.index);
}

Result<Pose, PoseError> convert_pose(const Kinematics& kinematics, Frame from, const Pose& pose, Frame to) {
  if (from == to) return pose;
  JointVector joints{};
  if (const auto reached = kinematics.inverse(from, pose, joints); !reached)
    return Error<PoseError>(reached.error());
  Pose converted = pose;
  if (const auto found = kinematics.forward(to, joints, converted); !found)
    return Error<PoseError>(found.error());
  return converted;
}

}  // namespace kinebus
