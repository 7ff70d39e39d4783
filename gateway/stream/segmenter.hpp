#pragma once
// JointSpans -> segments of one node: the C1 piecewise quadratic, in exact integers, that stays within
// tolerance of q(tau) on both axes with as few knots as that needs.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/motion/joint_span.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {

/// One fitted segment. `start` is the exact state at its first knot; times count from the run's start.
struct FittedSegment {
  std::int64_t start_units = 0;
  std::int32_t duration = 0;  ///< units of 16 us
  std::array<std::int32_t, kAxesPerNode> acceleration{};
  std::array<AxisState, kAxesPerNode> start{};
  std::uint32_t line = 0;  ///< the job's line at its first knot
};

/// Post-conditions: at every time both axes are within tolerance_counts of q(tau) as sampled (unless
/// counters().loose says otherwise); every segment's acceleration lies between the least and the greatest of
/// q'' that it covers, widened by at most three quarters of what is left to the joint's limit; the last knot
/// is at or after the run's end, with velocity exactly 0. Look-ahead: two of the longest segments (262 ms) or
/// kCapacity spans, whichever is less.
class Segmenter {
 public:
  struct Options {
    /// Kept free of the tolerance, counts: sampling error 0.026 and the rounding of path ticks.
    double margin_counts = 0.03;
    int acceleration_shift = kDefaultAccelerationShift;
  };
  struct Counters {
    std::uint64_t segments = 0;
    std::uint64_t candidates = 0;  ///< fits that were tried
    std::uint64_t loose = 0;       ///< segments that no fit brought within tolerance
    double worst_ratio = 0;        ///< largest error / tolerance so far, margin included
  };
  static constexpr std::size_t kCapacity = 256;

  explicit Segmenter(const NodeAxes& node) : Segmenter(node, Options{}) {}
  Segmenter(const NodeAxes& node, Options options);

  /// Begins a run from these exact states, at rest.
  void start(const std::array<AxisState, kAxesPerNode>& states);
  bool has_room() const { return count_ < kCapacity; }
  /// Spans in order of time, the last one marked `last`. Only when has_room().
  void push(const JointSpan& span);
  /// nullopt: push more spans, or the run has ended.
  std::optional<FittedSegment> next();
  /// The run's last segment was given out.
  bool ended() const { return ended_; }

  /// The last knot given out: time since the run's start, and the exact states there.
  std::int64_t knot_units() const { return knot_; }
  const std::array<AxisState, kAxesPerNode>& states() const { return states_; }
  const Counters& counters() const { return counters_; }
  const NodeAxes& node() const { return node_; }

 private:
  struct Piece {
    double start = 0, end = 0;                            ///< units since the run's start
    std::array<std::array<double, 4>, kAxesPerNode> c{};  ///< counts, powers of units since `start`
    double jump = 0;      ///< acceleration jump at its end over tolerance, 1/unit^2 (worse axis)
    double free_run = 0;  ///< units that one segment can cover of this cubic without end (worse axis)
    bool breaks_after = false;
    std::uint32_t line = 0;
  };
  struct Axis {
    double p = 0, v = 0;  ///< state at the knot, counts and counts/unit
    double tolerance = 0.47, limit = 0;
  };
  struct Fit {
    std::int32_t units = 0;
    std::array<std::int32_t, kAxesPerNode> acceleration{};
    double error = 0;  ///< largest error / tolerance
  };
  enum class Goal : std::uint8_t { kRunOn, kHalfway, kRest };

  const Piece& piece(std::size_t i) const { return pieces_[(first_ + i) & (kCapacity - 1)]; }
  Piece& piece(std::size_t i) { return pieces_[(first_ + i) & (kCapacity - 1)]; }
  void load_states();
  bool ready() const;
  std::size_t piece_at(double t, std::size_t hint) const;
  double region_end(double& reach) const;
  double next_run(double t, std::size_t index, double cap) const;
  Fit fit(std::int32_t units, Goal goal, double give_up);
  double error_over(const Fit& f, std::size_t last) const;
  Fit choose();
  Fit choose_rest(double remaining);
  Fit shrink(std::int32_t units, Goal goal, Fit best);
  FittedSegment emit(const Fit& f);

  NodeAxes node_;
  Options options_;
  Counters counters_;
  std::vector<Piece> pieces_;  ///< ring of kCapacity, allocated once
  std::size_t first_ = 0, count_ = 0;
  std::array<Axis, kAxesPerNode> axes_{};
  std::array<AxisState, kAxesPerNode> states_{};
  std::int64_t knot_ = 0;
  bool complete_ = false, ended_ = true, trim_ = false;
};

}  // namespace kinebus
