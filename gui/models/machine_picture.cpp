#include "gui/models/machine_picture.hpp"

#include <cmath>
#include <numbers>

#include "gui/scene/path_reader.hpp"

namespace kinebus::gui {
namespace {

Vec3 vec(const joblink::Vector& v) {
  return {v.x_mm(), v.y_mm(), v.z_mm()};
}
Range range(const joblink::Range& r, const Range& otherwise) {
  return r.min() < r.max() ? Range{r.min(), r.max()} : otherwise;
}

void legs_of(const joblink::MachineInfo& machine, MachineModel& m) {
  m.kind = MachineModel::Kind::kM1;
  m.tool_on_platform = machine.legs().tool_on_platform();
  m.nozzle_mm = vec(machine.legs().nozzle());
  m.table_mm = vec(machine.legs().table());
  m.turns = true;
  int i = 0;
  for (const auto& leg : machine.legs().legs()) {
    m.legs.push_back({.foot_mm = vec(leg.foot()),
                      .rail = unit(vec(leg.rail())),
                      .attachment_mm = vec(leg.attachment()),
                      .length_mm = leg.length_mm(),
                      .connector_mm = leg.connector_mm(),
                      .carriage_above = leg.carriage_above(),
                      .travel_mm = {leg.travel_mm().min(), leg.travel_mm().max()},
                      .speed_mm_per_s = i < machine.joints_size() ? machine.joints(i).speed_per_s() : 450});
    ++i;
  }
}

void delta_of(const joblink::MachineInfo& machine, MachineModel& m) {
  m.kind = MachineModel::Kind::kLinearDelta;
  // How the horizontal distance is split between tower and effector does not change how far arms reach.
  constexpr double kEffector_mm = 32;
  for (int i = 0; i < machine.delta().tower_angle_rad_size(); ++i) {
    const double angle = machine.delta().tower_angle_rad(i);
    const Vec3 out{std::cos(angle), std::sin(angle), 0};
    const bool known = i < machine.joints_size();
    m.legs.push_back({.foot_mm = (machine.delta().radius_mm() + kEffector_mm) * out,
                      .rail = {0, 0, 1},
                      .attachment_mm = kEffector_mm * out,
                      .length_mm = machine.delta().arm_length_mm(),
                      .connector_mm = 0,
                      .carriage_above = true,
                      .travel_mm = known ? range(machine.joints(i).travel(), {0, 600}) : Range{0, 600},
                      .speed_mm_per_s = known ? machine.joints(i).speed_per_s() : 450});
  }
}

Vector3 vector3(const joblink::Vector& v) {
  return {v.x_mm(), v.y_mm(), v.z_mm()};
}
Interval interval(const joblink::Range& r) {
  return {r.min(), r.max()};
}
PoseLimits limits_of(const joblink::Reach& reach) {
  return {.x_mm = interval(reach.x_mm()),
          .y_mm = interval(reach.y_mm()),
          .z_mm = interval(reach.z_mm()),
          .a_rad = interval(reach.a_rad()),
          .c_rad = interval(reach.c_rad()),
          .radius_mm = reach.radius_mm()};
}
/// Travel of joints 1, 2 and 3.
void set_travel(std::array<Interval, 3>& travel, const joblink::MachineInfo& machine) {
  for (int i = 0; i < 3 && i < machine.joints_size(); ++i)
    travel[static_cast<std::size_t>(i)] = interval(machine.joints(i).travel());
}

M1Geometry leg_geometry(const joblink::MachineInfo& machine) {
  M1Geometry g;
  if (machine.legs().tool_on_platform()) g.tool = ToolPlacement::kPlatform;
  g.nozzle_mm = vector3(machine.legs().nozzle());
  g.table_mm = vector3(machine.legs().table());
  g.limits = limits_of(machine.reach());
  for (std::size_t i = 0; i < g.legs.size(); ++i) {
    const auto& leg = machine.legs().legs(static_cast<int>(i));
    g.legs[i] = {.foot_mm = vector3(leg.foot()),
                 .rail = vector3(leg.rail()),
                 .attachment_mm = vector3(leg.attachment()),
                 .length_mm = leg.length_mm(),
                 .connector_mm = leg.connector_mm(),
                 .carriage_above = leg.carriage_above(),
                 .travel_mm = interval(leg.travel_mm())};
  }
  return g;
}

LinearDeltaGeometry delta_geometry(const joblink::MachineInfo& machine) {
  LinearDeltaGeometry g;
  g.radius_mm = machine.delta().radius_mm();
  g.arm_length_mm = machine.delta().arm_length_mm();
  for (std::size_t i = 0; i < g.tower_angle_rad.size(); ++i)
    g.tower_angle_rad[i] = machine.delta().tower_angle_rad(static_cast<int>(i));
  set_travel(g.travel_mm, machine);
  g.limits = limits_of(machine.reach());
  return g;
}

M4Geometry planar_geometry(const joblink::MachineInfo& machine) {
  const joblink::PlanarGeometry& planar = machine.planar();
  M4Geometry g;
  g.rod_mm = planar.rod_mm();
  g.triangle_mm = planar.triangle_mm();
  g.rails_mm = planar.rails_mm();
  g.spindle_rad = planar.spindle_rad();
  g.tool_mm = planar.tool_mm();
  g.table_y_mm = planar.table_y_mm();
  g.table_z_mm = planar.table_z_mm();
  set_travel(g.travel_mm, machine);
  g.limits = limits_of(machine.reach());
  return g;
}

CartesianGeometry cartesian_geometry(const joblink::MachineInfo& machine) {
  CartesianGeometry g;
  g.x_mm = interval(machine.reach().x_mm());
  g.y_mm = interval(machine.reach().y_mm());
  g.z_mm = interval(machine.reach().z_mm());
  g.has_table = machine.cartesian().table();
  g.table.pivot_mm = vector3(machine.cartesian().pivot());
  return g;
}

BodiesDescription bodies_of(const joblink::Bodies& message) {
  BodiesDescription b;
  b.clearance_mm = message.clearance_mm();
  b.rod_radius_mm = message.rod_radius_mm();
  b.rod_spacing_mm = message.rod_spacing_mm();
  b.carriage_length_mm = message.carriage_length_mm();
  b.carriage_width_mm = message.carriage_width_mm();
  b.rail_radius_mm = message.rail_radius_mm();
  b.rail_offset_mm = message.rail_offset_mm();
  b.platform_radius_mm = message.platform_radius_mm();
  b.table_radius_mm = message.table_radius_mm();
  b.table_thickness_mm = message.table_thickness_mm();
  b.tool_radius_mm = message.tool_radius_mm();
  b.tool_length_mm = message.tool_length_mm();
  b.holder_radius_mm = message.holder_radius_mm();
  b.holder_length_mm = message.holder_length_mm();
  b.floor_mm = message.floor_mm();
  b.part_radius_mm = message.part_radius_mm();
  b.part_height_mm = message.part_height_mm();
  for (const auto& fixed : message.fixed())
    if (b.fixed.size() < bodies::kMostFixed)
      b.fixed.push_back({.name = fixed.name(),
                         .from_mm = vector3(fixed.from()),
                         .to_mm = vector3(fixed.to()),
                         .radius_mm = fixed.radius_mm()});
  return b;
}

/// What is drawn: the bodies that the gateway keeps apart. A gateway that knows of none: those that a machine
/// of this kind has by default.
bodies::Model solid_of(const joblink::MachineInfo& machine, MachineModel::Kind kind) {
  const BodiesDescription b = machine.has_bodies() ? bodies_of(machine.bodies()) : BodiesDescription{};
  switch (kind) {
    case MachineModel::Kind::kM1: {
      const M1Geometry legs = leg_geometry(machine);
      return machine.kinematics() == "m5" ? bodies::make_model(M5Geometry{legs}, b)
                                          : bodies::make_model(legs, b);
    }
    case MachineModel::Kind::kM4:
      return bodies::make_model(planar_geometry(machine), b);
    case MachineModel::Kind::kLinearDelta:
      return bodies::make_model(delta_geometry(machine), b);
    case MachineModel::Kind::kCartesian:
    case MachineModel::Kind::kCoreXy:
      break;
  }
  return bodies::make_model(cartesian_geometry(machine), b);
}

}  // namespace

std::optional<MachineModel> model_of(const joblink::MachineInfo& machine) {
  MachineModel m;
  m.name = machine.name();
  if (machine.has_legs() && machine.legs().legs_size() == 4) {
    legs_of(machine, m);
  } else if (machine.has_delta() && machine.delta().tower_angle_rad_size() == 3) {
    delta_of(machine, m);
  } else if (machine.has_cartesian()) {
    m.kind = machine.cartesian().core_xy() ? MachineModel::Kind::kCoreXy : MachineModel::Kind::kCartesian;
    m.turns = machine.cartesian().table();
  } else if (machine.has_planar()) {
    m.kind = MachineModel::Kind::kM4;
    m.turns = true;
  } else {
    return std::nullopt;
  }
  m.x_mm = range(machine.reach().x_mm(), m.x_mm);
  m.y_mm = range(machine.reach().y_mm(), m.y_mm);
  m.z_mm = range(machine.reach().z_mm(), m.z_mm);
  m.radius_mm = machine.reach().radius_mm();
  m.solid = solid_of(machine, m.kind);
  m.watched = machine.has_bodies();
  for (const auto& body : m.solid->bodies())
    if (body.id.kind == bodies::BodyKind::kTable)
      m.table_radius_mm = m.solid->at_rest().shapes[body.first_shape].radius_mm;
  return m;
}

kinebus::Pose to_pose(const joblink::Pose& pose) {
  return {pose.x_mm(), pose.y_mm(), pose.z_mm(), pose.a_rad(), pose.c_rad(), pose.e_mm()};
}

gcode::Options reading_options(const joblink::MachineInfo& machine) {
  gcode::Options options = PathReader::any_machine();
  if (machine.has_bed_reference()) options.start = options.home = to_pose(machine.bed_reference());
  if (const joblink::Range& a = machine.reach().a_rad(); a.min() < a.max()) {
    options.a_min_rad = a.min();
    options.a_max_rad = a.max();
  }
  return options;
}

PartPose pose_of(const joblink::Status& status) {
  const joblink::Pose& t = status.tool();
  return {{t.x_mm(), t.y_mm(), t.z_mm()}, t.a_rad(), t.c_rad()};
}

}  // namespace kinebus::gui
