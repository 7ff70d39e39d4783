#include "gateway/shaping/tip_flow.hpp"

#include <cmath>

namespace kinebus {

bool moves_tip(const Phase& phase) {
  constexpr double kNoTipMotion = 1e-8;  // of moves without the tip
  const Pose along = phase.piece.evaluate(phase.s(0.5 * phase.duration_s)).x1;
  return std::hypot(along[kX], along[kY], along[kZ]) > kNoTipMotion;
}

void TipFlow::add(const std::array<double, 3>& weight, const Phase& phase, double t) {
  const double s = phase.s(t), rate = phase.speed(t), accel = phase.accel(t);
  const PosePoint p = phase.piece.evaluate(s);
  const double square = p.x1[kX] * p.x1[kX] + p.x1[kY] * p.x1[kY] + p.x1[kZ] * p.x1[kZ];
  if (!(square > 0)) return;
  const double length = std::sqrt(square);
  const double along = p.x1[kX] * p.x2[kX] + p.x1[kY] * p.x2[kY] + p.x1[kZ] * p.x2[kZ];
  // Filament on a millimetre of way, and how that changes along s.
  const double per_mm = p.x1[kE] / length, per_mm1 = (p.x2[kE] - p.x1[kE] * along / square) / length;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] += weight[i] * per_mm * p.x1[i] * rate;
    v1[i] +=
        weight[i] * (per_mm * (p.x2[i] * rate * rate + p.x1[i] * accel) + per_mm1 * p.x1[i] * rate * rate);
  }
}

double TipFlow::rate() const {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double TipFlow::change() const {
  const double now = rate();
  return now > 0 ? (v[0] * v1[0] + v[1] * v1[1] + v[2] * v1[2]) / now : 0;
}

}  // namespace kinebus
