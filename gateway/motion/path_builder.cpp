#include "gateway/motion/path_builder.hpp"

#include <algorithm>

#include "gateway/motion/arc_piece.hpp"
#include "gateway/motion/corner_blend.hpp"

namespace kinebus {
namespace {

// Shorter remains of lines between two blends are rounding, not path: 1 pm.
constexpr double kNothing = 1e-9;
constexpr std::uint64_t kLeastMergedLines = 3;
constexpr std::size_t kMovesAtOnce = 256;

bool turns(const Move& move) {
  return move.u[kA] != 0 || move.u[kC] != 0;
}

PieceDemand demand_of(const Move& move) {
  return {move.speed, move.accel_mm_per_s2, move.line,
          move.frame == Frame::kMachine && move.tool_motion && turns(move)};
}

PieceDemand demand_of(const Move& before, const Move& after) {
  PieceDemand demand = demand_of(after);
  demand.tip_feed = demand.tip_feed || demand_of(before).tip_feed;
  demand.speed = std::min(before.speed, after.speed);
  demand.accel_mm_per_s2 = std::min(before.accel_mm_per_s2, after.accel_mm_per_s2);
  return demand;
}

}  // namespace

PathBuilder::PathBuilder(const MotionLimits& limits, PathLimits& path_limits, Lookahead& lookahead)
    : limits_(limits),
      path_limits_(&path_limits),
      lookahead_(&lookahead),
      merger_(limits_),
      moves_(kMovesAtOnce) {}

Result<void, PathBuilder::Unreachable> PathBuilder::move_added() {
  ++counters_.moves;
  const std::uint64_t newest = moves_.end() - 1;
  if (newest == run_first_) return {};
  if (!may_merge(moves_[newest - 1], moves_[newest], limits_)) return end_run(newest - 1, true);
  // A run of any length is worked off as it grows, when as many lines are known as a cubic can use.
  const std::uint64_t from = merging_ ? merger_.knot() : run_first_;
  const std::uint64_t enough = LineMerger::kLongestSpan + LineMerger::kDirectionLines;
  if (newest - from < enough) return {};
  return merge_up_to(newest - LineMerger::kDirectionLines, newest);
}

Result<void, PathBuilder::Unreachable> PathBuilder::close() {
  if (moves_.empty()) return {};
  auto result = end_run(moves_.end() - 1, false);
  moves_.clear();
  run_first_ = moves_.end();
  used_ = 0;
  path_limits_->restart();
  return result;
}

double PathBuilder::open_s(double fastest) const {
  double open = 0;
  for (std::uint64_t i = moves_.begin(); i != moves_.end(); ++i)
    open += moves_[i].length / std::min(moves_[i].speed, fastest);
  return open;
}

void PathBuilder::clear() {
  moves_.clear();
  run_first_ = moves_.end();
  used_ = 0;
  merging_ = false;
  path_limits_->restart();
}

/// One cubic (run still open), or all up to the middle of line `last` (when it is the run's end).
Result<void, PathBuilder::Unreachable> PathBuilder::merge_up_to(std::uint64_t last, std::uint64_t run_end) {
  if (!merging_) {
    const Move& first = moves_[run_first_];
    if (auto ok = emit_part(first, used_, 0.5 * first.length); !ok) return ok;
    merger_.begin(moves_, run_first_);
    merging_ = true;
    ++counters_.merged;
  }
  do {
    const std::uint64_t from = merger_.knot();
    const std::uint64_t to = merger_.extend(moves_, last, run_end, lookahead_->new_geometry());
    PieceDemand demand = demand_of(moves_[from], moves_[to]);
    for (std::uint64_t i = from + 1; i < to; ++i) demand.speed = std::min(demand.speed, moves_[i].speed);
    if (auto ok = path_limits_->add_curve(demand); !ok) return Error<Unreachable>({demand.line, ok.error()});
    counters_.merged += to - from;
  } while (last == run_end && merger_.knot() < last);
  if (merger_.knot() > LineMerger::kDirectionLines)
    moves_.drop_to(merger_.knot() - LineMerger::kDirectionLines);
  return {};
}

/// Puts the open run, which ends with line `last`, and the corner to the move after it on the path.
Result<void, PathBuilder::Unreachable> PathBuilder::end_run(std::uint64_t last, bool corner_follows) {
  const double end_half = corner_follows ? blend_half_length(moves_[last], moves_[last + 1], limits_) : 0;
  if (merging_ || last + 1 - run_first_ >= kLeastMergedLines) {
    if (!merging_ || merger_.knot() < last) {
      if (auto ok = merge_up_to(last, last); !ok) return ok;
    }
    const Move& move = moves_[last];
    if (auto ok = emit_part(move, 0.5 * move.length, move.length - end_half); !ok) return ok;
  } else {
    for (std::uint64_t i = run_first_; i <= last; ++i) {
      const Move& move = moves_[i];
      const double half = i < last ? blend_half_length(move, moves_[i + 1], limits_) : end_half;
      if (auto ok = emit_part(move, used_, move.length - half); !ok) return ok;
      if (i == last) break;
      if (auto ok = emit_corner(move, moves_[i + 1], half); !ok) return ok;
      used_ = half;
    }
  }
  merging_ = false;
  if (corner_follows) {
    if (auto ok = emit_corner(moves_[last], moves_[last + 1], end_half); !ok) return ok;
    run_first_ = last + 1;
    used_ = end_half;
    moves_.drop_to(run_first_);
  }
  return {};
}

Result<void, PathBuilder::Unreachable> PathBuilder::emit_part(const Move& move, double from, double to) {
  if (to - from < kNothing) return {};
  PathPiece& piece = lookahead_->new_geometry();
  Result<void, PoseError> ok;
  if (move.arc) {
    arc_piece(move, from, to, piece);
    ok = path_limits_->add_curve(demand_of(move));
  } else {
    for (std::size_t i = 0; i < kPoseAxes; ++i)
      piece.coefficients[i] = {move.from[i] + move.u[i] * from, move.u[i], 0, 0};
    piece.arc = false;
    piece.length = to - from;
    piece.frame = move.frame;
    ok = path_limits_->add_line(demand_of(move));
  }
  if (!ok) return Error<Unreachable>({move.line, ok.error()});
  return {};
}

Result<void, PathBuilder::Unreachable> PathBuilder::emit_corner(const Move& before, const Move& after,
                                                                double half_length) {
  if (half_length <= 0) return {};
  ++counters_.blends;
  const PieceDemand demand = demand_of(before, after);
  if (limits_.limits_jerk() && !before.arc && !after.arc) {
    for (const bool second : {false, true}) {
      even_blend_piece(before, after, half_length, second, lookahead_->new_geometry());
      if (const auto ok = path_limits_->add_curve(demand); !ok)
        return Error<Unreachable>({after.line, ok.error()});
    }
    return {};
  }
  blend_piece(before, after, half_length, lookahead_->new_geometry());
  const auto ok =
      before.arc || after.arc ? path_limits_->add_curve(demand) : path_limits_->add_parabola(demand);
  if (!ok) return Error<Unreachable>({after.line, ok.error()});
  return {};
}

}  // namespace kinebus
