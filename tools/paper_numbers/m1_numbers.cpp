// M1: the mechanism's equations and the geometry that makes them well conditioned.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "gateway/kinematics/geometry.hpp"
#include "tools/paper_numbers/numbers.hpp"
#include "tools/workspace/optimise.hpp"
#include "tools/workspace/picture.hpp"

namespace kinebus::papers {
namespace {

struct Random {
  std::mt19937_64 engine{1};
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine); }
  Pose pose(double tilt_min_deg, double tilt_max_deg) {
    const double r = 100 * std::sqrt(uniform(0, 1)), f = uniform(-3.2, 3.2);
    return {r * std::cos(f),
            r * std::sin(f),
            uniform(0, 200),
            uniform(tilt_min_deg, tilt_max_deg) * kRadPerDeg,
            0,
            0};
  }
};

/// Leg length error when platform and carriages are put together by the drawing (eq. 1), mm.
double closure(const M1Geometry& g, const Pose& pose, const JointVector& q) {
  double worst = 0;
  const double c = std::cos(pose[kA]), s = std::sin(pose[kA]);
  const Vector3 p{g.nozzle_mm[0] - pose[0], g.nozzle_mm[1] - (c * pose[1] - s * pose[2]),
                  g.nozzle_mm[2] - (s * pose[1] + c * pose[2])};
  for (std::size_t i = 0; i < 4; ++i) {
    const M1Leg& leg = g.legs[i];
    const Vector3& b = leg.attachment_mm;
    const double x = p[0] + b[0] - leg.foot_mm[0];
    const double y = p[1] + c * b[1] - s * b[2] - leg.foot_mm[1];
    const double z = p[2] + s * b[1] + c * b[2] - leg.foot_mm[2] - q[i] - leg.connector_mm;
    worst = std::max(worst, std::abs(std::hypot(x, y, z) - leg.length_mm));
  }
  return worst;
}

}  // namespace

int m1(const std::string& folder) {
  Table t("M1, 5-DOF printer: eq. 1-10, default geometry");
  const M1Geometry g;
  const auto made = make_m1_kinematics(g);
  const Kinematics& m1 = **made;
  Random random;
  double worst_closure = 0, worst_condition = 0, velocity = 0, acceleration = 0, found = 0;
  for (int n = 0; n < 10'000; ++n) {
    PosePoint path{.x = random.pose(-45, 45), .x1 = {}, .x2 = {}};
    for (std::size_t k = 0; k < 4; ++k) {
      path.x1[k] = random.uniform(-1, 1) * (k == kA ? 0.02 : 1);
      path.x2[k] = random.uniform(-1, 1) * (k == kA ? 0.002 : 0.1);
    }
    JointPoint exact;
    if (!m1.inverse_along(Frame::kPart, path, exact)) continue;
    worst_closure = std::max(worst_closure, closure(g, path.x, exact.q));
    worst_condition = std::max(worst_condition, m1.condition(Frame::kPart, path.x));
    // Eighth-order differences of eq. 5 along the path.
    constexpr double kFirst[5] = {0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    constexpr double kSecond[5] = {-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    constexpr double h = 0.7;
    JointVector q1{}, q2{};
    for (int k = -4; k <= 4; ++k) {
      Pose x = path.x;
      for (std::size_t axis = 0; axis < 4; ++axis)
        x[axis] += k * h * (path.x1[axis] + 0.5 * k * h * path.x2[axis]);
      JointVector q{};
      static_cast<void>(m1.inverse(Frame::kPart, x, q));
      const auto at = static_cast<std::size_t>(std::abs(k));
      for (std::size_t j = 0; j < 4; ++j) {
        q1[j] += (k < 0 ? -1 : 1) * kFirst[at] * q[j] / h;
        q2[j] += kSecond[at] * q[j] / (h * h);
      }
    }
    double scale1 = 0, scale2 = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      scale1 = std::max(scale1, std::abs(exact.q1[j]));
      scale2 = std::max(scale2, std::abs(exact.q2[j]));
    }
    for (std::size_t j = 0; j < 4; ++j) {
      velocity = std::max(velocity, std::abs(q1[j] - exact.q1[j]) / scale1);
      acceleration = std::max(acceleration, std::abs(q2[j] - exact.q2[j]) / scale2);
    }
    Pose pose = random.pose(-45, 45);
    if (m1.forward(Frame::kPart, exact.q, pose))
      for (std::size_t k = 0; k < 4; ++k) found = std::max(found, std::abs(pose[k] - path.x[k]));
    else
      found = HUGE_VAL;
  }
  t.below("eq. 1-5: legs close, 10,000 random poses", 1e-9, worst_closure, "mm");
  t.below("eq. 6-8: J against differences, relative", 1e-8, velocity, "");
  t.below("eq. 9-10: acceleration against differences, relative", 1e-8, acceleration, "");
  t.below("forward kinematics from any pose to any other", 1e-9, found, "mm");
  t.below("worst condition number in the cylinder, |A| <= 45 deg", 3.1, worst_condition, "");
  const workspace::Fitness level = workspace::fitness(g, {100, 0, 200, 0, 0});
  const workspace::Fitness tilted = workspace::fitness(g, {100, 0, 200, -45 * kRadPerDeg, 45 * kRadPerDeg});
  t.below("leg angle at A = 0", 44.3, level.worst_leg_angle_rad / kRadPerDeg, "deg");
  t.below("leg angle at 45 deg tilt and full height", 56, tilted.worst_leg_angle_rad / kRadPerDeg, "deg");
  // The extremes lie on the cylinder's two rims.
  const auto carriages = [&](double tilt_from_deg, double tilt_to_deg) {
    Interval used{1e9, -1e9};
    for (int ray = 0; ray < 360; ++ray)
      for (const double z : {0.0, 200.0})
        for (int tilt = 0; tilt <= 30; ++tilt) {
          const double a = tilt_from_deg + (tilt_to_deg - tilt_from_deg) * tilt / 30;
          JointVector q{};
          const Pose pose{
              100 * std::cos(ray * kRadPerDeg), 100 * std::sin(ray * kRadPerDeg), z, a * kRadPerDeg, 0, 0};
          if (!m1.inverse(Frame::kPart, pose, q)) continue;
          for (std::size_t j = 0; j < 4; ++j) used = {std::min(used.min, q[j]), std::max(used.max, q[j])};
        }
    return used;
  };
  const Interval upright = carriages(0, 0), leaning = carriages(-30, 45);  // tilts 2.5 deg apart
  t.compare("carriages at A = 0, lowest", 533, upright.min, 1, "mm");
  t.compare("carriages at A = 0, highest", 919, upright.max, 1, "mm");
  // 539 is stated for the whole range of tilts, which contains A = 0 with its 533: it is the lowest at 30
  // deg.
  t.compare("carriages with A -30 .. 45 deg, lowest at 30 deg", 539, carriages(30, 30).min, 1, "mm");
  t.above("    lowest of all tilts (at 10 deg), above the rail's end", 530, leaning.min, "mm");
  t.compare("carriages with A -30 .. 45 deg, highest", 1007, leaning.max, 1, "mm");
  M1Geometry mirrored;
  mirrored.legs[2].attachment_mm = {-75, -90, 0};
  mirrored.legs[3].attachment_mm = {-75, 90, 0};
  const auto refused = make_m1_kinematics(mirrored);
  t.note(std::string("attachments mirrored about YZ: ") +
         (refused ? "accepted" : "refused, " + refused.error().what));

  if (!folder.empty()) {
    workspace::ScanOptions fine, coarse;
    fine.step_mm = fine.ray_step_mm = 4;
    fine.tilt_step_rad = 3 * kRadPerDeg;
    coarse.step_mm = 4.2;
    coarse.ray_step_mm = 7;
    coarse.tilt_step_rad = fine.tilt_step_rad;
    const workspace::Room room{150, -5, 250, -45 * kRadPerDeg, 45 * kRadPerDeg};
    const auto scan = workspace::scan(m1, room, fine);
    write_picture(
        folder, "m1-workspace.svg",
        workspace::draw_workspace(
            scan, workspace::scan(m1, room, coarse),
            {"Workspace of M1",
             "Travel, leg angle and conditioning kept; colour: how "
             "many of the tilts from -45 to 45 deg are allowed; white: a cylinder allowed at all of them."}));
  }
  return t.wrong() + (refused ? 1 : 0);
}

}  // namespace kinebus::papers
