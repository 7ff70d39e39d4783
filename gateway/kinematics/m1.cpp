// M1: four legs of fixed length from carriages on rails to a platform (x, y, z, A) that carries the rotary
// table C.
//
// Everything follows from one closure equation for each leg. With s = p + R_X(A) b - a (platform joint seen
// from the rail's foot), travel q and L = s - (q + c) d^, the leg's length says L . L = l^2. Its derivatives
// are
//   L . (s' - q' d^) = 0            =>  q'  = L . s' / (L . d^)
//   L . (s'' - q'' d^) + |L'|^2 = 0  =>  q'' = (L . s'' + |L'|^2) / (L . d^),  L' = s' - q' d^
// which is paper M1's eq. 6-10 with |w x L|^2 = |L'|^2 written without the leg's angular velocity.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "gateway/kinematics/m1_forward.hpp"
#include "gateway/kinematics/m1_geometry.hpp"
#include "gateway/kinematics/pose_limits.hpp"
#include "gateway/kinematics/table_rotation.hpp"
#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus {
namespace {

constexpr int kLegs = 4;
constexpr int kJointC = 4, kJointE = 5, kJoints = 6;
using Kind = PoseError::Kind;

class M1 final : public Kinematics {
 public:
  explicit M1(const M1Geometry& geometry)
      : g_(geometry),
        legs_(geometry),
        least_cosine_(std::cos(std::min(geometry.max_leg_angle_rad, std::numbers::pi / 2))),
        least_rise_(std::sin(std::min(geometry.min_platform_clearance_rad, std::numbers::pi / 2))) {}

  std::string name() const override { return "m1"; }
  int joint_count() const override { return kJoints; }

  JointInfo joint_info(int joint) const override {
    assert(joint >= 0 && joint < kJoints);
    if (joint == kJointC) return {"C", true, g_.limits.c_rad.min, g_.limits.c_rad.max};
    if (joint == kJointE) return {"E", false, 0, 0};
    const Interval& travel = g_.legs[static_cast<std::size_t>(joint)].travel_mm;
    return {"tower" + std::to_string(joint + 1), false, travel.min, travel.max};
  }

  Result<void, PoseError> inverse(Frame frame, const Pose& pose, JointVector& joints) const override {
    const Turn a(pose[kA]);
    const Vector3 p = platform(frame, pose, a);
    double radicand[kLegs];
    carriages(p, a, joints.data(), radicand);
    joints[kJointC] = pose[kC];
    joints[kJointE] = pose[kE];
    return reach(radicand);
  }

  Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                        JointPoint& joints) const override {
    const Turn a(pose.x[kA]);
    PointPath m{{pose.x[kX], pose.x[kY], pose.x[kZ]},
                {pose.x1[kX], pose.x1[kY], pose.x1[kZ]},
                {pose.x2[kX], pose.x2[kY], pose.x2[kZ]}};
    if (frame == Frame::kPart) part_to_machine(pose, a, m);
    const Vector3& n = g_.nozzle_mm;
    const double px = n[0] - m.x[0], py = n[1] - m.x[1], pz = n[2] - m.x[2];
    const double a1 = pose.x1[kA], a2 = pose.x2[kA], a11 = a1 * a1;
    const LegTable& t = legs_;
    // Own arrays: stores into `joints` could alias the inputs and keep the legs from going side by side.
    double radicand[kLegs], q[kLegs], q1[kLegs], q2[kLegs];
    for (int i = 0; i < kLegs; ++i) {
      const double by = a.c * t.by[i] - a.s * t.bz[i], bz = a.s * t.by[i] + a.c * t.bz[i];
      const double sx = px + t.bx_ax[i], sy = py + by - t.ay[i], sz = pz + bz - t.az[i];
      const double u = t.dx[i] * sx + t.dy[i] * sy + t.dz[i] * sz;
      const double r = t.ll[i] - (sx * sx + sy * sy + sz * sz) + u * u;
      radicand[i] = r;
      const double along = t.branch[i] * std::sqrt(std::max(r, 0.0));  // -L . d^
      const double w = u + along;                                      // q + c
      const double lx = sx - w * t.dx[i], ly = sy - w * t.dy[i], lz = sz - w * t.dz[i];
      const double s1x = -m.x1[0], s1y = -m.x1[1] - a1 * bz, s1z = -m.x1[2] + a1 * by;
      const double s2x = -m.x2[0], s2y = -m.x2[1] - a2 * bz - a11 * by, s2z = -m.x2[2] + a2 * by - a11 * bz;
      const double inv = -1 / along;
      const double v = (lx * s1x + ly * s1y + lz * s1z) * inv;
      const double l1x = s1x - v * t.dx[i], l1y = s1y - v * t.dy[i], l1z = s1z - v * t.dz[i];
      q[i] = w - t.c[i];
      q1[i] = v;
      q2[i] = (lx * s2x + ly * s2y + lz * s2z + (l1x * l1x + l1y * l1y + l1z * l1z)) * inv;
    }
    for (std::size_t i = 0; i < kLegs; ++i) {
      joints.q[i] = q[i];
      joints.q1[i] = q1[i];
      joints.q2[i] = q2[i];
    }
    joints.q[kJointC] = pose.x[kC];
    joints.q1[kJointC] = pose.x1[kC];
    joints.q2[kJointC] = pose.x2[kC];
    joints.q[kJointE] = pose.x[kE];
    joints.q1[kJointE] = pose.x1[kE];
    joints.q2[kJointE] = pose.x2[kE];
    return reach(radicand);
  }

  Result<void, PoseError> jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override {
    assert(matrix.size() >= std::size_t{kJoints} * kPoseAxes);
    const Turn a(pose[kA]), c(frame == Frame::kPart ? pose[kC] : 0);
    const Vector3 p = platform(frame, pose, a);
    const bool part = frame == Frame::kPart;
    const double mx = g_.nozzle_mm[0] - p[0], my = g_.nozzle_mm[1] - p[1], mz = g_.nozzle_mm[2] - p[2];
    const LegTable& t = legs_;
    double radicand[kLegs];
    double col[kLegs][5];
    for (int i = 0; i < kLegs; ++i) {
      const double by = a.c * t.by[i] - a.s * t.bz[i], bz = a.s * t.by[i] + a.c * t.bz[i];
      const double sx = p[0] + t.bx_ax[i], sy = p[1] + by - t.ay[i], sz = p[2] + bz - t.az[i];
      const double u = t.dx[i] * sx + t.dy[i] * sy + t.dz[i] * sz;
      radicand[i] = t.ll[i] - (sx * sx + sy * sy + sz * sz) + u * u;
      const double along = t.branch[i] * std::sqrt(std::max(radicand[i], 0.0));
      const double w = u + along;
      joints[static_cast<std::size_t>(i)] = w - t.c[i];
      // dq = g . ds with g = L / (L . d^); ds = -dm + dA x^ x R b.
      const double inv = -1 / along;
      const double gx = (sx - w * t.dx[i]) * inv, gy = (sy - w * t.dy[i]) * inv,
                   gz = (sz - w * t.dz[i]) * inv;
      // Table coordinates: dm = R_X (R_Z dq + dC z^ x R_Z q) + dA x^ x m. `hy` is g turned back by R_X.
      const double hy = a.c * gy + a.s * gz, hz = a.c * gz - a.s * gy;
      const double arm_y = part ? by - my : by, arm_z = part ? bz - mz : bz;
      const double ry = a.c * my + a.s * mz;  // y of R_Z q; its x is mx
      col[i][0] = part ? -(gx * c.c + hy * c.s) : -gx;
      col[i][1] = part ? gx * c.s - hy * c.c : -gy;
      col[i][2] = part ? -hz : -gz;
      col[i][3] = gz * arm_y - gy * arm_z;
      col[i][4] = part ? gx * ry - hy * mx : 0;
    }
    for (std::size_t i = 0; i < kLegs; ++i) {
      const std::span<double> row = jacobian_row(matrix, i);
      for (std::size_t k = 0; k < 5; ++k) row[k] = col[i][k];
      row[kE] = 0;
    }
    for (std::size_t k = 0; k < kPoseAxes; ++k) {
      jacobian_row(matrix, kJointC)[k] = k == kC ? 1 : 0;
      jacobian_row(matrix, kJointE)[k] = k == kE ? 1 : 0;
    }
    joints[kJointC] = pose[kC];
    joints[kJointE] = pose[kE];
    return reach(radicand);
  }

  Result<void, PoseError> forward(Frame frame, const JointVector& joints, Pose& pose) const override {
    const Turn a0(pose[kA]);
    PlatformPose platform_pose{platform(frame, pose, a0), pose[kA]};
    const double residual_mm = solve_platform(legs_, g_, joints, platform_pose);
    if (!(residual_mm < kForwardTolerance_mm))
      return Error<PoseError>({Kind::kNoConvergence, -1, residual_mm});
    const Vector3& p = platform_pose.p_mm;
    Vector3 m{g_.nozzle_mm[0] - p[0], g_.nozzle_mm[1] - p[1], g_.nozzle_mm[2] - p[2]};
    if (frame == Frame::kPart)
      m = turn_back_z(Turn(joints[kJointC]), turn_back_x(Turn(platform_pose.a_rad), m));
    pose = {m[0], m[1], m[2], platform_pose.a_rad, joints[kJointC], joints[kJointE]};
    return {};
  }

  Result<void, PoseError> check(Frame frame, const Pose& pose) const override {
    const Turn a(pose[kA]);
    const Vector3 p = platform(frame, pose, a);
    Vector3 q{pose[kX], pose[kY], pose[kZ]};
    if (frame == Frame::kMachine) q = turn_back_z(Turn(pose[kC]), turn_back_x(a, q));
    if (auto e = check_pose_limits(g_.limits, q, pose[kA], pose[kC])) return Error<PoseError>(*e);
    if (!std::isfinite(pose[kE])) return Error<PoseError>({Kind::kPoseLimit, kE, HUGE_VAL});

    const LegsAt legs(legs_, p, a);
    if (auto r = reach(legs.radicand); !r) return r;
    for (int i = 0; i < kLegs; ++i) {
      const Interval& travel = g_.legs[static_cast<std::size_t>(i)].travel_mm;
      if (auto e = outside_error(Kind::kJointLimit, i, travel, legs.w[i] - legs_.c[i], false))
        return Error<PoseError>(*e);
    }
    if (auto e = check_leg_angles(a, p, legs)) return Error<PoseError>(*e);

    double matrix[16];
    parallel_jacobian(legs, matrix);
    if (condition_is_within_4(matrix, g_.max_condition)) return {};
    const double cond = condition_number(matrix, 4);
    if (!(cond <= g_.max_condition)) return Error<PoseError>({Kind::kSingular, -1, cond});
    return {};
  }

  double condition(Frame frame, const Pose& pose) const override {
    const Turn a(pose[kA]);
    const Vector3 p = platform(frame, pose, a);
    const LegsAt legs(legs_, p, a);
    if (!reach(legs.radicand)) return std::numeric_limits<double>::infinity();
    double matrix[16];
    parallel_jacobian(legs, matrix);
    return condition_number(matrix, 4);
  }

  Pose bed_reference() const override { return {0, 0, g_.bed_reference_mm, 0, 0, 0}; }

 private:
  /// All legs at one pose, side by side. s, R b and w = q + c as in the head of this file; along = -L . d^.
  struct LegsAt {
    LegsAt(const LegTable& t, const Vector3& p, const Turn& a) {
      for (int i = 0; i < kLegs; ++i) {
        by[i] = a.c * t.by[i] - a.s * t.bz[i];
        bz[i] = a.s * t.by[i] + a.c * t.bz[i];
        sx[i] = p[0] + t.bx_ax[i];
        sy[i] = p[1] + by[i] - t.ay[i];
        sz[i] = p[2] + bz[i] - t.az[i];
        const double u = t.dx[i] * sx[i] + t.dy[i] * sy[i] + t.dz[i] * sz[i];
        radicand[i] = t.ll[i] - (sx[i] * sx[i] + sy[i] * sy[i] + sz[i] * sz[i]) + u * u;
        along[i] = t.branch[i] * std::sqrt(std::max(radicand[i], 0.0));
        w[i] = u + along[i];
      }
    }
    double by[kLegs], bz[kLegs], sx[kLegs], sy[kLegs], sz[kLegs], radicand[kLegs], along[kLegs], w[kLegs];
  };

  /// p = n - m.
  Vector3 platform(Frame frame, const Pose& pose, const Turn& a) const {
    Vector3 m{pose[kX], pose[kY], pose[kZ]};
    if (frame == Frame::kPart) {
      if (pose[kC] != 0) m = turn_z(Turn(pose[kC]), m);
      m = turn_x(a, m);
    }
    return {g_.nozzle_mm[0] - m[0], g_.nozzle_mm[1] - m[1], g_.nozzle_mm[2] - m[2]};
  }

  /// Paper M1, eq. 5. radicand[i] < 0: leg i cannot reach its rail.
  void carriages(const Vector3& p, const Turn& a, double* joints, double* radicand) const {
    const LegTable& t = legs_;
    for (int i = 0; i < kLegs; ++i) {
      const double sx = p[0] + t.bx_ax[i];
      const double sy = p[1] + (a.c * t.by[i] - a.s * t.bz[i]) - t.ay[i];
      const double sz = p[2] + (a.s * t.by[i] + a.c * t.bz[i]) - t.az[i];
      const double u = t.dx[i] * sx + t.dy[i] * sy + t.dz[i] * sz;
      radicand[i] = t.ll[i] - (sx * sx + sy * sy + sz * sz) + u * u;
      joints[i] = u - t.c[i] + t.branch[i] * std::sqrt(std::max(radicand[i], 0.0));
    }
  }

  Result<void, PoseError> reach(const double* radicand) const {
    // Written so that not-a-number fails too. Zero is the singular stretched leg, and also refused.
    if (radicand[0] > 0 && radicand[1] > 0 && radicand[2] > 0 && radicand[3] > 0) [[likely]]
      return {};
    int worst = 0;
    for (int i = 1; i < kLegs; ++i)
      if (!(radicand[i] >= radicand[worst])) worst = i;
    const double ll = legs_.ll[worst];
    return Error<PoseError>({Kind::kOutOfReach, worst, std::sqrt(ll - radicand[worst]) - std::sqrt(ll)});
  }

  std::optional<PoseError> check_leg_angles(const Turn& a, const Vector3& p, const LegsAt& legs) const {
    const double* radicand = legs.radicand;
    for (int i = 0; i < kLegs; ++i) {
      const M1Leg& leg = g_.legs[static_cast<std::size_t>(i)];
      // The angle itself is needed only for the message.
      if (radicand[i] < least_cosine_ * least_cosine_ * legs_.ll[i]) {
        const double angle = std::acos(std::min(1.0, std::sqrt(radicand[i] / legs_.ll[i])));
        return PoseError{Kind::kLegAngle, i, angle - g_.max_leg_angle_rad, true};
      }
      if (!(g_.min_rail_clearance_rad > 0) && !(g_.min_platform_clearance_rad > 0)) continue;
      const Vector3 b = turn_x(a, leg.attachment_mm);
      if (g_.min_rail_clearance_rad > 0) {
        const double length = std::hypot(b[0], b[1], b[2]);
        const double cosine = (b[0] * legs_.dx[i] + b[1] * legs_.dy[i] + b[2] * legs_.dz[i]) / length;
        const double gamma = std::acos(std::min(1.0, std::abs(cosine)));
        if (gamma < g_.min_rail_clearance_rad)
          return PoseError{Kind::kClearance, i, g_.min_rail_clearance_rad - gamma, true};
      }
      if (g_.min_platform_clearance_rad > 0) {
        const double w = legs.w[i];
        // From the platform along the leg, on the platform's normal R z^ = (0, -sin A, cos A); what counts as
        // free is the side of the carriage.
        const double leg_y = legs_.ay[i] + w * legs_.dy[i] - p[1] - b[1];
        const double leg_z = legs_.az[i] + w * legs_.dz[i] - p[2] - b[2];
        const double side = legs_.branch[i] * (legs_.dz[i] < 0 ? -1 : 1);
        const double rise = side * (-a.s * leg_y + a.c * leg_z) / leg.length_mm;
        if (rise < least_rise_) {
          const double elevation = std::asin(std::max(rise, -1.0));
          return PoseError{Kind::kClearance, i, g_.min_platform_clearance_rad - elevation, true};
        }
      }
    }
    return std::nullopt;
  }

  /// d q_towers / d(p, A * rotation_scale), 4 x 4, a leg in each column of the row-major matrix: transposed
  /// or not, singular values are the same. The legs must reach.
  void parallel_jacobian(const LegsAt& at, double* matrix) const {
    const double per_scale = 1 / g_.rotation_scale_mm;
    const LegTable& t = legs_;
    for (int i = 0; i < kLegs; ++i) {
      const double lx = at.sx[i] - at.w[i] * t.dx[i], ly = at.sy[i] - at.w[i] * t.dy[i],
                   lz = at.sz[i] - at.w[i] * t.dz[i];
      const double inv = -1 / at.along[i];
      matrix[i] = lx * inv;
      matrix[4 + i] = ly * inv;
      matrix[8 + i] = lz * inv;
      matrix[12 + i] = (at.by[i] * lz - at.bz[i] * ly) * inv * per_scale;
    }
  }

  M1Geometry g_;
  LegTable legs_;
  double least_cosine_;  ///< of a leg's angle against its rail
  double least_rise_;    ///< sine of a leg's angle against the platform's plane
};

}  // namespace

LegTable::LegTable(const M1Geometry& g) {
  for (std::size_t i = 0; i < kLegs; ++i) {
    const M1Leg& leg = g.legs[i];
    const double norm = std::hypot(leg.rail[0], leg.rail[1], leg.rail[2]);
    dx[i] = leg.rail[0] / norm;
    dy[i] = leg.rail[1] / norm;
    dz[i] = leg.rail[2] / norm;
    bx_ax[i] = leg.attachment_mm[0] - leg.foot_mm[0];
    by[i] = leg.attachment_mm[1];
    bz[i] = leg.attachment_mm[2];
    ay[i] = leg.foot_mm[1];
    az[i] = leg.foot_mm[2];
    ll[i] = leg.length_mm * leg.length_mm;
    c[i] = leg.connector_mm;
    branch[i] = leg.carriage_above ? 1 : -1;
  }
}

Result<std::unique_ptr<Kinematics>, GeometryError> make_m1_kinematics(const M1Geometry& geometry) {
  if (auto wrong = m1_geometry::wrong_numbers(geometry)) return Error<GeometryError>({*wrong});
  std::unique_ptr<Kinematics> m1 = std::make_unique<M1>(with_tool_in_frame(geometry));
  if (geometry.tool == ToolPlacement::kPlatform) m1 = make_tool_on_platform(geometry, std::move(m1));
  if (auto wrong = m1_geometry::wrong_everywhere(*m1, geometry)) return Error<GeometryError>({*wrong});
  return m1;
}

}  // namespace kinebus
