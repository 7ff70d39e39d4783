#include "gateway/jobs/print_trace.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

/// Less filament than this to a millimetre of way is none: a bead of 0.01 mm^2 takes 0.004.
constexpr double kExtrudes = 1e-3;
/// From point to point: the line between two is not farther from them than a cell is wide.
constexpr double kStep_mm = 0.8;
constexpr double kMostSteps = 1e6;

/// X Y Z alone of what a job has most of; else all there is.
bodies::Vec tip_at(const PathPiece& piece, double s) {
  if (piece.arc || piece.frame != Frame::kPart) return bodies::tip_on_table(piece.frame, piece.evaluate(s).x);
  const auto axis = [&](PoseAxis a) {
    const auto& c = piece.coefficients[a];
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
  };
  return {axis(kX), axis(kY), axis(kZ)};
}

}  // namespace

void trace_print(const Phase& phase, const PosePoint& end, bodies::PrintedPart& part) {
  Pose x1 = end.x1;
  // Where s is time, a phase may end at rest: the faster end tells the way.
  if (phase.timed) {
    const Pose begins = phase.piece.evaluate(phase.s0).x1;
    if (std::hypot(begins[kX], begins[kY], begins[kZ]) > std::hypot(x1[kX], x1[kY], x1[kZ])) x1 = begins;
  }
  double mm = std::sqrt(x1[kX] * x1[kX] + x1[kY] * x1[kY] + x1[kZ] * x1[kZ]);
  const Frame frame = phase.piece.frame;
  // The table turns under a tool that stands.
  if (frame == Frame::kMachine && (x1[kA] != 0 || x1[kC] != 0))
    mm += std::hypot(x1[kA], x1[kC]) * std::hypot(end.x[kX], end.x[kY], end.x[kZ]);
  if (!(x1[kE] > kExtrudes * mm && mm > 0)) return;
  const double to = phase.s(phase.duration_s), way = (to - phase.s0) * mm;
  const auto steps = static_cast<int>(std::min(way / kStep_mm, kMostSteps));
  for (int left = steps; left > 0; --left) part.add(tip_at(phase.piece, to - left * kStep_mm / mm));
  part.add(bodies::tip_on_table(frame, end.x));
}

}  // namespace kinebus
