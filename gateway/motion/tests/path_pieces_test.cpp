// Pieces of path by themselves: blends, arcs, merged curves, and their derivatives.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gateway/motion/arc_piece.hpp"
#include "gateway/motion/corner_blend.hpp"
#include "gateway/motion/line_merger.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
const MotionLimits kPieceLimits;

Move line(const Pose& from, const Pose& to) {
  Move move;
  move.from = from;
  move.to = to;
  for (std::size_t i = 0; i < kPoseAxes; ++i) move.u[i] = to[i] - from[i];
  move.length = norm_xyz(move.u);
  for (double& u : move.u) u /= move.length;
  move.u_end = move.u;
  move.tolerance_mm = kPieceLimits.blend_tolerance_mm;
  move.merge_tolerance_mm = kPieceLimits.merge_tolerance_mm;
  move.speed = 100;
  move.accel_mm_per_s2 = 3000;
  move.tool_motion = true;
  return move;
}

void expect_near(const Pose& a, const Pose& b, double tolerance) {
  for (std::size_t i = 0; i < kPoseAxes; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "axis " << i;
}

void expect_derivatives(const PathPiece& piece) {
  for (const double part : {0.1, 0.5, 0.9}) {
    const double s = part * piece.length, h = 1e-5;
    const PosePoint p = piece.evaluate(s), before = piece.evaluate(s - h), after = piece.evaluate(s + h);
    for (std::size_t i = 0; i < kPoseAxes; ++i) {
      EXPECT_NEAR(p.x1[i], (after.x[i] - before.x[i]) / (2 * h), 1e-6);
      EXPECT_NEAR(p.x2[i], (after.x1[i] - before.x1[i]) / (2 * h), 1e-6);
    }
  }
}

TEST(CornerBlend, ContinuesBothLinesAndPassesTheCornerAtTheTolerance) {
  const Move a = line({0, 0, 0, 0, 0, 0}, {10, 0, 0, 0.01, 0, 0.4}),
             b = line(a.to, {10, 8, 0, 0.01, 0.02, 0.8});
  const double half = blend_half_length(a, b, kPieceLimits);
  PathPiece piece;
  blend_piece(a, b, half, piece);
  const PosePoint start = piece.evaluate(0), middle = piece.evaluate(half), end = piece.evaluate(2 * half);
  expect_near(start.x, point_on(a, a.length - half).x, 1e-12);
  expect_near(start.x1, a.u, 1e-12);
  expect_near(end.x, point_on(b, half).x, 1e-12);
  expect_near(end.x1, b.u, 1e-12);
  EXPECT_NEAR(std::hypot(middle.x[0] - 10, middle.x[1]), kPieceLimits.blend_tolerance_mm, 1e-12);
  expect_derivatives(piece);
}

TEST(CornerBlend, TakesNoMoreThanHalfOfAMove) {
  const Move a = line({0, 0, 0, 0, 0, 0}, {0.01, 0, 0, 0, 0, 0}), b = line(a.to, {5, 0.2, 0, 0, 0, 0});
  EXPECT_DOUBLE_EQ(blend_half_length(a, b, kPieceLimits), 0.005);
}

TEST(CornerBlend, StraightOnNeedsNone) {
  const Move a = line({0, 0, 0, 0, 0, 0}, {10, 0, 0, 0, 0, 0}), b = line(a.to, {15, 0, 0, 0, 0, 0});
  EXPECT_EQ(blend_half_length(a, b, kPieceLimits), 0);
}

TEST(CornerBlend, RotationsKeepTheirTolerance) {
  const Move a = line({0, 0, 0, 0, 0, 0}, {10, 0, 0, 0, 0, 0}), b = line(a.to, {20, 0, 0, 0, 1, 0});
  const double half = blend_half_length(a, b, kPieceLimits);
  EXPECT_NEAR(0.1 * half / 4, kPieceLimits.blend_tolerance_rad, 1e-12);
}

TEST(ArcPiece, HelixHitsItsTargetAndHasUnitSpeed) {
  canonical::Arc arc;
  arc.target = {0, 10, 3, 0.1, 0.2, 5};
  arc.normal = {0, 0, 1};
  arc.sweep_rad = 2.5 * kHalfTurn;
  Move move;
  const Pose from{10, 0, 0, 0, 0, 0};
  move.from = from;
  move.to = arc.target;
  ASSERT_TRUE(shape_arc(arc, from, move));
  EXPECT_NEAR(move.length, std::hypot(25 * kHalfTurn, 3), 1e-9);
  expect_near(point_on(move, 0).x, from, 1e-9);
  expect_near(point_on(move, move.length).x, arc.target, 1e-9);
  PathPiece piece;
  arc_piece(move, 5, 40, piece);
  expect_near(piece.evaluate(0).x, point_on(move, 5).x, 1e-9);
  expect_near(piece.evaluate(35).x, point_on(move, 40).x, 1e-9);
  EXPECT_NEAR(norm_xyz(piece.evaluate(7).x1), 1, 1e-12);
  expect_derivatives(piece);
}

TEST(ArcPiece, TiltedPlaneTurnsRightHanded) {
  canonical::Arc arc;
  arc.target = {0, 0, 5, 0, 0, 0};
  arc.normal = {0, -1, 0};  // X towards Z
  arc.sweep_rad = kHalfTurn / 2;
  Move move;
  move.to = arc.target;
  ASSERT_TRUE(shape_arc(arc, {5, 0, 0, 0, 0, 0}, move));
  expect_near(point_on(move, move.length / 2).x, {5 * std::sqrt(0.5), 0, 5 * std::sqrt(0.5), 0, 0, 0}, 1e-9);
  expect_near(move.u, {0, 0, 1, 0, 0, 0}, 1e-12);
}

GrowingRing<Move> polygon(int lines, double radius, double step) {
  GrowingRing<Move> moves(256);
  const auto at = [&](int i) {
    const double angle = i * step / radius;
    return Pose{std::round(1e3 * radius * std::cos(angle)) * 1e-3,
                std::round(1e3 * radius * std::sin(angle)) * 1e-3,
                0,
                0,
                0,
                0.033 * step * i};
  };
  for (int i = 0; i < lines; ++i) moves.push() = line(at(i), at(i + 1));
  return moves;
}

TEST(LineMerger, RunOfRoundedLinesBecomesFewSmoothCubics) {
  const GrowingRing<Move> moves = polygon(100, 20, 0.2);
  for (std::uint64_t i = 1; i < 100; ++i) EXPECT_TRUE(may_merge(moves[i - 1], moves[i], kPieceLimits));
  LineMerger merger(kPieceLimits);
  merger.begin(moves, 0);
  PathPiece piece, before;
  int pieces = 0;
  while (merger.knot() < 99) {
    merger.extend(moves, 99, 99, piece);
    if (pieces > 0) {
      expect_near(piece.evaluate(0).x, before.evaluate(before.length).x, 1e-12);
      expect_near(piece.evaluate(0).x1, before.evaluate(before.length).x1, 1e-12);
    }
    for (int i = 0; i <= 100; ++i) {
      const PosePoint p = piece.evaluate(piece.length * i / 100);
      EXPECT_NEAR(std::hypot(p.x[0], p.x[1]), 20, 0.004);
      EXPECT_NEAR(norm_xyz(p.x1), 1, 2e-3);
    }
    before = piece;
    ++pieces;
  }
  EXPECT_LE(pieces, 5);
}

TEST(LineMerger, CornersAndChangesOfExtrusionAreNoCurve) {
  const Move a = line({0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 0, 0.04});
  EXPECT_TRUE(may_merge(a, line(a.to, {2, 0.01, 0, 0, 0, 0.08}), kPieceLimits));
  EXPECT_FALSE(may_merge(a, line(a.to, {2, 0.4, 0, 0, 0, 0.08}), kPieceLimits)) << "turns too much";
  EXPECT_FALSE(may_merge(a, line(a.to, {2, 0.05, 0, 0, 0, 0.08}), kPieceLimits))
      << "would leave the tolerance";
  EXPECT_FALSE(may_merge(a, line(a.to, {2, 0.01, 0, 0, 0, 0.04}), kPieceLimits)) << "no filament any more";
  EXPECT_FALSE(may_merge(a, line(a.to, {9, 0.01, 0, 0, 0, 0.32}), kPieceLimits)) << "too long";
  Move exact = line(a.to, {2, 0.01, 0, 0, 0, 0.08});
  exact.exact = true;
  EXPECT_FALSE(may_merge(a, exact, kPieceLimits)) << "exact path";
  Move slow = line(a.to, {2, 0.01, 0, 0, 0, 0.08});
  slow.speed = 50;
  EXPECT_FALSE(may_merge(a, slow, kPieceLimits)) << "another feed";
}

}  // namespace
}  // namespace kinebus
