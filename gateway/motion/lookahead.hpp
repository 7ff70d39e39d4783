#pragma once
// The speed profile: which speed at each boundary between pieces. Backward from the end of what is known
// (always a stop): the greatest speed from which the rest is feasible. Forward from where the machine is:
// what it can reach.
//
// Streaming: a boundary's backward speed is final once it, or one after it, is at its own cap: nothing that
// follows can change it then. Only final pieces are taken out, unless the window is full. A backward pass
// goes no further than the newest final boundary, or to where nothing changes any more, and runs once for
// kBatch new pieces: O(1) a piece. Post-condition: between neighbouring boundaries one constant acceleration
// within the piece's limits exists.

#include <cstddef>
#include <cstdint>

#include "gateway/motion/growing_ring.hpp"
#include "gateway/motion/plan_piece.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

class Lookahead {
 public:
  /// own_passes: false where another planner (JerkLookahead) makes the speed profile, and only the pieces are
  /// kept here.
  explicit Lookahead(std::size_t window_pieces, bool own_passes = true);

  /// A new PathPiece (not cleared); the pieces added after it lie on it.
  PathPiece& new_geometry() { return geometry_.push(); }
  PathPiece& newest_geometry() { return geometry_.back(); }
  /// A new piece on the newest geometry; its `geometry` and `entry` are set here.
  void add(const PlanPiece& piece);
  /// The backward pass for what was added since the last one, though it is less than a batch.
  void plan_known();
  /// The path comes to rest at the end of what was added so far.
  void stop_here();
  /// No more follows: everything becomes final.
  void finish();

  struct Step {
    const PlanPiece* piece = nullptr;
    const PathPiece* geometry = nullptr;
    double length = 0;  ///< of the piece, or of several that are cruised through as one
    double x_start = 0, x_end = 0;
    bool last = false;  ///< the finished path ends here
  };
  /// The next piece with its speeds at both ends; valid until the next call of any member. False: none is
  /// final.
  bool take(Step& step);

  /// Time that the pieces held take, s, to a stop at the end of what is known; and that of the final ones.
  struct Ahead {
    double final_s = 0, all_s = 0;
  };
  Ahead ahead();

  // For a planner of its own.
  const PlanPiece& piece(std::uint64_t index) const { return pieces_[index]; }
  const PathPiece& geometry(const PlanPiece& piece) const { return geometry_[piece.geometry]; }
  std::uint64_t first() const { return pieces_.begin(); }
  void drop_first();
  bool finishing() const { return finishing_; }

  bool full() const { return pieces_.size() >= window_; }
  bool empty() const { return pieces_.empty(); }
  std::uint64_t forced() const { return forced_; }
  std::uint64_t added() const { return pieces_.end(); }
  void clear();

 private:
  double boundary_cap(std::uint64_t index) const;
  void plan_backward();

  GrowingRing<PlanPiece> pieces_;
  GrowingRing<PathPiece> geometry_;
  std::size_t window_;
  bool own_passes_;
  std::uint64_t planned_ = 0;  ///< pieces before this one have an entry speed
  std::uint64_t final_ = 0;    ///< entry speeds up to this piece's are final
  bool finishing_ = false;
  double x_ = 0;  ///< speed at the start of the next piece to take
  std::uint64_t forced_ = 0;
};

}  // namespace kinebus
