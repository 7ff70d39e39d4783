#include "gateway/stream/tests/motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "gateway/gcode/canonical.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/planner.hpp"

namespace kinebus::testing {

namespace {

using Point = std::array<double, kPoseAxes>;

/// Accelerate, cruise, decelerate over `length` of one piece.
void trapezoid(std::vector<Phase>& out, Phase phase, double length, double v0, double v1, double v,
               double a) {
  v = std::min(v, std::sqrt(a * length + 0.5 * (v0 * v0 + v1 * v1)));
  const double up = std::max(0.0, (v * v - v0 * v0) / (2 * a)),
               down = std::max(0.0, (v * v - v1 * v1) / (2 * a));
  const auto add = [&](double from, double speed, double accel, double seconds) {
    if (seconds < 1e-9) return;
    phase.s0 = from;
    phase.v0 = speed;
    phase.a = accel;
    phase.duration_s = seconds;
    out.push_back(phase);
  };
  add(0, v0, a, (v - v0) / a);
  add(up, v, 0, (length - up - down) / v);
  add(length - down, v, -a, (v - v1) / a);
}

/// Where the lines end, and where the first begins.
std::vector<Point> corners(std::uint32_t seed, const PrintedLines& shape) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto count = static_cast<std::size_t>(shape.lines);
  std::vector<Point> points{Point{0, 0, 10, 0, 0, 0}};
  while (points.size() <= count) {
    Point p = points.back();
    const double length = shape.mean_length_mm * (0.1 + 1.8 * unit(random));
    const double angle = 2 * std::numbers::pi * unit(random);
    p[kX] += length * std::cos(angle);
    p[kY] += length * std::sin(angle);
    p[kE] += length * shape.extrusion * (0.5 + unit(random));
    if (std::hypot(p[kX], p[kY]) < shape.radius_mm) points.push_back(p);
  }
  return points;
}

}  // namespace

std::vector<Phase> printed_lines(std::uint32_t seed, const PrintedLines& shape) {
  const std::vector<Point> points = corners(seed, shape);
  const std::size_t count = points.size() - 1;
  std::vector<double> lengths(count), cut(count + 1, 0.0), speeds(count + 1, 0.0);
  std::vector<Point> tangents(count);
  for (std::size_t i = 0; i < count; ++i) {
    lengths[i] = std::hypot(points[i + 1][kX] - points[i][kX], points[i + 1][kY] - points[i][kY]);
    for (std::size_t k = 0; k < kPoseAxes; ++k)
      tangents[i][k] = (points[i + 1][k] - points[i][k]) / lengths[i];
  }
  const double a = shape.accel_mm_per_s2;
  for (std::size_t i = 1; i < count; ++i) {
    const double turn =
        std::hypot(tangents[i][kX] - tangents[i - 1][kX], tangents[i][kY] - tangents[i - 1][kY]) + 1e-9;
    const double length = std::min({8 * shape.blend_mm / turn, 0.9 * lengths[i], 0.9 * lengths[i - 1]});
    cut[i] = 0.5 * length;
    speeds[i] = std::min(shape.speed_mm_per_s, std::sqrt(a * length / turn));
  }
  const auto straight = [&](std::size_t i) { return lengths[i] - cut[i] - cut[i + 1]; };
  for (std::size_t i = 0; i < count; ++i)
    speeds[i + 1] = std::min(speeds[i + 1], std::sqrt(speeds[i] * speeds[i] + 2 * a * straight(i)));
  for (std::size_t i = count; i-- > 0;)
    speeds[i] = std::min(speeds[i], std::sqrt(speeds[i + 1] * speeds[i + 1] + 2 * a * straight(i)));

  std::vector<Phase> out;
  for (std::size_t i = 0; i < count; ++i) {
    Phase phase;
    phase.line = static_cast<std::uint32_t>(i + 1);
    phase.piece.length = straight(i);
    for (std::size_t k = 0; k < kPoseAxes; ++k)
      phase.piece.coefficients[k] = {points[i][k] + cut[i] * tangents[i][k], tangents[i][k], 0, 0};
    trapezoid(out, phase, straight(i), speeds[i], speeds[i + 1], shape.speed_mm_per_s, a);
    if (i + 1 == count) break;
    const double length = 2 * cut[i + 1];
    for (std::size_t k = 0; k < kPoseAxes; ++k)
      phase.piece.coefficients[k] = {points[i + 1][k] - cut[i + 1] * tangents[i][k], tangents[i][k],
                                     (tangents[i + 1][k] - tangents[i][k]) / (2 * length), 0};
    phase.piece.length = length;
    phase.s0 = phase.a = 0;
    phase.v0 = speeds[i + 1];
    phase.duration_s = length / speeds[i + 1];
    phase.line = static_cast<std::uint32_t>(i + 2);
    out.push_back(phase);
  }
  out.back().last = true;
  return out;
}

std::vector<Phase> eased_lines(const Kinematics& kinematics, std::uint32_t seed, const PrintedLines& shape,
                               double jerk_mm_per_s3) {
  MotionLimits limits;
  limits.tool_jerk_mm_per_s3 = jerk_mm_per_s3;
  for (std::size_t j = 0; j < kMaxJoints; ++j)
    limits.joint_jerk_per_s3[j] = jerk_mm_per_s3 * limits.joint_accel_per_s2[j] / limits.tool_accel_mm_per_s2;
  Planner planner(kinematics, limits);
  std::vector<Phase> out;
  Phase phase;
  std::uint32_t line = 0;
  bool taken = true;
  const auto add = [&](const canonical::Command& command) {
    taken = taken && planner.add({line++, command});
    while (planner.next(phase)) out.push_back(phase);
  };
  const std::vector<Point> points = corners(seed, shape);
  add(canonical::SetPosition{points.front(), Frame::kPart});
  for (std::size_t i = 1; i < points.size(); ++i)
    add(canonical::Feed{points[i], Frame::kPart, shape.speed_mm_per_s, 0});
  taken = taken && planner.finish();
  while (planner.next(phase)) out.push_back(phase);
  return taken ? out : std::vector<Phase>{};
}

std::vector<Phase> smooth_curve(std::uint32_t seed, const SmoothCurve& shape) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const double phase_x = 6 * unit(random), phase_y = 6 * unit(random);
  const double w = 1 / shape.radius_mm;
  // A circle with three lobes; its derivative never vanishes, and is scaled to a unit vector in XY below.
  const double big = 0.83 * shape.radius_mm, small = 0.17 * shape.radius_mm;
  const auto at = [&](double s) {
    return Point{big * std::cos(w * s) + small * std::cos(3 * w * s + phase_x),
                 big * std::sin(w * s) + small * std::sin(3 * w * s + phase_y),
                 10 + 0.01 * s,
                 shape.tilt_rad * std::sin(0.7 * w * s),
                 shape.turn_rad * std::sin(0.4 * w * s),
                 0.04 * s};
  };
  const auto slope = [&](double s) {
    return Point{-0.83 * std::sin(w * s) - 0.51 * std::sin(3 * w * s + phase_x),
                 0.83 * std::cos(w * s) + 0.51 * std::cos(3 * w * s + phase_y),
                 0.01,
                 shape.tilt_rad * 0.7 * w * std::cos(0.7 * w * s),
                 shape.turn_rad * 0.4 * w * std::cos(0.4 * w * s),
                 0.04};
  };
  std::vector<PathPiece> pieces;
  const double total = shape.seconds * shape.speed_mm_per_s;
  double s = 0;
  for (double length = 0; length < total;) {
    const Point p0 = at(s), d0 = slope(s);
    const double speed0 = std::hypot(d0[kX], d0[kY]);
    const double next = s + shape.piece_mm / speed0;
    const Point p1 = at(next), d1 = slope(next);
    const double speed1 = std::hypot(d1[kX], d1[kY]);
    PathPiece piece;
    piece.length = 0.5 * (next - s) * (speed0 + speed1);
    const double h = piece.length;
    for (std::size_t k = 0; k < kPoseAxes; ++k) {
      const double t0 = d0[k] / speed0, t1 = d1[k] / speed1, mean = (p1[k] - p0[k]) / h;
      piece.coefficients[k] = {p0[k], t0, (3 * mean - 2 * t0 - t1) / h, (t0 + t1 - 2 * mean) / (h * h)};
    }
    pieces.push_back(piece);
    length += h;
    s = next;
  }
  // One trapezoid over the whole chain, cut at the pieces' ends.
  double length = 0;
  for (const PathPiece& piece : pieces) length += piece.length;
  const double a = shape.accel_mm_per_s2, v = std::min(shape.speed_mm_per_s, std::sqrt(a * length));
  const double ramp = v * v / (2 * a);
  std::vector<Phase> out;
  double begin = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double end = begin + pieces[i].length;
    const std::array<double, 4> cuts{begin, std::clamp(ramp, begin, end),
                                     std::clamp(length - ramp, begin, end), end};
    for (std::size_t k = 0; k < 3; ++k) {
      const double from = cuts[k], to = cuts[k + 1];
      if (to - from < 1e-6) continue;
      const auto speed = [&](double x) {
        return std::min({v, std::sqrt(2 * a * x), std::sqrt(std::max(0.0, 2 * a * (length - x)))});
      };
      const double v0 = speed(from), v1 = speed(to);
      Phase phase{
          .piece = pieces[i], .s0 = from - begin, .v0 = v0, .line = static_cast<std::uint32_t>(i + 1)};
      phase.duration_s = 2 * (to - from) / (v0 + v1);
      phase.a = (v1 - v0) / phase.duration_s;
      out.push_back(phase);
    }
    begin = end;
  }
  out.back().last = true;
  return out;
}

std::vector<JointSpan> trapezoid_spans(double accel, double speed, double cruise_s) {
  const double ramp = speed / accel;
  std::vector<JointSpan> spans(3);
  spans[0].duration_s = spans[2].duration_s = ramp;
  spans[1].duration_s = cruise_s;
  spans[1].start_s = ramp;
  spans[2].start_s = ramp + cruise_s;
  double q = 600;
  spans[0].coefficients[0] = {q, 0, accel / 2, 0};
  q = spans[0].position(0, ramp);
  spans[1].coefficients[0] = {q, speed, 0, 0};
  q = spans[1].position(0, cruise_s);
  spans[2].coefficients[0] = {q, speed, -accel / 2, 0};
  spans[2].last = true;
  return spans;
}

std::vector<JointSpan> jumpy_spans(std::uint32_t seed, double accel, int count, double shortest_s,
                                   double longest_s) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<JointSpan> spans;
  double t = 0;
  std::array<double, 2> q{700, 640}, v{};
  for (int k = 0; k < count; ++k) {
    JointSpan span;
    span.start_s = t;
    span.duration_s = shortest_s * std::pow(longest_s / shortest_s, 0.5 + 0.5 * any(random));
    span.line = static_cast<std::uint32_t>(k + 1);
    const double h = span.duration_s;
    for (std::size_t j = 0; j < 2; ++j) {
      double a = accel * any(random), jerk = k % 3 == 0 ? (accel * any(random) - a) / h : 0;
      if (k + 1 == count) {  // the last span comes to rest
        span.duration_s = 0.1;
        a = -v[j] / 0.1;
        jerk = 0;
      } else if (std::abs(v[j] + a * h) > 200) {
        a = -std::copysign(a, v[j]);
        jerk = 0;
      }
      span.coefficients[j] = {q[j], v[j], a / 2, jerk / 6};
      q[j] = span.position(static_cast<int>(j), span.duration_s);
      v[j] = span.velocity(static_cast<int>(j), span.duration_s);
    }
    t += span.duration_s;
    spans.push_back(span);
  }
  spans.back().last = true;
  return spans;
}

}  // namespace kinebus::testing
