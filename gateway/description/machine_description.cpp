#include "gateway/description/machine_description.hpp"

#include <algorithm>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/machine_schema.hpp"

namespace kinebus {
namespace {

HomingDescription tower_homing(std::uint8_t input) {
  return {.method = 22,
          .switch_input = input,
          .fast_per_s = 40,
          .slow_per_s = 4,
          .accel_per_s2 = 500,
          .back_off = 5,
          .switch_position = 10,
          .max_search = 600};
}

JointDescription tower(int number) {
  JointDescription j;
  j.name = "tower" + std::to_string(number);
  j.node_id = static_cast<std::uint8_t>((number + 1) / 2);
  j.axis = static_cast<std::uint8_t>((number - 1) % 2);
  j.drive.travel_per_turn = 40;
  j.travel = {10, 540};  // below 40 it homes only: a tall part beside the nozzle then has room
  j.speed_per_s = 450;
  j.accel_per_s2 = 5000;
  j.stop_accel_per_s2 = 10000;
  j.run_current_ma = 2000;
  j.hold_current_ma = 1500;
  j.homing = tower_homing(static_cast<std::uint8_t>(j.axis + 1));
  return j;
}

}  // namespace

MachineDescription default_m1() {
  MachineDescription d;
  d.name = "M1";
  d.kinematics = M1Geometry{};
  d.gcode.traverse_mm_per_s = 300;
  // Upright legs pass a carriage's error on up to 3.6 times: 0.3 microsteps keep the tool within 1.5 um.
  d.tolerances.segment_counts = 0.3;
  d.homing.max_spread_mm = 270;
  d.homing.spared_part_mm = 250;
  for (int number = 1; number <= 4; ++number) d.joints.push_back(tower(number));
  JointDescription c;
  c.name = "C";
  c.rotary = true;
  c.node_id = 3;
  c.axis = 0;
  c.drive.travel_per_turn = 120 * kRadPerDeg;
  c.speed_per_s = 360 * kRadPerDeg;
  c.accel_per_s2 = 3600 * kRadPerDeg;
  c.stop_accel_per_s2 = 7200 * kRadPerDeg;
  c.run_current_ma = 1200;
  c.hold_current_ma = 800;
  d.joints.push_back(c);
  JointDescription e;
  e.name = "E";
  e.node_id = 3;
  e.axis = 1;
  e.drive.travel_per_turn = 23.2;
  e.speed_per_s = 60;
  e.accel_per_s2 = 3000;
  e.stop_accel_per_s2 = 4000;
  e.run_current_ma = 900;
  e.hold_current_ma = 400;
  d.joints.push_back(e);
  for (std::uint8_t id = 1; id <= 3; ++id) {
    NodeDescription node{.id = id, .vendor = {}, .product = {}, .serial = {}};
    if (id <= 2)
      for (std::uint8_t axis = 0; axis < 2; ++axis) node.inputs[axis] = {InputFunction::kHome, axis};
    d.nodes.push_back(node);
  }
  d.heaters = {{.name = "bed",
                .kind = HeaterKind::kBed,
                .max_c = 120,
                .sim_power_w = 150,
                .sim_heat_capacity_j_per_k = 300,
                .sim_loss_w_per_k = 1},
               {.name = "hotend"}};
  d.fans = {{.name = "part"}};
  d.bodies.emplace().table_radius_mm = 100;
  // Columns behind the rails, and what joins them above the tallest part.
  d.bodies->fixed = {
      {.name = "bridge", .from_mm = {-335, -20, 1760}, .to_mm = {340, 20, 1800}},
      {.name = "bridge_left", .from_mm = {-375, -266, 1760}, .to_mm = {-335, 266, 1800}},
      {.name = "column_left_back", .from_mm = {-375, 266, -70}, .to_mm = {-335, 306, 1800}},
      {.name = "column_left_front", .from_mm = {-375, -306, -70}, .to_mm = {-335, -266, 1800}},
      {.name = "column_right", .from_mm = {340, -110, -70}, .to_mm = {380, 110, 1800}},
      {.name = "stem", .from_mm = {-17, -17, 1420}, .to_mm = {17, 17, 1760}},
  };
  machine_schema::connect_travel(d);
  return d;
}

int MachineDescription::tools() const {
  int tools = 1;
  for (const HeaterDescription& h : heaters)
    if (h.kind == HeaterKind::kHotend) tools = std::max(tools, h.index + 1);
  return tools;
}

int MachineDescription::hotends_on(std::uint8_t node_id) const {
  return static_cast<int>(
      std::count_if(heaters.begin(), heaters.end(), [node_id](const HeaterDescription& h) {
        return h.kind == HeaterKind::kHotend && h.place.on_node() && h.place.node_id == node_id;
      }));
}

std::string identity(const MachineDescription& description) {
  std::string text = description.name;
  for (const JointDescription& joint : description.joints) text += " " + joint.name;
  return text;
}

std::uint64_t geometry_mark(const MachineDescription& description) {
  MachineDescription bare;
  bare.kinematics = description.kinematics;
  std::visit(
      [](auto& geometry) {
        if constexpr (requires { geometry.limits; }) geometry.limits = {};
      },
      bare.kinematics);
  bare.geometry_calibration = description.geometry_calibration;
  for (const JointDescription& joint : description.joints) {
    JointDescription& kept = bare.joints.emplace_back();
    kept.name = joint.name;
    kept.rotary = joint.rotary;
    kept.calibration = joint.calibration;
    if (joint.homing) kept.homing.emplace().switch_position = joint.homing->switch_position;
  }
  bare.probe.present = true;
  bare.probe.offset_mm = description.probe.offset_mm;
  // FNV-1a, 64 bit.
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : write_machine(bare)) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001b3;
  return hash;
}

std::vector<JointName> joint_names(const KinematicsGeometry& geometry) {
  if (std::holds_alternative<M1Geometry>(geometry))
    return {{"tower1"}, {"tower2"}, {"tower3"}, {"tower4"}, {"C", true}, {"E"}};
  if (const auto* cartesian = std::get_if<CartesianGeometry>(&geometry)) {
    if (cartesian->has_table) return {{"X"}, {"Y"}, {"Z"}, {"A", true}, {"C", true}, {"E"}};
    return {{"X"}, {"Y"}, {"Z"}, {"E"}};
  }
  if (std::holds_alternative<CoreXyGeometry>(geometry)) return {{"beltA"}, {"beltB"}, {"Z"}, {"E"}};
  if (std::holds_alternative<M4Geometry>(geometry))
    return {{"rail1"}, {"rail2"}, {"rail3"}, {"X"}, {"C", true}};
  if (std::holds_alternative<M5Geometry>(geometry)) return {{"rail1"}, {"rail2"}, {"rail3"}, {"rail4"}};
  return {{"tower1"}, {"tower2"}, {"tower3"}, {"E"}};
}

const PoseLimits* pose_limits(const KinematicsGeometry& geometry) {
  return std::visit(
      [](const auto& g) -> const PoseLimits* {
        if constexpr (requires { g.limits; })
          return &g.limits;
        else
          return nullptr;
      },
      geometry);
}

const AxisVibration& VibrationDescription::axis(std::size_t pose_axis) const {
  const std::optional<AxisVibration>& own = pose_axis == 0 ? x : pose_axis == 1 ? y : z;
  return own ? *own : every;
}

bool VibrationDescription::shapes() const {
  for (std::size_t i = 0; i < 3; ++i)
    if (axis(i).shaper != ShaperKind::kNone) return true;
  return false;
}

bool turns_part(const Kinematics& kinematics) {
  JointVector joints{};
  std::vector<double> matrix(static_cast<std::size_t>(kinematics.joint_count()) * kPoseAxes);
  if (!kinematics.jacobian(Frame::kMachine, kinematics.bed_reference(), joints, matrix)) return false;
  for (std::size_t row = 0; row < matrix.size(); row += kPoseAxes)
    if (matrix[row + kA] != 0 || matrix[row + kC] != 0) return true;
  return false;
}

Result<std::unique_ptr<Kinematics>, GeometryError> make_kinematics(const MachineDescription& description) {
  struct Make {
    const std::optional<M1Correction>& correction;
    auto operator()(const M1Geometry& g) const {
      return make_m1_kinematics(correction ? corrected(g, *correction) : g);
    }
    auto operator()(const CartesianGeometry& g) const { return make_cartesian_kinematics(g); }
    auto operator()(const CoreXyGeometry& g) const { return make_corexy_kinematics(g); }
    auto operator()(const LinearDeltaGeometry& g) const { return make_linear_delta_kinematics(g); }
    auto operator()(const M4Geometry& g) const { return make_m4_kinematics(g); }
    auto operator()(const M5Geometry& g) const {
      return make_m5_kinematics(correction ? M5Geometry{corrected(g, *correction)} : g);
    }
  };
  return std::visit(Make{description.geometry_calibration}, description.kinematics);
}

std::unique_ptr<const bodies::CollisionModel> make_collision_model(const MachineDescription& description) {
  if (!description.bodies) return nullptr;
  return std::visit(
      [&d = description]<typename G>(const G& geometry) {
        if constexpr (std::is_base_of_v<M1Geometry, G>)
          return bodies::make_model(
              d.geometry_calibration ? G{corrected(geometry, *d.geometry_calibration)} : geometry, *d.bodies);
        else
          return bodies::make_model(geometry, *d.bodies);
      },
      description.kinematics);
}

namespace machine_schema {

void prepare_kinematics(MachineDescription& d, int kind) {
  if (!d.joints.empty() && static_cast<int>(d.kinematics.index()) == kind) return;
  switch (kind) {
    case 0: {
      M1Geometry g;
      g.limits = {};
      g.min_platform_clearance_rad = 0;
      d.kinematics = g;
      break;
    }
    case 1:
      d.kinematics = CartesianGeometry{};
      break;
    case 2:
      d.kinematics = CoreXyGeometry{};
      break;
    case 3: {
      LinearDeltaGeometry g;
      g.limits = {};
      d.kinematics = g;
      break;
    }
    case 4: {
      M4Geometry g;
      g.limits = {};
      d.kinematics = g;
      break;
    }
    default: {
      M5Geometry g;
      g.limits = {};
      g.min_platform_clearance_rad = 0;
      d.kinematics = g;
      break;
    }
  }
  d.joints.clear();
}

BodyKeys body_keys(const KinematicsGeometry& geometry) {
  const bool m4 = std::holds_alternative<M4Geometry>(geometry);
  const bool legs = m4 || std::holds_alternative<M1Geometry>(geometry) ||
                    std::holds_alternative<M5Geometry>(geometry) ||
                    std::holds_alternative<LinearDeltaGeometry>(geometry);
  return {.legs = legs, .pairs = legs && !m4, .platform = legs};
}

void prepare_joints(MachineDescription& d) {
  const std::vector<JointName> names = joint_names(d.kinematics);
  d.joints.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (d.joints[i].name == names[i].name) continue;
    d.joints[i] = {};
    d.joints[i].name = names[i].name;
    d.joints[i].rotary = names[i].rotary;
  }
}

bool has_own_travel(const MachineDescription& d, std::size_t joint) {
  return !(std::holds_alternative<CoreXyGeometry>(d.kinematics) && joint < 2);
}

void connect_travel(MachineDescription& d) {
  auto& j = d.joints;
  if (auto* m1 = std::get_if<M1Geometry>(&d.kinematics)) {
    for (std::size_t i = 0; i < 4; ++i) m1->legs[i].travel_mm = j[i].travel;
    m1->limits.c_rad = j[4].travel;
  } else if (auto* cartesian = std::get_if<CartesianGeometry>(&d.kinematics)) {
    cartesian->x_mm = j[0].travel;
    cartesian->y_mm = j[1].travel;
    cartesian->z_mm = j[2].travel;
    if (cartesian->has_table) {
      cartesian->table.a_rad = j[3].travel;
      cartesian->table.c_rad = j[4].travel;
    } else {
      cartesian->table = {};
    }
  } else if (auto* corexy = std::get_if<CoreXyGeometry>(&d.kinematics)) {
    corexy->z_mm = j[2].travel;
    j[0].travel = {corexy->x_mm.min + corexy->y_mm.min, corexy->x_mm.max + corexy->y_mm.max};
    j[1].travel = {corexy->x_mm.min - corexy->y_mm.max, corexy->x_mm.max - corexy->y_mm.min};
  } else if (auto* m4 = std::get_if<M4Geometry>(&d.kinematics)) {
    for (std::size_t i = 0; i < 3; ++i) m4->travel_mm[i] = j[i].travel;
    m4->table_travel_mm = j[3].travel;
    m4->limits.c_rad = j[4].travel;
  } else if (auto* m5 = std::get_if<M5Geometry>(&d.kinematics)) {
    for (std::size_t i = 0; i < 4; ++i) m5->legs[i].travel_mm = j[i].travel;
  } else if (auto* delta = std::get_if<LinearDeltaGeometry>(&d.kinematics)) {
    for (std::size_t i = 0; i < 3; ++i) delta->travel_mm[i] = j[i].travel;
  }
}

}  // namespace machine_schema
}  // namespace kinebus
