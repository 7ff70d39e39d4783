#include "gateway/motion/path_limits.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace kinebus {
namespace {

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
// Stretch on either side of a jump of the curvature over which the joints' third derivative is taken.
constexpr double kJumpLook_mm = 0.01;
int parts_for(const PathPiece& piece, double part_mm, double part_rad) {
  const double turn = std::max(std::abs(piece.coefficients[kA][1]), std::abs(piece.coefficients[kC][1]));
  const double parts = piece.length * std::max(1 / part_mm, turn / part_rad);
  return static_cast<int>(std::clamp(std::ceil(parts), 1.0, static_cast<double>(kMostParts)));
}

/// Bounds over a stretch of a piece, whose derivatives vary little on it.
JerkTerms jerk_terms(const PathPiece& geometry, double from, double to) {
  JerkTerms terms{.x1 = 0, .along2 = 0, .along3 = 0, .across3 = 0};
  double least_e = 0, most_e = 0;
  for (const double s : {from, 0.5 * (from + to), to}) {
    const PosePoint p = geometry.evaluate(s);
    const auto third = geometry.third_derivative(s);
    const Pose x3{third[0], third[1], third[2]};
    const double size1 = dot3(p.x1, p.x1), size2 = dot3(p.x2, p.x2), size3 = dot3(x3, x3);
    terms.x1 = std::max(terms.x1, size1);
    terms.x2 = std::max(terms.x2, size2);
    terms.x3 = std::max(terms.x3, size3);
    const auto along = [&](const Pose& x, double size) {
      const double dot = dot3(x, p.x1);
      return size * size1 > 0 ? std::min(dot * dot / (size * size1), 1.0) : 0.0;
    };
    terms.along2 = std::max(terms.along2, along(p.x2, size2));
    terms.along3 = std::max(terms.along3, along(x3, size3));
    if (size3 > 0) terms.across3 = std::max(terms.across3, 1 - along(x3, size3));
    terms.e1 = std::max(terms.e1, std::abs(p.x1[kE]));
    terms.e2 = std::max(terms.e2, std::abs(p.x2[kE]));
    terms.e3 = std::max(terms.e3, std::abs(6 * geometry.coefficients[kE][3]));
    least_e = std::min(least_e, p.x1[kE]);
    most_e = std::max(most_e, p.x1[kE]);
  }
  if (least_e < 0 && most_e > 0) terms.e_jump = 0.5 * terms.e2;
  for (double* term : {&terms.x1, &terms.x2, &terms.x3, &terms.along2, &terms.along3, &terms.across3})
    *term = std::sqrt(*term);
  return terms;
}

JerkTerms line_terms(double tool_rate, const PathPiece& line) {
  return {.x1 = tool_rate, .e1 = std::abs(line.coefficients[kE][1])};
}

/// Between two places `length` apart.
JointJerkTerms joint_terms(const JointPoint& before, const JointPoint& after, double length) {
  JointJerkTerms terms;
  for (std::size_t j = 0; j < kMaxJoints; ++j) {
    terms.q1[j] = std::max(std::abs(before.q1[j]), std::abs(after.q1[j]));
    terms.q2[j] = std::max(std::abs(before.q2[j]), std::abs(after.q2[j]));
    terms.q3[j] = std::abs(after.q2[j] - before.q2[j]) / length;
  }
  return terms;
}

}  // namespace

PathLimits::PathLimits(const Kinematics& kinematics, const MotionLimits& limits, Lookahead& lookahead)
    : kinematics_(&kinematics),
      limits_(static_cast<std::size_t>(kinematics.joint_count()), limits),
      lookahead_(&lookahead),
      joints_(static_cast<std::size_t>(kinematics.joint_count())) {}

Result<void, PoseError> PathLimits::evaluate(Frame frame, Sample& sample) const {
  return kinematics_->inverse_along(frame, sample.pose, sample.joints);
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

/// Terms where newest geometry begins, of the pieces on both sides and of the jump between them. False: a
/// pose cannot be reached.
bool PathLimits::jump_terms(const PathPiece& geometry, JerkTerms& terms, JointJerkTerms& joints) const {
  const JerkTerms one = jerk_terms(before_, before_.length, before_.length), two = jerk_terms(geometry, 0, 0);
  terms = {std::max(one.x1, two.x1), std::max(one.x2, two.x2), std::max(one.x3, two.x3)};
  terms.e1 = std::max(one.e1, two.e1);
  terms.e2 = std::max(one.e2, two.e2);
  terms.e3 = std::max(one.e3, two.e3);
  const double back = std::min(kJumpLook_mm, before_.length), on = std::min(kJumpLook_mm, geometry.length);
  Sample far_before, before, after, far_after;
  far_before.pose = before_.evaluate(before_.length - back);
  before.pose = before_.evaluate(before_.length);
  after.pose = geometry.evaluate(0);
  far_after.pose = geometry.evaluate(on);
  for (Sample* sample : {&far_before, &before, &after, &far_after})
    if (!evaluate(geometry.frame, *sample)) return false;
  const JointJerkTerms left = joint_terms(far_before.joints, before.joints, back);
  const JointJerkTerms right = joint_terms(after.joints, far_after.joints, on);
  double jump2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double jump = after.pose.x2[i] - before.pose.x2[i];
    jump2 += jump * jump;
  }
  terms.jump = std::sqrt(jump2);
  terms.e_jump = std::abs(after.pose.x2[kE] - before.pose.x2[kE]);
  for (std::size_t j = 0; j < joints_; ++j) {
    joints.q1[j] = std::max(left.q1[j], right.q1[j]);
    joints.q2[j] = std::max(left.q2[j], right.q2[j]);
    joints.q3[j] = std::max(left.q3[j], right.q3[j]);
    joints.jump[j] = std::abs(after.joints.q2[j] - before.joints.q2[j]);
  }
  return true;
}

/// Where jerk is limited: what a jump of the curvature at the start of newest geometry allows.
void PathLimits::begin_jerk(const PieceDemand& demand, const PathPiece& geometry) {
  if (!limits_.limits_jerk()) return;
  PlanPiece place;
  place.line = demand.line;
  const Pose bend = before_.length > 0 ? before_.evaluate(before_.length).x2 : Pose{};
  place.cap = limits_.jump_cap(bend, geometry.evaluate(0).x2);
  if (place.cap < kNoAccel) {
    JerkTerms terms;
    JointJerkTerms joints;
    place.accel = kNoAccel;
    place.touch_jerk = kNoAccel * kNoAccel;
    place.even.fill({kNoAccel, place.touch_jerk});
    place.ramp_cap = place.cap;
    if (before_.length > 0 && before_.frame == geometry.frame && jump_terms(geometry, terms, joints))
      limits_.limit_jerk(terms, &joints, place);
    lookahead_->add(place);
  }
  before_ = geometry;
}

void PathLimits::put(const JerkTerms& terms, const JointJerkTerms* joints, PlanPiece& piece) {
  if (limits_.limits_jerk()) limits_.limit_jerk(terms, joints, piece);
  lookahead_->add(piece);
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
    limits_.bound_curve(demand, geometry, part);
    if (near) {
      after.pose = geometry.evaluate(part.s0 + part.length);
      if (auto ok = evaluate(geometry.frame, after); !ok) return ok;
      limits_.add_joints(before.joints, after.joints, part);
    }
    if (limits_.limits_jerk()) {
      const JointJerkTerms joints =
          near ? joint_terms(before.joints, after.joints, part.length) : JointJerkTerms{};
      put(jerk_terms(geometry, part.s0, part.s0 + part.length), near ? &joints : nullptr, part);
    } else {
      lookahead_->add(part);
    }
    before = after;
  }
  return {};
}

/// Adds a line in equal parts, with the joints' terms at both ends of each.
Result<void, PoseError> PathLimits::add_line_parts(const PieceDemand& demand, const PathPiece& geometry,
                                                   const PlanPiece& whole, double tool_rate, int parts) {
  Sample before, after;
  before.pose = geometry.evaluate(0);
  if (auto ok = evaluate(geometry.frame, before); !ok) return ok;
  for (int i = 0; i < parts; ++i) {
    PlanPiece part = whole;
    part.s0 = geometry.length * i / parts;
    part.length = geometry.length * (i + 1) / parts - part.s0;
    after.pose = geometry.evaluate(part.s0 + part.length);
    if (auto ok = evaluate(geometry.frame, after); !ok) return ok;
    limits_.tip_cap(demand, before.pose, part);
    limits_.tip_cap(demand, after.pose, part);
    limits_.add_joints(before.joints, after.joints, part);
    if (limits_.limits_jerk()) {
      const JointJerkTerms joints = joint_terms(before.joints, after.joints, part.length);
      put(line_terms(tool_rate, geometry), &joints, part);
    } else {
      lookahead_->add(part);
    }
    before = after;
  }
  return {};
}

Result<void, PoseError> PathLimits::add_line(const PieceDemand& demand) {
  const PathPiece& geometry = lookahead_->newest_geometry();
  if (auto ok = start_of_line(geometry); !ok) return ok;
  begin_jerk(demand, geometry);
  PosePoint direction;
  for (std::size_t i = 0; i < kPoseAxes; ++i) direction.x1[i] = geometry.coefficients[i][1];
  const double tool_rate = std::sqrt(dot3(direction.x1, direction.x1));

  PlanPiece piece;
  piece.line = demand.line;
  piece.length = geometry.length;
  limits_.set_cap(demand, tool_rate, piece);
  limits_.axis_caps(direction, piece);
  piece.accel = tool_rate > 0 ? demand.accel_mm_per_s2 / tool_rate : kNoAccel;
  limits_.limit_straight_accel(direction, piece);

  const int far_parts = parts_for(geometry, kFarLine_mm, kFarTurn_rad);
  double ratio = limits_.joint_ratio(tail_, piece);
  const bool jerk = limits_.limits_jerk();
  PlanPiece even = piece;
  const JerkTerms terms = line_terms(tool_rate, geometry);
  if (jerk) limits_.limit_jerk(terms, nullptr, even);
  JointPoint before = tail_;
  Sample end;
  for (int i = 1; i <= far_parts; ++i) {
    end.pose = geometry.evaluate(geometry.length * i / far_parts);
    if (auto ok = evaluate(geometry.frame, end); !ok) return ok;
    ratio = std::max(ratio, limits_.joint_ratio(end.joints, piece));
    if (jerk) {
      const JointJerkTerms joints = joint_terms(before, end.joints, geometry.length / far_parts);
      ratio = std::max(ratio, limits_.joint_jerk_ratio(joints, even));
      before = end.joints;
    }
  }
  const bool turning_feed = demand.tip_feed && far_parts > 1;
  tail_ = end.joints;
  if (ratio < kNear && !turning_feed) {
    if (demand.tip_feed) {
      limits_.tip_cap(demand, geometry.evaluate(0), piece);
      limits_.tip_cap(demand, end.pose, piece);
    }
    put(terms, nullptr, piece);
    return {};
  }
  return add_line_parts(demand, geometry, piece, tool_rate, parts_for(geometry, kNearLine_mm, kNearTurn_rad));
}

Result<void, PoseError> PathLimits::add_parabola(const PieceDemand& demand) {
  const PathPiece& geometry = lookahead_->newest_geometry();
  if (auto ok = start_of_line(geometry); !ok) return ok;
  const PosePoint start = geometry.evaluate(0);
  Sample end;
  end.pose = geometry.evaluate(geometry.length);
  const Pose bend = end.pose.x2;
  end.pose.x2 = {};
  if (auto ok = evaluate(geometry.frame, end); !ok) return ok;

  // |x_s| is convex along a parabola, and x_s . x_ss linear: both are greatest at an end.
  const double w = std::max(std::sqrt(dot3(start.x1, start.x1)), std::sqrt(dot3(end.pose.x1, end.pose.x1)));
  PlanPiece piece;
  piece.line = demand.line;
  piece.length = geometry.length;
  limits_.set_cap(demand, w, piece);
  piece.curved = true;
  piece.accel = demand.accel_mm_per_s2;
  PosePoint first = start, last = end.pose;
  first.x2 = last.x2 = bend;
  limits_.bound_flow(first, piece);
  limits_.bound_flow(last, piece);
  piece.k2 = dot3(bend, bend);
  piece.c = std::max(std::abs(dot3(bend, start.x1)), std::abs(dot3(bend, end.pose.x1)));
  piece.w2 = std::max(w * w, 1e-12);
  if (piece.k2 * piece.cap * piece.cap > piece.accel * piece.accel)
    piece.cap = piece.accel / std::sqrt(piece.k2);
  limits_.axis_caps(first, piece);
  limits_.axis_caps(last, piece);
  limits_.tip_cap(demand, first, piece);
  limits_.tip_cap(demand, last, piece);

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
  limits_.joint_caps(joints, piece);
  const double axis_accel = std::max({std::abs(bend[kA]), std::abs(bend[kC]), std::abs(bend[kE]),
                                      std::abs(first.x1[kA]), std::abs(first.x1[kC]), std::abs(first.x1[kE]),
                                      std::abs(last.x1[kA]), std::abs(last.x1[kC]), std::abs(last.x1[kE])});
  if (axis_accel > 0 || limits_.limits_xyz() || limits_.joint_ratio(joints, piece) >= kNear) {
    allow_any_acceleration(piece);
    limits_.axis_accels(first, piece);
    limits_.axis_accels(last, piece);
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t j = 0; j < joints_; ++j) joints.q2[j] *= sign;
      limits_.joint_accels(joints, piece);
    }
  }
  tail_ = end.joints;
  lookahead_->add(piece);
  return {};
}

Result<void, PoseError> PathLimits::add_curve(const PieceDemand& demand) {
  const PathPiece& geometry = lookahead_->newest_geometry();
  tail_valid_ = false;
  begin_jerk(demand, geometry);
  PlanPiece piece;
  piece.line = demand.line;
  piece.length = geometry.length;
  limits_.bound_curve(demand, geometry, piece);

  // An arc may be long: then it is looked at in more places.
  const double angle = geometry.arc ? geometry.length * geometry.angle1_rad_per_mm : 0;
  const int looks = 2 + static_cast<int>(std::min(angle / kArcLook_rad, static_cast<double>(kMostParts)));
  double ratio = 0;
  Sample sample, before;
  const bool jerk = limits_.limits_jerk();
  JerkTerms terms;
  if (jerk) {
    terms = jerk_terms(geometry, 0, geometry.length);
    limits_.limit_jerk(terms, nullptr, piece);
  }
  for (int i = 0; i <= looks; ++i) {
    sample.pose = geometry.evaluate(geometry.length * i / looks);
    if (auto ok = evaluate(geometry.frame, sample); !ok) return ok;
    ratio = std::max(ratio, limits_.joint_ratio(sample.joints, piece));
    if (!jerk) continue;
    if (i > 0) {
      const JointJerkTerms joints = joint_terms(before.joints, sample.joints, geometry.length / looks);
      ratio = std::max(ratio, limits_.joint_jerk_ratio(joints, piece));
    }
    before = sample;
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
    put(terms, nullptr, piece);
    return {};
  }
  return add_curve_parts(demand, geometry, parts, near);
}

}  // namespace kinebus
