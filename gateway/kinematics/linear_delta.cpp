// Linear delta: three vertical towers, arms of one length, an effector that does not turn; then E.
// With the arm's horizontal part h_i = (x, y) - tower_i: q_i = z + sqrt(l^2 - |h_i|^2).

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "gateway/kinematics/pose_limits.hpp"

namespace kinebus {
namespace {

constexpr int kArms = 3, kJointE = 3, kJoints = 4;
constexpr double kRounding = 1e-9;  // of a cosine
using Kind = PoseError::Kind;

class LinearDelta final : public Kinematics {
 public:
  explicit LinearDelta(const LinearDeltaGeometry& geometry)
      : g_(geometry),
        ll_(g_.arm_length_mm * g_.arm_length_mm),
        least_cosine_(std::cos(g_.max_arm_angle_rad) + kRounding) {
    for (std::size_t i = 0; i < kArms; ++i) {
      tx_[i] = g_.radius_mm * std::cos(g_.tower_angle_rad[i]);
      ty_[i] = g_.radius_mm * std::sin(g_.tower_angle_rad[i]);
    }
  }

  std::string name() const override { return "linear_delta"; }
  int joint_count() const override { return kJoints; }

  JointInfo joint_info(int joint) const override {
    assert(joint >= 0 && joint < kJoints);
    if (joint == kJointE) return {"E", false, 0, 0};
    const Interval& travel = g_.travel_mm[static_cast<std::size_t>(joint)];
    return {"tower" + std::to_string(joint + 1), false, travel.min, travel.max};
  }

  Result<void, PoseError> inverse(Frame, const Pose& pose, JointVector& joints) const override {
    double radicand[kArms];
    for (int i = 0; i < kArms; ++i) {
      const double hx = pose[kX] - tx_[i], hy = pose[kY] - ty_[i];
      radicand[i] = ll_ - hx * hx - hy * hy;
      joints[static_cast<std::size_t>(i)] = pose[kZ] + std::sqrt(std::max(radicand[i], 0.0));
    }
    joints[kJointE] = pose[kE];
    return reach(radicand);
  }

  Result<void, PoseError> inverse_along(Frame, const PosePoint& pose, JointPoint& joints) const override {
    double radicand[kArms];
    const double x1 = pose.x1[kX], y1 = pose.x1[kY], x2 = pose.x2[kX], y2 = pose.x2[kY];
    for (int i = 0; i < kArms; ++i) {
      const double hx = pose.x[kX] - tx_[i], hy = pose.x[kY] - ty_[i];
      radicand[i] = ll_ - hx * hx - hy * hy;
      const double root = std::sqrt(std::max(radicand[i], 0.0)), inv = 1 / root;
      // root^2 = l^2 - h.h, so root' = -h.h' / root and root'' = -(h'.h' + h.h'' + root'^2) / root.
      const double r1 = -(hx * x1 + hy * y1) * inv;
      const auto k = static_cast<std::size_t>(i);
      joints.q[k] = pose.x[kZ] + root;
      joints.q1[k] = pose.x1[kZ] + r1;
      joints.q2[k] = pose.x2[kZ] - (x1 * x1 + y1 * y1 + hx * x2 + hy * y2 + r1 * r1) * inv;
    }
    joints.q[kJointE] = pose.x[kE];
    joints.q1[kJointE] = pose.x1[kE];
    joints.q2[kJointE] = pose.x2[kE];
    return reach(radicand);
  }

  Result<void, PoseError> jacobian(Frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override {
    assert(matrix.size() >= std::size_t{kJoints} * kPoseAxes);
    for (double& v : matrix.first(std::size_t{kJoints} * kPoseAxes)) v = 0;
    double radicand[kArms];
    for (int i = 0; i < kArms; ++i) {
      const double hx = pose[kX] - tx_[i], hy = pose[kY] - ty_[i];
      radicand[i] = ll_ - hx * hx - hy * hy;
      const double root = std::sqrt(std::max(radicand[i], 0.0));
      const std::span<double> row = jacobian_row(matrix, static_cast<std::size_t>(i));
      row[kX] = -hx / root;
      row[kY] = -hy / root;
      row[kZ] = 1;
      joints[static_cast<std::size_t>(i)] = pose[kZ] + root;
    }
    jacobian_row(matrix, kJointE)[kE] = 1;
    joints[kJointE] = pose[kE];
    return reach(radicand);
  }

  /// Closed form: the lower of the two points that are an arm's length from all three carriages.
  Result<void, PoseError> forward(Frame, const JointVector& joints, Pose& pose) const override {
    // Differences of the closure equations are linear: x and y = start + z * slope.
    const double q0 = joints[0];
    double a[2][2], constant[2], slope[2];
    for (std::size_t k = 0; k < 2; ++k) {
      const double q = joints[k + 1];
      a[k][0] = 2 * (tx_[k + 1] - tx_[0]);
      a[k][1] = 2 * (ty_[k + 1] - ty_[0]);
      constant[k] = tx_[k + 1] * tx_[k + 1] + ty_[k + 1] * ty_[k + 1] - tx_[0] * tx_[0] - ty_[0] * ty_[0] +
                    (q - q0) * (q - q0);
      slope[k] = -2 * (q - q0);
    }
    // Heights are measured from carriage 0, so that large heights cost no digits.
    const double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    const double x0 = (constant[0] * a[1][1] - constant[1] * a[0][1]) / det - tx_[0];
    const double y0 = (a[0][0] * constant[1] - a[1][0] * constant[0]) / det - ty_[0];
    const double xs = (slope[0] * a[1][1] - slope[1] * a[0][1]) / det;
    const double ys = (a[0][0] * slope[1] - a[1][0] * slope[0]) / det;
    const double qa = xs * xs + ys * ys + 1, qb = x0 * xs + y0 * ys, qc = x0 * x0 + y0 * y0 - ll_;
    const double radicand = qb * qb - qa * qc;
    if (!(radicand >= 0))
      return Error<PoseError>({Kind::kNoConvergence, -1, std::sqrt(std::max(0.0, -radicand) / qa)});
    const double z = (-qb - std::sqrt(radicand)) / qa;
    pose = {x0 + xs * z + tx_[0], y0 + ys * z + ty_[0], q0 + z, 0, 0, joints[kJointE]};
    JointVector again{};
    double worst = 0;
    if (!inverse(Frame::kPart, pose, again)) worst = g_.arm_length_mm;
    for (std::size_t i = 0; i < kArms; ++i) worst = std::max(worst, std::abs(again[i] - joints[i]));
    constexpr double kClosed_mm = 1e-8;
    if (!(worst < kClosed_mm)) return Error<PoseError>({Kind::kNoConvergence, -1, worst});
    return {};
  }

  Result<void, PoseError> check(Frame frame, const Pose& pose) const override {
    if (auto e = check_no_rotation(pose)) return Error<PoseError>(*e);
    if (auto e = check_pose_limits(g_.limits, {pose[kX], pose[kY], pose[kZ]}, 0, 0))
      return Error<PoseError>(*e);
    if (!std::isfinite(pose[kE])) return Error<PoseError>({Kind::kPoseLimit, kE, HUGE_VAL});
    JointVector joints{};
    if (auto r = inverse(frame, pose, joints); !r) return r;
    for (int i = 0; i < kArms; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (auto e = outside_error(Kind::kJointLimit, i, g_.travel_mm[k], joints[k], false))
        return Error<PoseError>(*e);
      const double cosine = (joints[k] - pose[kZ]) / g_.arm_length_mm;
      if (cosine > least_cosine_) continue;
      const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
      if (angle > g_.max_arm_angle_rad)
        return Error<PoseError>({Kind::kLegAngle, i, angle - g_.max_arm_angle_rad, true});
    }
    return {};
  }

  double condition(Frame frame, const Pose& pose) const override {
    JointVector joints{};
    double full[kJoints * kPoseAxes], parallel[9];
    if (!jacobian(frame, pose, joints, full)) return std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) parallel[3 * i + k] = full[i * kPoseAxes + k];
    return condition_number(parallel, 3);
  }

  Pose bed_reference() const override { return {0, 0, g_.bed_reference_mm, 0, 0, 0}; }

 private:
  Result<void, PoseError> reach(const double* radicand) const {
    if (radicand[0] > 0 && radicand[1] > 0 && radicand[2] > 0) [[likely]]
      return {};
    int worst = 0;
    for (int i = 1; i < kArms; ++i)
      if (!(radicand[i] >= radicand[worst])) worst = i;
    return Error<PoseError>({Kind::kOutOfReach, worst, std::sqrt(ll_ - radicand[worst]) - g_.arm_length_mm});
  }

  LinearDeltaGeometry g_;
  double ll_;
  double least_cosine_;  ///< of an arm's angle that is certainly allowed
  double tx_[kArms], ty_[kArms];
};

}  // namespace

Result<std::unique_ptr<Kinematics>, GeometryError> make_linear_delta_kinematics(
    const LinearDeltaGeometry& geometry) {
  if (!(geometry.radius_mm > 0)) return Error<GeometryError>({say("radius_mm must be above 0")});
  if (!(geometry.arm_length_mm > geometry.radius_mm))
    return Error<GeometryError>({say("the arms must be longer than the delta radius")});
  for (const Interval& i : geometry.travel_mm)
    if (!(i.min <= i.max))
      return Error<GeometryError>({say("a tower travel's minimum is above its maximum")});
  for (const Interval& i : {geometry.limits.x_mm, geometry.limits.y_mm, geometry.limits.z_mm})
    if (!(i.min <= i.max)) return Error<GeometryError>({say("a pose limit's minimum is above its maximum")});
  auto delta = std::make_unique<LinearDelta>(geometry);
  // Towers in one plane (two at one angle) leave the effector free: singular at the centre, and so
  // everywhere.
  constexpr double kSingular = 1e6;
  if (!(delta->condition(Frame::kPart, {}) < kSingular))
    return Error<GeometryError>({say("the towers stand so that the delta is singular: two at one angle")});
  return delta;
}

}  // namespace kinebus
