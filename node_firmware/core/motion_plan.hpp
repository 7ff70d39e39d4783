#pragma once
// Where both motors are to be over the next milliseconds, as parabolas that a control interrupt evaluates
// with a few multiplications: no division, nothing of Node touched. The main loop makes a new plan after
// every input and now and then, and hands it over whole.
//
// A piece lasts 512 us and goes through three points that Node gives. Between them it may differ from the
// exact position only where the acceleration changes within a piece: by 1/60 of the change times the piece's
// length squared, 0.06 counts for the default machine's +-5000 mm/s^2 (kMostDifference in the test).

#include <array>
#include <atomic>
#include <cstdint>

#include "protocol/motion/segment.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class Node;

/// Local time in counts of 250 ns, modulo 2^32.
using PlanCounts = std::uint32_t;
inline constexpr LocalTime kPlanCount{250};

struct MotionPlan {
  static constexpr int kPieces = 16;      ///< at most
  static constexpr int kUsualPieces = 8;  ///< 4.1 ms
  static constexpr int kPieceBits = 11;
  static constexpr PlanCounts kPiece = PlanCounts{1} << kPieceBits;
  /// A plan that is not renewed in time fades to a standstill over this: 33 ms.
  static constexpr int kFadeBits = 17;

  struct Parabola {
    std::int64_t position = 0;  ///< 32 fractional bits
    std::int64_t first = 0;     ///< position + first * u + second * u^2, u = counts / kPiece
    std::int64_t second = 0;
  };
  struct Point {
    std::int64_t position = 0;  ///< 32 fractional bits
    std::int64_t velocity = 0;  ///< per kPiece, 32 fractional bits
  };

  PlanCounts start = 0;
  std::uint32_t count = kUsualPieces;  ///< of the pieces
  std::uint32_t axes = kAxesPerNode;   ///< from the first on; another one rests at 0
  static constexpr PlanCounts horizon(std::uint32_t pieces) { return kPiece * pieces; }
  PlanCounts horizon() const { return horizon(count); }
  std::array<std::array<Parabola, kPieces>, kAxesPerNode> pieces{};

  /// At or after `start`.
  Point at(int axis, PlanCounts now) const {
    const auto& mine = pieces[static_cast<std::size_t>(axis)];
    const auto elapsed = static_cast<std::int32_t>(now - start);
    if (elapsed < 0) return evaluate(mine[0], 0);
    const auto index = static_cast<std::uint32_t>(elapsed) >> kPieceBits;
    if (index < count) return evaluate(mine[index], static_cast<std::uint32_t>(elapsed) & (kPiece - 1));
    return faded(evaluate(mine[count - 1], kPiece), static_cast<std::uint32_t>(elapsed) - horizon());
  }
  bool late(PlanCounts now) const {
    return static_cast<std::int32_t>(now - start) >= static_cast<std::int32_t>(horizon());
  }

  static Point evaluate(const Parabola& p, std::uint32_t into) {
    const auto u = static_cast<std::int64_t>(into);
    const std::int64_t bend = (p.second * u) >> kPieceBits;
    return {p.position + (((p.first + bend) * u) >> kPieceBits), p.first + 2 * bend};
  }
  static Point faded(const Point& end, std::uint32_t beyond) {
    constexpr std::uint32_t kFade = std::uint32_t{1} << kFadeBits;
    const std::uint32_t t = beyond < kFade ? beyond : kFade;
    // velocity * (t - t^2 / (2 fade)), the time in 1/256 counts.
    const std::uint64_t way_q8 = (std::uint64_t{t} << 8) - ((std::uint64_t{t} * t) >> (kFadeBits + 1 - 8));
    return {end.position + (((end.velocity >> kPieceBits) * static_cast<std::int64_t>(way_q8)) >> 8),
            (end.velocity >> kFadeBits) * static_cast<std::int64_t>(kFade - t)};
  }
  /// The parabola through the positions at the start, the middle and the end of a piece.
  static Parabola through(std::int64_t from, std::int64_t middle, std::int64_t to) {
    return {from, 4 * (middle - from) - (to - from), 2 * (to - from) - 4 * (middle - from)};
  }
};

/// How far a plan reaches, after how much of it the next one is due, and for how many axes. A pass of the
/// main loop may be late by what is left then: that harms nothing.
struct PlanSize {
  std::uint32_t pieces = MotionPlan::kUsualPieces;
  std::uint32_t fresh = MotionPlan::kUsualPieces / 2;
  std::uint32_t axes = kAxesPerNode;
};

/// Two plans, one in use. The maker is interrupted by the user, never the other way round.
class MotionPlanExchange {
 public:
  const MotionPlan& current() const { return plans_[current_.load(std::memory_order_acquire)]; }
  /// A new plan from `now` on. `counts`: the same instant as the interrupt counts it.
  void renew(const Node& node, LocalTime now, PlanCounts counts, const PlanSize& size = {});
  /// The node would give another plan by now: looked at in the middle and at the end of what is left. Much
  /// cheaper than a new plan after every frame that changes nothing.
  bool outdated(const Node& node, LocalTime now, PlanCounts counts) const;

 private:
  std::array<MotionPlan, 2> plans_{};
  std::atomic<std::uint32_t> current_{0};
};

}  // namespace kinebus
