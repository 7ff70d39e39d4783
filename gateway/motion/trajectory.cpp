#include "gateway/motion/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/motion/speed_ramp.hpp"

namespace kinebus {

PosePoint PathPiece::evaluate(double s) const {
  PosePoint p;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    const auto& c = coefficients[i];
    p.x[i] = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
    p.x1[i] = c[1] + s * (2 * c[2] + s * 3 * c[3]);
    p.x2[i] = 2 * c[2] + 6 * c[3] * s;
  }
  if (arc) {
    const double angle = angle0_rad + s * angle1_rad_per_mm;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const double w = angle1_rad_per_mm;
    for (std::size_t i = 0; i < 3; ++i) {
      const double radial = radius_mm * (u[i] * cosine + v[i] * sine);
      p.x[i] += radial;
      p.x1[i] += radius_mm * w * (v[i] * cosine - u[i] * sine);
      p.x2[i] -= w * w * radial;
    }
  }
  return p;
}

std::array<double, 3> PathPiece::third_derivative(double s) const {
  std::array<double, 3> x3{6 * coefficients[0][3], 6 * coefficients[1][3], 6 * coefficients[2][3]};
  if (arc) {
    const double w = angle1_rad_per_mm, angle = angle0_rad + s * w;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (std::size_t i = 0; i < 3; ++i) x3[i] -= radius_mm * w * w * w * (v[i] * cosine - u[i] * sine);
  }
  return x3;
}

PosePoint Phase::at(double t) const {
  PosePoint p = piece.evaluate(s(t));
  const double rate = speed(t), now = accel(t);
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    p.x2[i] = p.x2[i] * rate * rate + p.x1[i] * now;
    p.x1[i] *= rate;
  }
  return p;
}

double Phase::pose_speed(double t) const {
  if (!timed) return std::abs(speed(t));
  double fastest = 0;
  for (const double x1 : at(t).x1) fastest = std::max(fastest, std::abs(x1));
  return fastest;
}

double time_at(const Phase& phase, double s) {
  const double way = std::max(0.0, s - phase.s0);
  if (phase.jerk != 0) return SpeedRamp::Stage{phase.duration_s, phase.v0, phase.a, phase.jerk}.time_of(way);
  const double speed = std::sqrt(std::max(0.0, phase.v0 * phase.v0 + 2 * phase.a * way));
  const double sum = phase.v0 + speed;
  return sum > 0 ? std::min(phase.duration_s, 2 * way / sum) : 0;
}

}  // namespace kinebus
