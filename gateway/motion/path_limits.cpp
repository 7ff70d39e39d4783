#include "gateway/motion/path_limits.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace kinebus {
namespace {

// Plan joints to this share of their limits. The rest is for what comes after planning: terms that vary
// within a piece (held to some 1 %), and segments whose accelerations are rounded to the wire's units.
constexpr double kJointShare = 0.98;
// Below this share of a limit a joint is not looked at any closer: on M1 the terms vary by less than the rest
// within an undivided piece.
constexpr double kNear = 0.8;
// Undivided pieces: lengths over which the terms of far-off joints are taken as known from both ends.
constexpr double kFarLine_mm = 25;
constexpr double kFarTurn_rad = 0.1;
// Parts of pieces on which a joint is near its limit. Curvature terms of M1 change by (part / leg length).
constexpr double kNearLine_mm = 2.5;
constexpr double kNearTurn_rad = 0.025;
constexpr int kMostParts = 256;
// Curves whose curvature takes this share of the acceleration at their speed are divided into parts of this
// share of the braking distance, so that curvature and acceleration are nearly constant on each.
constexpr double kBent = 0.3;
constexpr double kCurvePart = 0.5;
constexpr double kLeastPart_mm = 0.05;
constexpr double kArcLook_rad = 0.35;
// The bounds of a cubic's slope are taken at five points; between them it is greater by less than this.
constexpr double kBetweenSamples = 1 + 1e-4;
// Used where nothing limits: 1 km/s2 and 1 km/s. Finite, so that 0 x limit stays 0.
constexpr double kNoAccel = 1e6;

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

void begin_linear(PlanPiece& piece) {
  piece.linear = true;
  piece.up0 = piece.up1 = piece.down0 = piece.down1 = kNoAccel;
}

double dot3(const PoseVector& a, const PoseVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

int parts_for(const PathPiece& piece, double part_mm, double part_rad) {
  const double turn = std::max(std::abs(piece.coefficients[kA][1]), std::abs(piece.coefficients[kC][1]));
  const double parts = piece.length * std::max(1 / part_mm, turn / part_rad);
  return static_cast<int>(std::clamp(std::ceil(parts), 1.0, static_cast<double>(kMostParts)));
}

}  // namespace

PathLimits::PathLimits(const Kinematics& kinematics, const MotionLimits& limits, Lookahead& lookahead)
    : kinematics_(&kinematics),
      lookahead_(&lookahead),
      joints_(static_cast<std::size_t>(kinematics.joint_count())) {
  set_limits(limits);
}

void PathLimits::set_limits(const MotionLimits& limits) {
  limits_ = limits;
  for (std::size_t j = 0; j < kMaxJoints; ++j) {
    inverse_speed_[j] = inverse_of(limits.joint_speed_per_s[j] * kJointShare);
    inverse_accel_[j] = inverse_of(limits.joint_accel_per_s2[j] * kJointShare);
    accel_[j] = limits.joint_accel_per_s2[j] * kJointShare;
  }
  limited_xyz_ = false;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    inverse_axis_speed_[i] = inverse_of(limits.axis_speed_per_s[i]);
    inverse_axis_accel_[i] = inverse_of(limits.axis_accel_per_s2[i]);
    if (i < 3 && (inverse_axis_speed_[i] > 0 || inverse_axis_accel_[i] > 0)) limited_xyz_ = true;
  }
}

Result<void, PoseError> PathLimits::evaluate(Frame frame, Sample& sample) const {
  return kinematics_->inverse_along(frame, sample.pose, sample.joints);
}

void PathLimits::set_cap(const PieceDemand& demand, double tool_rate, PlanPiece& piece) const {
  const double tool_speed = tool_rate > 0 ? limits_.tool_speed_mm_per_s / tool_rate : kNoAccel;
  // The feed is along X Y Z where s is, and a curve may be a little longer than its parameter.
  const double feed = demand.tip_feed ? kNoAccel : demand.speed;
  const double speed = std::min({feed, tool_speed, kNoAccel});
  piece.cap = speed * speed;
}

/// Speed caps of the single axes, at a point where x1 and x2 are known.
void PathLimits::axis_caps(const PosePoint& pose, PlanPiece& piece) const {
  double speed = 0, accel = 0;
  for (std::size_t i = limited_xyz_ ? 0 : 3; i < kPoseAxes; ++i) {
    speed = std::max(speed, std::abs(pose.x1[i]) * inverse_axis_speed_[i]);
    accel = std::max(accel, std::abs(pose.x2[i]) * inverse_axis_accel_[i]);
  }
  const double inverse_cap = std::max(speed * speed, accel);
  if (inverse_cap * piece.cap > 1) piece.cap = 1 / inverse_cap;
}

void PathLimits::tip_cap(const PieceDemand& demand, const PosePoint& pose, PlanPiece& piece) const {
  if (!demand.tip_feed || !std::isfinite(demand.speed)) return;
  const double rate = tip_rate(pose);
  if (rate * rate * piece.cap > demand.speed * demand.speed)
    piece.cap = demand.speed * demand.speed / (rate * rate);
}

double PathLimits::joint_ratio(const JointPoint& joints, const PlanPiece& piece) const {
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

void PathLimits::joint_caps(const JointPoint& joints, PlanPiece& piece) const {
  double speed = 0, accel = 0;
  for (std::size_t j = 0; j < joints_; ++j) {
    speed = std::max(speed, std::abs(joints.q1[j]) * inverse_speed_[j]);
    accel = std::max(accel, std::abs(joints.q2[j]) * inverse_accel_[j]);
  }
  const double inverse_cap = std::max(speed * speed, accel);
  if (inverse_cap * piece.cap > 1) piece.cap = 1 / inverse_cap;
}

void PathLimits::joint_accels(const JointPoint& joints, PlanPiece& piece) const {
  for (std::size_t j = 0; j < joints_; ++j) {
    if (inverse_accel_[j] == 0) continue;
    bound_accel(joints.q1[j], joints.q2[j], accel_[j], 0, piece.up0, piece.down0);
    bound_accel(joints.q1[j], joints.q2[j], accel_[j], piece.cap, piece.up1, piece.down1);
  }
}

void PathLimits::axis_accels(const PosePoint& pose, PlanPiece& piece) const {
  for (std::size_t i = limited_xyz_ ? 0 : 3; i < kPoseAxes; ++i) {
    if (inverse_axis_accel_[i] == 0) continue;
    bound_accel(pose.x1[i], pose.x2[i], limits_.axis_accel_per_s2[i], 0, piece.up0, piece.down0);
    bound_accel(pose.x1[i], pose.x2[i], limits_.axis_accel_per_s2[i], piece.cap, piece.up1, piece.down1);
  }
}

Result<void, PoseError> PathLimits::start_of_line(const PathPiece& geometry) {
  if (tail_valid_) return {};
  Sample start;
  start.pose = geometry.evaluate(0);
  start.pose.x2 = {};
  if (auto ok = evaluate(geometry.frame, start); !ok) return ok;
  tail_ = start.joints;
  tail_valid_ = true;
  return {};
}

/// Speed cap and acceleration bounds of geometry's stretch from piece.s0 over piece.length, joints aside.
void PathLimits::bound_curve(const PieceDemand& demand, const PathPiece& geometry, PlanPiece& piece) const {
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
      ratio = std::max(ratio, most * inverse_axis_accel_[i]);
    }
  }
  if (ratio <= kNear) return;
  begin_linear(piece);
  for (const PosePoint& point : points) axis_accels(point, piece);
}

/// Adds a curve in equal parts. near: joints count, with their terms at both ends of each part.
Result<void, PoseError> PathLimits::add_curve_parts(const PieceDemand& demand, const PathPiece& geometry,
                                                    int parts, bool near) {
  Sample before, after;
  before.pose = geometry.evaluate(0);
  if (near) {
    if (auto ok = evaluate(geometry.frame, before); !ok) return ok;
  }
  for (int i = 0; i < parts; ++i) {
    PlanPiece part;
    part.line = demand.line;
    part.s0 = geometry.length * i / parts;
    part.length = geometry.length * (i + 1) / parts - part.s0;
    bound_curve(demand, geometry, part);
    if (near) {
      after.pose = geometry.evaluate(part.s0 + part.length);
      if (auto ok = evaluate(geometry.frame, after); !ok) return ok;
      add_joints(before.joints, after.joints, part);
      before = after;
    }
    lookahead_->add(part);
  }
  return {};
}

/// Adds a line in equal parts, with the joints' terms at both ends of each.
Result<void, PoseError> PathLimits::add_line_parts(const PieceDemand& demand, const PathPiece& geometry,
                                                   const PlanPiece& whole, int parts) {
  Sample before, after;
  before.pose = geometry.evaluate(0);
  if (auto ok = evaluate(geometry.frame, before); !ok) return ok;
  for (int i = 0; i < parts; ++i) {
    PlanPiece part = whole;
    part.s0 = geometry.length * i / parts;
    part.length = geometry.length * (i + 1) / parts - part.s0;
    after.pose = geometry.evaluate(part.s0 + part.length);
    if (auto ok = evaluate(geometry.frame, after); !ok) return ok;
    tip_cap(demand, before.pose, part);
    tip_cap(demand, after.pose, part);
    add_joints(before.joints, after.joints, part);
    lookahead_->add(part);
    before = after;
  }
  return {};
}

/// The joints' terms at both ends of a piece: cap and accelerations.
void PathLimits::add_joints(const JointPoint& before, const JointPoint& after, PlanPiece& piece) const {
  const double cap = piece.cap;
  joint_caps(before, piece);
  joint_caps(after, piece);
  if (piece.linear) {
    // The axes' share was for the cap before: a lower cap only leaves more, up to the value at rest.
    const double down = piece.cap / cap;
    piece.up1 = piece.up0 + (piece.up1 - piece.up0) * down;
    piece.down1 = piece.down0 + (piece.down1 - piece.down0) * down;
  } else {
    begin_linear(piece);
  }
  joint_accels(before, piece);
  joint_accels(after, piece);
}

Result<void, PoseError> PathLimits::add_line(const PieceDemand& demand) {
  const PathPiece& geometry = lookahead_->newest_geometry();
  if (auto ok = start_of_line(geometry); !ok) return ok;
  PosePoint direction;
  for (std::size_t i = 0; i < kPoseAxes; ++i) direction.x1[i] = geometry.coefficients[i][1];
  const double tool_rate = std::sqrt(dot3(direction.x1, direction.x1));

  PlanPiece piece;
  piece.line = demand.line;
  piece.length = geometry.length;
  set_cap(demand, tool_rate, piece);
  axis_caps(direction, piece);
  piece.accel = tool_rate > 0 ? demand.accel_mm_per_s2 / tool_rate : kNoAccel;
  for (std::size_t i = limited_xyz_ ? 0 : 3; i < kPoseAxes; ++i) {
    const double rate = std::abs(direction.x1[i]) * inverse_axis_accel_[i];
    if (rate * piece.accel > 1) piece.accel = 1 / rate;
  }

  const int far_parts = parts_for(geometry, kFarLine_mm, kFarTurn_rad);
  double ratio = joint_ratio(tail_, piece);
  Sample end;
  for (int i = 1; i <= far_parts; ++i) {
    end.pose = geometry.evaluate(geometry.length * i / far_parts);
    if (auto ok = evaluate(geometry.frame, end); !ok) return ok;
    ratio = std::max(ratio, joint_ratio(end.joints, piece));
  }
  const bool turning_feed = demand.tip_feed && far_parts > 1;
  tail_ = end.joints;
  if (ratio < kNear && !turning_feed) {
    if (demand.tip_feed) {
      tip_cap(demand, geometry.evaluate(0), piece);
      tip_cap(demand, end.pose, piece);
    }
    lookahead_->add(piece);
    return {};
  }
  return add_line_parts(demand, geometry, piece, parts_for(geometry, kNearLine_mm, kNearTurn_rad));
}

Result<void, PoseError> PathLimits::add_parabola(const PieceDemand& demand) {
  const PathPiece& geometry = lookahead_->newest_geometry();
  if (auto ok = start_of_line(geometry); !ok) return ok;
  const PosePoint start = geometry.evaluate(0);
  Sample end;
  end.pose = geometry.evaluate(geometry.length);
  const PoseVector bend = end.pose.x2;
  end.pose.x2 = {};
  if (auto ok = evaluate(geometry.frame, end); !ok) return ok;

  // |x_s| is convex along a parabola, and x_s . x_ss linear: both are greatest at an end.
  const double w = std::max(std::sqrt(dot3(start.x1, start.x1)), std::sqrt(dot3(end.pose.x1, end.pose.x1)));
  PlanPiece piece;
  piece.line = demand.line;
  piece.length = geometry.length;
  set_cap(demand, w, piece);
  piece.curved = true;
  piece.accel = demand.accel_mm_per_s2;
  piece.k2 = dot3(bend, bend);
  piece.c = std::max(std::abs(dot3(bend, start.x1)), std::abs(dot3(bend, end.pose.x1)));
  piece.w2 = std::max(w * w, 1e-12);
  if (piece.k2 * piece.cap * piece.cap > piece.accel * piece.accel)
    piece.cap = piece.accel / std::sqrt(piece.k2);
  PosePoint first = start, last = end.pose;
  first.x2 = last.x2 = bend;
  axis_caps(first, piece);
  axis_caps(last, piece);
  tip_cap(demand, first, piece);
  tip_cap(demand, last, piece);

  // Joints: the mean of q_ss over the blend is the change of q_s over its length; it varies by the part of
  // q_ss that is quadratic in the direction, which is q2 at either end.
  JointPoint joints;
  double du2 = 0;
  for (std::size_t i = 0; i < 3; ++i) du2 += (last.x1[i] - first.x1[i]) * (last.x1[i] - first.x1[i]);
  const double turn = std::min(1.0, 0.5 * du2);
  for (std::size_t j = 0; j < joints_; ++j) {
    const double mean = (end.joints.q1[j] - tail_.q1[j]) / geometry.length;
    const double vary = std::abs(end.joints.q2[j] - tail_.q2[j]) +
                        turn * std::max(std::abs(end.joints.q2[j]), std::abs(tail_.q2[j]));
    joints.q1[j] = std::max(std::abs(end.joints.q1[j]), std::abs(tail_.q1[j]));
    joints.q2[j] = std::abs(mean) + vary;
  }
  joint_caps(joints, piece);
  const double axis_accel = std::max({std::abs(bend[kA]), std::abs(bend[kC]), std::abs(bend[kE]),
                                      std::abs(first.x1[kA]), std::abs(first.x1[kC]), std::abs(first.x1[kE]),
                                      std::abs(last.x1[kA]), std::abs(last.x1[kC]), std::abs(last.x1[kE])});
  if (axis_accel > 0 || limited_xyz_ || joint_ratio(joints, piece) >= kNear) {
    begin_linear(piece);
    axis_accels(first, piece);
    axis_accels(last, piece);
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t j = 0; j < joints_; ++j) joints.q2[j] *= sign;
      joint_accels(joints, piece);
    }
  }
  tail_ = end.joints;
  lookahead_->add(piece);
  return {};
}

Result<void, PoseError> PathLimits::add_curve(const PieceDemand& demand) {
  const PathPiece& geometry = lookahead_->newest_geometry();
  tail_valid_ = false;
  PlanPiece piece;
  piece.line = demand.line;
  piece.length = geometry.length;
  bound_curve(demand, geometry, piece);

  // An arc may be long: then it is looked at in more places.
  const double angle = geometry.arc ? geometry.length * geometry.angle1_rad_per_mm : 0;
  const int looks = 2 + static_cast<int>(std::min(angle / kArcLook_rad, static_cast<double>(kMostParts)));
  double ratio = 0;
  Sample sample;
  for (int i = 0; i <= looks; ++i) {
    sample.pose = geometry.evaluate(geometry.length * i / looks);
    if (auto ok = evaluate(geometry.frame, sample); !ok) return ok;
    ratio = std::max(ratio, joint_ratio(sample.joints, piece));
  }
  const bool near = ratio >= kNear;
  // Where curvature or joints set the speed, it varies along the curve: parts of a share of the braking
  // distance.
  double part_mm = kFarLine_mm;
  const bool bent = piece.k2 * piece.cap * piece.cap > kBent * kBent * piece.accel * piece.accel;
  if (bent || near) {
    const double cap = near ? piece.cap / std::max(ratio, 1.0) : piece.cap;
    part_mm = std::max(kCurvePart * cap / (2 * piece.accel), kLeastPart_mm);
  }
  if (near) part_mm = std::min(part_mm, kNearLine_mm);
  const int parts = parts_for(geometry, part_mm, near ? kNearTurn_rad : kFarTurn_rad);
  if (!near && parts == 1) {
    lookahead_->add(piece);
    return {};
  }
  return add_curve_parts(demand, geometry, parts, near);
}

}  // namespace kinebus
