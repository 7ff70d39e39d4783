// The tool on the platform, the table in the frame: against closures written down from the geometry alone,
// and against the machine whose table rides.

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "gateway/kinematics/tests/derivatives.hpp"
#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using testing::hanging;
using testing::RandomPose;

std::unique_ptr<Kinematics> made(const M1Geometry& g) {
  auto kinematics = make_m1_kinematics(g);
  EXPECT_TRUE(kinematics) << kinematics.error().what;
  return std::move(*kinematics);
}

Vector3d vector(const Vector3& v) {
  return Vector3d(v[0], v[1], v[2]);
}

TEST(ToolOnPlatform, LegsCloseWithTheTipAtThePartsPointAndTheToolTiltedAgainstThePart) {
  const M1Geometry g = hanging();
  const auto kinematics = made(g);
  RandomPose random(51);
  for (int n = 0; n < 2000; ++n) {
    const Pose pose = random.in_m1_cylinder();
    JointVector q{};
    ASSERT_TRUE(kinematics->inverse(Frame::kPart, pose, q));
    // The table stands, turned by C. A is the part's tilt as the tool sees it: the tool leans the other way.
    const Vector3d tip =
        vector(g.table_mm) + AngleAxisd(pose[kC], Vector3d::UnitZ()) * Vector3d(pose[kX], pose[kY], pose[kZ]);
    const AngleAxisd lean(-pose[kA], Vector3d::UnitX());
    const Vector3d p = tip - lean * vector(g.nozzle_mm);
    for (std::size_t i = 0; i < 4; ++i) {
      const M1Leg& leg = g.legs[i];
      const Vector3d carriage = vector(leg.foot_mm) + (q[i] + leg.connector_mm) * vector(leg.rail);
      const Vector3d rod = carriage - (p + lean * vector(leg.attachment_mm));
      EXPECT_NEAR(rod.norm(), leg.length_mm, 1e-10);
      EXPECT_GT(rod.z(), 0);
    }
    EXPECT_EQ(q[4], pose[kC]);
    EXPECT_EQ(q[5], pose[kE]);
  }
}

TEST(ToolOnPlatform, OneProgramMakesOnePartOnBothMachines) {
  // Along the part's axes the tool stands alike, wherever it rides: by the platforms of both machines.
  const M1Geometry riding = hanging(), standing;
  RandomPose random(52);
  for (int n = 0; n < 500; ++n) {
    const Pose pose = random.in_m1_cylinder();
    for (const Frame frame : {Frame::kPart, Frame::kMachine}) {
      const PlatformPose a = platform_at(standing, frame, pose), b = platform_at(riding, frame, pose);
      const AngleAxisd turn(pose[kC], Vector3d::UnitZ());
      const Eigen::Matrix3d table = AngleAxisd(a.a_rad, Vector3d::UnitX()) * turn.toRotationMatrix(),
                            spindle = AngleAxisd(b.a_rad, Vector3d::UnitX()).toRotationMatrix();
      const Vector3d tip_a = table.transpose() * (vector(standing.nozzle_mm) - vector(a.p_mm)),
                     tip_b = turn.inverse() *
                             (vector(b.p_mm) + spindle * vector(riding.nozzle_mm) - vector(riding.table_mm));
      EXPECT_LT((tip_a - tip_b).norm(), 1e-9);
      const Vector3d axis_a = table.transpose() * Vector3d::UnitZ(),
                     axis_b = turn.inverse() * (spindle * Vector3d::UnitZ());
      EXPECT_LT((axis_a - axis_b).norm(), 1e-12);
    }
  }
}

TEST(ToolOnPlatform, ForwardFindsThePoseFromAnyOther) {
  for (const M1Geometry& g : {hanging(), M1Geometry{}}) {
    const auto kinematics = made(g);
    RandomPose random(53);
    for (int n = 0; n < 3000; ++n) {
      const Pose pose = random.in_m1_cylinder();
      for (const Frame frame : {Frame::kPart, Frame::kMachine}) {
        JointVector q{};
        ASSERT_TRUE(kinematics->inverse(frame, pose, q));
        Pose found = random.in_m1_cylinder();
        ASSERT_TRUE(kinematics->forward(frame, q, found)) << "pose " << n;
        for (std::size_t k = 0; k < kPoseAxes; ++k) EXPECT_NEAR(found[k], pose[k], 1e-9);
        // The platform alone says the same.
        const Pose again = pose_at(g, frame, platform_at(g, frame, pose), pose[kC], pose[kE]);
        for (std::size_t k = 0; k < kPoseAxes; ++k) EXPECT_NEAR(again[k], pose[k], 1e-9);
      }
    }
  }
}

TEST(ToolOnPlatform, DerivativesMatchDifferencesInBothFrames) {
  const auto kinematics = made(hanging());
  RandomPose random(54);
  for (int n = 0; n < 1000 && !::testing::Test::HasFailure(); ++n) {
    PosePoint path = random.path_through(random.in_m1_cylinder());
    if (n % 4 == 0) path.x[kA] = path.x1[kA] = path.x2[kA] = 0;
    if (n % 4 == 1) path.x[kC] = path.x1[kC] = path.x2[kC] = 0;
    for (const Frame frame : {Frame::kPart, Frame::kMachine})
      testing::expect_derivatives(*kinematics, frame, path, 0.5, 1e-9, 1e-8);
  }
}

TEST(ToolOnPlatform, PoseLimitsAreThoseOfThePart) {
  M1Geometry g = hanging();
  g.limits.a_rad = {-10 * kRadPerDeg, 30 * kRadPerDeg};
  g.limits.c_rad = {-1, 2};
  const auto kinematics = made(g);
  using Kind = PoseError::Kind;
  const auto refused = [&](const Pose& pose, Frame frame = Frame::kPart) {
    const auto checked = kinematics->check(frame, pose);
    return checked ? -1 : checked.error().kind == Kind::kPoseLimit ? checked.error().joint : -2;
  };
  EXPECT_EQ(refused({0, 0, 20, 29 * kRadPerDeg, 1.9, 0}), -1);
  EXPECT_EQ(refused({0, 0, 20, -12 * kRadPerDeg, 0, 0}), kA);
  EXPECT_EQ(refused({0, 0, 20, 0, 2.1, 0}), kC);
  EXPECT_EQ(refused({0, 0, -6, 0, 0, 0}), kZ);
  EXPECT_EQ(refused({0, 0, 251, 0, 0, 0}), kZ);
  EXPECT_EQ(refused({0, 151, 20, 0, 0, 0}), kY);
  // Tilted by 25 deg, 7 mm along the table's -Z is the tool's own way down.
  EXPECT_EQ(refused({0, 7 * std::sin(25 * kRadPerDeg), -7 * std::cos(25 * kRadPerDeg), 25 * kRadPerDeg, 0, 0},
                    Frame::kMachine),
            kZ);
  EXPECT_EQ(refused({0, 0, 20, 0, 0, HUGE_VAL}), kE);
}

TEST(ToolOnPlatform, AsAMillItHasNeitherTableNorExtruder) {
  const auto mill = *make_m5_kinematics(M5Geometry{hanging()});
  const auto whole = made(hanging());
  EXPECT_EQ(mill->joint_count(), 4);
  RandomPose random(55);
  for (int n = 0; n < 500; ++n) {
    Pose pose = random.in_m1_cylinder();
    pose[kC] = pose[kE] = 0;
    JointVector q{}, of_mill{};
    ASSERT_TRUE(whole->inverse(Frame::kPart, pose, q));
    ASSERT_TRUE(mill->inverse(Frame::kPart, pose, of_mill));
    EXPECT_EQ(q, of_mill);
    PosePoint path = random.path_through(pose);
    for (const std::size_t axis : {std::size_t{kC}, std::size_t{kE}}) path.x1[axis] = path.x2[axis] = 0;
    testing::expect_derivatives(*mill, Frame::kPart, path, 0.5, 1e-9, 1e-8);
  }
}

TEST(ToolOnPlatform, ATableThatIsNowhereIsRefused) {
  M1Geometry g = hanging();
  g.table_mm[1] = std::nan("");
  ASSERT_FALSE(make_m1_kinematics(g));
  g = hanging();
  g.table_mm[0] = 2000;
  const auto far = make_m1_kinematics(g);
  ASSERT_FALSE(far);
  EXPECT_NE(far.error().what.find("no pose of the workspace can be reached"), std::string::npos);
}

}  // namespace
}  // namespace kinebus
