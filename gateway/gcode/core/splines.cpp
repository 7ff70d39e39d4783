// G5 and G5.1: Bezier curves of the third and second degree, flattened to lines.

#include <algorithm>
#include <cmath>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/curves/arc.hpp"
#include "gateway/gcode/curves/nurbs.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kMaxPieces = 20'000;
constexpr int kNoteForSpline = 101000;

}  // namespace

bool Core::run_spline(Code code) {
  if (block_.present == 0 && !options_.spindle) {
    // Some printers: going on after a loss of power.
    note(kNoteForSpline + code.number, say("%1 has no effect on this machine", g_name(code.number)));
    return true;
  }
  ModalState& m = state_.modal;
  const std::string name = g_name(code.number);
  const bool cubic = code.number == 50;
  if (m.plane != Plane::kXy) return fail(code.column, say("%1 needs the plane XY (G17)", name));
  if (m.inverse_time) return fail(code.column, say("%1 needs feed per minute (G94)", name));
  if (!m.feed_known) return fail(code.column, say("no feed rate is set: this move needs F"));
  for (const char letter : {'A', 'C'})
    if (has(letter)) return fail(block_.column_of(letter), say("%1 has no place in a spline", letter));
  double i = 0, j = 0, p = 0, q = 0;
  const bool starts = has('I') || has('J');
  if (has('I') != has('J') || (!starts && (!cubic || !m.spline)))
    return fail(code.column, say("%1 needs I and J", name));
  if (cubic && (!has('P') || !has('Q'))) return fail(code.column, say("%1 needs P and Q", name));
  if (!take_if_given('I', i) || !take_if_given('J', j)) return false;
  if (cubic && (!take('P', p) || !take('Q', q))) return false;
  for (const char letter : kAxisLetters)
    if ((block_.present & ~used_ & block_.bare & Block::bit(letter)) != 0)
      return fail(block_.column_of(letter), say("%1 needs a number", letter));
  const Pose from = m.program;
  Pose to = from;
  program_target(to);
  std::array<std::array<double, 2>, 4> b{};
  b[0] = {from[kAxisX], from[kAxisY]};
  b[3] = {to[kAxisX], to[kAxisY]};
  if (cubic) {
    b[1] = starts ? Point2{b[0][0] + length(i), b[0][1] + length(j)}
                  : Point2{b[0][0] - m.spline_end_mm[0], b[0][1] - m.spline_end_mm[1]};
    b[2] = {b[3][0] + length(p), b[3][1] + length(q)};
  } else {
    const Point2 middle = {b[0][0] + length(i), b[0][1] + length(j)};
    for (std::size_t k = 0; k < 2; ++k) {
      b[1][k] = b[0][k] + (middle[k] - b[0][k]) * 2 / 3;
      b[2][k] = b[3][k] + (middle[k] - b[3][k]) * 2 / 3;
    }
  }
  // A chord over 1/n of the parameter is off by at most the second derivative / (8 n^2), and that derivative
  // is greatest at an end.
  const auto bend = [&](std::size_t k) {
    return 6 * std::hypot(b[k][0] - 2 * b[k + 1][0] + b[k + 2][0], b[k][1] - 2 * b[k + 1][1] + b[k + 2][1]);
  };
  const double pieces = std::ceil(std::sqrt(std::max(bend(0), bend(1)) / (8 * kSplineFlatness_mm)));
  if (!(pieces <= kMaxPieces)) return fail(code.column, say("the spline is too large"));
  const int n = std::max(1, static_cast<int>(pieces));
  for (int piece = 1; piece <= n; ++piece) {
    const double t = static_cast<double>(piece) / n, s = 1 - t;
    Pose program = from;
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      program[axis] = piece == n ? to[axis] : from[axis] + (to[axis] - from[axis]) * t;
    if (piece != n)
      for (std::size_t k = 0; k < 2; ++k)
        program[k] =
            s * s * s * b[0][k] + 3 * s * s * t * b[1][k] + 3 * s * t * t * b[2][k] + t * t * t * b[3][k];
    const Pose target = canonical_pose(program);
    emit(canonical::Feed{target, m.frame, m.feed_mm_per_s * m.feed_ratio, 0});
    m.position = target;
    m.e_max_mm = std::max(m.e_max_mm, target[kAxisE]);
  }
  m.program = to;
  used_ |= block_.present & (Block::bit('X') | Block::bit('Y') | Block::bit('Z') | Block::bit('E'));
  m.spline = cubic;
  m.spline_end_mm = {length(p), length(q)};
  return true;
}

}  // namespace kinebus::gcode
