#include "gateway/kinematics/m4.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/kinematics/tests/derivatives.hpp"

namespace kinebus {
namespace {

using testing::RandomPose;

std::unique_ptr<Kinematics> m4(const M4Geometry& geometry = {}) {
  auto made = make_m4_kinematics(geometry);
  EXPECT_TRUE(made) << made.error().what;
  return made ? std::move(*made) : nullptr;
}

Pose random_pose(RandomPose& random) {
  const double r = 150 * std::sqrt(random.uniform(0, 1)), f = random.uniform(-3, 3);
  return {r * std::cos(f),        r * std::sin(f),
          random.uniform(0, 200), random.uniform(-25, 25) * kRadPerDeg,
          random.uniform(-7, 7),  0};
}

/// The paper's table 6: inputs 932.6, 1029.4, 283.4 mm.
constexpr Vector3 kTable6{932.6, 1029.4, 283.4};

TEST(M4, Table6HasTwoTruePosesAndTheMirroredOnesAreLabelled) {
  struct Row {
    double phi_deg, y_mm, x_mm;
    bool mirrored;
  };
  // Degrees as they are modulo a full turn; the mirrored triangle's are printed as measured on the other
  // side.
  const Row rows[] = {{36.48, 162.94, -7.08, false}, {-69.92, 231.96, 248.80, false}};
  const auto found = m4_assemblies({}, kTable6);
  int physical = 0;
  for (const M4Assembly& a : found) {
    EXPECT_LT(a.residual_mm, 1e-9);
    physical += a.physical() ? 1 : 0;
  }
  EXPECT_EQ(physical, 2);
  for (const Row& row : rows) {
    bool seen = false;
    for (const M4Assembly& a : found)
      seen =
          seen || (a.mirrored == row.mirrored && std::abs(a.pose.phi_rad / kRadPerDeg - row.phi_deg) < 0.01 &&
                   std::abs(a.pose.x_mm - row.x_mm) < 0.01 && std::abs(a.pose.y_mm - row.y_mm) < 0.01);
    EXPECT_TRUE(seen) << row.phi_deg;
  }
  // The printed rows (115.27, 219.5, -49.7) and (77.46 + 180, 250.9, 221) close with the mirrored triangle
  // only.
  const Row mirrored[] = {{115.27, 219.5, -49.7, true}, {77.46 - 180, 250.9, 221, true}};
  for (const Row& row : mirrored) {
    bool seen = false;
    for (const M4Assembly& a : found)
      seen = seen || (a.mirrored && std::abs(a.pose.phi_rad / kRadPerDeg - row.phi_deg) < 0.05 &&
                      std::abs(a.pose.x_mm - row.x_mm) < 0.1 && std::abs(a.pose.y_mm - row.y_mm) < 0.1);
    EXPECT_TRUE(seen) << row.phi_deg;
  }
}

TEST(M4, EveryAssemblyClosesByAnIndependentSubstitution) {
  RandomPose random(21);
  int listed = 0;
  for (int n = 0; n < 500; ++n) {
    const Vector3 inputs{random.uniform(700, 1200), random.uniform(700, 1200), random.uniform(0, 400)};
    const M4Geometry g;
    for (const M4Assembly& a : m4_assemblies(g, inputs)) {
      ++listed;
      const double side = a.mirrored ? -1 : 1, h = std::sqrt(3.0) / 2 * g.triangle_mm * side;
      const double c = std::cos(a.pose.phi_rad), s = std::sin(a.pose.phi_rad), l = g.triangle_mm / 2;
      const double ax = a.pose.x_mm - l * c, ay = a.pose.y_mm - l * s;
      const double bx = a.pose.x_mm + l * c, by = a.pose.y_mm + l * s;
      EXPECT_NEAR(std::hypot(ax + g.rails_mm / 2, ay - inputs[0]), g.rod_mm, 1e-8);
      EXPECT_NEAR(std::hypot(bx - g.rails_mm / 2, by - inputs[1]), g.rod_mm, 1e-8);
      EXPECT_NEAR(a.pose.y_mm + h * c, inputs[2], 1e-8);
      EXPECT_EQ(a.block_above[0], inputs[0] > ay);
    }
  }
  EXPECT_GT(listed, 500);
}

TEST(M4, Table4PathClosesTo1e9Metres) {
  // The paper's path, in metres: x = 0.2 cos t, y = 0.1 + 0.2 sin t, phi = -0.3 + 0.2 t.
  const M4Geometry g;
  for (int k = 0; k <= 3000; ++k) {
    const double t = 1e-3 * k;
    const PlanarPose p{200 * std::cos(t), 100 + 200 * std::sin(t), -0.3 + 0.2 * t};
    const auto inputs = m4_inputs(g, p);
    ASSERT_TRUE(inputs);
    const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), l = g.triangle_mm / 2;
    EXPECT_NEAR(std::hypot(p.x_mm - l * c + g.rails_mm / 2, p.y_mm - l * s - (*inputs)[0]), g.rod_mm, 1e-6);
    EXPECT_NEAR(std::hypot(p.x_mm + l * c - g.rails_mm / 2, p.y_mm + l * s - (*inputs)[1]), g.rod_mm, 1e-6);
    EXPECT_NEAR(p.y_mm + std::sqrt(3.0) / 2 * g.triangle_mm * c, (*inputs)[2], 1e-6);
    // Both ways back find it.
    if (k % 50 != 0) continue;
    // The path crosses the singular curve between t = 1.57 and 1.62 s; Newton begins near, and away from
    // there.
    PlanarPose newton{p.x_mm + 1, p.y_mm - 1, p.phi_rad + 0.003};
    if (t < 1.3 || t > 1.8) {
      EXPECT_LT(m4_newton(g, *inputs, newton), 1e-9);
      EXPECT_NEAR(newton.x_mm, p.x_mm, 1e-6) << "t = " << t;
    }
    bool listed = false;
    for (const M4Assembly& a : m4_assemblies(g, *inputs))
      listed =
          listed || (a.physical() && std::abs(a.pose.x_mm - p.x_mm) < 1e-6 &&
                     std::abs(a.pose.y_mm - p.y_mm) < 1e-6 && std::abs(a.pose.phi_rad - p.phi_rad) < 1e-9);
    EXPECT_TRUE(listed) << "t = " << t;
  }
}

TEST(M4, ForwardOfInverseOverTheWorkspaceFromAnyStart) {
  const auto kinematics = m4();
  RandomPose random(22);
  for (int n = 0; n < 5000; ++n) {
    const Pose pose = random_pose(random);
    for (const Frame frame : {Frame::kPart, Frame::kMachine}) {
      JointVector q{};
      ASSERT_TRUE(kinematics->inverse(frame, pose, q));
      Pose found = random_pose(random);
      ASSERT_TRUE(kinematics->forward(frame, q, found)) << "sample " << n;
      for (std::size_t k = 0; k < kPoseAxes; ++k) EXPECT_NEAR(found[k], pose[k], 1e-9) << "sample " << n;
    }
  }
}

TEST(M4, DerivativesMatchDifferences) {
  const auto kinematics = m4();
  RandomPose random(23);
  for (int n = 0; n < 2000 && !::testing::Test::HasFailure(); ++n) {
    PosePoint path = random.path_through(random_pose(random));
    path.x1[kE] = path.x2[kE] = 0;
    testing::expect_derivatives(*kinematics, Frame::kPart, path, 0.5, 1e-9, 1e-8);
    testing::expect_derivatives(*kinematics, Frame::kMachine, path, 0.5, 1e-9, 1e-8);
  }
}

TEST(M4, TheTurningTableBringsThePartToTheTool) {
  // The tool stands over the same point of the part, seen along the same direction, as on M1 at this A and C.
  const auto kinematics = m4();
  const double c = 0.7, a = 0.3;
  JointVector q{};
  const Pose pose{30, 40, 50, a, c, 0};
  ASSERT_TRUE(kinematics->inverse(Frame::kPart, pose, q));
  EXPECT_NEAR(q[3], 30 * std::cos(c) - 40 * std::sin(c), 1e-12);
  EXPECT_EQ(q[4], c);
  // G49 sees the same place as R_X(A) R_Z(C) q.
  const double y = 30 * std::sin(c) + 40 * std::cos(c);
  const Pose machine{q[3], std::cos(a) * y - std::sin(a) * 50, std::sin(a) * y + std::cos(a) * 50, a, c, 0};
  JointVector again{};
  ASSERT_TRUE(kinematics->inverse(Frame::kMachine, machine, again));
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(again[j], q[j], 1e-10);
}

TEST(M4, CheckNamesTheRuleThatIsBroken) {
  const auto kinematics = m4();
  EXPECT_TRUE(kinematics->check(Frame::kPart, kinematics->bed_reference()));
  RandomPose random(24);
  for (int n = 0; n < 3000; ++n) {
    const auto ok = kinematics->check(Frame::kPart, random_pose(random));
    ASSERT_TRUE(ok) << to_string(ok.error(), *kinematics);
  }
  EXPECT_EQ(kinematics->check(Frame::kPart, {0, 0, 50, 0, 0, 1}).error().joint, kE);
  EXPECT_EQ(kinematics->check(Frame::kPart, {0, 0, 50, 0.6, 0, 0}).error().joint, kA);
  EXPECT_EQ(kinematics->check(Frame::kPart, {0, 0, 250, 0, 0, 0}).error().joint, kZ);
  JointVector q{};
  EXPECT_EQ(kinematics->inverse(Frame::kPart, {0, 900, 50, 0, 0, 0}, q).error().kind,
            PoseError::Kind::kOutOfReach);
}

TEST(M4, AGeometryThatIsSingularEverywhereIsRefused) {
  M4Geometry g;
  g.triangle_mm = 0.01;  // a point: nothing controls its rotation
  const auto made = make_m4_kinematics(g);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().what.find("singular or nearly so at every pose"), std::string::npos);
  g = {};
  g.rod_mm = 200;
  ASSERT_FALSE(make_m4_kinematics(g));
}

}  // namespace
}  // namespace kinebus
