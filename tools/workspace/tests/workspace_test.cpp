#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/description/machine_file.hpp"
#include "tools/workspace/bodies_picture.hpp"
#include "tools/workspace/boundary.hpp"
#include "tools/workspace/optimise_text.hpp"
#include "tools/workspace/picture.hpp"

namespace kinebus::workspace {
namespace {

Room small_room() {
  return {150, 0, 250, -45 * kRadPerDeg, 45 * kRadPerDeg};
}
ScanOptions coarse(int threads) {
  ScanOptions o;
  o.step_mm = 10;
  o.ray_step_mm = 15;
  o.tilt_step_rad = 9 * kRadPerDeg;
  o.threads = threads;
  return o;
}

TEST(Scan, ThreadsChangeNothing) {
  const auto m1 = *make_m1_kinematics({});
  const Scan one = scan(*m1, small_room(), coarse(1)), three = scan(*m1, small_room(), coarse(3));
  EXPECT_EQ(one.allowed, three.allowed);
  EXPECT_EQ(one.worst_condition, three.worst_condition);
  EXPECT_EQ(one.refused, three.refused);
}

TEST(Scan, EveryCellIsWhatTheMachineSays) {
  const auto m1 = *make_m1_kinematics({});
  const Scan s = scan(*m1, small_room(), coarse(2));
  for (int plane = 0; plane < s.planes; plane += 5)
    for (int ray = 0; ray < s.rays; ray += 7)
      for (int radius = 0; radius < s.radii; ++radius)
        for (int tilt = 0; tilt < s.tilts; ++tilt) {
          // Near the axis several rays share one place.
          const double a = s.angle_rad(ray - ray % s.stride(radius)), r = s.radius_mm(radius);
          const Pose pose{r * std::cos(a), r * std::sin(a), s.z_mm(plane), s.tilt_rad(tilt), 0, 0};
          EXPECT_EQ(s.is_allowed(s.cell(plane, ray, radius), tilt),
                    m1->check(Frame::kPart, pose).has_value());
        }
}

TEST(Scan, BodiesTakeWhatTheyCannotKeepAndAreNamedWithThePlace) {
  MachineDescription d = legs_below();
  const Room room{100, 0, 200, -45 * kRadPerDeg, 45 * kRadPerDeg};
  const auto kinematics = *make_kinematics(d);
  const auto sparse = [](int threads) {
    ScanOptions o = coarse(threads);
    o.step_mm = 25;
    o.ray_step_mm = 50;
    o.tilt_step_rad = 15 * kRadPerDeg;
    return o;
  };
  const Scan free = scan(*kinematics, room, sparse(2));
  {
    const bodies::Model model = make_collision_model(d);
    const Scan s = scan(*kinematics, room, sparse(2), model.get());
    EXPECT_TRUE(s.meetings.empty()) << model->words(s.meetings.front().worst);
    EXPECT_EQ(s.allowed, free.allowed) << "this machine has room for its bodies";
  }
  // A holder much wider than the nozzle is long meets the tilted table.
  d.bodies->holder_radius_mm = 75;
  const bodies::Model model = make_collision_model(d);
  const Scan s = scan(*kinematics, room, sparse(1), model.get()),
             three = scan(*kinematics, room, sparse(3), model.get());
  EXPECT_EQ(s.allowed, three.allowed);
  ASSERT_FALSE(s.meetings.empty());
  EXPECT_EQ(model->words(s.meetings.front().worst), "table and nozzle holder would touch");
  EXPECT_EQ(s.meetings.front().pose, three.meetings.front().pose);
  EXPECT_EQ(s.meetings.front().poses, three.meetings.front().poses);
  for (int plane = 0; plane < s.planes; ++plane)
    for (int ray = 0; ray < s.rays; ++ray)
      for (int radius = 0; radius < s.radii; ++radius)
        for (int tilt = 0; tilt < s.tilts; ++tilt) {
          const double a = s.angle_rad(ray - ray % s.stride(radius)), r = s.radius_mm(radius);
          const Pose pose{r * std::cos(a), r * std::sin(a), s.z_mm(plane), s.tilt_rad(tilt), 0, 0};
          const std::size_t cell = s.cell(plane, ray, radius);
          EXPECT_EQ(
              s.is_allowed(cell, tilt),
              free.is_allowed(cell, tilt) && model->clearance(Frame::kPart, pose)->mm >= model->wanted_mm());
        }
}

TEST(Scan, AMachineWithoutRulesFillsTheRoom) {
  CartesianGeometry g;
  g.x_mm = g.y_mm = g.z_mm = {-1000, 1000};
  const auto cartesian = *make_cartesian_kinematics(g);
  const Room room{100, 0, 50, 0, 0};
  const Scan s = scan(*cartesian, room, coarse(2));
  const double full = std::numbers::pi * 100 * 100 * 50;
  EXPECT_NEAR(volume_mm3(s, 0), full, 1e-6 * full);
  const Cylinder c = largest_cylinder(s, -1);
  EXPECT_NEAR(c.volume_mm3(), full, 1e-6 * full);
}

TEST(Scan, ACylinderStandsOnTheTableAndIsNoWiderThanIt) {
  CartesianGeometry g;
  g.x_mm = g.y_mm = g.z_mm = {-1000, 1000};
  const auto cartesian = *make_cartesian_kinematics(g);
  // Whatever the planes' distance, neither through the table nor above the room.
  for (const int step_mm : {2, 9, 11}) {
    const Cylinder c = standing_cylinder(scan(*cartesian, {100, -20, 50, 0, 0}, coarse(step_mm)), 60);
    EXPECT_DOUBLE_EQ(c.radius_mm, 60);
    EXPECT_DOUBLE_EQ(c.z_min_mm, 0);
    EXPECT_LE(c.z_max_mm, 50);
    EXPECT_GT(c.z_max_mm, 50 - step_mm);
  }
  Scan s = scan(*cartesian, {100, -20, 50, 0, 0}, coarse(2));
  // Something on the table near its axis: nothing stands there.
  for (int plane = 0; plane < s.planes; ++plane)
    if (s.z_mm(plane) < 10) s.allowed[s.cell(plane, 0, 0)] = 0;
  EXPECT_EQ(standing_cylinder(s, 60).volume_mm3(), 0);
  EXPECT_GT(largest_cylinder(s, -1).z_min_mm, 0);
}

TEST(BodiesPicture, ShowsFourPosesAndNamesTheTwoThatAreNearest) {
  const MachineDescription d = legs_below();
  const bodies::Model model = make_collision_model(d);
  const std::string svg =
      draw_bodies(*model, **make_kinematics(d), {100, 0, 200, -45 * kRadPerDeg, 45 * kRadPerDeg}, "Bodies");
  for (const char* words : {"X 0 Y 0 Z 0 A 0<", "X 0 Y 0 Z 100 A -45<", "X 0 Y 0 Z 100 A 45<",
                            "where two bodies are nearest", " mm: platform, nozzle<"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Scan, TheDefaultMachineHoldsTheCylinderItIsMadeFor) {
  // 200 mm diameter and 200 mm height, level.
  const auto m1 = *make_m1_kinematics({});
  const Room level{100, 0, 200, 0, 0};
  const Cylinder c = largest_cylinder(scan(*m1, level, coarse(2)), 0);
  EXPECT_GE(c.radius_mm, 100);
  EXPECT_GE(c.z_max_mm - c.z_min_mm, 200);
}

TEST(Boundary, IsClosedAndHoldsTheVolume) {
  const auto m1 = *make_m1_kinematics({});
  const Scan s = scan(*m1, small_room(), coarse(2));
  const auto triangles = boundary(s, 2);
  // Divergence theorem; chords instead of arcs cost a little volume.
  double volume = 0;
  for (const Triangle& t : triangles) {
    const auto &a = t.corner[0], &b = t.corner[1], &c = t.corner[2];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6.0;
  }
  EXPECT_NEAR(volume, volume_mm3(s, 2), 0.01 * volume);
  std::ostringstream stl, ply;
  write_stl(stl, triangles);
  write_ply(ply, triangles);
  EXPECT_EQ(stl.str().size(), 84 + 50 * triangles.size());
  EXPECT_EQ(ply.str().rfind("ply\n", 0), 0u);
}

TEST(Picture, IsAnSvgWithAllItsParts) {
  const auto m1 = *make_m1_kinematics({});
  const Scan s = scan(*m1, small_room(), coarse(2));
  const std::string svg = draw_workspace(s, s, {"Workspace", "test"});
  EXPECT_EQ(svg.rfind("<svg", 0), 0u);
  EXPECT_NE(svg.find("Volume at each tilt"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Optimise, WhereNothingKeepsTheRulesThatIsSaid) {
  // No leg stays under a platform that tilts so far.
  const Wish wish{.room = {100, 0, 200, -80 * kRadPerDeg, 80 * kRadPerDeg}};
  const Optimised o = optimise(default_m1(), wish, {.threads = 2, .begins = 2, .tries = 120});
  EXPECT_FALSE(o.found());
  const bodies::Model model = bodies::make_model(*four_legs(o.machine), *o.machine.bodies);
  const std::string text = broken_text(o.after, *model);
  EXPECT_NE(text.find(" at X "), std::string::npos) << text;
}

}  // namespace
}  // namespace kinebus::workspace
