#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "gateway/kinematics/tests/derivatives.hpp"

namespace kinebus {
namespace {

using testing::RandomPose;

std::unique_ptr<Kinematics> m1(const M1Geometry& geometry = {}) {
  auto made = make_m1_kinematics(geometry);
  EXPECT_TRUE(made) << made.error().what;
  return made ? std::move(*made) : nullptr;
}

/// Rails that lean in four directions, attachments off the platform's plane, and one rail that counts
/// downwards: there the carriage below is the one ahead of the platform.
M1Geometry leaning() {
  M1Geometry g;
  g.legs[0].rail = {0.10, 0.05, 1.0};
  g.legs[1].rail = {-0.2, 0.1, 2.0};
  g.legs[2].rail = {0.03, 0.04, 0.7};
  g.legs[3].rail = {0.05, -0.12, -1.0};
  g.legs[3].foot_mm = {-273, 252, 600};
  g.legs[3].carriage_above = true;
  g.legs[0].attachment_mm[2] = 12;
  g.legs[2].attachment_mm[2] = -7;
  for (M1Leg& leg : g.legs) leg.travel_mm = {0, 0};
  // A machine for its equations alone: nobody would build it.
  g.max_condition = 100;
  return g;
}

TEST(M1, LegsCloseBetweenCarriageAndPlatform) {
  // Built from the machine's drawing with rotation matrices; shares no formula with the code under test.
  for (const M1Geometry& g : {M1Geometry{}, leaning()}) {
    const auto kinematics = m1(g);
    RandomPose random(1);
    for (int n = 0; n < 5000; ++n) {
      const Pose pose = random.in_m1_cylinder();
      JointVector q{};
      ASSERT_TRUE(kinematics->inverse(Frame::kPart, pose, q));
      const Eigen::Matrix3d tilt = Eigen::AngleAxisd(pose[kA], Eigen::Vector3d::UnitX()).toRotationMatrix();
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(q[4], Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const Eigen::Vector3d nozzle(g.nozzle_mm.data()), point(pose.data());
      const Eigen::Vector3d platform = nozzle - tilt * turn * point;
      for (std::size_t i = 0; i < 4; ++i) {
        const M1Leg& leg = g.legs[i];
        const Eigen::Vector3d rail = Eigen::Vector3d(leg.rail.data()).normalized();
        const Eigen::Vector3d carriage = Eigen::Vector3d(leg.foot_mm.data()) + q[i] * rail;
        const Eigen::Vector3d attachment = platform + tilt * Eigen::Vector3d(leg.attachment_mm.data());
        const Eigen::Vector3d end = attachment - leg.connector_mm * rail;
        EXPECT_NEAR((end - carriage).norm(), leg.length_mm, 1e-9) << "leg " << i;
        EXPECT_EQ((carriage - end).dot(rail) > 0, leg.carriage_above) << "leg " << i;
      }
      EXPECT_EQ(q[4], pose[kC]);
      EXPECT_EQ(q[5], pose[kE]);
    }
  }
}

TEST(M1, MachineAndPartFrameAgreeThroughTheTablesRotation) {
  const auto kinematics = m1();
  RandomPose random(2);
  for (int n = 0; n < 2000; ++n) {
    const Pose part = random.in_m1_cylinder();
    const Eigen::Vector3d m = Eigen::AngleAxisd(part[kA], Eigen::Vector3d::UnitX()) *
                              Eigen::AngleAxisd(part[kC], Eigen::Vector3d::UnitZ()) *
                              Eigen::Vector3d(part.data());
    const Pose machine{m.x(), m.y(), m.z(), part[kA], part[kC], part[kE]};
    JointVector a{}, b{};
    ASSERT_TRUE(kinematics->inverse(Frame::kPart, part, a));
    ASSERT_TRUE(kinematics->inverse(Frame::kMachine, machine, b));
    for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(a[j], b[j], 1e-9);
    EXPECT_EQ(kinematics->check(Frame::kPart, part).has_value(),
              kinematics->check(Frame::kMachine, machine).has_value());
  }
}

TEST(M1, DerivativesAlongAnyPathMatchDifferencesInBothFrames) {
  for (const M1Geometry& g : {M1Geometry{}, leaning()}) {
    const auto kinematics = m1(g);
    RandomPose random(3);
    for (int n = 0; n < 1500 && !::testing::Test::HasFailure(); ++n) {
      const PosePoint path = random.path_through(random.in_m1_cylinder());
      testing::expect_derivatives(*kinematics, Frame::kPart, path, 0.5, 1e-9, 1e-8);
      testing::expect_derivatives(*kinematics, Frame::kMachine, path, 0.5, 1e-9, 1e-8);
    }
  }
}

TEST(M1, EveryTermOfTheRotationIsThere) {
  // One axis at a time, in pairs, and with angles that are zero but move: the shortcuts for zero must not
  // drop terms.
  const auto kinematics = m1();
  RandomPose random(4);
  for (int mask = 0; mask < 64 && !::testing::Test::HasFailure(); ++mask)
    for (int n = 0; n < 4; ++n) {
      PosePoint path = random.path_through(random.in_m1_cylinder());
      for (std::size_t k = 0; k < kPoseAxes; ++k)
        if ((mask >> k) & 1) path.x1[k] = path.x2[k] = 0;
      if (mask == 0x3F) path.x1[kX] = 1;
      if (n & 1) path.x[kA] = 0;
      if (n & 2) path.x[kC] = 0;
      testing::expect_derivatives(*kinematics, Frame::kPart, path, 0.5, 1e-9, 1e-8);
    }
}

TEST(M1, ForwardFromAnyPoseOfTheWorkspaceFindsThePose) {
  const auto kinematics = m1();
  RandomPose random(5);
  for (int n = 0; n < 5000; ++n) {
    const Pose pose = random.in_m1_cylinder();
    for (const Frame frame : {Frame::kPart, Frame::kMachine}) {
      JointVector q{};
      ASSERT_TRUE(kinematics->inverse(frame, pose, q));
      Pose found = random.in_m1_cylinder();
      const auto result = kinematics->forward(frame, q, found);
      ASSERT_TRUE(result) << to_string(result.error());
      for (std::size_t k = 0; k < kPoseAxes; ++k)
        EXPECT_NEAR(found[k], pose[k], 1e-9) << "sample " << n << " axis " << k;
    }
  }
}

TEST(M1, ForwardOfLeaningRailsFindsThePose) {
  const auto kinematics = m1(leaning());
  RandomPose random(6);
  for (int n = 0; n < 2000; ++n) {
    const Pose pose = random.in_m1_cylinder();
    JointVector q{};
    ASSERT_TRUE(kinematics->inverse(Frame::kPart, pose, q));
    Pose found{};
    ASSERT_TRUE(kinematics->forward(Frame::kPart, q, found));
    for (std::size_t k = 0; k < kPoseAxes; ++k)
      EXPECT_NEAR(found[k], pose[k], 1e-9) << "sample " << n << " axis " << k;
  }
}

TEST(M1, ForwardFindsTheHomePose) {
  const auto kinematics = m1();
  Pose pose{};
  const JointVector home{40, 40, 40, 40, 0, 0};
  ASSERT_TRUE(kinematics->forward(Frame::kMachine, home, pose));
  // The table is level, in the middle, and far below the nozzle.
  EXPECT_NEAR(pose[kX], 0, 0.5);
  EXPECT_NEAR(pose[kY], 0, 1e-9);
  EXPECT_NEAR(pose[kA], 0, 1e-9);
  EXPECT_GT(pose[kZ], 300);
  JointVector again{};
  ASSERT_TRUE(kinematics->inverse(Frame::kMachine, pose, again));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(again[i], home[i], 1e-9);
}

TEST(M1, ForwardSaysWhenNoPlatformFits) {
  const auto kinematics = m1();
  Pose pose{1, 2, 3, 0, 0, 0};
  const Pose before = pose;
  const auto result = kinematics->forward(Frame::kPart, {40, 540, 40, 540, 0, 0}, pose);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, PoseError::Kind::kNoConvergence);
  EXPECT_EQ(pose, before);
}

TEST(M1, TheDefaultCylinderIsWellConditioned) {
  // Numbers of the geometry's search: condition number <= 7.34, leg angle <= 19.8 deg level and <= 27.4 deg
  // at any tilt.
  const auto kinematics = m1();
  RandomPose random(7);
  double worst = 0;
  for (int n = 0; n < 20000; ++n)
    worst = std::max(worst, kinematics->condition(Frame::kPart, random.in_m1_cylinder()));
  EXPECT_LE(worst, 7.34);
  EXPECT_GE(worst, 7.3);

  M1Geometry g;
  g.limits = {};
  for (M1Leg& leg : g.legs) leg.travel_mm = {0, 0};
  g.max_leg_angle_rad = 27.4 * kRadPerDeg;
  const auto tight = m1(g);
  for (int n = 0; n < 20000; ++n) ASSERT_TRUE(tight->check(Frame::kPart, random.in_m1_cylinder()));
  g.max_leg_angle_rad = 19.9 * kRadPerDeg;
  const auto level = m1(g);
  for (int n = 0; n < 20000; ++n) {
    Pose pose = random.in_m1_cylinder();
    pose[kA] = 0;
    ASSERT_TRUE(level->check(Frame::kPart, pose));
  }
}

TEST(M1, CheckRefusesExactlyThePosesOfAWorseConditionNumber) {
  M1Geometry g;
  g.limits = {};
  g.min_platform_clearance_rad = 0;
  g.max_leg_angle_rad = 90 * kRadPerDeg;
  for (M1Leg& leg : g.legs) leg.travel_mm = {0, 0};
  RandomPose random(9);
  for (const double most : {7.1, 7.2, 7.25, 7.33}) {
    g.max_condition = most;
    const auto kinematics = m1(g);
    for (int n = 0; n < 5000; ++n) {
      const Pose pose = random.in_m1_cylinder();
      ASSERT_EQ(kinematics->check(Frame::kPart, pose).has_value(),
                kinematics->condition(Frame::kPart, pose) <= most);
    }
  }
}

TEST(M1, CheckAcceptsTheWorkspaceThatTheDefaultMachineIsFor) {
  const auto kinematics = m1();
  RandomPose random(8);
  for (int n = 0; n < 20000; ++n) {
    Pose pose = random.in_m1_cylinder();
    const auto ok = kinematics->check(Frame::kPart, pose);
    ASSERT_TRUE(ok) << to_string(ok.error());
  }
  ASSERT_TRUE(kinematics->check(Frame::kPart, kinematics->bed_reference()));
}

struct Refused {
  const char* why;
  Pose pose;
  PoseError::Kind kind;
  int joint;
};

TEST(M1, CheckNamesTheRuleThatIsBroken) {
  const auto kinematics = m1();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Refused table[] = {
      {"above the workspace", {0, 0, 260, 0, 0, 0}, PoseError::Kind::kPoseLimit, kZ},
      {"under the bed", {0, 0, -6, 0, 0, 0}, PoseError::Kind::kPoseLimit, kZ},
      {"too far out", {20, 160, 10, 0, 0, 0}, PoseError::Kind::kPoseLimit, kY},
      {"tilted too far", {0, 0, 50, 46 * kRadPerDeg, 0, 0}, PoseError::Kind::kPoseLimit, kA},
      {"not a number", {nan, 0, 50, 0, 0, 0}, PoseError::Kind::kPoseLimit, kX},
      {"not a number in E", {0, 0, 50, 0, 0, nan}, PoseError::Kind::kPoseLimit, kE},
      {"rail's lower end", {0, 145, 245, 25 * kRadPerDeg, 0, 0}, PoseError::Kind::kJointLimit, 1},
      {"leg angle", {0, -145, 245, 44 * kRadPerDeg, 0, 0}, PoseError::Kind::kLegAngle, -1},
  };
  for (const Refused& r : table) {
    const auto result = kinematics->check(Frame::kPart, r.pose);
    ASSERT_FALSE(result) << r.why;
    EXPECT_EQ(result.error().kind, r.kind) << r.why << ": " << to_string(result.error(), *kinematics);
    if (r.joint >= 0) {
      EXPECT_EQ(result.error().joint, r.joint) << r.why;
    }
    EXPECT_GT(std::isnan(result.error().amount) ? 1 : result.error().amount, 0) << r.why;
  }
}

TEST(M1, OutOfReachSaysWhichLegAndByHowMuch) {
  const auto kinematics = m1();
  JointVector q{};
  // Far towards +x: leg 3 (foot -273, -252, attachment -124, -69) is the one most stretched when y is -100.
  const double beside_x = 900 - 124 + 273, beside_y = 100 - 69 + 252;
  const Pose pose{-900, -100, 0, 0, 0, 0};
  const auto result = kinematics->inverse(Frame::kMachine, pose, q);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, PoseError::Kind::kOutOfReach);
  EXPECT_EQ(result.error().joint, 2);
  EXPECT_NEAR(result.error().amount, std::hypot(beside_x, beside_y) - 991, 1e-9);
  EXPECT_EQ(to_string(result.error(), *kinematics), "tower3: out of reach, the leg is 95.504 mm too short");
}

TEST(M1, ClearanceAnglesAreKeptWhenAsked) {
  M1Geometry g;
  // At A = 0 every arm stands nearly square to its rail; tilted by 30 deg the longest arms come nearer.
  g.min_rail_clearance_rad = 80 * kRadPerDeg;
  auto kinematics = m1(g);
  EXPECT_TRUE(kinematics->check(Frame::kPart, {0, 0, 50, 0, 0, 0}));
  const auto rail = kinematics->check(Frame::kPart, {0, 0, 50, 30 * kRadPerDeg, 0, 0});
  ASSERT_FALSE(rail);
  EXPECT_EQ(rail.error().kind, PoseError::Kind::kClearance);

  g.min_rail_clearance_rad = 0;
  g.min_platform_clearance_rad = 50 * kRadPerDeg;
  const auto nearest_leg = [](const M1Geometry& geometry) {
    const auto machine = m1(geometry);
    EXPECT_TRUE(machine->check(Frame::kPart, {0, 0, 50, 0, 0, 0}));
    const auto leg = machine->check(Frame::kPart, {0, 0, 50, 44 * kRadPerDeg, 0, 0});
    EXPECT_FALSE(leg);
    EXPECT_EQ(leg.error().kind, PoseError::Kind::kClearance);
    return leg.error().amount;
  };
  const double below = nearest_leg(g);
  // The carriages' side of the platform is the free one, whichever way the rails count.
  for (M1Leg& leg : g.legs) {
    leg.foot_mm[2] = 600;
    leg.rail = {0, 0, -1};
    leg.connector_mm = -leg.connector_mm;
    leg.carriage_above = true;
  }
  EXPECT_NEAR(nearest_leg(g), below, 1e-9);
}

TEST(M1, MirrorSymmetricAttachmentsAreRefusedAsSingular) {
  M1Geometry g;
  g.legs[2].foot_mm = {-273, -63, 0};
  g.legs[2].attachment_mm = {-124, -128, -5};
  g.legs[3].foot_mm = {-273, 63, 0};
  g.legs[3].attachment_mm = {-124, 128, -5};
  const auto made = make_m1_kinematics(g);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().what.find("singular or nearly so at every pose"), std::string::npos)
      << made.error().what;
}

TEST(M1, LegsThatReachNowhereAreRefused) {
  M1Geometry g;
  for (M1Leg& leg : g.legs) leg.length_mm = 100;
  const auto made = make_m1_kinematics(g);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().what.find("no pose of the workspace can be reached"), std::string::npos);
}

TEST(M1, NumbersThatNoMachineCanHaveAreRefused) {
  const auto refused = [](auto&& change) {
    M1Geometry g;
    change(g);
    return !make_m1_kinematics(g).has_value();
  };
  EXPECT_TRUE(refused([](M1Geometry& g) { g.legs[1].length_mm = 0; }));
  EXPECT_TRUE(refused([](M1Geometry& g) { g.legs[1].rail = {0, 0, 0}; }));
  EXPECT_TRUE(refused([](M1Geometry& g) { g.legs[3].foot_mm[1] = std::nan(""); }));
  EXPECT_TRUE(refused([](M1Geometry& g) { g.legs[0].travel_mm = {10, 5}; }));
  EXPECT_TRUE(refused([](M1Geometry& g) { g.rotation_scale_mm = 0; }));
}

}  // namespace
}  // namespace kinebus
