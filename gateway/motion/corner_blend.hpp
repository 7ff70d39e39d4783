#pragma once
// Corners. The direction of the path changes over a stretch of 2 b around the corner instead of in a point,
// so that no motor ever sees a velocity step. Between lines this is a parabola with its control point at the
// corner: d2x/ds2 is constant, and the path passes the corner at a distance of |u2 - u1| b / 4 on each axis.

#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/move.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

/// Half length b of the blend between two moves that follow each other: as long as the tolerances and half of
/// either move allow. 0: the directions agree, nothing to blend.
double blend_half_length(const Move& before, const Move& after, const MotionLimits& limits);

/// The blend, from b before the corner to b after it. Between lines a parabola; where an arc is involved, the
/// cubic that continues both sides with their position and direction.
void blend_piece(const Move& before, const Move& after, double half_length, PathPiece& piece);

/// Either half of a blend between lines whose bend rises evenly from 0 and falls again, where jerk is
/// limited. It passes the corner at a distance of |u2 - u1| b / 6.
void even_blend_piece(const Move& before, const Move& after, double half_length, bool second,
                      PathPiece& piece);

/// The cubic over `length` with these ends (pose and dx/ds).
void hermite_piece(const Pose& x0, const Pose& u0, const Pose& x1, const Pose& u1, double length,
                   PathPiece& piece);

/// How far the rotations may deviate at `pose`: under tool-centre-point control what the limits say; in the
/// machine frame what moves the tip by `tolerance_mm`.
double rotation_tolerance_rad(Frame frame, const Pose& pose, double tolerance_mm, const MotionLimits& limits);

}  // namespace kinebus
