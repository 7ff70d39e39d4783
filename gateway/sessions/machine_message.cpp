#include <algorithm>
#include <utility>
#include <variant>

#include "gateway/description/usual_temperature.hpp"
#include "gateway/sessions/messages.hpp"
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

void set_reach(joblink::Reach& reach, const PoseLimits& limits) {
  set_range(*reach.mutable_x_mm(), limits.x_mm);
  set_range(*reach.mutable_y_mm(), limits.y_mm);
  set_range(*reach.mutable_z_mm(), limits.z_mm);
  set_range(*reach.mutable_a_rad(), limits.a_rad);
  set_range(*reach.mutable_c_rad(), limits.c_rad);
  reach.set_radius_mm(limits.radius_mm);
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
  for (const CameraDescription& camera : machine.cameras) {
    joblink::Camera& told = *m.add_cameras();
    told.set_name(shown(camera.name));
    told.set_stream(camera.stream);
    told.set_snapshot(camera.snapshot);
  }
  for (const MacroDescription& macro : machine.macros) m.add_macros(shown(macro.name));
  const bool melts = std::any_of(machine.heaters.begin(), machine.heaters.end(),
                                 [](const auto& h) { return h.kind == HeaterKind::kHotend; });
  if (melts) {
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
