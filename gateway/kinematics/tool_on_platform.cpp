// A four-leg machine whose tool rides on the platform, in terms of the same mechanism with a fixed tool: each
// pose is one of that machine, along its axes,
//   m' = n' - p = (n' - w) - v + R_X(-A) t,   A' = -A,
// with v = R_Z(C) q = R_X(-A) m, the tip from the table's centre in the machine frame.

#include <cassert>
#include <cmath>

#include "gateway/kinematics/pose_limits.hpp"
#include "gateway/kinematics/table_rotation.hpp"
#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus {
namespace {

Vector3 less(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// The tip from the table's centre, machine frame. `tilt`: of the platform, -A.
Vector3 tip_of(Frame frame, const Pose& pose, const Turn& tilt) {
  const Vector3 at{pose[kX], pose[kY], pose[kZ]};
  if (frame == Frame::kMachine) return turn_x(tilt, at);
  return pose[kC] == 0 ? at : turn_z(Turn(pose[kC]), at);
}

class ToolOnPlatform final : public Kinematics {
 public:
  ToolOnPlatform(const M1Geometry& geometry, std::unique_ptr<Kinematics> fixed_tool)
      : g_(geometry),
        fixed_tool_(std::move(fixed_tool)),
        base_(less(with_tool_in_frame(geometry).nozzle_mm, geometry.table_mm)) {}

  std::string name() const override { return fixed_tool_->name(); }
  int joint_count() const override { return fixed_tool_->joint_count(); }
  JointInfo joint_info(int joint) const override { return fixed_tool_->joint_info(joint); }

  Result<void, PoseError> inverse(Frame frame, const Pose& pose, JointVector& joints) const override {
    return fixed_tool_->inverse(Frame::kMachine, seen_fixed(frame, pose), joints);
  }

  Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                        JointPoint& joints) const override {
    const double a1 = -pose.x1[kA], a2 = -pose.x2[kA];
    const Turn tilt(-pose.x[kA]);
    PointPath v{{pose.x[kX], pose.x[kY], pose.x[kZ]},
                {pose.x1[kX], pose.x1[kY], pose.x1[kZ]},
                {pose.x2[kX], pose.x2[kY], pose.x2[kZ]}};
    if (frame == Frame::kMachine)
      turn_path_x(tilt, a1, a2, v);
    else if (pose.x[kC] != 0 || pose.x1[kC] != 0 || pose.x2[kC] != 0)
      turn_path_z(Turn(pose.x[kC]), pose.x1[kC], pose.x2[kC], v);
    PointPath t{g_.nozzle_mm, {}, {}};
    turn_path_x(tilt, a1, a2, t);
    PosePoint fixed = pose;
    for (std::size_t k = 0; k < 3; ++k) {
      fixed.x[k] = base_[k] - v.x[k] + t.x[k];
      fixed.x1[k] = t.x1[k] - v.x1[k];
      fixed.x2[k] = t.x2[k] - v.x2[k];
    }
    fixed.x[kA] = -pose.x[kA];
    fixed.x1[kA] = a1;
    fixed.x2[kA] = a2;
    return fixed_tool_->inverse_along(Frame::kMachine, fixed, joints);
  }

  Result<void, PoseError> jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override {
    const bool part = frame == Frame::kPart;
    const Turn tilt(-pose[kA]), c(part ? pose[kC] : 0);
    const Vector3 v = tip_of(frame, pose, tilt), t = turn_x(tilt, g_.nozzle_mm);
    const auto reached = fixed_tool_->jacobian(Frame::kMachine, seen_fixed(tilt, v, pose), joints, matrix);
    // Columns of d m' / d pose; A turns t and, along the tool's axes, v about -X.
    const Vector3 x = part ? Vector3{-c.c, -c.s, 0} : Vector3{-1, 0, 0};
    const Vector3 y = part ? Vector3{c.s, -c.c, 0} : Vector3{0, -tilt.c, -tilt.s};
    const Vector3 z = part ? Vector3{0, 0, -1} : Vector3{0, tilt.s, -tilt.c};
    const Vector3 turned = part ? t : less(t, v);
    const Vector3 a{0, turned[2], -turned[1]};
    const Vector3 of_c = part ? Vector3{v[1], -v[0], 0} : Vector3{};
    for (std::size_t joint = 0; joint < static_cast<std::size_t>(joint_count()); ++joint) {
      const std::span<double> row = jacobian_row(matrix, joint);
      const Vector3 g{row[kX], row[kY], row[kZ]};
      const auto along = [&g](const Vector3& d) { return g[0] * d[0] + g[1] * d[1] + g[2] * d[2]; };
      row[kX] = along(x);
      row[kY] = along(y);
      row[kZ] = along(z);
      row[kA] = along(a) - row[kA];
      row[kC] += along(of_c);
    }
    return reached;
  }

  Result<void, PoseError> forward(Frame frame, const JointVector& joints, Pose& pose) const override {
    Pose fixed = seen_fixed(frame, pose);
    if (auto found = fixed_tool_->forward(Frame::kMachine, joints, fixed); !found) return found;
    const Vector3 p{base_[0] + g_.table_mm[0] - fixed[kX], base_[1] + g_.table_mm[1] - fixed[kY],
                    base_[2] + g_.table_mm[2] - fixed[kZ]};
    pose = pose_at(g_, frame, {p, fixed[kA]}, fixed[kC], fixed[kE]);
    return {};
  }

  Result<void, PoseError> check(Frame frame, const Pose& pose) const override {
    const Turn tilt(-pose[kA]);
    const Vector3 v = tip_of(frame, pose, tilt);
    const Vector3 q =
        frame == Frame::kPart ? Vector3{pose[kX], pose[kY], pose[kZ]} : turn_back_z(Turn(pose[kC]), v);
    if (auto e = check_pose_limits(g_.limits, q, pose[kA], pose[kC])) return Error<PoseError>(*e);
    return fixed_tool_->check(Frame::kMachine, seen_fixed(tilt, v, pose));
  }

  double condition(Frame frame, const Pose& pose) const override {
    return fixed_tool_->condition(Frame::kMachine, seen_fixed(frame, pose));
  }

  Pose bed_reference() const override { return fixed_tool_->bed_reference(); }

 private:
  Pose seen_fixed(Frame frame, const Pose& pose) const {
    const Turn tilt(-pose[kA]);
    return seen_fixed(tilt, tip_of(frame, pose, tilt), pose);
  }
  Pose seen_fixed(const Turn& tilt, const Vector3& tip, const Pose& pose) const {
    const Vector3 t = turn_x(tilt, g_.nozzle_mm);
    return {base_[0] - tip[0] + t[0],
            base_[1] - tip[1] + t[1],
            base_[2] - tip[2] + t[2],
            -pose[kA],
            pose[kC],
            pose[kE]};
  }

  M1Geometry g_;
  std::unique_ptr<Kinematics> fixed_tool_;
  Vector3 base_;  ///< n' - w
};

}  // namespace

Vector3 platform_at(const M1Geometry& g, Frame frame, const Pose& pose, const Turn& tilt) {
  if (g.tool == ToolPlacement::kPlatform) {
    const Vector3 v = tip_of(frame, pose, tilt), t = turn_x(tilt, g.nozzle_mm);
    return {g.table_mm[0] + v[0] - t[0], g.table_mm[1] + v[1] - t[1], g.table_mm[2] + v[2] - t[2]};
  }
  Vector3 m{pose[kX], pose[kY], pose[kZ]};
  if (frame == Frame::kPart) {
    if (pose[kC] != 0) m = turn_z(Turn(pose[kC]), m);
    m = turn_x(tilt, m);
  }
  return less(g.nozzle_mm, m);
}

Pose pose_at(const M1Geometry& g, Frame frame, const PlatformPose& platform, double c_rad, double e_mm) {
  const Vector3& p = platform.p_mm;
  const Turn tilt(platform.a_rad);
  if (g.tool == ToolPlacement::kPlatform) {
    const Vector3 t = turn_x(tilt, g.nozzle_mm);
    Vector3 v = less({p[0] + t[0], p[1] + t[1], p[2] + t[2]}, g.table_mm);
    v = frame == Frame::kPart ? turn_back_z(Turn(c_rad), v) : turn_back_x(tilt, v);
    return {v[0], v[1], v[2], -platform.a_rad, c_rad, e_mm};
  }
  Vector3 m = less(g.nozzle_mm, p);
  if (frame == Frame::kPart) m = turn_back_z(Turn(c_rad), turn_back_x(tilt, m));
  return {m[0], m[1], m[2], platform.a_rad, c_rad, e_mm};
}

M1Geometry with_tool_in_frame(const M1Geometry& geometry) {
  if (geometry.tool == ToolPlacement::kFrame) return geometry;
  M1Geometry g = geometry;
  const PoseLimits& limits = geometry.limits;
  // The platform in the middle of the workspace is where the fixed tool is: forward kinematics begins there.
  const double middle = limits.z_mm.limited() ? 0.5 * (limits.z_mm.min + limits.z_mm.max) : 0;
  g.tool = ToolPlacement::kFrame;
  g.nozzle_mm = platform_at(geometry, Frame::kPart, {0, 0, middle, 0, 0, 0}).p_mm;
  g.table_mm = {};
  g.limits = {.a_rad = {-limits.a_rad.max, -limits.a_rad.min}, .c_rad = limits.c_rad};
  return g;
}

std::unique_ptr<Kinematics> make_tool_on_platform(const M1Geometry& geometry,
                                                  std::unique_ptr<Kinematics> fixed_tool) {
  assert(geometry.tool == ToolPlacement::kPlatform);
  return std::make_unique<ToolOnPlatform>(geometry, std::move(fixed_tool));
}

}  // namespace kinebus
