#include "gateway/shaping/tip_flow.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {

bool feeds_along_tip(const Phase& phase) {
  double most = 0, fastest = 0;
  // A blend into a wipe feeds at one end only, and in that of a full turn the tip halts in the middle.
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Pose along = phase.piece.evaluate(phase.s(t * phase.duration_s)).x1;
    most = std::max(most, along[kE]);
    fastest = std::max(fastest, std::hypot(along[kX], along[kY], along[kZ]));
  }
  constexpr double kNoTipMotion = 1e-8;  // of moves without the tip
  return most > 0 && fastest > kNoTipMotion;
}

void TipFlow::add(const std::array<double, 3>& weight, const Phase& phase, double t) {
  const double s = phase.s(t), rate = phase.speed(t), accel = phase.accel(t);
  const PosePoint p = phase.piece.evaluate(s);
  const double length = std::hypot(p.x1[kX], p.x1[kY], p.x1[kZ]);
  // E' and E''.
  const double fed = p.x1[kE] * rate, fed1 = p.x2[kE] * rate * rate + p.x1[kE] * accel;
  // Along straights and arcs all of it: s is their way. In a blend of a sharp turn the tip nearly halts.
  const double share = fed > 0 ? 1 : 0;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] += share * weight[i] * fed * p.x1[i];
    v1[i] += share * weight[i] * (fed1 * p.x1[i] + fed * p.x2[i] * rate);
  }
  const double along = p.x1[kX] * p.x2[kX] + p.x1[kY] * p.x2[kY] + p.x1[kZ] * p.x2[kZ];
  const double mean = (weight[0] + weight[1] + weight[2]) / 3;
  apart += mean * fed * (1 - share * length);
  apart1 += mean * (fed1 * (1 - share * length) - (length > 0 ? share * fed * along / length * rate : 0));
}

double TipFlow::rate() const {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double TipFlow::change() const {
  const double now = rate();
  return now > 0 ? (v[0] * v1[0] + v[1] * v1[1] + v[2] * v1[2]) / now : 0;
}

}  // namespace kinebus
