#include "gateway/motion/phase_emitter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kinebus {
namespace {

// A peak within a piece that gains less speed (squared) than this is not worth two more phases on the wire:
// it would save less than half a percent of the piece's time.
constexpr double kWorthwhilePeak = 0.01;

double length_used(const PlanPiece& piece, double x0, double x1, double peak) {
  double used = 0;
  if (peak > x0) used += (peak - x0) / (2 * piece.accel_between(x0, peak));
  if (peak > x1) used += (peak - x1) / (2 * piece.decel_between(x1, peak));
  return used;
}

/// Greatest speed between the ends that still leaves room to slow down; on the feasible side.
double peak_speed(const PlanPiece& piece, double x0, double x1) {
  const double floor = std::max(x0, x1);
  if (length_used(piece, x0, x1, piece.cap) <= piece.length) return piece.cap;
  if (!piece.curved && !piece.linear) {
    return std::clamp(0.5 * (x0 + x1) + piece.accel * piece.length, floor, piece.cap);
  }
  double low = floor, high = std::min(piece.cap, floor + piece.greatest_accel(floor) * piece.length);
  // 12 halvings: the peak to 1/4096 of what there is to gain; more only where the ends are at rest, and the
  // piece would not be passed at all.
  for (int i = 0; i < 12 || (low == 0 && i < 200); ++i) {
    const double middle = 0.5 * (low + high);
    (length_used(piece, x0, x1, middle) <= piece.length ? low : high) = middle;
  }
  return low;
}

}  // namespace

void PhaseEmitter::append(double distance, double x0, double x1) {
  parts_[count_++] = {distance, std::sqrt(x0), std::sqrt(x1)};
}

void PhaseEmitter::start(const Lookahead::Step& step) {
  const PlanPiece& piece = *step.piece;
  const double x0 = step.x_start, x1 = step.x_end, length = step.length;
  index_ = count_ = 0;
  s_ = piece.s0;
  line_ = piece.line;
  last_ = step.last;
  geometry_ = step.geometry;

  const double higher = std::max(x0, x1);
  double peak = higher;
  if (piece.cap > higher * (1 + kWorthwhilePeak)) {
    // Even with full acceleration to the middle there may be nothing to gain: cheaper to see than the peak
    // itself.
    const double bound = higher + piece.greatest_accel(higher) * length;
    if (bound > higher * (1 + kWorthwhilePeak)) peak = peak_speed(piece, x0, x1);
  }
  if (peak <= higher * (1 + kWorthwhilePeak) && higher > 0 && x0 != x1) {
    // Also when one end is at the cap: a constant acceleration over less than the whole piece is only better
    // by the little that cruising at the higher end saves.
    const double ramp = length_used(piece, x0, x1, higher);
    if (ramp > 0.9 * length || higher < 1.05 * std::min(x0, x1)) {
      append(length, x0, x1);
      return;
    }
    peak = higher;
  }
  if (peak == x0 && peak == x1) {
    append(length, x0, x1);
    return;
  }
  double up = peak > x0 ? (peak - x0) / (2 * piece.accel_between(x0, peak)) : 0;
  double down = peak > x1 ? (peak - x1) / (2 * piece.decel_between(x1, peak)) : 0;
  double cruise = length - up - down;
  if (cruise < 1e-6 * length) {
    // Rounding, or nothing worth a phase: shared out to the ramps, where it lowers their acceleration.
    const double scale = length / (up + down);
    up *= scale;
    down *= scale;
    cruise = 0;
  }
  if (up > 0) append(up, x0, peak);
  if (cruise > 0) append(cruise, peak, peak);
  if (down > 0) append(down, peak, x1);
}

double PhaseEmitter::left_s() const {
  double left = 0;
  for (int i = index_; i < count_; ++i) left += 2 * parts_[i].distance / (parts_[i].v0 + parts_[i].v1);
  return left;
}

bool PhaseEmitter::next(Phase& phase) {
  if (index_ == count_) return false;
  const Part& part = parts_[index_++];
  phase.piece = *geometry_;
  phase.s0 = s_;
  phase.v0 = part.v0;
  phase.duration_s = 2 * part.distance / (part.v0 + part.v1);
  phase.a = (part.v1 - part.v0) / phase.duration_s;
  phase.line = line_;
  phase.last = last_ && index_ == count_;
  s_ += part.distance;
  assert(std::isfinite(phase.duration_s) && phase.duration_s > 0);
  return true;
}

}  // namespace kinebus
