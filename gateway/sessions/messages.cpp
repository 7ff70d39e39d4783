#include "gateway/sessions/messages.hpp"

#include <algorithm>
#include <utility>

#include "gateway/description/usual_temperature.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

void set_range(joblink::Range& message, const Interval& interval) {
  message.set_min(interval.min);
  message.set_max(interval.max);
}
void set_vector(joblink::Vector& message, const Vector3& v) {
  message.set_x_mm(v[0]);
  message.set_y_mm(v[1]);
  message.set_z_mm(v[2]);
}
void set_heater(joblink::Heater& message, const HeaterStatus& heater) {
  message.set_actual_celsius(heater.actual_celsius);
  message.set_target_celsius(heater.target_celsius);
  if (heater.power) message.set_power(*heater.power);
  if (heater.measured != Measured::kNotTold) message.set_measured(heater.measured == Measured::kYes);
}

static_assert(static_cast<int>(TuningStage::kFailed) == joblink::TUNING_FAILED);

void set_tuning(joblink::HeaterTuning& message, const HeaterTuning& tuning) {
  message.set_stage(static_cast<joblink::TuningStage>(tuning.stage));
  message.set_celsius(tuning.celsius);
  message.set_power_w(tuning.model.power_w);
  message.set_capacity_j_per_k(tuning.model.capacity_j_per_k);
  message.set_loss_w_per_k(tuning.model.loss_w_per_k);
  message.set_lag_s(tuning.model.lag_s);
  message.set_dead_s(tuning.model.dead_s);
  if (!tuning.failure.empty()) *message.mutable_failure() = to_message(tuning.failure);
}

void set_output(joblink::Output& message, const OutputStatus& output) {
  message.set_name(shown(output.name));
  message.set_index(output.index);
  message.set_ratio(output.ratio);
}

void set_reach(joblink::Reach& reach, const PoseLimits& limits) {
  set_range(*reach.mutable_x_mm(), limits.x_mm);
  set_range(*reach.mutable_y_mm(), limits.y_mm);
  set_range(*reach.mutable_z_mm(), limits.z_mm);
  set_range(*reach.mutable_a_rad(), limits.a_rad);
  set_range(*reach.mutable_c_rad(), limits.c_rad);
  reach.set_radius_mm(limits.radius_mm);
}

constexpr std::uint16_t kStateBits = 0x6F;  // CiA 402
constexpr bool operation_enabled(std::uint16_t statusword) {
  return (statusword & kStateBits) == 0x27;
}
constexpr bool in_fault(std::uint16_t statusword) {
  return (statusword & 0x4F) == 0x08 || (statusword & 0x4F) == 0x0F;
}

void set_node(joblink::NodeStatus& message, const NodeStatus& node, bool moves) {
  message.set_id(node.id);
  message.set_present(node.present);
  message.set_nmt_state(node.nmt_state);
  message.set_inputs(node.inputs);
  message.set_synchronised(node.synchronised);
  message.set_sync_error_s(node.sync_error_us * 1e-6);
  message.set_queue_records(static_cast<std::uint32_t>(std::max(node.queue_records, 0)));
  message.set_queue_capacity(static_cast<std::uint32_t>(node.queue_capacity));
  message.set_stopped(node.stopped);
  message.set_records_sent(node.records_sent);
  message.set_emergencies(node.emergencies);
  for (std::size_t axis = 0; node.has_axes && axis < node.statusword.size(); ++axis) {
    joblink::AxisStatus& a = *message.add_axes();
    a.set_statusword(node.statusword[axis]);
    a.set_enabled(node.present && operation_enabled(node.statusword[axis]));
    a.set_fault(node.present && in_fault(node.statusword[axis]));
    if (node.off_course[axis]) a.set_off_course(*node.off_course[axis]);
    if (node.by_scale_mm[axis]) a.set_by_scale_mm(*node.by_scale_mm[axis]);
    if (node.current_a[axis]) a.set_current_a(*node.current_a[axis]);
    a.set_run_current_a(node.run_current_a[axis]);
    a.set_hold_current_a(node.hold_current_a[axis]);
    if (a.enabled()) a.set_configured_current_a(moves ? a.run_current_a() : a.hold_current_a());
    if (node.stage_celsius[axis]) a.set_stage_celsius(*node.stage_celsius[axis]);
    a.set_position_counts(node.position_counts[axis]);
    a.set_measures(node.measures[axis]);
  }
}

struct GeometryMessage {
  joblink::MachineInfo& info;
  void operator()(const M1Geometry& g) const {
    info.set_kinematics("m1");
    set_reach(*info.mutable_reach(), g.limits);
    for (const M1Leg& leg : g.legs) {
      joblink::LegGeometry::Leg& l = *info.mutable_legs()->add_legs();
      set_vector(*l.mutable_foot(), leg.foot_mm);
      set_vector(*l.mutable_rail(), leg.rail);
      set_vector(*l.mutable_attachment(), leg.attachment_mm);
      l.set_length_mm(leg.length_mm);
      l.set_connector_mm(leg.connector_mm);
      l.set_carriage_above(leg.carriage_above);
      set_range(*l.mutable_travel_mm(), leg.travel_mm);
    }
    set_vector(*info.mutable_legs()->mutable_nozzle(), g.nozzle_mm);
    if (g.tool != ToolPlacement::kPlatform) return;
    info.mutable_legs()->set_tool_on_platform(true);
    set_vector(*info.mutable_legs()->mutable_table(), g.table_mm);
  }
  void operator()(const CartesianGeometry& g) const {
    info.set_kinematics("cartesian");
    joblink::Reach& reach = *info.mutable_reach();
    set_range(*reach.mutable_x_mm(), g.x_mm);
    set_range(*reach.mutable_y_mm(), g.y_mm);
    set_range(*reach.mutable_z_mm(), g.z_mm);
    info.mutable_cartesian()->set_table(g.has_table);
    if (!g.has_table) return;
    set_range(*reach.mutable_a_rad(), g.table.a_rad);
    set_range(*reach.mutable_c_rad(), g.table.c_rad);
    set_vector(*info.mutable_cartesian()->mutable_pivot(), g.table.pivot_mm);
  }
  void operator()(const CoreXyGeometry& g) const {
    info.set_kinematics("corexy");
    joblink::Reach& reach = *info.mutable_reach();
    set_range(*reach.mutable_x_mm(), g.x_mm);
    set_range(*reach.mutable_y_mm(), g.y_mm);
    set_range(*reach.mutable_z_mm(), g.z_mm);
    info.mutable_cartesian()->set_core_xy(true);
  }
  void operator()(const M5Geometry& g) const {
    (*this)(static_cast<const M1Geometry&>(g));
    info.set_kinematics("m5");
  }
  void operator()(const M4Geometry& g) const {
    info.set_kinematics("m4");
    set_reach(*info.mutable_reach(), g.limits);
    joblink::PlanarGeometry& planar = *info.mutable_planar();
    planar.set_rod_mm(g.rod_mm);
    planar.set_triangle_mm(g.triangle_mm);
    planar.set_rails_mm(g.rails_mm);
    planar.set_spindle_rad(g.spindle_rad);
    planar.set_tool_mm(g.tool_mm);
    planar.set_table_y_mm(g.table_y_mm);
    planar.set_table_z_mm(g.table_z_mm);
  }
  void operator()(const LinearDeltaGeometry& g) const {
    info.set_kinematics("delta");
    set_reach(*info.mutable_reach(), g.limits);
    info.mutable_delta()->set_radius_mm(g.radius_mm);
    info.mutable_delta()->set_arm_length_mm(g.arm_length_mm);
    for (const double angle : g.tower_angle_rad) info.mutable_delta()->add_tower_angle_rad(angle);
  }
};

void set_bodies(joblink::Bodies& message, const BodiesDescription& b) {
  message.set_clearance_mm(b.clearance_mm);
  message.set_rod_radius_mm(b.rod_radius_mm);
  message.set_rod_spacing_mm(b.rod_spacing_mm);
  message.set_carriage_length_mm(b.carriage_length_mm);
  message.set_carriage_width_mm(b.carriage_width_mm);
  message.set_rail_radius_mm(b.rail_radius_mm);
  message.set_rail_offset_mm(b.rail_offset_mm);
  message.set_platform_radius_mm(b.platform_radius_mm);
  message.set_table_radius_mm(b.table_radius_mm);
  message.set_table_thickness_mm(b.table_thickness_mm);
  message.set_tool_radius_mm(b.tool_radius_mm);
  message.set_tool_length_mm(b.tool_length_mm);
  message.set_holder_radius_mm(b.holder_radius_mm);
  message.set_holder_length_mm(b.holder_length_mm);
  message.set_floor_mm(b.floor_mm);
  message.set_part_radius_mm(b.part_radius_mm);
  message.set_part_height_mm(b.part_height_mm);
  for (const FixedBody& body : b.fixed) {
    joblink::Bodies::Fixed& fixed = *message.add_fixed();
    fixed.set_name(shown(body.name));
    set_vector(*fixed.mutable_from(), body.from_mm);
    set_vector(*fixed.mutable_to(), body.to_mm);
    fixed.set_radius_mm(body.radius_mm);
  }
}

std::string input_words(const SwitchInput& input) {
  const std::string axis = input.axis == 0 ? " A" : " B";
  switch (input.function) {
    case InputFunction::kNone:
      return "";
    case InputFunction::kHome:
      return "home" + axis;
    case InputFunction::kPositiveLimit:
      return "positive limit" + axis;
    case InputFunction::kNegativeLimit:
      return "negative limit" + axis;
    case InputFunction::kEmergencyStop:
      return "emergency stop";
    case InputFunction::kProbe:
      return "probe";
  }
  return "";
}

}  // namespace

bool at_rest(MachineState state) {
  switch (state) {
    case MachineState::kOff:
    case MachineState::kUnhomed:
    case MachineState::kReady:
    case MachineState::kHeld:
    case MachineState::kStopped:
    case MachineState::kAlarm:
      return true;
    default:
      return false;
  }
}

void set_pose(joblink::Pose& message, const Pose& pose) {
  message.set_x_mm(pose[kX]);
  message.set_y_mm(pose[kY]);
  message.set_z_mm(pose[kZ]);
  message.set_a_rad(pose[kA]);
  message.set_c_rad(pose[kC]);
  message.set_e_mm(pose[kE]);
}

Pose pose_of(const joblink::Pose& message) {
  return {message.x_mm(), message.y_mm(), message.z_mm(), message.a_rad(), message.c_rad(), message.e_mm()};
}

joblink::Status to_message(const MachineStatus& s) {
  joblink::Status m;
  m.set_time_s(to_seconds(s.now));
  m.set_state(static_cast<joblink::State>(s.state));
  m.set_state_words(std::string(to_string(s.state)));
  m.set_doing(shown(s.doing));
  if (!s.doing.empty()) *m.mutable_doing_said() = to_message(s.doing);
  m.set_at_rest(at_rest(s.state));
  m.set_positions_known(s.positions_known);
  set_pose(*m.mutable_tool(), s.pose);
  set_pose(*m.mutable_machine(), s.machine_pose);
  if (s.measured_pose) set_pose(*m.mutable_measured_tool(), *s.measured_pose);
  for (int i = 0; i < s.joint_count; ++i) m.add_joints(s.joints[static_cast<std::size_t>(i)]);
  m.set_path_time_s(s.path_time_s);
  m.set_rate(s.rate);
  m.set_feed_override(s.feed_override);
  m.set_job(shown(s.job));
  m.set_interrupted(s.interrupted);
  m.set_filament_change(s.filament_change);
  m.set_line(s.line);
  m.set_progress(s.progress);
  m.set_elapsed_s(s.elapsed_s);
  if (s.job_filament_mm) m.set_job_filament_mm(*s.job_filament_mm);
  m.set_remaining_s(s.remaining_s);
  m.set_work_system(s.work_system);
  set_pose(*m.mutable_work_offset(), s.work_offset);
  set_heater(*m.mutable_hotend(), s.heater(kFirstHotend));
  set_heater(*m.mutable_bed(), s.heater(kFirstBed));
  m.mutable_bed()->set_kind(joblink::HEATER_BED);
  for (const NamedHeaterStatus& heater : s.heaters) {
    joblink::Heater& h = *m.add_heaters();
    set_heater(h, heater);
    h.set_kind(static_cast<joblink::HeaterKind>(heater.id.kind));
    h.set_index(heater.id.index);
    h.set_name(shown(heater.name));
    if (heater.tuning.stage != TuningStage::kNone) set_tuning(*h.mutable_tuning(), heater.tuning);
  }
  for (const OutputStatus& fan : s.fans) {
    set_output(*m.add_fans(), fan);
    if (fan.index == 0) m.set_fan(fan.ratio);
  }
  for (const OutputStatus& output : s.outputs) set_output(*m.add_outputs(), output);
  for (const InputStatus& input : s.inputs) {
    joblink::Input& told = *m.add_inputs();
    told.set_name(shown(input.name));
    told.set_index(input.index);
    if (input.level != InputLevel::kUnknown) told.set_on(input.level == InputLevel::kOn);
  }
  for (const SensorStatus& sensor : s.sensors) {
    joblink::Sensor& told = *m.add_sensors();
    told.set_name(shown(sensor.name));
    told.set_celsius(sensor.celsius);
  }
  for (const FilamentStatus& filament : s.filaments) {
    joblink::FilamentSensor& told = *m.add_filament_sensors();
    told.set_name(shown(filament.name));
    told.set_condition(static_cast<joblink::FilamentCondition>(filament.condition));
    if (filament.condition != FilamentCondition::kInOrder)
      *told.mutable_words() = to_message(sentence(filament.condition));
  }
  for (const ObjectStatus& object : s.objects) {
    constexpr int kListed = 100;
    if (m.objects_size() == kListed) break;
    joblink::PrintObject& told = *m.add_objects();
    told.set_name(shown(object.name));
    told.set_left_out(object.left_out);
  }
  if (s.probe_touches) m.set_probe_touches(*s.probe_touches);
  m.set_probe_pin(static_cast<joblink::ProbePin>(s.probe_pin));
  m.set_spindle_rpm(s.spindle.actual_rpm);
  m.set_spindle_target_rpm(s.spindle.target_rpm);
  m.set_bus_load(s.bus_load);
  m.set_bus_load_peak(s.bus_load_peak);
  for (const NodeStatus& node : s.nodes) set_node(*m.add_nodes(), node, s.rate > 0);
  joblink::Counters& c = *m.mutable_counters();
  c.set_frames_sent(s.counters.frames_sent);
  c.set_frames_received(s.counters.frames_received);
  c.set_segments_sent(s.counters.segments_sent);
  c.set_malformed_frames(s.counters.malformed_frames);
  c.set_foreign_frames(s.counters.foreign_frames);
  c.set_sequence_errors(s.counters.sequence_errors);
  c.set_underruns(s.counters.underruns);
  c.set_checkpoint_errors(s.counters.checkpoint_errors);
  c.set_sdo_aborts(s.counters.sdo_aborts);
  c.set_sdo_timeouts(s.counters.sdo_timeouts);
  c.set_bus_slowdowns(s.counters.bus_slowdowns);
  c.set_starvation_holds(s.counters.starvation_holds);
  return m;
}

joblink::Event to_message(const MachineEvent& event) {
  joblink::Event m;
  m.set_kind(static_cast<joblink::EventKind>(event.kind));
  m.set_time_s(to_seconds(event.when));
  m.set_state(static_cast<joblink::State>(event.state));
  m.set_code(event.code);
  m.set_node(event.node);
  m.set_line(event.line);
  m.set_words(shown(event.words));
  m.set_advice(shown(event.advice));
  *m.mutable_said() = to_message(event.words);
  if (!event.advice.empty()) *m.mutable_advice_said() = to_message(event.advice);
  return m;
}

joblink::MachineInfo to_message(const MachineDescription& machine, const Pose& bed_reference) {
  joblink::MachineInfo m;
  m.set_name(shown(machine.name));
  for (const JointDescription& joint : machine.joints) {
    joblink::Joint& j = *m.add_joints();
    j.set_name(shown(joint.name));
    j.set_rotary(joint.rotary);
    j.set_node(joint.node_id);
    j.set_axis(joint.axis);
    set_range(*j.mutable_travel(), joint.travel);
    j.set_speed_per_s(joint.speed_per_s);
    j.set_accel_per_s2(joint.accel_per_s2);
    j.set_run_current_a(joint.run_current_ma * 1e-3);
    j.set_hold_current_a(joint.hold_current_ma * 1e-3);
    j.set_has_scale(joint.scale.has_value());
    if (joint.homing) j.set_home_switch(joint.homing->switch_input);
  }
  for (const NodeDescription& node : machine.nodes) {
    joblink::Node& n = *m.add_nodes();
    n.set_id(node.id);
    for (const SwitchInput& input : node.inputs) n.add_inputs(input_words(input));
  }
  std::visit(GeometryMessage{m}, machine.kinematics);
  set_pose(*m.mutable_bed_reference(), bed_reference);
  m.set_tool_speed_mm_per_s(machine.path.tool_speed_mm_per_s);
  m.set_tool_accel_mm_per_s2(machine.path.tool_accel_mm_per_s2);
  const auto most = [&](HeaterId id) {
    const HeaterDescription* heater = machine.heater(id);
    return heater != nullptr ? heater->max_c : 0;
  };
  m.set_hotend_max_celsius(most(kFirstHotend));
  m.set_bed_max_celsius(most(kFirstBed));
  for (const HeaterDescription& heater : machine.heaters) {
    joblink::HeaterInfo& h = *m.add_heaters();
    h.set_name(shown(heater.name));
    h.set_kind(static_cast<joblink::HeaterKind>(heater.kind));
    h.set_index(heater.index);
    h.set_max_celsius(heater.max_c);
    h.set_usual_celsius(usual_celsius(heater));
  }
  for (const MaterialDescription& material : machine.materials) {
    joblink::Material& told = *m.add_materials();
    told.set_name(shown(material.name));
    told.set_hotend_celsius(material.hotend_c);
    told.set_bed_celsius(material.bed_c);
    told.set_chamber_celsius(material.chamber_c);
  }
  if (machine.heater(kFirstHotend) != nullptr) {
    joblink::FilamentWays& ways = *m.mutable_filament_ways();
    ways.set_unload_mm(machine.pause.unload_mm);
    ways.set_load_mm(machine.pause.load_mm);
    ways.set_purge_mm(machine.pause.purge_mm);
  }
  m.set_filament_diameter_mm(machine.gcode.filament_diameter_mm);
  m.set_bus(shown(machine.bus.interface));
  if (machine.bodies) set_bodies(*m.mutable_bodies(), *machine.bodies);
  return m;
}

}  // namespace kinebus
