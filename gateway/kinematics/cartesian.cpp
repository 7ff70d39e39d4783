// Cartesian machine: a joint for each axis; with a rotary table the tool follows the turning part.

#include <cassert>
#include <cmath>

#include "gateway/kinematics/pose_limits.hpp"
#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus {
namespace {

class Cartesian final : public Kinematics {
 public:
  explicit Cartesian(const CartesianGeometry& geometry) : g_(geometry) {}

  std::string name() const override { return "cartesian"; }
  int joint_count() const override { return g_.has_table ? 6 : 4; }

  JointInfo joint_info(int joint) const override {
    assert(joint >= 0 && joint < joint_count());
    if (joint == 0) return {"X", false, g_.x_mm.min, g_.x_mm.max};
    if (joint == 1) return {"Y", false, g_.y_mm.min, g_.y_mm.max};
    if (joint == 2) return {"Z", false, g_.z_mm.min, g_.z_mm.max};
    if (joint == joint_e()) return {"E", false, 0, 0};
    if (joint == 3) return {"A", true, g_.table.a_rad.min, g_.table.a_rad.max};
    return {"C", true, g_.table.c_rad.min, g_.table.c_rad.max};
  }

  Result<void, PoseError> inverse(Frame frame, const Pose& pose, JointVector& joints) const override {
    const Vector3 m = machine_point(frame, pose);
    set(joints, {m[0], m[1], m[2], pose[kA], pose[kC], pose[kE]});
    return {};
  }

  Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                        JointPoint& joints) const override {
    PointPath m{{pose.x[kX], pose.x[kY], pose.x[kZ]},
                {pose.x1[kX], pose.x1[kY], pose.x1[kZ]},
                {pose.x2[kX], pose.x2[kY], pose.x2[kZ]}};
    if (turns(frame)) {
      const Vector3& pivot = g_.table.pivot_mm;
      for (std::size_t k = 0; k < 3; ++k) m.x[k] -= pivot[k];
      part_to_machine(pose, Turn(pose.x[kA]), m);
      for (std::size_t k = 0; k < 3; ++k) m.x[k] += pivot[k];
    }
    set(joints.q, {m.x[0], m.x[1], m.x[2], pose.x[kA], pose.x[kC], pose.x[kE]});
    set(joints.q1, {m.x1[0], m.x1[1], m.x1[2], pose.x1[kA], pose.x1[kC], pose.x1[kE]});
    set(joints.q2, {m.x2[0], m.x2[1], m.x2[2], pose.x2[kA], pose.x2[kC], pose.x2[kE]});
    return {};
  }

  Result<void, PoseError> jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override {
    assert(matrix.size() >= static_cast<std::size_t>(joint_count() * kPoseAxes));
    // Column by column: the path along one pose axis has the column as its q1.
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
      PosePoint along{.x = pose, .x1 = {}, .x2 = {}};
      along.x1[axis] = 1;
      JointPoint column;
      (void)inverse_along(frame, along, column);
      for (std::size_t row = 0; row < static_cast<std::size_t>(joint_count()); ++row)
        jacobian_row(matrix, row)[axis] = column.q1[row];
      joints = column.q;
    }
    return {};
  }

  Result<void, PoseError> forward(Frame frame, const JointVector& joints, Pose& pose) const override {
    pose = {joints[0], joints[1], joints[2], 0, 0, joints[static_cast<std::size_t>(joint_e())]};
    if (g_.has_table) {
      pose[kA] = joints[3];
      pose[kC] = joints[4];
    }
    const Vector3 q = frame == Frame::kPart ? table_point(pose) : Vector3{joints[0], joints[1], joints[2]};
    for (std::size_t k = 0; k < 3; ++k) pose[k] = q[k];
    return {};
  }

  Result<void, PoseError> check(Frame frame, const Pose& pose) const override {
    if (!g_.has_table)
      if (auto e = check_no_rotation(pose)) return Error<PoseError>(*e);
    if (!std::isfinite(pose[kE])) return Error<PoseError>({PoseError::Kind::kPoseLimit, kE, HUGE_VAL});
    JointVector joints{};
    (void)inverse(frame, pose, joints);
    for (int j = 0; j < joint_e(); ++j) {
      const JointInfo info = joint_info(j);
      if (auto e = outside_error(PoseError::Kind::kJointLimit, j, {info.min, info.max},
                                 joints[static_cast<std::size_t>(j)], info.rotary))
        return Error<PoseError>(*e);
    }
    return {};
  }

  double condition(Frame, const Pose&) const override { return 1; }

  Pose bed_reference() const override { return {0, 0, g_.bed_reference_mm, 0, 0, 0}; }

 private:
  int joint_e() const { return g_.has_table ? 5 : 3; }
  bool turns(Frame frame) const { return g_.has_table && frame == Frame::kPart; }

  void set(JointVector& joints, const Pose& v) const {
    for (std::size_t k = 0; k < 3; ++k) joints[k] = v[k];
    if (g_.has_table) {
      joints[3] = v[kA];
      joints[4] = v[kC];
    }
    joints[static_cast<std::size_t>(joint_e())] = v[kE];
  }

  Vector3 machine_point(Frame frame, const Pose& pose) const {
    Vector3 m{pose[kX], pose[kY], pose[kZ]};
    if (!turns(frame)) return m;
    const Vector3& pivot = g_.table.pivot_mm;
    for (std::size_t k = 0; k < 3; ++k) m[k] -= pivot[k];
    m = turn_x(Turn(pose[kA]), turn_z(Turn(pose[kC]), m));
    for (std::size_t k = 0; k < 3; ++k) m[k] += pivot[k];
    return m;
  }

  Vector3 table_point(const Pose& machine_pose) const {
    Vector3 q{machine_pose[kX], machine_pose[kY], machine_pose[kZ]};
    if (!g_.has_table) return q;
    const Vector3& pivot = g_.table.pivot_mm;
    for (std::size_t k = 0; k < 3; ++k) q[k] -= pivot[k];
    q = turn_back_z(Turn(machine_pose[kC]), turn_back_x(Turn(machine_pose[kA]), q));
    for (std::size_t k = 0; k < 3; ++k) q[k] += pivot[k];
    return q;
  }

  CartesianGeometry g_;
};

}  // namespace

Result<std::unique_ptr<Kinematics>, GeometryError> make_cartesian_kinematics(
    const CartesianGeometry& geometry) {
  for (const Interval& i :
       {geometry.x_mm, geometry.y_mm, geometry.z_mm, geometry.table.a_rad, geometry.table.c_rad})
    if (!(i.min <= i.max)) return Error<GeometryError>({say("a travel's minimum is above its maximum")});
  for (const double v : geometry.table.pivot_mm)
    if (!std::isfinite(v)) return Error<GeometryError>({say("the table's pivot is not a number")});
  return std::make_unique<Cartesian>(geometry);
}

}  // namespace kinebus
