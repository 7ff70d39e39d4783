// Gouges of cutter compensation. Walls are programmed feed moves, tracks the tool's path beside them; both of
// one height.

#include <algorithm>
#include <cmath>

#include "gateway/gcode/curves/cutter.hpp"

namespace kinebus::gcode {
namespace {

// Curves this near touch: less than anything follows, more than rounding makes.
constexpr double kTouch_mm = 1e-5;
// Where neighbours meet this near to their corner, it is the corner.
constexpr double kCorner_mm = 1e-3;

}  // namespace

/// The programmed path crosses or touches itself there: what the tool does to it is meant. Neighbours touch
/// at their corner.
bool CutterPath::meet(const Wall& a, const Wall& b) {
  if (a.number == b.number) return false;
  if (a.number != b.number + 1 && b.number != a.number + 1) return distance(a.curve, b.curve) <= kTouch_mm;
  const Point2& corner = a.number > b.number ? a.curve.from : b.curve.from;
  const Meetings met = meetings(a.curve, b.curve);
  for (std::size_t i = 0; i < static_cast<std::size_t>(met.count); ++i)
    if (lies_on(a.curve, met.points[i]) && lies_on(b.curve, met.points[i]) &&
        length_of(met.points[i] - corner) > kCorner_mm)
      return true;
  return false;
}

bool CutterPath::cuts(const Track& track, const Wall& wall) const {
  return distance(wall.curve, track.curve) < std::abs(left_mm_) - kTolerance_mm;
}

void CutterPath::keep_wall(const Piece& next) {
  const bool free = next.entry || next.traverse || !next.level;
  if (std::exchange(apart_, free) || free) {
    walls_.clear();
    tracks_.clear();
  }
  if (free) return;
  if (walls_.size() == kWindow) walls_.erase(walls_.begin());
  walls_.push_back({next.wall, next.line, ++number_});
}

/// A track beside the last wall, or about the corner between it and the one before.
///
/// It gouges a wall that it comes too near to, when the tool beside that wall comes too near to this one as
/// well: then both have to be there. The arc by which a contour is reached is cut by the tool that comes
/// round to its end, and is in the air.
bool CutterPath::keep_track(const Curve& curve, bool corner, Sentence& error) {
  if (walls_.empty()) return true;
  Track track{curve, walls_.back(), {}};
  if (corner && walls_.size() > 1) track.before = walls_[walls_.size() - 2];
  for (const Wall& wall : walls_) {
    if (!cuts(track, wall) || meet(wall, track.beside) || (track.before && meet(wall, *track.before)))
      continue;
    const bool both = std::any_of(tracks_.begin(), tracks_.end(), [&](const Track& other) {
      const bool of_wall =
          other.beside.number == wall.number || (other.before && other.before->number == wall.number);
      return of_wall && (cuts(other, track.beside) || (track.before && cuts(other, *track.before)));
    });
    if (!both) continue;
    error = say("the tool would cut into line %1 on its way along line %2", wall.line, track.beside.line);
    return false;
  }
  if (tracks_.size() == 2 * kWindow) tracks_.erase(tracks_.begin());
  tracks_.push_back(track);
  return true;
}

}  // namespace kinebus::gcode
