#include "gateway/motion/point_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinebus {
namespace {

// Plan joints to this share of their limits. The rest is for what comes after planning: terms that vary
// within a piece (held to some 1 %), and segments whose accelerations are rounded to the wire's units.
constexpr double kJointShare = 0.98;
// The bounds of a cubic's slope are taken at five points; between them it is greater by less than this.
constexpr double kBetweenSamples = 1 + 1e-4;
// Jerk: the same, and room for a smooth ramp of path time; the tool's tangent and curvature are not quite
// perpendicular on cubics, either.
constexpr double kJerkShare = 0.96;
// Of a jerk limit, what a bend may take at ramp_cap; of an acceleration, what it may take there. The rest is
// for changing the speed. At the cap a bend may take nearly all of the jerk.
constexpr double kBendJerk = 0.6, kSteadyJerk = 0.98;
constexpr double kBendAccel = 0.9;
// A jump of the acceleration counts as a jerk, as what is sampled each millisecond sees it: third differences
// weigh it by at most 0.75 / 1 ms. With it a bend may take less of a joint's: next to a ramp that ends just
// before, half of the ramp's jerk is added, and 0.98 / 2 + 0.6 / 2 + 0.375 / 2 is within the limit.
constexpr double kJump_per_s = 0.75 / (2 * kCurvatureJump_s);
constexpr double kJumpJerk = 0.6;
// Of what bends leave of the jerk, what the tangent's turning (3 x_ss v a) may take; across for the tool,
// where a right angle leaves 0.8 for the jerk along the path, and in line for a joint.
constexpr double kTurnJerk = 0.6, kTurnJointJerk = 0.5;
// Share of the acceleration at rest that the cap has to leave, and by how much a cap is lowered for that.
constexpr double kLeastAccel = 0.15, kLower = 0.9;
constexpr int kLowerings = 60;
constexpr double kNoJerk = 1e9;
double inverse_of(double limit) {
  return std::isfinite(limit) ? 1 / limit : 0;
}

/// Lowers `up` and `down` to the a that |second x + first a| <= limit allows.
void bound_accel(double first, double second, double limit, double x, double& up, double& down) {
  const double size = std::abs(first);
  if (size * kNoAccel < limit) return;
  const double bend = first > 0 ? second * x : -second * x;
  up = std::min(up, std::max(limit - bend, 0.0) / size);
  down = std::min(down, std::max(limit + bend, 0.0) / size);
}

/// Jerk by the path's shape alone, at a constant speed.
double bend_jerk(double third, double jump, double speed) {
  return speed * speed * (third * speed + kJump_per_s * jump);
}

/// Lowers `speed` to where the shape takes `share` of `jerk`; where there is a jump, to a little less.
void lower_for_bend(double share, double third, double jump, double jerk, double& speed) {
  const double most = share * jerk, size = bend_jerk(third, jump, speed);
  if (size > most) speed *= jump > 0 ? std::sqrt(most / size) : std::cbrt(most / size);
}

/// Speed of the tip relative to the part per unit of s, for a path in the machine frame while A and C turn:
/// |m' - omega x m| with omega = A' x^ + C' R_X(A) z^.
double tip_rate(const PosePoint& p) {
  const double wx = p.x1[kA];
  const double wy = -std::sin(p.x[kA]) * p.x1[kC], wz = std::cos(p.x[kA]) * p.x1[kC];
  const double dx = p.x1[kX] - (wy * p.x[kZ] - wz * p.x[kY]);
  const double dy = p.x1[kY] - (wz * p.x[kX] - wx * p.x[kZ]);
  const double dz = p.x1[kZ] - (wx * p.x[kY] - wy * p.x[kX]);
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

}  // namespace

PointLimits::PointLimits(std::size_t joints, const MotionLimits& limits) : joints_(joints) {
  set_limits(limits);
}

void PointLimits::set_limits(const MotionLimits& limits) {
  limits_ = limits;
  for (std::size_t j = 0; j < kMaxJoints; ++j) {
    inverse_speed_[j] = inverse_of(limits.joint_speed_per_s[j] * kJointShare);
    inverse_accel_[j] = inverse_of(limits.joint_accel_per_s2[j] * kJointShare);
    accel_[j] = limits.joint_accel_per_s2[j] * kJointShare;
    jerk_[j] = limits.joint_jerk_per_s3[j] * kJerkShare;
  }
  inverse_flow_accel_ = inverse_of(limits.flow_accel_mm_per_s2);
  flow_jerk_ = limits.flow_jerk_mm_per_s3 * kJerkShare;
  limited_xyz_ = false;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    inverse_axis_speed_[i] = inverse_of(limits.axis_speed_per_s[i]);
    inverse_axis_accel_[i] = inverse_of(limits.axis_accel_per_s2[i]);
    if (i < 3 && (inverse_axis_speed_[i] > 0 || inverse_axis_accel_[i] > 0)) limited_xyz_ = true;
  }
}

void PointLimits::set_cap(const PieceDemand& demand, double tool_rate, PlanPiece& piece) const {
  const double tool_speed = tool_rate > 0 ? limits_.tool_speed_mm_per_s / tool_rate : kNoAccel;
  // The feed is along X Y Z where s is, and a curve may be a little longer than its parameter.
  const double feed = demand.tip_feed ? kNoAccel : demand.speed;
  const double speed = std::min({feed, tool_speed, kNoAccel});
  piece.cap = speed * speed;
}

void PointLimits::axis_caps(const PosePoint& pose, PlanPiece& piece) const {
  double speed = 0, accel = 0;
  for (std::size_t i = limited_xyz_ ? 0 : 3; i < kPoseAxes; ++i) {
    speed = std::max(speed, std::abs(pose.x1[i]) * inverse_axis_speed_[i]);
    accel = std::max(accel, std::abs(pose.x2[i]) * inverse_accel(i, pose.x1));
  }
  const double inverse_cap = std::max(speed * speed, accel);
  if (inverse_cap * piece.cap > 1) piece.cap = 1 / inverse_cap;
}

void PointLimits::tip_cap(const PieceDemand& demand, const PosePoint& pose, PlanPiece& piece) const {
  if (!demand.tip_feed || !std::isfinite(demand.speed)) return;
  const double rate = tip_rate(pose);
  if (rate * rate * piece.cap > demand.speed * demand.speed)
    piece.cap = demand.speed * demand.speed / (rate * rate);
}

double PointLimits::joint_ratio(const JointPoint& joints, const PlanPiece& piece) const {
  const double speed = std::sqrt(piece.cap);
  const double accel = std::min({piece.curved ? piece.accel / std::sqrt(piece.w2) : piece.accel, kNoAccel});
  double ratio = 0;
  for (std::size_t j = 0; j < joints_; ++j) {
    const double first = std::abs(joints.q1[j]), second = std::abs(joints.q2[j]);
    ratio = std::max(
        {ratio, first * speed * inverse_speed_[j], (second * piece.cap + first * accel) * inverse_accel_[j]});
  }
  return ratio;
}

void PointLimits::joint_caps(const JointPoint& joints, PlanPiece& piece) const {
  double speed = 0, accel = 0;
  for (std::size_t j = 0; j < joints_; ++j) {
    speed = std::max(speed, std::abs(joints.q1[j]) * inverse_speed_[j]);
    accel = std::max(accel, std::abs(joints.q2[j]) * inverse_accel_[j]);
  }
  const double inverse_cap = std::max(speed * speed, accel);
  if (inverse_cap * piece.cap > 1) piece.cap = 1 / inverse_cap;
}

void PointLimits::joint_accels(const JointPoint& joints, PlanPiece& piece) const {
  for (std::size_t j = 0; j < joints_; ++j) {
    if (inverse_accel_[j] == 0) continue;
    bound_accel(joints.q1[j], joints.q2[j], accel_[j], 0, piece.up0, piece.down0);
    bound_accel(joints.q1[j], joints.q2[j], accel_[j], piece.cap, piece.up1, piece.down1);
  }
}

void PointLimits::limit_straight_accel(const PosePoint& direction, PlanPiece& piece) const {
  for (std::size_t i = limited_xyz_ ? 0 : 3; i < kPoseAxes; ++i) {
    const double rate = std::abs(direction.x1[i]) * inverse_accel(i, direction.x1);
    if (rate * piece.accel > 1) piece.accel = 1 / rate;
  }
}

void PointLimits::axis_accels(const PosePoint& pose, PlanPiece& piece) const {
  for (std::size_t i = limited_xyz_ ? 0 : 3; i < kPoseAxes; ++i) {
    if (inverse_accel(i, pose.x1) == 0) continue;
    const double limit = accel_limit(i, pose.x1);
    bound_accel(pose.x1[i], pose.x2[i], limit, 0, piece.up0, piece.down0);
    bound_accel(pose.x1[i], pose.x2[i], limit, piece.cap, piece.up1, piece.down1);
  }
}

void PointLimits::bound_flow(const PosePoint& pose, PlanPiece& piece) const {
  if (inverse_flow_accel_ == 0) return;
  // Where what is fed changes along the way, half of its acceleration is for that.
  const double changes = std::abs(pose.x2[kE]) * std::sqrt(dot3(pose.x1, pose.x1));
  const double most = (changes > 0 ? 0.5 : 1) * limits_.flow_accel_mm_per_s2;
  if (changes * piece.cap > most) piece.cap = most / changes;
  if (std::abs(pose.x1[kE]) * piece.accel > most) piece.accel = most / std::abs(pose.x1[kE]);
}

void PointLimits::bound_curve(const PieceDemand& demand, const PathPiece& geometry, PlanPiece& piece) const {
  constexpr int kPoints = 5;
  std::array<PosePoint, kPoints> points;
  double w2 = 0, k2 = 0, c = 0;
  for (int i = 0; i < kPoints; ++i) {
    PosePoint& p = points[static_cast<std::size_t>(i)];
    p = geometry.evaluate(piece.s0 + piece.length * i / (kPoints - 1));
    w2 = std::max(w2, dot3(p.x1, p.x1));
    k2 = std::max(k2, dot3(p.x2, p.x2));
    c = std::max(c, std::abs(dot3(p.x1, p.x2)));
  }
  set_cap(demand, std::sqrt(w2) * kBetweenSamples, piece);
  piece.curved = true;
  piece.accel = demand.accel_mm_per_s2;
  for (const PosePoint& p : points) bound_flow(p, piece);
  piece.k2 = k2 * kBetweenSamples * kBetweenSamples;
  piece.c = c;
  piece.w2 = std::max(w2 * kBetweenSamples * kBetweenSamples, 1e-12);
  if (piece.k2 * piece.cap * piece.cap > piece.accel * piece.accel) {
    piece.cap = piece.accel / std::sqrt(piece.k2);
  }
  for (const PosePoint& point : points) {
    axis_caps(point, piece);
    tip_cap(demand, point, piece);
  }
  for (std::size_t i = 3; i < kPoseAxes && !geometry.arc; ++i) {
    // Where an axis is fastest within the cubic.
    const auto& cubic = geometry.coefficients[i];
    const double s = cubic[3] != 0 ? -cubic[2] / (3 * cubic[3]) : -1;
    const double rate = (cubic[1] + cubic[2] * s) * inverse_axis_speed_[i];
    if (s > piece.s0 && s < piece.s0 + piece.length && rate * rate * piece.cap > 1) {
      piece.cap = 1 / (rate * rate);
    }
  }
  double ratio = 0;
  for (const PosePoint& point : points) {
    for (std::size_t i = limited_xyz_ ? 0 : 3; i < kPoseAxes; ++i) {
      const double most = std::abs(point.x2[i]) * piece.cap + std::abs(point.x1[i]) * piece.accel;
      ratio = std::max(ratio, most * inverse_accel(i, point.x1));
    }
  }
  if (ratio <= kNear) return;
  allow_any_acceleration(piece);
  for (const PosePoint& point : points) axis_accels(point, piece);
}

PlanPiece::Even PointLimits::even(const JerkTerms& terms, const JointJerkTerms* joints,
                                  const PlanPiece& piece, double x) const {
  const double v = std::sqrt(x);
  PlanPiece::Even even{std::min({piece.accel_between(0, x), piece.decel_between(0, x), kNoAccel}), kNoJerk};
  const double most = limits_.tool_jerk_mm_per_s3 * kJerkShare, bend = bend_jerk(terms.x3, 0, v);
  // What jumps is across the path, as its turning is.
  const double left = most - bend, turn = 3 * terms.x2 * v, jump = bend_jerk(0, terms.jump, v);
  if (turn * even.accel > kTurnJerk * left - jump)
    even.accel = std::max(kTurnJerk * left - jump, 0.0) / std::max(turn, 1e-300);
  for (std::size_t j = 0; j < joints_ && joints != nullptr; ++j) {
    const double room = kTurnJointJerk * (jerk_[j] - bend_jerk(joints->q3[j], joints->jump[j], v));
    const double joint_turn = 3 * joints->q2[j] * v;
    if (joint_turn * even.accel > room) even.accel = std::max(room, 0.0) / joint_turn;
  }
  const bool flows = flow_jerk_ < kUnlimited && terms.x1 > 0;
  const double flow_bend = flows ? bend_jerk(terms.e3, terms.e_jump, v) : 0;
  if (const double flow_turn = 3 * terms.e2 * v; flows && flow_turn > 0)
    even.accel = std::min(even.accel, std::max(kTurnJointJerk * (flow_jerk_ - flow_bend), 0.0) / flow_turn);
  // Whichever way the bend's own jerk points; or, by how much of it is across the path, and how much along
  // it.
  const double across = turn * even.accel + jump;
  const double all_across = across + bend * terms.across3;
  const double along = bend * terms.along3 + turn * terms.along2 * even.accel;
  if (terms.x1 > 0)
    even.jerk =
        std::min(kNoJerk, std::max(std::sqrt(std::max(left * left - across * across, 0.0)),
                                   std::sqrt(std::max(most * most - all_across * all_across, 0.0)) - along) /
                              terms.x1);
  for (std::size_t j = 0; j < joints_ && joints != nullptr; ++j) {
    const double room =
        jerk_[j] - bend_jerk(joints->q3[j], joints->jump[j], v) - 3 * joints->q2[j] * v * even.accel;
    if (joints->q1[j] * even.jerk > room) even.jerk = room / joints->q1[j];
  }
  if (const double room = flow_jerk_ - flow_bend - 3 * terms.e2 * v * even.accel;
      flows && terms.e1 * even.jerk > room)
    even.jerk = std::max(room, 0.0) / terms.e1;
  return even;
}

double PointLimits::bend_cap(double share, const JerkTerms& terms, const JointJerkTerms* joints,
                             const PlanPiece& piece) const {
  double speed = std::sqrt(piece.cap);
  const double jerk = limits_.tool_jerk_mm_per_s3 * kJerkShare;
  lower_for_bend(share, terms.x3, terms.jump, jerk, speed);
  for (std::size_t j = 0; j < joints_ && joints != nullptr; ++j) {
    const double jump = kCurvatureJump_s * jerk_[j];
    if (joints->jump[j] * speed * speed > jump) speed = std::sqrt(jump / joints->jump[j]);
    lower_for_bend(joints->jump[j] > 0 ? kJumpJerk : share, joints->q3[j], joints->jump[j], jerk_[j], speed);
  }
  if (flow_jerk_ < kUnlimited && terms.x1 > 0) {
    const double jump = kCurvatureJump_s * flow_jerk_;
    if (terms.e_jump * speed * speed > jump) speed = std::sqrt(jump / terms.e_jump);
    lower_for_bend(terms.e_jump > 0 ? kJumpJerk : share, terms.e3, terms.e_jump, flow_jerk_, speed);
  }
  const double cap = std::min(piece.cap, speed * speed);
  return piece.curved && piece.k2 * cap * cap > kBendAccel * kBendAccel * piece.accel * piece.accel
             ? kBendAccel * piece.accel / std::sqrt(piece.k2)
             : cap;
}

void PointLimits::limit_jerk(const JerkTerms& terms, const JointJerkTerms* joints, PlanPiece& piece) const {
  const double before = piece.cap;
  double cap = bend_cap(kBendJerk, terms, joints, piece);
  const double steady = piece.length > 0 ? bend_cap(kSteadyJerk, terms, joints, piece) : cap;
  const auto accel_at = [&](double x) {
    return std::min(piece.accel_between(0, x), piece.decel_between(0, x));
  };
  const double least = kLeastAccel * accel_at(0);
  for (int i = 0; i < kLowerings && accel_at(cap) < least; ++i) cap *= kLower;
  for (std::size_t i = 0; i < piece.even.size(); ++i) {
    const double share = PlanPiece::kRampSpeeds[i];
    piece.even[i] = even(terms, joints, piece, cap * share * share);
  }
  if (piece.length == 0) {
    PlanPiece unchanged = piece;
    unchanged.accel = 0;
    piece.touch_jerk = even(terms, joints, unchanged, cap).jerk;
  }
  if (piece.linear) {
    const double down = steady / before;
    piece.up1 = piece.up0 + (piece.up1 - piece.up0) * down;
    piece.down1 = piece.down0 + (piece.down1 - piece.down0) * down;
  }
  piece.ramp_cap = cap;
  piece.cap = steady;
}

double PointLimits::joint_jerk_ratio(const JointJerkTerms& joints, const PlanPiece& piece) const {
  const double v = std::sqrt(piece.ramp_cap), steady = std::sqrt(piece.cap);
  double ratio = 0;
  for (std::size_t j = 0; j < joints_; ++j) {
    const auto size = [&](const PlanPiece::Even& even, double speed) {
      return joints.q3[j] * speed * speed * speed + joints.q1[j] * even.jerk +
             3 * joints.q2[j] * speed * even.accel;
    };
    double most = size({}, steady);
    for (const PlanPiece::Even& even : piece.even) most = std::max(most, size(even, v));
    ratio = std::max(ratio, most / jerk_[j]);
  }
  return ratio;
}

double PointLimits::jump_cap(const Pose& before, const Pose& after) const {
  const double jerk = limits_.tool_jerk_mm_per_s3;
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) square += (after[i] - before[i]) * (after[i] - before[i]);
  double share = std::sqrt(square) / jerk;
  for (std::size_t i = 3; i < kPoseAxes; ++i)
    share = std::max(
        share, std::abs(after[i] - before[i]) * limits_.tool_accel_mm_per_s2 * inverse_axis_accel_[i] / jerk);
  return kCurvatureJump_s / std::max(share, 1e-300);
}

void PointLimits::add_joints(const JointPoint& before, const JointPoint& after, PlanPiece& piece) const {
  const double cap = piece.cap;
  joint_caps(before, piece);
  joint_caps(after, piece);
  if (piece.linear) {
    // The axes' share was for the cap before: a lower cap only leaves more, up to the value at rest.
    const double down = piece.cap / cap;
    piece.up1 = piece.up0 + (piece.up1 - piece.up0) * down;
    piece.down1 = piece.down0 + (piece.down1 - piece.down0) * down;
  } else {
    allow_any_acceleration(piece);
  }
  joint_accels(before, piece);
  joint_accels(after, piece);
}

}  // namespace kinebus
