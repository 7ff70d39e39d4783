// M5: M1's mechanism on ball screws, as a mill of four axes: no table C, no extruder.

#include <cassert>
#include <cmath>

#include "gateway/kinematics/pose_limits.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kRails = 4;
using Kind = PoseError::Kind;

class M5 final : public Kinematics {
 public:
  explicit M5(std::unique_ptr<Kinematics> mechanism) : mechanism_(std::move(mechanism)) {}

  std::string name() const override { return "m5"; }
  int joint_count() const override { return kRails; }

  JointInfo joint_info(int joint) const override {
    assert(joint >= 0 && joint < joint_count());
    JointInfo info = mechanism_->joint_info(joint);
    info.name = "rail" + std::to_string(joint + 1);
    return info;
  }

  Result<void, PoseError> inverse(Frame frame, const Pose& pose, JointVector& joints) const override {
    const auto reached = mechanism_->inverse(frame, still(pose), joints);
    joints[4] = joints[5] = 0;
    return reached;
  }

  Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                        JointPoint& joints) const override {
    const auto reached =
        mechanism_->inverse_along(frame, {still(pose.x), still(pose.x1), still(pose.x2)}, joints);
    for (const std::size_t unused : {4u, 5u}) joints.q[unused] = joints.q1[unused] = joints.q2[unused] = 0;
    return reached;
  }

  Result<void, PoseError> jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override {
    assert(matrix.size() >= kRails * kPoseAxes);
    std::array<double, std::size_t{6} * kPoseAxes> full{};
    const auto reached = mechanism_->jacobian(frame, still(pose), joints, full);
    for (std::size_t row = 0; row < kRails; ++row)
      for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
        jacobian_row(matrix, row)[axis] = axis == kC ? 0 : full[row * kPoseAxes + axis];
    joints[4] = joints[5] = 0;
    return reached;
  }

  Result<void, PoseError> forward(Frame frame, const JointVector& joints, Pose& pose) const override {
    JointVector rails = joints;
    rails[4] = rails[5] = 0;
    return mechanism_->forward(frame, rails, pose);
  }

  Result<void, PoseError> check(Frame frame, const Pose& pose) const override {
    if (pose[kC] != 0) return Error<PoseError>({Kind::kPoseLimit, kC, std::abs(pose[kC]), true});
    if (pose[kE] != 0) return Error<PoseError>({Kind::kPoseLimit, kE, std::abs(pose[kE])});
    return mechanism_->check(frame, pose);
  }

  double condition(Frame frame, const Pose& pose) const override {
    return mechanism_->condition(frame, still(pose));
  }

  Pose bed_reference() const override { return mechanism_->bed_reference(); }

 private:
  static Pose still(Pose pose) {
    pose[kC] = pose[kE] = 0;
    return pose;
  }

  std::unique_ptr<Kinematics> mechanism_;
};

}  // namespace

Result<std::unique_ptr<Kinematics>, GeometryError> make_m5_kinematics(const M5Geometry& geometry) {
  auto mechanism = make_m1_kinematics(geometry);
  if (!mechanism) return Error<GeometryError>(mechanism.error());
  return std::make_unique<M5>(std::move(*mechanism));
}

}  // namespace kinebus
