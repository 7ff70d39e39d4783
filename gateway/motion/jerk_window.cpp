#include "gateway/motion/jerk_window.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace kinebus {
namespace {

// A corner is blended by two pieces, whose caps are the same but for rounding and the joints.
constexpr std::size_t kBlendPieces = 2;
// Of two speeds: so near that they count as one.
constexpr double kOneSpeed = 0.97;
constexpr PlanPiece::Even kUnbounded{std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::infinity()};
// Over a bend that takes nearly all of the jerk: no stretch is so long.
constexpr PlanPiece::Even kNoRamp{1e-9, 1e-9};

}  // namespace

void JerkWindow::load(const Lookahead& path, double start) {
  const std::uint64_t first = path.first(), end = path.added();
  const auto count = static_cast<std::size_t>(end - first);
  leaves_ = std::bit_ceil(std::max<std::size_t>(count, 1));
  starts_.resize(count + 1);
  speeds_.resize(count);
  ramp_speeds_.resize(count);
  even_.resize(count);
  touch_jerk_.resize(count);
  lowest_.assign(2 * leaves_, std::numeric_limits<std::uint32_t>::max());
  starts_[0] = start;
  for (std::size_t i = 0; i < count; ++i) {
    const PlanPiece& piece = path.piece(first + i);
    starts_[i + 1] = starts_[i] + piece.length;
    speeds_[i] = ramp_speeds_[i] = std::sqrt(piece.ramp_cap);
    even_[i] = piece.even;
    touch_jerk_[i] = piece.touch_jerk;
    lowest_[leaves_ + i] = static_cast<std::uint32_t>(i);
  }
  find_lone_bends(path);
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    const std::uint32_t a = lowest_[2 * node], b = lowest_[2 * node + 1];
    lowest_[node] = b >= count || (a < count && speeds_[a] <= speeds_[b]) ? a : b;
  }
}

/// Bends between straight pieces that are faster may be passed at their cap: a ramp has room beside them. In
/// curves the pieces next to a slow one are hardly faster, and no ramp would lead out of it.
void JerkWindow::find_lone_bends(const Lookahead& path) {
  const auto bends = [&](std::size_t i) {
    const PlanPiece& piece = path.piece(path.first() + i);
    return piece.cap > piece.ramp_cap;
  };
  for (std::size_t a = 0, b = 0; a < speeds_.size(); a = b + 1) {
    b = a;
    if (!bends(a)) continue;
    double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
    double ramp = slowest;
    for (;; ++b) {
      const double speed = std::sqrt(path.piece(path.first() + b).cap);
      slowest = std::min(slowest, speed);
      fastest = std::max(fastest, speed);
      ramp = std::min(ramp, ramp_speeds_[b]);
      if (b + 1 == speeds_.size() || !bends(b + 1)) break;
    }
    // What follows is not known yet, or is no straight piece.
    if (b + 1 == speeds_.size() || b - a >= kBlendPieces || slowest < kOneSpeed * fastest) continue;
    const auto is_faster = [&](std::size_t i) { return starts_[i + 1] > starts_[i] && speeds_[i] > slowest; };
    if (!is_faster(b + 1) || (a > 0 && !is_faster(a - 1))) continue;
    for (std::size_t i = a; i <= b; ++i) {
      speeds_[i] = slowest;
      ramp_speeds_[i] = ramp;
    }
  }
}

std::size_t JerkWindow::lowest(std::size_t first, std::size_t last) const {
  std::size_t best = first;
  for (std::size_t l = first + leaves_, r = last + leaves_ + 1; l < r; l /= 2, r /= 2) {
    if ((l & 1) != 0) {
      const std::size_t i = lowest_[l++];
      if (speeds_[i] < speeds_[best]) best = i;
    }
    if ((r & 1) != 0) {
      const std::size_t i = lowest_[--r];
      if (speeds_[i] < speeds_[best]) best = i;
    }
  }
  return best;
}

std::size_t JerkWindow::piece_after(double position) const {
  const auto at = std::upper_bound(starts_.begin() + 1, starts_.end(), position + kShortest_mm);
  return std::min(static_cast<std::size_t>(at - starts_.begin()) - 1, speeds_.size() - 1);
}

std::size_t JerkWindow::piece_before(double position) const {
  const auto at = std::lower_bound(starts_.begin(), starts_.end() - 1, position - kShortest_mm);
  return at == starts_.begin() ? 0 : static_cast<std::size_t>(at - starts_.begin()) - 1;
}

bool JerkWindow::lower(std::size_t i, double speed, PlanPiece::Even& even) const {
  const bool steady = speed > ramp_speeds_[i] && speeds_[i] > ramp_speeds_[i];
  std::size_t tier = 0;
  while (tier + 1 < even_[i].size() && speed > PlanPiece::kRampSpeeds[tier] * ramp_speeds_[i]) ++tier;
  const PlanPiece::Even& bound = steady ? kNoRamp : even_[i][tier];
  if (bound.accel >= even.accel && bound.jerk >= even.jerk) return false;
  even = {std::min(even.accel, bound.accel), std::min(even.jerk, bound.jerk)};
  return true;
}

bool JerkWindow::blocks(std::size_t i, double speed) const {
  return ramp_speeds_[i] < speeds_[i] && speed > kOneSpeed * ramp_speeds_[i];
}

PlanPiece::Even JerkWindow::touching_from(double from, std::size_t first) const {
  PlanPiece::Even even = kUnbounded;
  for (std::size_t i = first; i > 0 && starts_[i - 1] >= from - kShortest_mm; --i)
    if (!(starts_[i] > starts_[i - 1])) even.jerk = std::min(even.jerk, touch_jerk_[i - 1]);
  return even;
}

PlanPiece::Even JerkWindow::touching_to(double to, std::size_t last) const {
  PlanPiece::Even even = kUnbounded;
  for (std::size_t i = last + 1; i < speeds_.size() && starts_[i + 1] <= to + kShortest_mm; ++i)
    if (!(starts_[i + 1] > starts_[i])) even.jerk = std::min(even.jerk, touch_jerk_[i]);
  return even;
}

}  // namespace kinebus
