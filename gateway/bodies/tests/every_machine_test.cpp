// Bodies of each shipped machine against its kinematics, and the models' shortcuts against measuring all
// pairs.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>

#include "gateway/bodies/sweep.hpp"
#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/bodies/tests/model_poses.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"

namespace kinebus::bodies {
namespace {

MachineDescription shipped(const std::string& name) {
  auto machine = load_machine(machines_folder() / name);
  EXPECT_TRUE(machine) << to_string(machine.error());
  machine->bodies.emplace();
  return *machine;
}

/// Each pair measured by itself, and the first of the nearest.
TEST(EveryMachine, WhicheverPairIsLookedAtFirstTheNearestIsTheSame) {
  std::mt19937 random(11);
  const auto in = [&random](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (const char* name : {"m1.toml", "m4.toml", "m5.toml", "delta.toml", "cartesian.toml", "corexy.toml"}) {
    const Model model = make_collision_model(shipped(name));
    Scene scene = model->at_rest();
    int seen = 0;
    CollisionModel::Memory on_the_way;
    for (int n = 0; n < 60; ++n) {
      const Pose pose{in(-80, 80), in(-80, 80), in(0, 150), n % 2 == 0 ? 0 : in(-0.3, 0.3), 0, 0};
      if (!model->place(Frame::kPart, pose, scene)) continue;
      ++seen;
      double least = HUGE_VAL;
      const CollisionModel::Pair* nearest = nullptr;
      for (const CollisionModel::Pair& pair : model->pairs())
        if (const double mm = model->distance(scene, pair); !pair.homing_only && mm < least) {
          least = mm;
          nearest = &pair;
        }
      ASSERT_NE(nearest, nullptr) << name;
      for (const std::size_t begin :
           {std::size_t{0}, model->pairs().size() / 2, model->pairs().size() - 1, std::size_t{100'000}}) {
        CollisionModel::Memory before{.likely = begin};
        const Clearance c = model->clearance(scene, Occasion::kMotion, &before);
        EXPECT_EQ(c.mm, least) << name << " pose " << n << " from pair " << begin;
        EXPECT_EQ(&model->pairs()[before.likely], nearest) << name << " pose " << n << " from pair " << begin;
      }
      EXPECT_EQ(model->clearance(scene, Occasion::kMotion, &on_the_way).mm, least)
          << name << " pose " << n << ", planes of the pose before";
      EXPECT_EQ(&model->pairs()[on_the_way.likely], nearest) << name << " pose " << n;
    }
    EXPECT_GT(seen, 10) << name;
  }
}

TEST(EveryMachine, PairsThatAreAlwaysPartedKeepTheClearanceAtEveryPose) {
  std::mt19937 random(12);
  const auto in = [&random](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  // Carriages against each other and against each other's rails, at least.
  const std::map<const char*, std::size_t> machines{{"m1.toml", 6 + 12},
                                                    {"m4.toml", 1 + 2},
                                                    {"m5.toml", 6 + 12},
                                                    {"delta.toml", 3 + 6},
                                                    {"cartesian.toml", 0}};
  for (const auto& [name, least] : machines) {
    const Model model = make_collision_model(shipped(name));
    std::vector<CollisionModel::Pair> parted;
    for (const CollisionModel::Pair& pair : model->pairs())
      if (model->always_parted(pair)) parted.push_back(pair);
    EXPECT_GE(parted.size(), least) << name;
    Scene scene = model->at_rest();
    for (int n = 0; n < 200; ++n) {
      const Pose pose{in(-150, 150), in(-150, 150), in(-50, 300), in(-0.8, 0.8), 0, 0};
      if (!model->place(Frame::kPart, pose, scene)) continue;
      for (const CollisionModel::Pair& pair : parted)
        EXPECT_GE(model->distance(scene, pair), model->wanted_mm())
            << name << ": " << model->name(model->bodies()[pair.first].id) << " and "
            << model->name(model->bodies()[pair.second].id);
    }
  }
}

/// The tool's tip against the table: what the pose says.
TEST(EveryMachine, TipAndTableAreAsFarApartAsThePoseSays) {
  for (const char* name : {"m4.toml", "m5.toml", "delta.toml", "cartesian.toml", "corexy.toml"}) {
    SCOPED_TRACE(name);
    const MachineDescription d = shipped(name);
    const Model model = make_collision_model(d);
    Scene scene = model->at_rest();
    const Pose pose{10, -20, 35, 0, 0, 0};
    ASSERT_TRUE(model->place(Frame::kPart, pose, scene));
    EXPECT_NEAR(modelled(*model, scene, {BodyKind::kTable, 0}, {BodyKind::kTool, 0}), 35, 2e-3);
    EXPECT_NEAR(modelled(*model, scene, {BodyKind::kTable, 0}, {BodyKind::kHolder, 0}), 75, 2e-3);
  }
}

TEST(ToolOnPlatform, ToolAndHolderTiltWithThePlatformOverATableThatStands) {
  MachineDescription d = shipped("m5.toml");
  d.bodies->part_radius_mm = 30;
  d.bodies->part_height_mm = 10;
  const auto& g = std::get<M5Geometry>(d.kinematics);
  const Model model = make_collision_model(d);
  Scene scene = model->at_rest();
  std::mt19937 source(9);
  for (int n = 0; n < 50; ++n) {
    Pose pose = random_pose(source, 100, 200, 45 * kRadPerDeg);
    pose[kC] = 0;
    ASSERT_TRUE(model->place(Frame::kPart, pose, scene));
    // The tool leans by -A about its tip, which is over the table as the pose says.
    const Vec tip{g.table_mm[0] + pose[kX], g.table_mm[1] + pose[kY], g.table_mm[2] + pose[kZ]};
    const Vec up{0, std::sin(pose[kA]), std::cos(pose[kA])};
    int found = 0;
    for (const CollisionModel::Body& body : model->bodies()) {
      const Shape& s = scene.shapes[body.first_shape];
      const auto expect_at = [&](const Vec& expected) {
        ++found;
        EXPECT_LT(norm(s.centre - expected), 1e-9) << model->name(body.id);
      };
      const double tool = d.bodies->tool_length_mm;
      if (body.id.kind == BodyKind::kTool) expect_at(tip + (0.5 * (tool + d.bodies->tool_radius_mm)) * up);
      if (body.id.kind == BodyKind::kHolder) expect_at(tip + (tool + 0.5 * d.bodies->holder_length_mm) * up);
      const Vec table{g.table_mm[0], g.table_mm[1], g.table_mm[2]};
      if (body.id.kind == BodyKind::kTable) expect_at(table - Vec{0, 0, 0.5 * d.bodies->table_thickness_mm});
      if (body.id.kind == BodyKind::kPart) expect_at(table + Vec{0, 0, 5});
    }
    EXPECT_EQ(found, 4);
  }
  // The platform comes down on the table's side towards which it leans; nearer to the platform, sooner.
  const Pose leaning{-20, -90, 1, 45 * kRadPerDeg, 0, 0};
  EXPECT_GT(model->clearance(Frame::kPart, leaning)->mm, 2);
  std::get<M5Geometry>(d.kinematics).nozzle_mm[2] = -110;
  const auto c = make_collision_model(d)->clearance(Frame::kPart, leaning);
  ASSERT_TRUE(c);
  EXPECT_LT(c->mm, 0);
  EXPECT_TRUE(c->first.kind == BodyKind::kTable || c->second.kind == BodyKind::kTable) << model->words(*c);
}

TEST(EveryMachine, LegsEndAtTheirCarriagesAndHaveTheirLength) {
  for (const char* name : {"m4.toml", "delta.toml", "m5.toml"}) {
    SCOPED_TRACE(name);
    const MachineDescription d = shipped(name);
    const auto kinematics = make_kinematics(d);
    const Model model = make_collision_model(d);
    Scene scene = model->at_rest();
    const double tilt = std::string(name) == "delta.toml" ? 0 : 0.3;
    const double length = std::string(name) == "m4.toml" ? std::get<M4Geometry>(d.kinematics).rod_mm
                          : std::string(name) == "delta.toml"
                              ? std::get<LinearDeltaGeometry>(d.kinematics).arm_length_mm
                              : std::get<M5Geometry>(d.kinematics).legs[0].length_mm;
    const Pose at[2] = {{10, -20, 35, 0, 0, 0}, {25, -5, 60, tilt, 0, 0}};
    std::vector<double> heights[2];
    JointVector joints[2]{};
    for (std::size_t n = 0; n < 2; ++n) {
      ASSERT_TRUE((*kinematics)->inverse(Frame::kPart, at[n], joints[n]));
      ASSERT_TRUE(model->place(Frame::kPart, at[n], scene));
      for (const CollisionModel::Body& body : model->bodies()) {
        if (body.id.kind == BodyKind::kLeg) {
          EXPECT_NEAR(2 * norm(scene.shapes[body.first_shape].half[0]), length, 1e-6);
        }
        if (body.id.kind == BodyKind::kCarriage)
          heights[n].push_back(scene.shapes[body.first_shape].centre.z);
      }
    }
    ASSERT_GE(heights[0].size(), 2u);
    for (std::size_t i = 0; i < heights[0].size(); ++i)
      EXPECT_NEAR(heights[1][i] - heights[0][i], joints[1][i] - joints[0][i], 1e-9) << i;
  }
}

TEST(EveryMachine, AHolderThatIsTooWideMeetsATableThatTilts) {
  MachineDescription d = legs_below();
  const Pose tilted{0, 0, 1, 45 * kRadPerDeg, 0, 0};
  EXPECT_GT(make_collision_model(d)->clearance(Frame::kPart, tilted)->mm, 2);
  d.bodies->holder_radius_mm = 45;
  const Model model = make_collision_model(d);
  const auto c = model->clearance(Frame::kPart, tilted);
  EXPECT_LE(c->mm, 0);
  EXPECT_EQ(model->words(*c), "table and nozzle holder would touch");
}

TEST(EveryMachine, FixedBodiesHaveTheNamesOfTheirTables) {
  MachineDescription d = legs_below();
  d.bodies->fixed.push_back({"lamp", {-20, -20, 1350}, {20, 20, 1500}});
  d.bodies->fixed.push_back({"duct", {60, -20, 1301}, {90, 20, 1400}});
  const Model model = make_collision_model(d);
  // The platform comes up to z 1300 - 30 at this pose; the duct's foot is 31 mm over the table.
  const auto c = model->clearance(Frame::kPart, {0, 0, 30, 0, 0, 0});
  ASSERT_TRUE(c);
  EXPECT_GT(c->mm, 2);
  const auto low = model->clearance(Frame::kPart, {0, 0, 0, 0, 0, 0});
  EXPECT_NEAR(low->mm, 1, 2e-3);
  EXPECT_EQ(model->words(*low), "table and duct would come as near as 1.00 mm; bodies keep 2 mm apart");
  // A rod is round: its side is its radius from the line between its ends.
  d.bodies->fixed.push_back({"brace", {-50, 60, 1306}, {50, 60, 1306}, 5.5});
  const Model braced = make_collision_model(d);
  const auto under = braced->clearance(Frame::kPart, {0, 0, 0, 0, 0, 0});
  EXPECT_NEAR(under->mm, 0.5, 2e-3);
  EXPECT_EQ(braced->words(*under), "table and brace would come as near as 0.50 mm; bodies keep 2 mm apart");
}

}  // namespace
}  // namespace kinebus::bodies
