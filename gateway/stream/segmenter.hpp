#pragma once
// JointSpans -> segments of one node: the C1 piecewise quadratic, in exact integers, that stays within
// tolerance of q(tau) on both axes with as few knots as that needs.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/motion/joint_span.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "gateway/stream/both_axes.hpp"
#include "gateway/stream/cubic_error.hpp"
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
/// counters().loose says otherwise); every segment's acceleration lies between the least and the greatest q''
/// that it covers, widened by at most three quarters of what is left to the joint's limit; the last knot is
/// at or after the run's end, with velocity exactly 0. Look-ahead: three of the longest segments (393 ms) or
/// kCapacity spans, whichever is less. No heap after construction.
class Segmenter {
 public:
  struct Options {
    /// Kept free of the tolerance, counts: the sampling error (35 nm = 0.045) and the rounding of path ticks.
    double margin_counts = 0.05;
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
  /// A span brings one piece, the last span two.
  bool has_room() const { return count() + 2 <= kCapacity; }
  /// Spans in order of time, the last one marked `last`. Only when has_room().
  void push(const JointSpan& span);
  /// nullopt: push more spans, or the run has ended.
  std::optional<FittedSegment> next();
  /// The run's last segment was given out.
  bool ended() const { return ended_; }

  /// The last knot given out: time since the run's start, and the exact states there.
  std::int64_t knot_units() const { return at_.knot; }
  const std::array<AxisState, kAxesPerNode>& states() const { return at_.states; }
  /// Counts between q at the run's start and the state that it starts from, the worse axis; 0 before the
  /// first span.
  double start_offset_counts() const { return start_offset_; }
  const Counters& counters() const { return counters_; }
  const NodeAxes& node() const { return node_; }

 private:
  /// One cubic on both axes: counts, as powers of units since `start`.
  struct Piece {
    double start = 0, end = 0;  ///< units since the run's start
    std::array<Both, 4> c{};
    double bend = 0;  ///< |c3| / tolerance, worse axis: what a constant acceleration misses
    double jump = 0;  ///< jump of q''/2 at its end / tolerance, worse axis
    std::uint32_t line = 0;

    Both at(double x) const { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }
    Both slope(double x) const { return c[1] + x * (2 * c[2] + x * 3 * c[3]); }
    Both half_bend(double x) const { return c[2] + 3 * c[3] * x; }
  };
  /// What does not change during a run.
  struct Axes {
    Both tolerance{}, per_tolerance{};
    Both limit{};  ///< of q''/2, counts/unit^2; infinite: none
  };
  /// A segment on trial.
  struct Fit {
    std::int32_t units = 0;
    std::array<std::int32_t, kAxesPerNode> acceleration{};
    double error = 0;  ///< largest error / tolerance
    double drift = 0;  ///< how much of the tolerance the end state will cost the next segment
    double score = 0;  ///< of both, over what is allowed
    bool good() const { return score <= 1; }
  };
  /// Where the first guess ends: at `units`, because of a jump there (`at_jump`), the run's end, or the bend.
  struct Reach {
    double units = 0;
    std::size_t piece = 0;
    bool at_jump = false, at_end = false;
  };
  /// What the end of a segment shall be like.
  enum class Goal : std::uint8_t {
    kRunOn,    ///< position and velocity such that the next segment can be long
    kHalfway,  ///< such that one more segment comes to rest at the run's end
    kRest,     ///< at rest
  };
  /// What a segment on trial shall reach, the same for both axes.
  struct Target {
    Goal goal{};
    double per_h2 = 0;
    std::size_t last = 0, covered = 0;     ///< pieces that hold at the segment's end, and just before it
    double next = 0;                       ///< units that the next segment will go
    double velocity_share = 0, scale = 0;  ///< a = (position + velocity_share * velocity) * scale
  };
  struct Bounds {
    Both low{}, high{};
  };
  /// The axes at the end of a segment without acceleration: what is missing in position, and in velocity
  /// against the best start of the next segment.
  struct Miss {
    Both position{}, velocity{};
    Both bend{};  ///< q''/2 there
  };
  /// Where each axis is farthest from what it should be.
  struct Worst {
    Both x{}, value{};
  };

  /// Everything that apply() changes.
  struct Position {
    std::size_t first = 0;  ///< of the run's pieces
    std::int64_t knot = 0;
    Both p{}, v{};  ///< exact state at the knot as counts and counts/unit
    /// As usual, or wider while the state at the knot is out of it.
    Both tolerance{}, per_tolerance{};
    std::array<AxisState, kAxesPerNode> states{};
  };

  /// A segment that was chosen, and where it begins.
  struct Link {
    Position at;
    Fit fit;
    std::size_t pushed = kWhateverComes;  ///< pieces known, if more of them might have changed the choice
  };
  static constexpr std::size_t kWhateverComes = 0, kLinks = 16;

  const Piece& piece(std::size_t i) const {
    furthest_ = std::max(furthest_, i);
    return pieces_[(at_.first + i) & (kCapacity - 1)];
  }
  std::size_t count() const { return pushed_ - at_.first; }
  Link& link(std::size_t i) { return chain_[(first_link_ + i) % kLinks]; }
  /// More path has come that might have changed the choice.
  bool is_stale(const Link& link) const { return link.pushed != kWhateverComes && link.pushed != pushed_; }
  Piece& place(std::size_t i) { return pieces_[(at_.first + i) & (kCapacity - 1)]; }
  const Piece& place(std::size_t i) const { return pieces_[(at_.first + i) & (kCapacity - 1)]; }
  void append(const Piece& piece);
  void widen(Both offset);
  bool ready() const;
  /// How far the path is known, units from the knot.
  double known() const;
  std::size_t piece_at(double t, std::size_t hint) const;
  bool stops_at(std::size_t index, double b) const;
  Reach reach() const;
  double next_units(double t, std::size_t index, double most) const;
  Miss miss(double h, double next, std::size_t index) const;
  Both resting_acceleration(double h, Goal goal) const;
  Both spare(Both most) const;
  Bounds bounds(double h, std::size_t last) const;
  Worst error_over(Both a, double h, std::size_t last) const;
  Fit fit(std::int32_t units, Goal goal);
  void fit_rest(const Target& target, Fit& f) const;
  void fit_run_on(const Target& target, Fit& f) const;
  Both accelerate(Both wanted, Fit& f) const;
  Fit choose();
  void begin_chain(const Fit& fit);
  bool extend_chain(std::size_t i);
  Fit come_to_rest();
  double steadied(double h) const;
  Fit run_on(const Reach& reach);
  Fit cross_jumps(Fit best, const Reach& reach);
  Fit shrink(Fit failed);
  bool leads_on();
  const Fit& choose_safe();
  void apply(const Fit& fit);
  FittedSegment emit(const Fit& fit);
  std::optional<FittedSegment> settle();

  NodeAxes node_;
  Options options_;
  Counters counters_;
  double raw_per_unit_, unit_per_raw_;        ///< raw acceleration for 1 count/unit^2 of q''/2, and back
  std::array<double, kAxesPerNode> slope_{};  ///< counts per joint unit
  Axes axes_;
  std::vector<Piece> pieces_;  ///< ring of kCapacity
  Position at_;
  mutable std::size_t furthest_ = 0;  ///< piece that was looked at since the last choice began
  std::size_t pushed_ = 0;            ///< pieces of the run
  /// The next segments: each is proved by those that follow. links_ of them, from first_link_ on.
  std::array<Link, kLinks> chain_{};
  std::size_t first_link_ = 0, links_ = 0;
  double run_end_ = 0;  ///< units; valid when complete_
  double start_offset_ = 0;
  bool complete_ = false, ended_ = true;
  bool eased_ = false;  ///< the run's accelerations do not jump
};

}  // namespace kinebus
