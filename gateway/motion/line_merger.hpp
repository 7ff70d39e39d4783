#pragma once
// Runs of short lines that mean a smooth curve (CAM output, sliced arcs) become cubic pieces of several
// millimetres. The cubics join at midpoints of lines. Directions there are central differences over some
// lines, because coordinates in G-code are rounded to 1 um, which makes single short lines point anywhere by
// several mrad.
//
// Post-condition: each cubic passes every vertex of the lines that it replaces within the merge share of the
// tolerance, measured at equal path length, on all six axes; it joins its neighbours with position and
// direction.

#include <cstdint>

#include "gateway/motion/growing_ring.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/move.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

/// Two lines that follow each other may become parts of one curve: both short and of comparable length, a
/// slight turn that a cubic between their midpoints rounds off within half the tolerance, same feed and
/// acceleration.
bool may_merge(const Move& before, const Move& after, const MotionLimits& limits);

class LineMerger {
 public:
  explicit LineMerger(const MotionLimits& limits) : limits_(&limits) {}

  /// Lines that a cubic may span, and how many lines after its end its direction there looks at.
  static constexpr std::uint64_t kLongestSpan = 64;
  static constexpr std::uint64_t kDirectionLines = 3;

  /// A run begins: the next cubic starts at the middle of line `first`, in that line's direction.
  void begin(const GrowingRing<Move>& moves, std::uint64_t first);
  /// The longest cubic from the last one's end to the middle of a line up to `last`. `run_end`: the run's
  /// last line known (directions look no further; at a run's own end it is the direction of its line).
  /// Returns the line in whose middle it ends, `knot()` from now on.
  std::uint64_t extend(const GrowingRing<Move>& moves, std::uint64_t last, std::uint64_t run_end,
                       PathPiece& piece);

  std::uint64_t knot() const { return knot_; }

 private:
  bool fits(const GrowingRing<Move>& moves, std::uint64_t end, const PathPiece& piece) const;
  Pose direction(const GrowingRing<Move>& moves, std::uint64_t line, std::uint64_t run_end) const;
  void span(const GrowingRing<Move>& moves, std::uint64_t end, std::uint64_t run_end, PathPiece& piece,
            Pose& end_direction) const;

  const MotionLimits* limits_;
  std::uint64_t run_first_ = 0;
  std::uint64_t knot_ = 0;
  Pose direction_{}, direction_next_{};
  std::uint64_t last_span_ = 8;
};

}  // namespace kinebus
