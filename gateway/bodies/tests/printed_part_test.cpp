#include "gateway/bodies/printed_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus::bodies {
namespace {

/// A nozzle of 4 mm, 40 mm long, under a holder of 25 mm.
BodiesDescription nozzle() {
  return {};
}

Pose over(double x, double y, double z, double a = 0, double c = 0) {
  return {x, y, z, a, c, 0};
}

/// A block, layer by layer, in lines 0.4 mm apart.
void print_block(PrintedPart& part, const Vec& from, const Vec& to) {
  for (double z = from.z + 0.2; z < to.z + 1e-9; z += 0.2)
    for (double y = from.y; y < to.y + 1e-9; y += 0.4)
      for (double x = from.x; x < to.x + 1e-9; x += 0.5) part.add({x, y, z});
}

std::optional<BodyKind> meets(const PrintedPart& part, const Pose& pose) {
  return PrintWatch(nozzle()).meets(part, Frame::kPart, pose);
}

TEST(PrintedPart, NothingIsMetOnAnEmptyTable) {
  PrintedPart part;
  EXPECT_TRUE(part.empty());
  EXPECT_EQ(meets(part, over(0, 0, 0)), std::nullopt);
  part.add({1, 2, 0.3});
  EXPECT_FALSE(part.empty());
  EXPECT_EQ(meets(part, over(1, 2, -20)), BodyKind::kTool);
  part.clear();
  EXPECT_TRUE(part.empty());
  EXPECT_EQ(meets(part, over(1, 2, -20)), std::nullopt);
}

TEST(PrintedPart, WhatHangsInTheAirIsNoPartAndWhatHangsFromThePartIs) {
  PrintedPart part;
  for (double x = -30; x <= 30; x += 0.5) part.add({x, 40, 30});
  EXPECT_TRUE(part.empty());
  print_block(part, {-5, -5, 0}, {5, 5, 30});
  // From its top a bridge of 40 mm, then a strand 3 mm beside its end and one 20 mm below it.
  for (double x = 5; x <= 45; x += 0.8) part.add({x, 0, 30});
  for (double x = 0; x <= 20; x += 0.8) part.add({45 + x, 3, 30});
  for (double x = 20; x <= 45; x += 0.8) part.add({x, 0, 10});
  EXPECT_EQ(meets(part, over(40, 0, 20)), BodyKind::kTool);
  EXPECT_EQ(meets(part, over(60, 3, 20)), BodyKind::kTool);
  EXPECT_EQ(meets(part, over(40, 40, 20)), std::nullopt);
  PrintedPart other;
  print_block(other, {-5, -5, 0}, {5, 5, 30});
  for (double x = 20; x <= 45; x += 0.8) other.add({x, 0, 10});
  EXPECT_EQ(meets(other, over(40, 0, 0)), std::nullopt) << "nothing holds this one";
}

TEST(PrintedPart, ATravelThroughItMeetsTheNozzleAndTheSameTravelBesideAndAboveDoesNot) {
  PrintedPart part;
  print_block(part, {-10, -10, 0}, {10, 10, 20});
  PrintWatch watch(nozzle());
  const auto first_met = [&](double y, double z) {
    watch.jump();
    for (double x = -40; x <= 40; x += 1)
      if (watch.meets(part, Frame::kPart, over(x, y, z)) == BodyKind::kTool) return x;
    return 99.0;
  };
  EXPECT_NEAR(first_met(0, 5), -14, 1.4) << "the nozzle's own radius before the wall";
  EXPECT_EQ(first_met(0, 20), 99) << "over its top layer";
  EXPECT_EQ(first_met(16, 5), 99) << "2 mm beside it";
  EXPECT_NE(first_met(13, 5), 99);
}

TEST(PrintedPart, PrintingItLayerByLayerMeetsNothing) {
  PrintedPart part;
  PrintWatch watch(nozzle());
  for (double z = 0.2; z < 12; z += 0.2)
    for (double angle = 0; angle < 6.3; angle += 0.1) {
      const Pose pose = over(15 * std::cos(angle), 15 * std::sin(angle), z);
      ASSERT_EQ(watch.meets(part, Frame::kPart, pose), std::nullopt) << z << " " << angle;
      part.add(tip_on_table(Frame::kPart, pose));
    }
}

TEST(PrintedPart, LayersAcrossATiltedToolMeetNothingHoweverTheyLie) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-0.8, 0.8), turn(-3.1, 3.1);
  for (int n = 0; n < 20; ++n) {
    const double a = angle(random), c = turn(random);
    PrintedPart part;
    PrintWatch watch(nozzle());
    const Vec foot = tip_on_table(Frame::kMachine, over(0, 0, 30, a, c));
    print_block(part, {foot.x - 1, foot.y - 1, 0}, {foot.x + 1, foot.y + 1, foot.z});
    // Machine frame: the layers are level under the nozzle, the table is not.
    for (double z = 30; z < 36; z += 0.25)
      for (double y = -6; y <= 6; y += 0.5)
        for (double x = -6; x <= 6; x += 1) {
          const Pose pose = over(x, y, z, a, c);
          ASSERT_EQ(watch.meets(part, Frame::kMachine, pose), std::nullopt)
              << "tilt " << a << " turn " << c << " at " << x << " " << y << " " << z;
          part.add(tip_on_table(Frame::kMachine, pose));
        }
  }
}

TEST(PrintedPart, ATiltThatLeansTheHolderAgainstATowerPrintedBeforeMeetsTheHolder) {
  PrintedPart part;
  print_block(part, {-5, 45, 0}, {5, 55, 70});
  // Upright, 45 mm beside the tower: both are free of it.
  EXPECT_EQ(meets(part, over(0, 0, 1)), std::nullopt);
  // Tilted towards it the holder is in the tower, tilted away it is not.
  const double tilt = 0.7;
  const Vector3 axis = turn_back_x(Turn(tilt), {0, 0, 1});
  ASSERT_GT(axis[1], 0) << "A > 0 leans the tool towards +Y of the table";
  EXPECT_EQ(meets(part, over(0, 0, 1, tilt)), BodyKind::kHolder);
  EXPECT_EQ(meets(part, over(0, 0, 1, -tilt)), std::nullopt);
  // The same with the table turned by half a turn.
  EXPECT_EQ(meets(part, over(0, 0, 1, tilt, M_PI)), std::nullopt);
  EXPECT_EQ(meets(part, over(0, 0, 1, -tilt, M_PI)), BodyKind::kHolder);
}

/// Distance of a point from tool (from 2.5 mm above the tip) and holder, from outside.
double distance_from(const Vec& tip, const Vec& axis, const Vec& p) {
  const BodiesDescription b = nozzle();
  const double along = dot(p - tip, axis), across = norm(p - tip - along * axis);
  const double low = 2.5 + b.tool_radius_mm, high = b.tool_length_mm;
  const double tool = std::hypot(std::max({low - along, along - high, 0.0}), across) - b.tool_radius_mm;
  const double holder = std::hypot(std::max({high - along, along - high - b.holder_length_mm, 0.0}),
                                   std::max(across - b.holder_radius_mm, 0.0));
  return std::min(tool, holder);
}

TEST(PrintedPart, WhatIsDeepInTheToolIsFoundAndWhatKeepsItsDistanceIsNotRefused) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-60, 60), height(0, 120), angle(-0.8, 0.8);
  int found = 0, free = 0;
  PrintedPart part;
  for (int n = 0; n < 30000; ++n) {
    part.clear();
    const Vec p{place(random), place(random), 2 * angle(random) - 2};
    part.add(p);
    const Pose pose =
        over(place(random) / 2, place(random) / 2, -height(random), angle(random), 3 * angle(random));
    const Vector3 u = turn_back_z(Turn(pose[kC]), turn_back_x(Turn(pose[kA]), {0, 0, 1}));
    const double mm = distance_from({pose[kX], pose[kY], pose[kZ]}, {u[0], u[1], u[2]}, p);
    const bool met = meets(part, pose).has_value();
    if (mm >= 1.6) {
      EXPECT_FALSE(met) << mm;
      ++free;
    } else if (mm < -0.4) {
      EXPECT_TRUE(met) << mm;
      ++found;
    }
  }
  EXPECT_GT(free, 10000);
  EXPECT_GT(found, 10);
}

TEST(PrintedPart, AWatchOnItsWayFindsWhatAFreshOneFinds) {
  PrintedPart part;
  print_block(part, {20, -30, 0}, {30, 30, 60});
  PrintWatch on_its_way(nozzle());
  std::mt19937 random(5);
  std::normal_distribution<double> step(0, 1);
  Pose pose = over(0, 0, 10);
  int met = 0;
  for (int n = 0; n < 20000; ++n) {
    for (const PoseAxis axis : {kX, kY, kZ}) pose[axis] += 0.4 * step(random);
    pose[kX] = std::clamp(pose[kX], -60.0, 60.0);
    pose[kY] = std::clamp(pose[kY], -60.0, 60.0);
    pose[kZ] = std::clamp(pose[kZ], 0.0, 60.0);
    pose[kA] = std::clamp(pose[kA] + 0.004 * step(random), -0.78, 0.78);
    pose[kC] += 0.004 * step(random);
    const auto fresh = meets(part, pose);
    ASSERT_EQ(on_its_way.meets(part, Frame::kPart, pose), fresh) << "step " << n;
    met += fresh ? 1 : 0;
  }
  EXPECT_GT(met, 100);
  EXPECT_LT(met, 19900);
}

TEST(PrintedPart, WhatLiesBeyondItsGridAndFillsItIsLeftOut) {
  PrintedPart part;
  for (const Vec& beyond :
       {Vec{600, 0, 10}, Vec{0, -600, 10}, Vec{0, 0, 2000}, Vec{0, 0, -40}, Vec{NAN, 0, 0}})
    part.add(beyond);
  EXPECT_TRUE(part.empty());
  for (double x = -500; x < 500; x += 32)
    for (double y = -500; y < 500; y += 32)
      for (double z = 0; z < 300; z += 2) part.add({x, y, z});
  EXPECT_EQ(meets(part, over(-500, -500, -10)), BodyKind::kTool) << "what came first is kept";
}

}  // namespace
}  // namespace kinebus::bodies
