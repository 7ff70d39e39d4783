// Bodies against the kinematics and geometry of each machine, by ways that the models do not go.

#include "gateway/bodies/collision_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>

#include "gateway/bodies/sweep.hpp"
#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/description/machine_file.hpp"

namespace kinebus::bodies {
namespace {

using Cloud = std::vector<Vec>;
constexpr double kStep_mm = 3;

/// Points of a rod's surface, not more than kStep_mm apart, and one set into its axis where `radius` is 0.
void add_tube(Cloud& cloud, const Vec& from, const Vec& to, double radius) {
  const Vec way = to - from;
  const double length = norm(way);
  const Vec d = (1 / length) * way, any = std::abs(d.x) < 0.7 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  Vec e = cross(d, any);
  e = (1 / norm(e)) * e;
  const Vec f = cross(d, e);
  const int along = static_cast<int>(length / kStep_mm) + 1,
            around = static_cast<int>(2 * std::numbers::pi * radius / kStep_mm) + 6;
  for (int i = 0; i <= along; ++i)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      cloud.push_back(from + (static_cast<double>(i) / along) * way +
                      radius * (std::cos(angle) * e + std::sin(angle) * f));
    }
}

struct Rod {
  Vec from, to;
};
struct Leg {
  std::array<Rod, 2> rods;
  Cloud surface;
};

/// From the points of one leg's surface to the other's rods.
double nearest(const Leg& a, const Leg& b, double radius) {
  double least = HUGE_VAL;
  for (const Vec& p : a.surface)
    for (const Rod& rod : b.rods) {
      const Vec way = rod.to - rod.from, r = p - rod.from;
      const double t = std::clamp(dot(r, way) / dot(way, way), 0.0, 1.0);
      least = std::min(least, norm(r - t * way) - radius);
    }
  return least;
}

/// The legs' rods of an M1 by its joints from the kinematics, as points.
std::array<Leg, 4> sampled_legs(const MachineDescription& d, const Kinematics& kinematics, const Pose& pose) {
  const auto& g = std::get<M1Geometry>(d.kinematics);
  JointVector q{};
  EXPECT_TRUE(kinematics.inverse(Frame::kPart, pose, q));
  const double ca = std::cos(pose[kA]), sa = std::sin(pose[kA]), cc = std::cos(pose[kC]),
               sc = std::sin(pose[kC]);
  const double x = cc * pose[kX] - sc * pose[kY], y = sc * pose[kX] + cc * pose[kY];
  const Vec p{g.nozzle_mm[0] - x, g.nozzle_mm[1] - (ca * y - sa * pose[kZ]),
              g.nozzle_mm[2] - (sa * y + ca * pose[kZ])};
  std::array<Leg, 4> legs;
  for (std::size_t i = 0; i < 4; ++i) {
    const M1Leg& leg = g.legs[i];
    const auto& b = leg.attachment_mm;
    const Vec joint = p + Vec{b[0], ca * b[1] - sa * b[2], sa * b[1] + ca * b[2]};
    const Vec foot{leg.foot_mm[0], leg.foot_mm[1], leg.foot_mm[2]},
        rail{leg.rail[0], leg.rail[1], leg.rail[2]};
    const Vec low = foot + q[i] * rail, high = joint - leg.connector_mm * rail;
    EXPECT_NEAR(norm(high - low), leg.length_mm, 1e-9);
    for (const std::size_t side : {0u, 1u}) {
      const Vec apart{(side == 0 ? -0.5 : 0.5) * d.bodies->rod_spacing_mm, 0, 0};
      legs[i].rods[side] = {low + apart, high + apart};
      add_tube(legs[i].surface, low + apart, high + apart, d.bodies->rod_radius_mm);
    }
  }
  return legs;
}

/// Distance of two kinds of bodies, all of their numbers apart.
double modelled(const CollisionModel& model, const Scene& scene, BodyId a, BodyId b) {
  double least = HUGE_VAL;
  for (const CollisionModel::Pair& pair : model.pairs()) {
    const BodyId first = model.bodies()[pair.first].id, second = model.bodies()[pair.second].id;
    if ((first == a && second == b) || (first == b && second == a))
      least = std::min(least, model.distance(scene, pair));
  }
  return least;
}

Pose random_pose(std::mt19937& source, double radius_mm, double z_mm, double tilt_rad) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(source);
  };
  const double r = radius_mm * std::sqrt(in(0, 1)), angle = in(-3.14, 3.14);
  return {r * std::cos(angle), r * std::sin(angle), in(0, z_mm), in(-tilt_rad, tilt_rad), in(-3, 3), 0};
}

TEST(LegMachine, LegsTableAndHolderAreWhereTheKinematicsPutThem) {
  MachineDescription d = legs_below();
  std::get<M1Geometry>(d.kinematics).legs[2].connector_mm = 25;
  const auto kinematics = make_kinematics(d);
  ASSERT_TRUE(kinematics) << kinematics.error().what;
  const Model model = make_collision_model(d);
  const auto& g = std::get<M1Geometry>(d.kinematics);
  Scene scene = model->at_rest();
  std::mt19937 source(7);
  for (int n = 0; n < 12; ++n) {
    const Pose pose = random_pose(source, 100, 200, 45 * kRadPerDeg);
    SCOPED_TRACE(n);
    ASSERT_TRUE(model->place(Frame::kPart, pose, scene));
    const auto legs = sampled_legs(d, **kinematics, pose);
    for (std::uint8_t i = 0; i < 4; ++i)
      for (auto k = static_cast<std::uint8_t>(i + 1); k < 4; ++k) {
        const double there = modelled(*model, scene, {BodyKind::kLeg, static_cast<std::uint8_t>(i + 1)},
                                      {BodyKind::kLeg, static_cast<std::uint8_t>(k + 1)});
        const double here = nearest(legs[i], legs[k], d.bodies->rod_radius_mm);
        EXPECT_LE(there, here + 1e-3) << int{i} << int{k};
        // Leg 3's connector is sampled by nobody: it may be nearer.
        if (i != 2 && k != 2) {
          EXPECT_GT(there, here - 2 * kStep_mm) << int{i} << int{k};
        }
      }
    // The table's disc, from its own frame: the nozzle's tip is at the pose in it.
    const double ca = std::cos(pose[kA]), sa = std::sin(pose[kA]), cc = std::cos(pose[kC]),
                 sc = std::sin(pose[kC]);
    const double tip_x = cc * pose[kX] - sc * pose[kY], tip_y = sc * pose[kX] + cc * pose[kY];
    const auto in_table = [&](const Vec& machine) {
      const Vec v = machine - Vec{g.nozzle_mm[0], g.nozzle_mm[1], g.nozzle_mm[2]};
      return Vec{tip_x + v.x, tip_y + ca * v.y + sa * v.z, pose[kZ] - sa * v.y + ca * v.z};
    };
    const auto to_disc = [](const Vec& v) {
      return std::hypot(std::max(std::hypot(v.x, v.y) - 100, 0.0), std::max({v.z, -8 - v.z, 0.0}));
    };
    Cloud holder;
    const Vec nozzle{g.nozzle_mm[0], g.nozzle_mm[1], g.nozzle_mm[2]};
    for (double radius = 0; radius <= d.bodies->holder_radius_mm; radius += 2.5)
      add_tube(holder, nozzle + Vec{0, 0, d.bodies->tool_length_mm},
               nozzle + Vec{0, 0, d.bodies->tool_length_mm + d.bodies->holder_length_mm}, radius);
    const auto check = [&](const Cloud& cloud, double there) {
      double here = HUGE_VAL;
      for (const Vec& v : cloud) here = std::min(here, to_disc(in_table(v)));
      EXPECT_LE(there, here + 1e-3);
      EXPECT_GT(there, here - 2 * kStep_mm);
    };
    check(holder, modelled(*model, scene, {BodyKind::kTable, 0}, {BodyKind::kHolder, 0}));
    for (std::uint8_t i = 0; i < 4; ++i)
      if (i != 2)
        check(legs[i].surface, modelled(*model, scene, {BodyKind::kTable, 0},
                                        {BodyKind::kLeg, static_cast<std::uint8_t>(i + 1)}));
  }
}

TEST(LegMachine, TheMachineWithLegsBelowHasRoomInItsWholeWorkspace) {
  const MachineDescription d = legs_below();
  const auto kinematics = make_kinematics(d);
  ASSERT_TRUE(kinematics);
  const Model model = make_collision_model(d);
  std::mt19937 source(3);
  Clearance least{.mm = 1e9};
  for (int n = 0; n < 1000; ++n) {
    const Pose pose = random_pose(source, 100, 200, 45 * kRadPerDeg);
    const auto ok = (*kinematics)->check(Frame::kPart, pose);
    ASSERT_TRUE(ok) << to_string(ok.error());
    const auto c = model->clearance(Frame::kPart, pose);
    ASSERT_TRUE(c);
    if (c->mm < least.mm) least = *c;
  }
  EXPECT_GT(least.mm, 2) << model->words(least);
}

TEST(LegMachine, LegsThatCrossAreNamed) {
  // Attachments 3 and 4 changed over: their legs meet wherever the platform is in the middle.
  MachineDescription d = legs_below();
  auto& legs = std::get<M1Geometry>(d.kinematics).legs;
  std::swap(legs[2].attachment_mm, legs[3].attachment_mm);
  d.bodies.emplace();
  const Model model = make_collision_model(d);
  const auto c = model->clearance(Frame::kPart, {0, 0, 100, 0, 0, 0});
  ASSERT_TRUE(c);
  EXPECT_LE(c->mm, 0);
  const Scene& at_rest = model->at_rest();
  Scene scene = at_rest;
  ASSERT_TRUE(model->place(Frame::kPart, {0, 0, 100, 0, 0, 0}, scene));
  EXPECT_LE(modelled(*model, scene, {BodyKind::kLeg, 3}, {BodyKind::kLeg, 4}), 0);
  EXPECT_EQ(model->words({.mm = -1, .first = {BodyKind::kLeg, 3}, .second = {BodyKind::kLeg, 4}}),
            "leg 3 and leg 4 would touch");
}

TEST(LegMachine, APoseOutOfReachHasNoClearance) {
  const Model model = make_collision_model(legs_below());
  EXPECT_FALSE(model->clearance(Frame::kPart, {2000, 0, 0, 0, 0, 0}));
}

TEST(LegMachine, BothFramesAreOnePlace) {
  const MachineDescription d = legs_below();
  const Model model = make_collision_model(d);
  const Pose part{40, -30, 80, 0.4, 1.1, 0};
  const double y = std::sin(1.1) * 40 + std::cos(1.1) * -30, x = std::cos(1.1) * 40 - std::sin(1.1) * -30;
  const Pose machine{
      x, std::cos(0.4) * y - std::sin(0.4) * 80, std::sin(0.4) * y + std::cos(0.4) * 80, 0.4, 1.1, 0};
  EXPECT_NEAR(model->clearance(Frame::kPart, part)->mm, model->clearance(Frame::kMachine, machine)->mm, 2e-3);
}

TEST(LegMachine, WithAPartOnTheTableHomingKeepsTheHolderAwayAndMotionDoesNot) {
  MachineDescription d = legs_below();
  d.bodies->part_radius_mm = 60;
  d.bodies->part_height_mm = 150;
  const Model model = make_collision_model(d);
  const Pose low{0, 0, 100, 0, 0, 0};
  EXPECT_GT(model->clearance(Frame::kPart, low)->mm, 2);
  const auto homing = model->clearance(Frame::kPart, low, Occasion::kHoming);
  EXPECT_LE(homing->mm, 0);
  EXPECT_EQ(model->name(homing->first), "part on the table");
}

MachineDescription shipped(const std::string& name) {
  auto machine = load_machine(std::filesystem::path(KINEBUS_MACHINES) / name);
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

TEST(LegMachine, ACarriageIsPartedFromAColumnBesideItUnlessItComesTooNear) {
  MachineDescription d = legs_below();
  const auto& foot = std::get<M1Geometry>(d.kinematics).legs[0].foot_mm;
  d.bodies->fixed.push_back(
      {"column", {foot[0] - 20, foot[1] + 55, -200}, {foot[0] + 20, foot[1] + 95, 2000}});
  const auto between = [](const CollisionModel& model) {
    const auto found = std::find_if(model.pairs().begin(), model.pairs().end(), [&](const auto& pair) {
      return model.bodies()[pair.first].id == BodyId{BodyKind::kCarriage, 1} &&
             model.bodies()[pair.second].id.kind == BodyKind::kFixed;
    });
    return *found;
  };
  Model model = make_collision_model(d);
  Scene scene = model->at_rest();
  ASSERT_TRUE(model->place(Frame::kPart, {0, 0, 100, 0, 0, 0}, scene));
  const double mm = model->distance(scene, between(*model));
  ASSERT_GT(mm, 2);
  ASSERT_LT(mm, 30);
  EXPECT_TRUE(model->always_parted(between(*model)));
  d.bodies->clearance_mm = mm + 0.5;
  model = make_collision_model(d);
  EXPECT_FALSE(model->always_parted(between(*model)));
  EXPECT_EQ(Sweep(*model).to(Frame::kPart, {0, 0, 100, 0, 0, 0}), Sweep::Step::kNear);
  // One that stands above its carriage is in the way wherever that comes.
  d.bodies->clearance_mm = 2;
  d.bodies->fixed.back() = {"lamp", {foot[0] - 20, foot[1] - 20, 1500}, {foot[0] + 20, foot[1] + 20, 1600}};
  model = make_collision_model(d);
  EXPECT_FALSE(model->always_parted(between(*model)));
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
