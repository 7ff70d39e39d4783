#include "gateway/motion/line_merger.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/motion/corner_blend.hpp"

namespace kinebus {
namespace {

constexpr double kLongestLine_mm = 3.0;
constexpr double kGreatestLengthRatio = 4.0;
constexpr double kLeastCosine = 0.95;  // a turn of 18 degrees from line to line
// The cubic between two neighbouring midpoints passes their vertex at turn * length / 8. Half the tolerance
// for this, a tenth for each smoothed direction at its ends: always within the tolerance, so that a run never
// fails.
constexpr double kVertexShare = 0.5;
constexpr double kDirectionShare = 0.1;
constexpr double kSpanShare = 0.6;
// A cubic of unit slope at one end and a slope error d at the other deviates by at most 4/27 of d times its
// length.
constexpr double kSlopeToDeviation = 4.0 / 27.0;
// Longest distance between midpoints of neighbours, in lengths of the shorter one.
constexpr double kLongestPair = 0.5 * (1 + kGreatestLengthRatio);
// How far a direction looks to either side: rounding to 1 um is 1 mrad then.
constexpr double kDirectionWindow_mm = 0.6;

}  // namespace

bool may_merge(const Move& before, const Move& after, const MotionLimits& limits) {
  if (before.arc || after.arc || before.exact || after.exact || !before.tool_motion || !after.tool_motion)
    return false;
  const double longer = std::max(before.length, after.length),
               shorter = std::min(before.length, after.length);
  if (longer > kLongestLine_mm || longer > kGreatestLengthRatio * shorter) return false;
  if (before.merge_tolerance_mm != after.merge_tolerance_mm || !(after.merge_tolerance_mm > 0) ||
      before.traverse != after.traverse || before.accel_mm_per_s2 != after.accel_mm_per_s2)
    return false;
  if (std::abs(before.speed - after.speed) > 0.1 * before.speed && before.speed != after.speed) return false;
  if (dot_xyz(before.u, after.u) < kLeastCosine) return false;
  const double tolerance = after.merge_tolerance_mm;
  const double share = 8 * kVertexShare / longer;
  double bend2 = 0;
  for (std::size_t i = 0; i < 3; ++i) bend2 += (after.u[i] - before.u[i]) * (after.u[i] - before.u[i]);
  if (bend2 > share * share * tolerance * tolerance) return false;
  const double e0 = before.u[kE], e1 = after.u[kE];
  if (std::abs(e1 - e0) >
      std::min(0.1 * std::max(std::abs(e0), std::abs(e1)) + 0.002, share * limits.blend_tolerance_e_mm)) {
    return false;
  }
  const double turn = std::max(std::abs(after.u[kA] - before.u[kA]), std::abs(after.u[kC] - before.u[kC]));
  return turn == 0 || turn <= share * rotation_tolerance_rad(after.frame, after.from, tolerance, limits);
}

void LineMerger::begin(const GrowingRing<Move>& moves, std::uint64_t first) {
  run_first_ = knot_ = first;
  direction_ = moves[first].u;
}

Pose LineMerger::direction(const GrowingRing<Move>& moves, std::uint64_t line, std::uint64_t run_end) const {
  const Move& move = moves[line];
  const std::uint64_t room =
      std::min({kDirectionLines, line - std::max(run_first_, moves.begin()), run_end - line});
  double before = 0.5 * move.length, after = before;
  std::uint64_t reach = 0;
  while (reach < room && before < kDirectionWindow_mm) {
    ++reach;
    before += moves[line - reach].length;
    after += moves[line + reach].length;
  }
  if (reach == 0) return move.u;
  const Pose& first = moves[line - reach].from;
  const Pose& last = moves[line + reach].to;
  Pose t;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    // Exact for a parabola, also when the lines differ in length.
    const double middle = 0.5 * (move.from[i] + move.to[i]);
    t[i] = ((middle - first[i]) * after / before + (last[i] - middle) * before / after) / (before + after);
  }
  const double scale = 1 / norm_xyz(t);
  for (std::size_t i = 0; i < 3; ++i) t[i] *= scale;
  double off2 = 0;
  for (std::size_t i = 0; i < 3; ++i) off2 += (t[i] - move.u[i]) * (t[i] - move.u[i]);
  const double allowed = kDirectionShare / (kSlopeToDeviation * kLongestPair * move.length);
  const double rotation = std::max(std::abs(t[kA] - move.u[kA]), std::abs(t[kC] - move.u[kC]));
  if (off2 > allowed * allowed * move.merge_tolerance_mm * move.merge_tolerance_mm ||
      std::abs(t[kE] - move.u[kE]) > allowed * limits_->blend_tolerance_e_mm ||
      (rotation > 0 && rotation > allowed * rotation_tolerance_rad(move.frame, move.from,
                                                                   move.merge_tolerance_mm, *limits_))) {
    return move.u;
  }
  return t;
}

void LineMerger::span(const GrowingRing<Move>& moves, std::uint64_t end, std::uint64_t run_end,
                      PathPiece& piece, Pose& end_direction) const {
  end_direction = direction(moves, end, run_end);
  Pose x0, x1;
  const Move &first = moves[knot_], &last = moves[end];
  double length = 0.5 * (first.length + last.length);
  for (std::uint64_t i = knot_ + 1; i < end; ++i) length += moves[i].length;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    x0[i] = 0.5 * (first.from[i] + first.to[i]);
    x1[i] = 0.5 * (last.from[i] + last.to[i]);
  }
  hermite_piece(x0, direction_, x1, end_direction, length, piece);
}

bool LineMerger::fits(const GrowingRing<Move>& moves, std::uint64_t end, const PathPiece& piece) const {
  const Move& first = moves[knot_];
  const double share2 = kSpanShare * kSpanShare;
  const double xyz2 = share2 * first.merge_tolerance_mm * first.merge_tolerance_mm;
  const double e = kSpanShare * limits_->blend_tolerance_e_mm;
  const double rotation =
      kSpanShare * rotation_tolerance_rad(first.frame, first.from, first.merge_tolerance_mm, *limits_);
  const auto& c = piece.coefficients;
  double s = 0.5 * first.length;
  for (std::uint64_t k = knot_; k < end; ++k) {
    const Pose& vertex = moves[k].to;
    Pose off;
    for (std::size_t i = 0; i < kPoseAxes; ++i) {
      off[i] = c[i][0] + s * (c[i][1] + s * (c[i][2] + s * c[i][3])) - vertex[i];
    }
    if (dot_xyz(off, off) > xyz2 || std::abs(off[kE]) > e || std::abs(off[kA]) > rotation ||
        std::abs(off[kC]) > rotation) {
      return false;
    }
    s += moves[k + 1].length;
  }
  return true;
}

std::uint64_t LineMerger::extend(const GrowingRing<Move>& moves, std::uint64_t last, std::uint64_t run_end,
                                 PathPiece& piece) {
  const std::uint64_t most = std::min(last - knot_, kLongestSpan);
  piece.frame = moves[knot_].frame;
  Pose end_direction{};
  // Galloping from the last cubic's span: `good` fits, `bad` does not.
  std::uint64_t good = 0, bad = most + 1, tried = std::clamp<std::uint64_t>(last_span_, 1, most);
  PathPiece candidate;
  candidate.frame = piece.frame;
  while (true) {
    span(moves, knot_ + tried, run_end, candidate, end_direction);
    // A single vertex always fits, see may_merge.
    if (tried == 1 || fits(moves, knot_ + tried, candidate)) {
      good = tried;
      piece = candidate;
      direction_next_ = end_direction;
    } else {
      bad = tried;
    }
    if (bad - good <= 1 + good / 8) break;
    tried = good == 0 ? std::max<std::uint64_t>(1, bad * 5 / 8)
                      : (bad > most ? std::min(most, good + std::max<std::uint64_t>(1, good / 2))
                                    : (good + bad) / 2);
  }
  knot_ += good;
  direction_ = direction_next_;
  last_span_ = good;
  return knot_;
}

}  // namespace kinebus
