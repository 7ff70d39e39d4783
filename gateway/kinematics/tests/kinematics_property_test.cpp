// What every kinematics must keep, over random poses and random geometries.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {
namespace {

double in(double low, double high) {
  return low + (high - low) * static_cast<double>(*rc::gen::inRange<std::uint64_t>(0, 1ull << 53)) * 0x1p-53;
}

Pose pose_in_cylinder(double radius, double height, double tilt_deg) {
  const double r = radius * std::sqrt(in(0, 1)), f = in(-3.2, 3.2);
  return {r * std::cos(f),
          r * std::sin(f),
          in(0, height),
          in(-tilt_deg, tilt_deg) * kRadPerDeg,
          tilt_deg > 0 ? in(-7, 7) : 0,
          in(-100, 100)};
}

void expect_inverse_of_forward(const Kinematics& kinematics, const Pose& pose, Pose start) {
  for (const Frame frame : {Frame::kPart, Frame::kMachine}) {
    JointVector q{};
    RC_ASSERT(kinematics.inverse(frame, pose, q).has_value());
    Pose found = start;
    RC_ASSERT(kinematics.forward(frame, q, found).has_value());
    for (std::size_t k = 0; k < kPoseAxes; ++k) RC_ASSERT(std::abs(found[k] - pose[k]) < 1e-9);
  }
}

TEST(KinematicsProperty, ForwardOfInverseIsThePoseOnAnyBuiltM1) {
  EXPECT_TRUE(rc::check([] {
    // A real machine: every dimension a little off its drawing, and rails that lean up to 3 deg.
    M1Geometry g;
    g.max_condition = 20;
    for (M1Leg& leg : g.legs) {
      for (std::size_t k = 0; k < 3; ++k) {
        leg.foot_mm[k] += in(-10, 10);
        leg.attachment_mm[k] += in(-5, 5);
      }
      leg.rail = {in(-0.05, 0.05), in(-0.05, 0.05), in(0.5, 2)};
      leg.length_mm += in(-10, 10);
      leg.connector_mm += in(-10, 10);
    }
    const auto kinematics = make_m1_kinematics(g);
    if (!kinematics) RC_FAIL(kinematics.error().what);
    for (int n = 0; n < 5; ++n)
      expect_inverse_of_forward(**kinematics, pose_in_cylinder(100, 200, 45), pose_in_cylinder(100, 200, 45));
  }));
}

TEST(KinematicsProperty, ForwardOfInverseIsThePoseOnTheOthers) {
  EXPECT_TRUE(rc::check([] {
    CartesianGeometry table;
    table.has_table = true;
    table.table.pivot_mm = {in(-50, 50), in(-50, 50), in(-50, 50)};
    expect_inverse_of_forward(**make_cartesian_kinematics(table), pose_in_cylinder(100, 200, 90), {});
    expect_inverse_of_forward(**make_corexy_kinematics({}), pose_in_cylinder(100, 200, 0), {});
    LinearDeltaGeometry delta;
    delta.radius_mm = in(100, 200);
    delta.arm_length_mm = delta.radius_mm * in(1.7, 2.5);
    for (double& angle : delta.tower_angle_rad) angle += in(-0.05, 0.05);
    expect_inverse_of_forward(**make_linear_delta_kinematics(delta),
                              pose_in_cylinder(0.6 * delta.radius_mm, 300, 0), {});
  }));
}

TEST(KinematicsProperty, AnyNumbersAreAnsweredAndNeverAcceptedOutside) {
  EXPECT_TRUE(rc::check([] {
    const auto kinematics = *make_m1_kinematics({});
    Pose pose{};
    for (double& v : pose) v = *rc::gen::arbitrary<double>() * std::pow(10.0, *rc::gen::inRange(-3, 12));
    const auto ok = kinematics->check(Frame::kPart, pose);
    if (!ok) RC_ASSERT(!to_string(ok.error(), *kinematics).empty());
    if (std::hypot(pose[kX], pose[kY]) > 151 || pose[kZ] > 251 || pose[kZ] < -6) RC_ASSERT(!ok.has_value());
    JointVector q{};
    for (double& v : q) v = *rc::gen::arbitrary<double>();
    (void)kinematics->forward(Frame::kPart, q, pose);
  }));
}

}  // namespace
}  // namespace kinebus
