#pragma once
// The path: a chain of pieces with continuous position and direction, made of programmed moves. Lines keep
// their middle, corners become blends, runs of short lines become cubics, arcs stay arcs.

#include <cstdint>

#include "gateway/motion/growing_ring.hpp"
#include "gateway/motion/line_merger.hpp"
#include "gateway/motion/lookahead.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/move.hpp"
#include "gateway/motion/path_limits.hpp"
#include "gateway/result.hpp"

namespace kinebus {

class PathBuilder {
 public:
  /// A pose on the path that the machine cannot take, and the job's line.
  struct Unreachable {
    std::uint32_t line = 0;
    PoseError pose{};
  };
  struct Counters {
    std::uint64_t moves = 0, merged = 0, blends = 0;
  };

  PathBuilder(const MotionLimits& limits, PathLimits& path_limits, Lookahead& lookahead);

  /// The next move, which begins where the last one ended. `move` is filled in by the caller through
  /// new_move().
  Move& new_move() { return moves_.push(); }
  /// Takes back the slot of new_move().
  void discard_move() { moves_.pop_back(); }
  Result<void, Unreachable> move_added();
  /// No move follows without a stop: the path is completed up to the end of the last move.
  Result<void, Unreachable> close();
  /// Tolerances for the corners from here on; only after close().
  void set_limits(const MotionLimits& limits) { limits_ = limits; }
  void clear();

  bool empty() const { return moves_.empty(); }
  /// Time that the moves not yet on the path take at their own speed, at most `fastest` mm/s; s.
  double open_s(double fastest) const;
  const Counters& counters() const { return counters_; }

 private:
  Result<void, Unreachable> end_run(std::uint64_t last, bool corner_follows);
  Result<void, Unreachable> merge_up_to(std::uint64_t last, std::uint64_t run_end);
  Result<void, Unreachable> emit_part(const Move& move, double from, double to);
  Result<void, Unreachable> emit_corner(const Move& before, const Move& after, double half_length);

  MotionLimits limits_;
  PathLimits* path_limits_;
  Lookahead* lookahead_;
  LineMerger merger_;
  GrowingRing<Move> moves_;
  std::uint64_t run_first_ = 0;  ///< first move of the run that is open
  double used_ = 0;              ///< of the open run's first move: already on the path
  bool merging_ = false;         ///< cubics of the open run up to merger_.knot() are on the path
  Counters counters_;
};

}  // namespace kinebus
