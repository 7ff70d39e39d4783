// M4: planar 2-RRP + PRP mechanism with the spindle, and a table that slides along X and turns about Z.
//
// With the tip at v from the table's centre (machine axes), the corners are tip + R(-A) r, r fixed in the
// spindle. Rod i from its block at (rail, y_i): y_i = corner.z + sqrt(L1^2 - h^2), h = corner.y - rail. Its
// derivatives are
//   root' = -h h' / root,   root'' = -(h'^2 + h h'' + root'^2) / root.

#include "gateway/kinematics/m4.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "gateway/kinematics/pose_limits.hpp"
#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kRails = 3;
constexpr int kJointX = 3, kJointC = 4, kJoints = 5;
using Kind = PoseError::Kind;

class M4 final : public Kinematics {
 public:
  explicit M4(const M4Geometry& geometry) : g_(geometry) {
    const double half = g_.triangle_mm / 2, c = std::cos(g_.spindle_rad), s = std::sin(g_.spindle_rad);
    const double height = std::numbers::sqrt3 * half, t = g_.tool_mm;
    corner_ = {{{-half * c, t - half * s}, {half * c, t + half * s}, {-height * s, t + height * c}}};
    rail_ = {-g_.rails_mm / 2, g_.rails_mm / 2};
    side_ = determinant(planar_of(Frame::kPart, bed_reference()));
  }

  std::string name() const override { return "m4"; }
  int joint_count() const override { return kJoints; }

  JointInfo joint_info(int joint) const override {
    assert(joint >= 0 && joint < kJoints);
    if (joint == kJointC) return {"C", true, g_.limits.c_rad.min, g_.limits.c_rad.max};
    if (joint == kJointX) return {"X", false, g_.table_travel_mm.min, g_.table_travel_mm.max};
    const Interval& travel = g_.travel_mm[static_cast<std::size_t>(joint)];
    return {"rail" + std::to_string(joint + 1), false, travel.min, travel.max};
  }

  Result<void, PoseError> inverse(Frame frame, const Pose& pose, JointVector& joints) const override {
    JointPoint point;
    const auto reached = inverse_along(frame, {.x = pose, .x1 = {}, .x2 = {}}, point);
    joints = point.q;
    return reached;
  }

  Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                        JointPoint& joints) const override {
    const PointPath v = tip(frame, pose);
    const double phi1 = -pose.x1[kA], phi2 = -pose.x2[kA];
    const Turn turn(-pose.x[kA]);
    std::array<double, 2> radicand{};
    joints = {};
    for (std::size_t i = 0; i < kRails; ++i) {
      const double ry = turn.c * corner_[i][0] - turn.s * corner_[i][1];
      const double rz = turn.s * corner_[i][0] + turn.c * corner_[i][1];
      const double z = g_.table_z_mm + v.x[2] + rz, z1 = v.x1[2] + phi1 * ry;
      const double z2 = v.x2[2] + phi2 * ry - phi1 * phi1 * rz;
      if (i == 2) {
        joints.q[i] = z;
        joints.q1[i] = z1;
        joints.q2[i] = z2;
        break;
      }
      const double h = g_.table_y_mm + v.x[1] + ry - rail_[i], h1 = v.x1[1] - phi1 * rz;
      const double h2 = v.x2[1] - phi2 * rz - phi1 * phi1 * ry;
      radicand[i] = g_.rod_mm * g_.rod_mm - h * h;
      const double root = std::sqrt(std::max(radicand[i], 0.0)), inverse_root = 1 / root;
      const double root1 = -h * h1 * inverse_root;
      joints.q[i] = z + root;
      joints.q1[i] = z1 + root1;
      joints.q2[i] = z2 - (h1 * h1 + h * h2 + root1 * root1) * inverse_root;
    }
    joints.q[kJointX] = v.x[0];
    joints.q1[kJointX] = v.x1[0];
    joints.q2[kJointX] = v.x2[0];
    joints.q[kJointC] = pose.x[kC];
    joints.q1[kJointC] = pose.x1[kC];
    joints.q2[kJointC] = pose.x2[kC];
    return reach(radicand);
  }

  Result<void, PoseError> jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override {
    assert(matrix.size() >= std::size_t{kJoints} * kPoseAxes);
    Result<void, PoseError> reached;
    // Column by column: the path along one pose axis has the column as its q1.
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
      PosePoint along{.x = pose, .x1 = {}, .x2 = {}};
      along.x1[axis] = 1;
      JointPoint column;
      reached = inverse_along(frame, along, column);
      for (std::size_t row = 0; row < kJoints; ++row) jacobian_row(matrix, row)[axis] = column.q1[row];
      joints = column.q;
    }
    return reached;
  }

  Result<void, PoseError> forward(Frame frame, const JointVector& joints, Pose& pose) const override {
    const Vector3 inputs{joints[0], joints[1], joints[2]};
    PlanarPose planar = planar_of(frame, pose);
    double residual = m4_newton(g_, inputs, planar);
    constexpr double kClosed_mm = 1e-9;
    if (!(residual < kClosed_mm) || !ours(inputs, planar)) {
      // Newton ended nowhere or in an assembly that the machine cannot take: look through all of them.
      bool found = false;
      for (const M4Assembly& assembly : m4_assemblies(g_, inputs))
        if (assembly.physical() && ours(inputs, assembly.pose) && !found) {
          planar = assembly.pose;
          found = true;
        }
      if (!found) {
        residual = residual < kClosed_mm ? g_.triangle_mm : residual;
        return Error<PoseError>({Kind::kNoConvergence, -1, residual});
      }
    }
    // P back to the tip, the tip back to the frame asked for.
    const double a_rad = std::remainder(g_.spindle_rad - planar.phi_rad, 2 * std::numbers::pi),
                 s = std::sin(-a_rad), c = std::cos(-a_rad);
    Vector3 v{joints[kJointX], planar.x_mm + g_.tool_mm * s - g_.table_y_mm,
              planar.y_mm - g_.tool_mm * c - g_.table_z_mm};
    v = frame == Frame::kPart ? turn_back_z(Turn(joints[kJointC]), v) : turn_x(Turn(a_rad), v);
    pose = {v[0], v[1], v[2], a_rad, joints[kJointC], 0};
    return {};
  }

  Result<void, PoseError> check(Frame frame, const Pose& pose) const override {
    const PointPath v = tip(frame, {.x = pose, .x1 = {}, .x2 = {}});
    if (auto e = check_pose_limits(g_.limits, turn_back_z(Turn(pose[kC]), v.x), pose[kA], pose[kC]))
      return Error<PoseError>(*e);
    if (pose[kE] != 0) return Error<PoseError>({Kind::kPoseLimit, kE, std::abs(pose[kE])});
    JointVector joints{};
    if (auto r = inverse(frame, pose, joints); !r) return r;
    for (int j = 0; j < kJointC; ++j) {
      const JointInfo info = joint_info(j);
      if (auto e = outside_error(Kind::kJointLimit, j, {info.min, info.max},
                                 joints[static_cast<std::size_t>(j)], false))
        return Error<PoseError>(*e);
    }
    const PlanarPose planar = planar_of(frame, pose);
    for (std::size_t i = 0; i < 2; ++i) {
      const double angle = std::asin(std::clamp(std::abs(across(planar, i)) / g_.rod_mm, 0.0, 1.0));
      if (angle > g_.max_leg_angle_rad)
        return Error<PoseError>({Kind::kLegAngle, static_cast<int>(i), angle - g_.max_leg_angle_rad, true});
    }
    const double cond = condition(frame, pose);
    if (!(cond <= g_.max_condition)) return Error<PoseError>({Kind::kSingular, -1, cond});
    return {};
  }

  /// Of d(y1, y2, y3) / d(Y, Z, phi about P): independent of where the tip is measured from.
  double condition(Frame frame, const Pose& pose) const override {
    double matrix[9];
    if (!planar_jacobian(planar_of(frame, pose), matrix)) return std::numeric_limits<double>::infinity();
    return condition_number(matrix, 3);
  }

  Pose bed_reference() const override { return {0, 0, g_.bed_reference_mm, 0, 0, 0}; }

 private:
  /// d(y1, y2, y3) / d(x, y, phi * rotation_scale) about P, 3 x 3 row-major. false: out of reach.
  bool planar_jacobian(const PlanarPose& p, double* matrix) const {
    const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), half = g_.triangle_mm / 2;
    for (std::size_t i = 0; i < 2; ++i) {
      const double side = i == 0 ? -half : half, h = across(p, i);
      const double radicand = g_.rod_mm * g_.rod_mm - h * h;
      if (!(radicand > 0)) return false;
      const double slope = -h / std::sqrt(radicand);
      matrix[3 * i] = slope;
      matrix[3 * i + 1] = 1;
      matrix[3 * i + 2] = side * (c - slope * s) / g_.rotation_scale_mm;
    }
    matrix[6] = 0;
    matrix[7] = 1;
    matrix[8] = -std::numbers::sqrt3 * half * s / g_.rotation_scale_mm;
    return true;
  }

  /// Its sign tells on which side of the singular curve the mechanism stands. 0: out of reach.
  double determinant(const PlanarPose& p) const {
    double m[9];
    if (!planar_jacobian(p, m)) return 0;
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
  }

  /// The tip from the table's centre, along the machine's axes.
  static PointPath tip(Frame frame, const PosePoint& pose) {
    PointPath v{{pose.x[kX], pose.x[kY], pose.x[kZ]},
                {pose.x1[kX], pose.x1[kY], pose.x1[kZ]},
                {pose.x2[kX], pose.x2[kY], pose.x2[kZ]}};
    if (frame == Frame::kPart)
      turn_path_z(Turn(pose.x[kC]), pose.x1[kC], pose.x2[kC], v);
    else
      turn_path_x(Turn(-pose.x[kA]), -pose.x1[kA], -pose.x2[kA], v);
    return v;
  }

  PlanarPose planar_of(Frame frame, const Pose& pose) const {
    const Vector3 v = tip(frame, {.x = pose, .x1 = {}, .x2 = {}}).x;
    const double s = std::sin(-pose[kA]), c = std::cos(-pose[kA]);
    return {g_.table_y_mm + v[1] - g_.tool_mm * s, g_.table_z_mm + v[2] + g_.tool_mm * c,
            g_.spindle_rad - pose[kA]};
  }

  /// Horizontal part of rod i.
  double across(const PlanarPose& p, std::size_t i) const {
    const double side = i == 0 ? -1 : 1;
    return p.x_mm + side * g_.triangle_mm / 2 * std::cos(p.phi_rad) - rail_[i];
  }

  /// Both blocks above their corners, on the machine's side of the singular curve, and tilted no farther than
  /// it can.
  bool ours(const Vector3& inputs, const PlanarPose& p) const {
    const double rise = g_.triangle_mm / 2 * std::sin(p.phi_rad);
    if (!(inputs[0] > p.y_mm - rise && inputs[1] > p.y_mm + rise)) return false;
    if (!(determinant(p) * side_ > 0)) return false;
    constexpr double kSpare_rad = 0.35;  // hand-moved rails stand a little outside the pose limits
    const Interval& a = g_.limits.a_rad;
    const double tilt = std::remainder(g_.spindle_rad - p.phi_rad, 2 * std::numbers::pi);
    return a.limited() ? tilt >= a.min - kSpare_rad && tilt <= a.max + kSpare_rad
                       : std::abs(tilt) < std::numbers::pi / 2;
  }

  static Result<void, PoseError> reach_error(double rod, std::array<double, 2> radicand) {
    const int worst = radicand[0] > radicand[1] ? 1 : 0;
    const double h = std::sqrt(rod * rod - radicand[static_cast<std::size_t>(worst)]);
    return Error<PoseError>({Kind::kOutOfReach, worst, h - rod});
  }
  Result<void, PoseError> reach(const std::array<double, 2>& radicand) const {
    if (radicand[0] > 0 && radicand[1] > 0) [[likely]]
      return {};
    return reach_error(g_.rod_mm, radicand);
  }

  M4Geometry g_;
  std::array<std::array<double, 2>, kRails> corner_{};  ///< A, B, C from the tip, in the triangle's frame
  std::array<double, 2> rail_{};
  double side_ = 0;  ///< the Jacobian's determinant at the bed reference
};

std::optional<Sentence> wrong_numbers(const M4Geometry& g) {
  for (const double v : {g.rod_mm, g.triangle_mm, g.rails_mm, g.rotation_scale_mm})
    if (!(v > 0) || !std::isfinite(v))
      return say("rods, triangle, rails and rotation_scale_mm must be above 0 mm");
  for (const double v : {g.spindle_rad, g.tool_mm, g.table_y_mm, g.table_z_mm})
    if (!std::isfinite(v)) return say("tool or table position is not a number");
  for (const Interval& i : {g.travel_mm[0], g.travel_mm[1], g.travel_mm[2], g.table_travel_mm, g.limits.x_mm,
                            g.limits.y_mm, g.limits.z_mm, g.limits.a_rad, g.limits.c_rad})
    if (!(i.min <= i.max)) return say("a travel's or limit's minimum is above its maximum");
  if (!(g.max_condition >= 1)) return say("max_condition must be 1 or more");
  return std::nullopt;
}

/// Looks over the workspace for one pose that can be controlled.
std::optional<Sentence> wrong_everywhere(const M4& m4, const M4Geometry& g) {
  const auto sample = [](const Interval& limits, double otherwise, int k) {
    const Interval i = limits.limited() ? limits : Interval{-otherwise, otherwise};
    return i.min + (i.max - i.min) * (0.03 + 0.94 * k / 6);
  };
  const double radius = g.limits.radius_mm > 0 ? g.limits.radius_mm : 100;
  bool reached = false;
  double best = std::numeric_limits<double>::infinity();
  for (int y = 0; y <= 6; ++y)
    for (int z = 0; z <= 6; ++z)
      for (int a = 0; a <= 6; ++a) {
        const Pose pose{
            0, radius * (y - 3.1) / 3.2, sample(g.limits.z_mm, 100, z), sample(g.limits.a_rad, 0.5, a), 0, 0};
        JointVector joints{};
        if (!m4.inverse(Frame::kPart, pose, joints)) continue;
        reached = true;
        best = std::min(best, m4.condition(Frame::kPart, pose));
      }
  if (!reached)
    return say("no pose of the workspace can be reached: the rods are too short for the rails' distance");
  if (best <= g.max_condition) return std::nullopt;
  return say(
      "the mechanism is singular or nearly so at every pose: the best condition number in the workspace is "
      "%1, the limit is %2; rods and triangle leave one motion of the spindle without control",
      printed("%.3g", best), printed("%.3g", g.max_condition));
}

}  // namespace

Result<std::unique_ptr<Kinematics>, GeometryError> make_m4_kinematics(const M4Geometry& geometry) {
  if (auto wrong = wrong_numbers(geometry)) return Error<GeometryError>({*wrong});
  auto m4 = std::make_unique<M4>(geometry);
  if (auto wrong = wrong_everywhere(*m4, geometry)) return Error<GeometryError>({*wrong});
  return m4;
}

}  // namespace kinebus
