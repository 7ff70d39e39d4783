// CoreXY: two belts that both motors share. a = x + y, b = x - y; then Z and E.

#include <cassert>
#include <cmath>

#include "gateway/kinematics/pose_limits.hpp"

namespace kinebus {
namespace {

class CoreXy final : public Kinematics {
 public:
  explicit CoreXy(const CoreXyGeometry& geometry) : g_(geometry) {}

  std::string name() const override { return "corexy"; }
  int joint_count() const override { return 4; }

  JointInfo joint_info(int joint) const override {
    assert(joint >= 0 && joint < 4);
    const Interval &x = g_.x_mm, &y = g_.y_mm;
    const bool limited = x.limited() && y.limited();
    switch (joint) {
      case 0:
        return {"beltA", false, limited ? x.min + y.min : 0, limited ? x.max + y.max : 0};
      case 1:
        return {"beltB", false, limited ? x.min - y.max : 0, limited ? x.max - y.min : 0};
      case 2:
        return {"Z", false, g_.z_mm.min, g_.z_mm.max};
      default:
        return {"E", false, 0, 0};
    }
  }

  Result<void, PoseError> inverse(Frame, const Pose& pose, JointVector& joints) const override {
    set(joints, pose);
    return {};
  }

  Result<void, PoseError> inverse_along(Frame, const PosePoint& pose, JointPoint& joints) const override {
    set(joints.q, pose.x);
    set(joints.q1, pose.x1);
    set(joints.q2, pose.x2);
    return {};
  }

  Result<void, PoseError> jacobian(Frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override {
    assert(matrix.size() >= std::size_t{4} * kPoseAxes);
    constexpr double kMatrix[4][kPoseAxes] = {
        {1, 1, 0, 0, 0, 0}, {1, -1, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 1}};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < kPoseAxes; ++k) matrix[i * kPoseAxes + k] = kMatrix[i][k];
    set(joints, pose);
    return {};
  }

  Result<void, PoseError> forward(Frame, const JointVector& joints, Pose& pose) const override {
    pose = {0.5 * (joints[0] + joints[1]), 0.5 * (joints[0] - joints[1]), joints[2], 0, 0, joints[3]};
    return {};
  }

  Result<void, PoseError> check(Frame, const Pose& pose) const override {
    if (auto e = check_no_rotation(pose)) return Error<PoseError>(*e);
    if (!std::isfinite(pose[kE])) return Error<PoseError>({PoseError::Kind::kPoseLimit, kE, HUGE_VAL});
    const PoseLimits limits{.x_mm = g_.x_mm, .y_mm = g_.y_mm, .z_mm = g_.z_mm};
    if (auto e = check_pose_limits(limits, {pose[kX], pose[kY], pose[kZ]}, 0, 0)) return Error<PoseError>(*e);
    return {};
  }

  /// Both belts together pull with sqrt(2) along X and Y, Z with 1.
  double condition(Frame, const Pose&) const override { return std::numbers::sqrt2; }

  Pose bed_reference() const override { return {0, 0, g_.bed_reference_mm, 0, 0, 0}; }

 private:
  static void set(JointVector& joints, const Pose& v) {
    joints[0] = v[kX] + v[kY];
    joints[1] = v[kX] - v[kY];
    joints[2] = v[kZ];
    joints[3] = v[kE];
  }

  CoreXyGeometry g_;
};

}  // namespace

Result<std::unique_ptr<Kinematics>, GeometryError> make_corexy_kinematics(const CoreXyGeometry& geometry) {
  for (const Interval& i : {geometry.x_mm, geometry.y_mm, geometry.z_mm})
    if (!(i.min <= i.max)) return Error<GeometryError>({say("a travel's minimum is above its maximum")});
  return std::make_unique<CoreXy>(geometry);
}

}  // namespace kinebus
