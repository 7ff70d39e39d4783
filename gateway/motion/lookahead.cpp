#include "gateway/motion/lookahead.hpp"

#include <algorithm>
#include <cassert>

namespace kinebus {
namespace {

// New pieces between two backward passes. A pass covers the braking distance besides; 128 keeps that small
// change.
constexpr std::uint64_t kBatch = 128;

}  // namespace

Lookahead::Lookahead(std::size_t window_pieces, bool own_passes)
    : pieces_(window_pieces * 2),
      geometry_(window_pieces * 2),
      window_(std::max<std::size_t>(window_pieces, 8)),
      own_passes_(own_passes) {}

void Lookahead::add(const PlanPiece& piece) {
  PlanPiece& added = pieces_.push();
  added = piece;
  added.geometry = geometry_.end() - 1;
  finishing_ = false;
  if (own_passes_ && pieces_.end() - planned_ >= kBatch) plan_backward();
}

void Lookahead::plan_known() {
  if (own_passes_ && planned_ < pieces_.end()) plan_backward();
}

void Lookahead::stop_here() {
  if (!pieces_.empty()) pieces_.back().stop_after = true;
}

void Lookahead::finish() {
  stop_here();
  if (own_passes_) plan_backward();
  final_ = pieces_.end();
  finishing_ = true;
}

double Lookahead::boundary_cap(std::uint64_t index) const {
  // Before the oldest piece of the window: where the machine will be, at the speed that was promised.
  if (index == pieces_.begin()) return x_;
  const PlanPiece& before = pieces_[index - 1];
  return before.stop_after ? 0 : std::min(before.cap, pieces_[index].cap);
}

void Lookahead::plan_backward() {
  double exit = 0;
  std::uint64_t newest_capped = final_;
  for (std::uint64_t i = pieces_.end(); i-- > std::max(final_, pieces_.begin());) {
    PlanPiece& piece = pieces_[i];
    const double cap = boundary_cap(i);
    const double entry = std::min(cap, piece.reach_decelerating(exit));
    if (entry == cap && newest_capped == final_) newest_capped = i;
    const bool unchanged = i < planned_ && entry == piece.entry;
    piece.entry = entry;
    exit = entry;
    if (unchanged) break;
  }
  final_ = std::max(final_, newest_capped);
  planned_ = pieces_.end();
}

bool Lookahead::take(Step& step) {
  if (pieces_.empty()) return false;
  const std::uint64_t index = pieces_.begin();
  const bool last_known = index + 1 == pieces_.end();
  if (!finishing_ && full() && index + 1 > final_) {
    plan_backward();
    if (index + 1 > final_) {
      // Nothing is final in a full window: take half of it with the speeds that a stop at its end allows.
      final_ = index + pieces_.size() / 2;
      ++forced_;
    }
  }
  if (last_known ? !finishing_ : index + 1 > final_) return false;

  const PlanPiece& piece = pieces_[index];
  step.piece = &piece;
  step.geometry = &geometry_[piece.geometry];
  step.x_start = x_;
  step.x_end = last_known ? 0 : std::min(pieces_[index + 1].entry, piece.reach_accelerating(x_));
  step.last = last_known;
  step.length = piece.length;
  std::uint64_t next = index + 1;
  if (x_ == piece.cap && step.x_end == piece.cap) {
    // Parts of one curve at one speed: one step, so that they become one phase.
    for (; next + 1 < pieces_.end() && next + 1 <= final_; ++next) {
      const PlanPiece& part = pieces_[next];
      if (part.geometry != piece.geometry || part.cap != piece.cap || pieces_[next + 1].entry != piece.cap)
        break;
      step.length += part.length;
    }
  }
  x_ = step.x_end;
  geometry_.drop_to(piece.geometry);
  pieces_.drop_to(next);
  return true;
}

Lookahead::Ahead Lookahead::ahead() {
  plan_known();
  Ahead ahead;
  double x = x_;
  for (std::uint64_t i = pieces_.begin(); i != pieces_.end(); ++i) {
    const PlanPiece& piece = pieces_[i];
    const bool last = i + 1 == pieces_.end();
    const double x_end = last ? 0 : std::min(pieces_[i + 1].entry, piece.reach_accelerating(x));
    ahead.all_s += piece.crossing_s(x, x_end);
    if (last ? finishing_ : i + 1 <= final_) ahead.final_s = ahead.all_s;
    x = x_end;
  }
  return ahead;
}

void Lookahead::drop_first() {
  const std::uint64_t first = pieces_.begin();
  geometry_.drop_to(pieces_[first].geometry);
  pieces_.drop_to(first + 1);
}

void Lookahead::clear() {
  pieces_.clear();
  geometry_.clear();
  planned_ = final_ = pieces_.end();
  x_ = 0;
  finishing_ = false;
}

}  // namespace kinebus
