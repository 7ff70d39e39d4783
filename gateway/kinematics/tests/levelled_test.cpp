// A levelled bed: derivatives against differences, there and back, and nothing at all without a mesh.

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/kinematics/levelled.hpp"
#include "gateway/kinematics/tests/derivatives.hpp"

namespace kinebus {
namespace {

using testing::RandomPose;

double bent(double x, double y) {
  return 0.3 + 0.004 * x - 0.003 * y + 2e-5 * x * x - 1.5e-5 * x * y + 1e-5 * y * y;
}

MeshGrid grid(int columns = 7, int rows = 6, double fade_mm = 10) {
  MeshGrid g{{columns, rows}, {-60, -50}, {60, 50}, fade_mm, {}};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      g.height_mm.push_back(
          static_cast<float>(bent(-60 + 120.0 * column / (columns - 1), -50 + 100.0 * row / (rows - 1))));
  return g;
}

std::unique_ptr<LevelledKinematics> levelled_m1(MeshGrid g) {
  auto m1 = std::make_unique<LevelledKinematics>(*make_m1_kinematics({}));
  m1->set_mesh(std::make_shared<BedMesh>(std::move(g)));
  return m1;
}

TEST(BedMesh, GoesThroughItsPointsAndBetweenThemAsThePlaneDoes) {
  const MeshGrid g = grid();
  const BedMesh mesh(g);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 7; ++column)
      EXPECT_NEAR(mesh.lift(-60 + 20.0 * column, -50 + 20.0 * row, 0).v,
                  static_cast<double>(g.height_mm[static_cast<std::size_t>(7 * row + column)]), 1e-9);
  MeshGrid plane = g;
  for (std::size_t i = 0; i < plane.height_mm.size(); ++i)
    plane.height_mm[i] = 0.5F + 0.25F * static_cast<float>(i % 7) - 0.125F * static_cast<float>(i / 7);
  EXPECT_NEAR(BedMesh(plane).lift(-60 + 1.7 * 20, -50 + 3.2 * 20, 0).v, 0.5 + 0.25 * 1.7 - 0.125 * 3.2, 1e-9);
}

TEST(BedMesh, ValueSlopeAndCurvatureAreContinuousEverywhere) {
  const BedMesh mesh(grid(5, 4));
  // Over lines of the grid, its border, where the border's rest begins, and both ends of the fade.
  constexpr double kStep = 1e-5;
  const auto expect_smooth = [&](double x, double y, double z, double dx, double dy, double dz) {
    const BedMesh::Lift a = mesh.lift(x, y, z), b = mesh.lift(x + dx, y + dy, z + dz);
    EXPECT_NEAR(b.v, a.v + a.x * dx + a.y * dy + a.z * dz, 1e-9) << x << " " << y << " " << z;
    EXPECT_NEAR(b.x, a.x, 1e-7) << x << " " << y;
    EXPECT_NEAR(b.y, a.y, 1e-7) << x << " " << y;
    EXPECT_NEAR(b.xx, a.xx, 1e-7) << x << " " << y;
    EXPECT_NEAR(b.yy, a.yy, 1e-7) << x << " " << y;
    EXPECT_NEAR(b.zz, a.zz, 1e-5) << z;
  };
  for (const double x : {-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0})
    for (const double y : {-83.0 - 1.0 / 3, -50.0, -20.0, 12.0, 50.0, 83.0 + 1.0 / 3})
      expect_smooth(x - kStep / 2, y - kStep / 2, 1, kStep, kStep, 0);
  for (const double z : {0.0, 10.0}) expect_smooth(3, 4, z - kStep / 2, 0, 0, kStep);
  // Far outside the height stays what it is, and above the fade there is none.
  EXPECT_EQ(mesh.lift(500, 0, 0).v, mesh.lift(900, 0, 0).v);
  EXPECT_EQ(mesh.lift(0, 0, 10).v, 0);
}

TEST(Levelled, DerivativesAgreeWithDifferencesInBothFrames) {
  const auto m1 = levelled_m1(grid());
  RandomPose random(7);
  for (const Frame frame : {Frame::kPart, Frame::kMachine})
    for (int n = 0; n < 300 && !::testing::Test::HasFailure(); ++n) {
      PosePoint path = random.path_through(random.in_m1_cylinder());
      path.x[kE] = 0;
      path.x[kZ] = std::fmod(std::abs(path.x[kZ]), 9.0) + 0.2;
      if (frame == Frame::kMachine) path.x[kA] *= 0.2;
      JointPoint exact;
      if (!m1->inverse_along(frame, path, exact)) continue;
      const JointPoint numeric = testing::numeric_along(*m1, frame, path, 0.02);
      double scale1 = 1e-3, scale2 = 1e-3;
      for (std::size_t j = 0; j < 6; ++j) {
        scale1 = std::max(scale1, std::abs(exact.q1[j]));
        scale2 = std::max(scale2, std::abs(exact.q2[j]));
      }
      for (std::size_t j = 0; j < 6; ++j) {
        EXPECT_NEAR(exact.q1[j], numeric.q1[j], 1e-6 * scale1) << n << " joint " << j;
        EXPECT_NEAR(exact.q2[j], numeric.q2[j], 2e-5 * scale2) << n << " joint " << j;
      }
    }
}

TEST(Levelled, ForwardIsTheWayBackWhicheverWayTheTableStands) {
  const auto m1 = levelled_m1(grid());
  for (const Frame frame : {Frame::kPart, Frame::kMachine})
    for (const double a : {0.0, 0.3, -0.5})
      for (const double c : {0.0, 1.1})
        for (const double z : {0.0, 0.2, 3.0, 9.5, 40.0}) {
          const Pose pose{21, -13, z, a, c, 4};
          JointVector joints{};
          ASSERT_TRUE(m1->inverse(frame, pose, joints));
          Pose back{0, 0, 20, a, c, 0};
          ASSERT_TRUE(m1->forward(frame, joints, back));
          for (std::size_t i = 0; i < kPoseAxes; ++i) EXPECT_NEAR(back[i], pose[i], 1e-8);
        }
}

TEST(Levelled, TheMeshTurnsAndTiltsWithTheTable) {
  const auto m1 = levelled_m1(grid(7, 6, 0));
  // At table coordinates (30, 20), 0.5 mm above the bed, whatever the table does: along the table's normal.
  const Pose over = m1->over_even_bed(Frame::kPart, {30, 20, 0.5, 0.4, 0.9, 0});
  EXPECT_NEAR(over[kZ], 0.5 + bent(30, 20), 0.02);
  EXPECT_EQ(over[kX], 30);
  // The same place in the frame that does not turn.
  Pose part{30, 20, 0.5, 0.4, 0.9, 0}, machine{0, 0, 20, 0.4, 0.9, 0};
  JointVector joints{};
  ASSERT_TRUE(m1->inverse(Frame::kPart, part, joints));
  ASSERT_TRUE(m1->forward(Frame::kMachine, joints, machine));
  JointVector again{};
  ASSERT_TRUE(m1->inverse(Frame::kMachine, machine, again));
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(again[j], joints[j], 1e-9);
}

TEST(Levelled, WithoutAMeshNothingChangesByABit) {
  const auto even = *make_m1_kinematics({});
  const LevelledKinematics levelled(*make_m1_kinematics({}));
  RandomPose random(3);
  for (int n = 0; n < 1000; ++n) {
    const PosePoint path = random.path_through(random.in_m1_cylinder());
    JointPoint a, b;
    ASSERT_EQ(even->inverse_along(Frame::kPart, path, a).has_value(),
              levelled.inverse_along(Frame::kPart, path, b).has_value());
    EXPECT_EQ(a.q, b.q);
    EXPECT_EQ(a.q2, b.q2);
  }
}

TEST(Levelled, JointLimitsCountAfterTheMesh) {
  // A hill of 3 mm lifts the tool out of what the machine may do at its greatest height.
  CartesianGeometry geometry;
  geometry.z_mm = {0, 50};
  LevelledKinematics machine(*make_cartesian_kinematics(geometry));
  EXPECT_TRUE(machine.check(Frame::kPart, {0, 0, 48, 0, 0, 0}));
  machine.set_mesh(std::make_shared<BedMesh>(MeshGrid{{2, 2}, {-50, -50}, {50, 50}, 0, {3, 3, 3, 3}}));
  EXPECT_FALSE(machine.check(Frame::kPart, {0, 0, 48, 0, 0, 0}));
  EXPECT_TRUE(machine.check(Frame::kPart, {0, 0, -2, 0, 0, 0}));
}

}  // namespace
}  // namespace kinebus
