// Bodies of a machine with legs against its kinematics and geometry, by ways that the model does not go.

#include "gateway/bodies/collision_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "gateway/bodies/sweep.hpp"
#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/bodies/tests/model_poses.hpp"

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

}  // namespace
}  // namespace kinebus::bodies
