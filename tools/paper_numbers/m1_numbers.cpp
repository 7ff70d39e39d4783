// M1: the mechanism's equations, and how far the shipped machine file keeps the paper's rules.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "tools/paper_numbers/numbers.hpp"
#include "tools/paper_numbers/worst.hpp"
#include "tools/workspace/picture.hpp"

namespace kinebus::papers {
namespace {

using Joints4 = std::array<double, 4>;

double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// u + f v
Vector3 plus(const Vector3& u, const Vector3& v, double f = 1) {
  return {u[0] + f * v[0], u[1] + f * v[1], u[2] + f * v[2]};
}

/// A leg as the paper's equations have it.
struct PaperLeg {
  Vector3 rail{}, attachment{}, leg{};  // d^; R b; L, from the carriage's joint to the platform's
  double length = 0;

  PaperLeg(const M1Leg& m, const Vector3& p, double a_rad, double travel) : length(m.length_mm) {
    const double norm = std::sqrt(dot(m.rail, m.rail)), c = std::cos(a_rad), s = std::sin(a_rad);
    for (std::size_t k = 0; k < 3; ++k) rail[k] = m.rail[k] / norm;
    const Vector3& b = m.attachment_mm;
    attachment = {b[0], c * b[1] - s * b[2], s * b[1] + c * b[2]};
    leg = plus(plus(plus(p, attachment), m.foot_mm, -1), rail, -travel - m.connector_mm);
  }
  /// Eq. 1.
  double closure() const { return std::abs(std::sqrt(dot(leg, leg)) - length); }
  /// Eq. 6-8.
  double speed(const Vector3& p1, double a1) const {
    return (dot(leg, p1) + a1 * cross(attachment, leg)[0]) / dot(rail, leg);
  }
  /// Eq. 9-10, with the leg's angular velocity w = L x L' / l^2.
  double acceleration(const Vector3& p1, const Vector3& p2, double a1, double a2) const {
    const Vector3 x{1, 0, 0}, turning = cross(x, attachment);
    const Vector3 leg1 = plus(plus(p1, turning, a1), rail, -speed(p1, a1));
    Vector3 w = cross(leg, leg1);
    for (double& v : w) v /= length * length;
    const Vector3 inwards = plus(Vector3{attachment[0], 0, 0}, attachment, -1);
    const Vector3 tip = plus(plus(p2, turning, a2), inwards, a1 * a1);
    return (dot(tip, leg) - dot(w, leg) * dot(w, leg) + dot(w, w) * length * length) / dot(rail, leg);
  }
  double angle() const { return std::acos(std::min(1.0, std::abs(dot(rail, leg)) / length)); }
};

/// p and its derivatives for a path in Frame::kMachine: p = n - m.
Vector3 platform(const M1Geometry& g, const Pose& m) {
  return {g.nozzle_mm[0] - m[0], g.nozzle_mm[1] - m[1], g.nozzle_mm[2] - m[2]};
}
Vector3 against(const Pose& derivative) {
  return {-derivative[0], -derivative[1], -derivative[2]};
}

void equations(Table& t, const Kinematics& m1, const M1Geometry& g, const Room& room) {
  std::mt19937_64 engine(1);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  double closure = 0, speed = 0, acceleration = 0, found = 0;
  int paths = 0;
  for (int n = 0; n < 10'000; ++n) {
    const double r = room.radius_mm * std::sqrt(uniform(0, 1)), f = uniform(-3.2, 3.2);
    PosePoint path{.x = {r * std::cos(f), r * std::sin(f), uniform(room.z_mm.min, room.z_mm.max),
                         uniform(room.a_rad.min, room.a_rad.max), 0, 0},
                   .x1 = {},
                   .x2 = {}};
    for (std::size_t k = 0; k < 4; ++k) {
      path.x1[k] = uniform(-1, 1) * (k == kA ? 0.02 : 1);
      path.x2[k] = uniform(-1, 1) * (k == kA ? 0.002 : 0.1);
    }
    JointPoint here;
    if (!m1.check(Frame::kMachine, path.x) || !m1.inverse_along(Frame::kMachine, path, here)) continue;
    ++paths;
    Joints4 q1{}, q2{};
    double largest1 = 0, largest2 = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const PaperLeg leg(g.legs[i], platform(g, path.x), path.x[kA], here.q[i]);
      closure = std::max(closure, leg.closure());
      q1[i] = leg.speed(against(path.x1), path.x1[kA]);
      q2[i] = leg.acceleration(against(path.x1), against(path.x2), path.x1[kA], path.x2[kA]);
      largest1 = std::max(largest1, std::abs(q1[i]));
      largest2 = std::max(largest2, std::abs(q2[i]));
    }
    for (std::size_t i = 0; i < 4; ++i) {
      speed = std::max(speed, std::abs(here.q1[i] - q1[i]) / largest1);
      acceleration = std::max(acceleration, std::abs(here.q2[i] - q2[i]) / largest2);
    }
    Pose pose = m1.bed_reference();
    if (m1.forward(Frame::kMachine, here.q, pose))
      for (std::size_t k = 0; k < 4; ++k) found = std::max(found, std::abs(pose[k] - path.x[k]));
    else
      found = HUGE_VAL;
  }
  t.note("the kinematics against the paper's equations, written down once more for this table, on " +
         std::to_string(paths) + " random paths:");
  t.compare("    eq. 1-5: leg lengths are off by", {}, 0, closure, 1e-9, "mm");
  t.compare("    eq. 6-8: carriage speeds are off by, relative", {}, 0, speed, 1e-9, "");
  t.compare("    eq. 9-10: accelerations are off by, relative", {}, 0, acceleration, 1e-9, "");
  t.ours("    forward kinematics from the bed reference is off by", found, 1e-9, "mm");
}

std::string place(const Pose& p) {
  return printed("        at x %.1f, y %.1f, z %.1f mm, A %.2f deg", p[0], p[1], p[2], p[3] / kRadPerDeg);
}

/// Largest values over the poses that can be reached.
void rules(Table& t, const Kinematics& m1, const M1Geometry& g, const Room& room) {
  const auto over = [&](const auto& value) {
    return worst_over(room, [&](const Pose& pose) {
      JointVector q{};
      return m1.inverse(Frame::kPart, pose, q) ? value(pose) : -HUGE_VAL;
    });
  };
  const auto joints = [&](const Pose& pose) {
    JointVector q{};
    static_cast<void>(m1.inverse(Frame::kPart, pose, q));
    return q;
  };
  t.note(
      printed("largest values that a search finds where the machine is to print (radius %.0f mm, z %.0f .. "
              "%.0f mm, A %.0f .. %.0f deg):",
              room.radius_mm, room.z_mm.min, room.z_mm.max, room.a_rad.min / kRadPerDeg,
              room.a_rad.max / kRadPerDeg));
  const Worst angle = over([&](const Pose& pose) {
    const JointVector q = joints(pose);
    const double c = std::cos(pose[kA]), s = std::sin(pose[kA]);
    const Pose m{pose[0], c * pose[1] - s * pose[2], s * pose[1] + c * pose[2], 0, 0, 0};
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i)
      worst = std::max(worst, PaperLeg(g.legs[i], platform(g, m), pose[kA], q[i]).angle());
    return worst;
  });
  const double angle_deg = angle.value / kRadPerDeg;
  t.rule("    angle between a leg and its rail", "<= 30", angle_deg, angle_deg <= 30 + 1e-6, "deg");
  t.note(place(angle.pose));
  const Worst condition = over([&](const Pose& pose) { return m1.condition(Frame::kPart, pose); });
  t.ours(printed("    condition number, A scaled by %.0f mm", g.rotation_scale_mm), condition.value,
         g.max_condition, "");
  t.note(place(condition.pose));
  const Worst highest = over([&](const Pose& pose) {
    const JointVector q = joints(pose);
    return std::max({q[0], q[1], q[2], q[3]});
  });
  const Worst lowest = over([&](const Pose& pose) {
    const JointVector q = joints(pose);
    return -std::min({q[0], q[1], q[2], q[3]});
  });
  t.ours("    highest carriage", highest.value, "mm");
  t.ours("    lowest carriage", -lowest.value, "mm");
}

}  // namespace

int m1(const std::string& folder) {
  Table t(
      "M1, 5-DOF printer: eq. 1-10 on the shipped machine file, whose geometry is ours: the paper prints "
      "none");
  const MachineDescription machine = shipped("m1");
  const auto& g = std::get<M1Geometry>(machine.kinematics);
  const auto made = make_kinematics(machine);
  if (!made) {
    t.note(made.error().what);
    return 1;
  }
  const Kinematics& m1 = **made;
  const PoseLimits& limits = g.limits;
  const Room room{limits.radius_mm > 0 ? limits.radius_mm : 100, limits.z_mm, limits.a_rad};
  // What the machine is made for; at the rim of all that its rules allow, the largest values are the rules.
  const Room wanted{std::min(100.0, room.radius_mm),
                    {std::max(0.0, room.z_mm.min), std::min(200.0, room.z_mm.max)},
                    room.a_rad};
  equations(t, m1, g, room);
  rules(t, m1, g, wanted);
  // Both attachments of the - side moved to the mirror images of the + side's.
  M1Geometry mirrored = g;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      if (g.legs[i].foot_mm[0] < 0 && g.legs[k].foot_mm[0] > 0 &&
          g.legs[i].foot_mm[1] * g.legs[k].foot_mm[1] > 0) {
        mirrored.legs[i].attachment_mm = g.legs[k].attachment_mm;
        mirrored.legs[i].attachment_mm[0] *= -1;
        mirrored.legs[i].foot_mm = g.legs[k].foot_mm;
        mirrored.legs[i].foot_mm[0] *= -1;
      }
  const auto refused = make_m1_kinematics(mirrored);
  t.note(std::string("not in the paper: legs mirrored about the YZ plane are ") +
         (refused ? "accepted" : "refused: " + refused.error().what));

  if (!folder.empty()) {
    workspace::ScanOptions fine, coarse;
    fine.step_mm = fine.ray_step_mm = 4;
    fine.tilt_step_rad = 3 * kRadPerDeg;
    coarse.step_mm = 4.2;
    coarse.ray_step_mm = 7;
    coarse.tilt_step_rad = fine.tilt_step_rad;
    const workspace::Room scanned{room.radius_mm, room.z_mm.min, room.z_mm.max, room.a_rad.min,
                                  room.a_rad.max};
    const auto scan = workspace::scan(m1, scanned, fine);
    write_picture(
        folder, "m1-workspace.svg",
        workspace::draw_workspace(
            scan, workspace::scan(m1, scanned, coarse),
            {"Workspace of M1",
             "Travel, leg angle and conditioning kept; colour: how many of the tilts are allowed; white: a "
             "cylinder allowed at all of them."}));
  }
  return t.wrong();
}

}  // namespace kinebus::papers
