// What a client is told of the machine: every value of the description is where its name says.

#include "gateway/sessions/messages.hpp"
#include "gateway/sessions/tests/message_text.hpp"

namespace kinebus {
namespace {

joblink::MachineInfo info_of(const MachineDescription& machine) {
  return to_message(machine, Pose{});
}

/// The geometry alone: with what reaches.
template <typename Geometry>
joblink::MachineInfo geometry_of(Geometry geometry) {
  MachineDescription machine;
  machine.kinematics = geometry;
  const joblink::MachineInfo all = info_of(machine);
  joblink::MachineInfo told;
  told.set_kinematics(all.kinematics());
  *told.mutable_reach() = all.reach();
  if (all.has_legs()) *told.mutable_legs() = all.legs();
  if (all.has_cartesian()) *told.mutable_cartesian() = all.cartesian();
  if (all.has_delta()) *told.mutable_delta() = all.delta();
  if (all.has_planar()) *told.mutable_planar() = all.planar();
  return told;
}

constexpr PoseLimits kReach{{1, 2}, {3, 4}, {5, 6}, {7, 8}, {9, 10}, 11};
const std::string kReachSays =
    "reach { x_mm { min: 1 max: 2 } y_mm { min: 3 max: 4 } z_mm { min: 5 max: 6 } "
    "a_rad { min: 7 max: 8 } c_rad { min: 9 max: 10 } radius_mm: 11 }";

M1Geometry four_legs() {
  M1Geometry g;
  g.limits = kReach;
  g.nozzle_mm = {21, 22, 23};
  g.table_mm = {24, 25, 26};
  for (std::size_t i = 0; i < 4; ++i)
    g.legs[i] = {{31, 32, 33}, {34, 35, 36}, {37, 38, 39}, 40, 41, i == 1, {42, 43}};
  return g;
}
std::string legs_say(const char* more = "") {
  std::string legs;
  for (int i = 0; i < 4; ++i)
    legs += std::string(R"(legs { foot { x_mm: 31 y_mm: 32 z_mm: 33 } rail { x_mm: 34 y_mm: 35 z_mm: 36 }
        attachment { x_mm: 37 y_mm: 38 z_mm: 39 } length_mm: 40 connector_mm: 41 )") +
            (i == 1 ? "carriage_above: true " : "") + "travel_mm { min: 42 max: 43 } } ";
  return "legs { " + legs + "nozzle { x_mm: 21 y_mm: 22 z_mm: 23 } " + more + " }";
}

TEST(MachineMessage, TellsTheGeometryOfEachKindOfMachine) {
  M1Geometry legs = four_legs();
  expect_says(geometry_of(legs), "kinematics: 'm1' " + kReachSays + legs_say());
  legs.tool = ToolPlacement::kPlatform;
  expect_says(geometry_of(legs), "kinematics: 'm1' " + kReachSays +
                                     legs_say("tool_on_platform: true table { x_mm: 24 y_mm: 25 z_mm: 26 }"));
  M5Geometry mill;
  static_cast<M1Geometry&>(mill) = four_legs();
  expect_says(geometry_of(mill), "kinematics: 'm5' " + kReachSays + legs_say());

  const std::string box = "x_mm { min: 1 max: 2 } y_mm { min: 3 max: 4 } z_mm { min: 5 max: 6 }";
  CartesianGeometry cartesian{{1, 2}, {3, 4}, {5, 6}, true, {{21, 22, 23}, {7, 8}, {9, 10}}};
  expect_says(geometry_of(cartesian), "kinematics: 'cartesian' reach { " + box +
                                          " a_rad { min: 7 max: 8 } c_rad { min: 9 max: 10 } } " +
                                          "cartesian { table: true pivot { x_mm: 21 y_mm: 22 z_mm: 23 } }");
  cartesian.has_table = false;
  expect_says(geometry_of(cartesian), "kinematics: 'cartesian' reach { " + box + " } cartesian {}");
  expect_says(geometry_of(CoreXyGeometry{{1, 2}, {3, 4}, {5, 6}}),
              "kinematics: 'corexy' reach { " + box + " } cartesian { core_xy: true }");

  LinearDeltaGeometry delta;
  delta.radius_mm = 21;
  delta.arm_length_mm = 22;
  delta.tower_angle_rad = {23, 24, 25};
  delta.limits = kReach;
  expect_says(geometry_of(delta), "kinematics: 'delta' " + kReachSays +
                                      "delta { radius_mm: 21 arm_length_mm: 22 tower_angle_rad: 23 "
                                      "tower_angle_rad: 24 tower_angle_rad: 25 }");
  M4Geometry planar{21, 22, 23, 24, 25, 26, 27};
  planar.limits = kReach;
  expect_says(geometry_of(planar), "kinematics: 'm4' " + kReachSays +
                                       "planar { rod_mm: 21 triangle_mm: 22 rails_mm: 23 spindle_rad: 24 "
                                       "tool_mm: 25 table_y_mm: 26 table_z_mm: 27 }");
}

TEST(MachineMessage, TellsOfJointsAndSwitches) {
  MachineDescription machine;
  JointDescription joint;
  joint.name = "tilt";
  joint.rotary = true;
  joint.node_id = 3;
  joint.axis = 1;
  joint.travel = {1, 2};
  joint.speed_per_s = 4;
  joint.accel_per_s2 = 5;
  joint.run_current_ma = 1500;
  joint.hold_current_ma = 500;
  joint.scale.emplace();
  joint.homing.emplace().switch_input = 6;
  machine.joints = {joint, JointDescription{}};
  NodeDescription node;
  node.id = 9;
  using F = InputFunction;
  node.inputs = {{{F::kHome, 0},
                  {F::kHome, 1},
                  {F::kPositiveLimit, 0},
                  {F::kNegativeLimit, 1},
                  {F::kEmergencyStop},
                  {F::kProbe},
                  {}}};
  machine.nodes = {node};
  const joblink::MachineInfo info = info_of(machine);
  ASSERT_EQ(info.joints_size(), 2);
  expect_says(info.joints(0),
              R"(name: "tilt" rotary: true node: 3 axis: 1 travel { min: 1 max: 2 } speed_per_s: 4
      accel_per_s2: 5 run_current_a: 1.5 hold_current_a: 0.5 home_switch: 6 has_scale: true)");
  EXPECT_EQ(info.joints(1).home_switch(), 0U) << "it has none";
  EXPECT_FALSE(info.joints(1).has_scale());
  expect_says(info.nodes(0), R"(id: 9 inputs: "home A" inputs: "home B" inputs: "positive limit A"
      inputs: "negative limit B" inputs: "emergency stop" inputs: "probe" inputs: "")");
}

TEST(MachineMessage, TellsOfHeatFilamentAndWhatIsNamed) {
  MachineDescription machine;
  machine.name = "mine";
  EXPECT_FALSE(info_of(machine).has_filament_ways()) << "nothing here melts";
  EXPECT_EQ(info_of(machine).hotend_max_celsius(), 0);
  HeaterDescription hotend, bed;
  hotend.name = "hot";
  hotend.max_c = 290;
  bed.name = "bed";
  bed.kind = HeaterKind::kBed;
  bed.max_c = 75;
  machine.heaters = {bed};
  EXPECT_FALSE(info_of(machine).has_filament_ways());
  machine.heaters = {hotend, bed};
  machine.heaters[0].index = 1;
  EXPECT_EQ(info_of(machine).hotend_max_celsius(), 0) << "there is no first one";
  expect_says(info_of(machine).heaters(0), "name: 'hot' index: 1 max_celsius: 290 usual_celsius: 200");
  machine.heaters[0].index = 0;
  machine.path.tool_speed_mm_per_s = 11;
  machine.path.tool_accel_mm_per_s2 = 12;
  machine.materials = {{"PLA", 13, 14, 15}};
  machine.cameras = {{"top", ":1/a", ":1/b"}};
  machine.macros = {{"START", "G28"}};
  machine.pause.unload_mm = 16;
  machine.pause.load_mm = 17;
  machine.pause.purge_mm = 18;
  machine.gcode.filament_diameter_mm = 2.5;
  machine.bus.interface = "can7";
  joblink::MachineInfo info = to_message(machine, {1, 2, 3, 4, 5, 6});
  info.clear_legs();
  info.clear_reach();
  expect_says(
      info,
      R"(name: "mine" kinematics: "m1" bed_reference { x_mm: 1 y_mm: 2 z_mm: 3 a_rad: 4 c_rad: 5 e_mm: 6 }
      tool_speed_mm_per_s: 11 tool_accel_mm_per_s2: 12 hotend_max_celsius: 290 bed_max_celsius: 75
      filament_diameter_mm: 2.5 bus: "can7"
      heaters { name: "hot" max_celsius: 290 usual_celsius: 200 }
      heaters { name: "bed" kind: HEATER_BED max_celsius: 75 usual_celsius: 75 }
      materials { name: "PLA" hotend_celsius: 13 bed_celsius: 14 chamber_celsius: 15 }
      filament_ways { unload_mm: 16 load_mm: 17 purge_mm: 18 } macros: "START"
      cameras { name: "top" stream: ":1/a" snapshot: ":1/b" })");
}

TEST(MachineMessage, TellsWhatIsSolid) {
  MachineDescription machine;
  EXPECT_FALSE(info_of(machine).has_bodies()) << "nobody knows";
  BodiesDescription b{1,
                      2,
                      3,
                      4,
                      5,
                      6,
                      7,
                      8,
                      9,
                      10,
                      11,
                      12,
                      13,
                      14,
                      15,
                      16,
                      17,
                      true,
                      {{"post", {21, 22, 23}, {24, 25, 26}, 27}}};
  machine.bodies = b;
  expect_says(info_of(machine).bodies(),
              R"(clearance_mm: 1 rod_radius_mm: 2 rod_spacing_mm: 3 carriage_length_mm: 4
      carriage_width_mm: 5 rail_radius_mm: 6 rail_offset_mm: 7 platform_radius_mm: 8 table_radius_mm: 9
      table_thickness_mm: 10 tool_radius_mm: 11 tool_length_mm: 12 holder_radius_mm: 13 holder_length_mm: 14
      floor_mm: 15 part_radius_mm: 16 part_height_mm: 17
      fixed { name: "post" from { x_mm: 21 y_mm: 22 z_mm: 23 } to { x_mm: 24 y_mm: 25 z_mm: 26 } radius_mm: 27 })");
}

}  // namespace
}  // namespace kinebus
