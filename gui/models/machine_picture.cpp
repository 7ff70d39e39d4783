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
  m.nozzle_mm = vec(machine.legs().nozzle());
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
  // How the horizontal distance is split between tower and effector changes nothing but the drawing.
  constexpr double kEffector_mm = 32;
  m.tower_radius_mm = machine.delta().radius_mm() + kEffector_mm;
  for (int i = 0; i < machine.delta().tower_angle_rad_size(); ++i) {
    const double angle = machine.delta().tower_angle_rad(i);
    const Vec3 out{std::cos(angle), std::sin(angle), 0};
    const bool known = i < machine.joints_size();
    m.legs.push_back({.foot_mm = m.tower_radius_mm * out,
                      .rail = {0, 0, 1},
                      .attachment_mm = kEffector_mm * out,
                      .length_mm = machine.delta().arm_length_mm(),
                      .connector_mm = 0,
                      .carriage_above = true,
                      .travel_mm = known ? range(machine.joints(i).travel(), {0, 600}) : Range{0, 600},
                      .speed_mm_per_s = known ? machine.joints(i).speed_per_s() : 450});
  }
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
  } else {
    return std::nullopt;
  }
  m.x_mm = range(machine.reach().x_mm(), m.x_mm);
  m.y_mm = range(machine.reach().y_mm(), m.y_mm);
  m.z_mm = range(machine.reach().z_mm(), m.z_mm);
  m.radius_mm = machine.reach().radius_mm();
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

std::vector<double> carriages_of(const joblink::MachineInfo& machine, const joblink::Status& status) {
  std::vector<double> travel;
  if (!status.positions_known()) return travel;
  const int legs = machine.has_legs() ? machine.legs().legs_size() : machine.has_delta() ? 3 : 0;
  for (int i = 0; i < legs && i < status.joints_size(); ++i) travel.push_back(status.joints(i));
  return travel;
}

}  // namespace kinebus::gui
