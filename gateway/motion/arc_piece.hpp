#pragma once
// Arcs stay arcs: a programmed G2/G3 as a move, and parts of it as pieces of path.

#include "gateway/gcode/canonical.hpp"
#include "gateway/motion/move.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

/// Fills what makes `move` an arc (shape, length, directions) from `from` to the arc's target.
/// False: the numbers do not make an arc (no radius, no normal, sweep not > 0, start and end radius differ by
/// more than 0.5 mm and 2 %).
bool shape_arc(const canonical::Arc& arc, const Pose& from, Move& move);

/// The part of an arc between s = from and s = to, both measured along the whole move.
void arc_piece(const Move& move, double from, double to, PathPiece& piece);

/// Pose and direction on any move (line or arc) at s.
PosePoint point_on(const Move& move, double s);

}  // namespace kinebus
