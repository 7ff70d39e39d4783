#pragma once
// Phases -> shaped phases: pose(tau) convolved with pulses, axis by axis, and pressure advance of the
// filament along what comes out.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/motion/growing_ring.hpp"
#include "gateway/motion/trajectory.hpp"
#include "gateway/shaping/advance_model.hpp"
#include "gateway/shaping/input_shaper.hpp"

namespace kinebus {

/// Pull style, like the planner: push() a phase when next() has none left. What comes out are timed phases
/// (Phase::timed): cubics in path time, C1 from rest to rest, within 10 nm of
///
///   x(tau) = sum over pulses: weight * planned(tau - time)
///
/// for each axis with the pulses of its own shaper; all shapers' mean times are the same, that of the
/// longest. A run ends later by the longest shaper, exactly where it was planned to end, at rest. Between two
/// places where the poses do not join (another frame) the motion comes to rest in the same way.
///
/// A and C are shaped as X is: machines with rotations have one shaper for all axes, so that the tip keeps to
/// the part. Filament: each stretch of it is shaped like the tip's motion along which it was planned, in
/// proportion to the squares of the direction's components; with one shaper for all axes that is E itself.
///
/// Pressure advance adds to E what AdvanceWindow makes of A(v) about each instant, shaped in the same way: 0
/// wherever nothing was printed for the length of window and shaper. It begins before the tool moves and ends
/// after it: the run is longer by twice the window's reach.
class PathShaper {
 public:
  using Shapers = std::array<InputShaper, 3>;  ///< X Y Z

  PathShaper() : PathShaper(Shapers{}) {}
  explicit PathShaper(const Shapers& shapers, const AdvanceWindow& window = {});

  /// Of the phases pushed from here on. Where it changes, no filament may be flowing: A is continuous then.
  void set_advance(const AdvanceModel& model) { advance_ = model; }
  const AdvanceWindow& advance_window() const { return window_; }

  /// Not all shapers are a single pulse at 0. Otherwise there is no reason to push anything.
  bool active() const { return taps_.size() > 1; }
  /// By how much runs become longer.
  double duration_s() const { return taps_.back().delay_s; }

  /// Phases in their order, from rest to the one marked `last`. Only when next() has said no.
  void push(const Phase& phase);
  /// False: what comes next depends on a phase that was not pushed, or nothing is left.
  bool next(Phase& phase);

  /// Everything pushed was given out.
  bool empty() const { return !moving_ && !waiting_; }
  /// Of the motion pushed, what was not given out, s.
  double held_s() const;
  /// Forgets all.
  void reset();

 private:
  struct Source {
    Phase phase;
    double start_s = 0;              ///< since `origin`
    std::array<double, 3> share{};   ///< of the filament, by axis
    std::array<double, 3> before{};  ///< filament by axis at its start
    PhaseAdvance advance;
    std::array<double, 3> advance_before{};  ///< the sum of the advance by axis at its start
    bool curved = false;
  };
  /// One delayed copy of the planned motion.
  struct Tap {
    double delay_s = 0;
    std::array<double, 3> weight{};         ///< X Y Z
    std::array<double, 3> advance_per_s{};  ///< of the sum of the advance
    std::uint64_t at = 0;                   ///< of sources_: what it looks at
    bool begun = false;                     ///< it has left the pose at the start
  };
  struct Knot {
    Pose x{}, x1{}, x2{};
  };

  void begin(const Phase& phase);
  std::optional<Phase> pause_before(const Phase& phase) const;
  void append(const Phase& phase);
  bool joins(const Phase& phase) const;
  double end_of(const Source& source) const { return source.start_s + source.phase.duration_s; }
  /// When the tap next comes to another source; none: it rests for good, or (`unknown`) what follows is not
  /// known yet.
  std::optional<double> turn_of(const Tap& tap, bool& unknown) const;
  Knot evaluate(double t) const;
  void add(const Tap& tap, const PosePoint& point, const std::array<double, 3>& before,
           const std::array<double, 3>& share, double e_start, Knot& knot) const;
  void add_advance(const Tap& tap, const PhaseAdvance::Sum& sum, const std::array<double, 3>& before,
                   const std::array<double, 3>& share, Knot& knot) const;
  Tap& tap_at(double delay_s);
  void advance();
  void rebase();
  std::uint32_t line() const;
  static void hermite(const Knot& a, const Knot& b, double h, PathPiece& piece);

  std::vector<Tap> taps_;   ///< by rising delay
  std::size_t centre_ = 0;  ///< the tap nearest to the mean
  GrowingRing<Source> sources_;
  std::optional<Phase> waiting_;  ///< begins the next stretch
  bool moving_ = false;           ///< a stretch is begun
  bool ended_ = false;            ///< its last source is known
  bool last_ = false;             ///< and ends the run
  double now_s_ = 0, end_s_ = 0;  ///< given out, planned
  Knot knot_{};                   ///< at now_s_
  Pose start_{}, stop_{};
  std::array<double, 3> filament_start_{}, filament_stop_{};  ///< by axis
  std::array<double, 3> advance_stop_{};                      ///< the same for the sum of the advance
  AdvanceModel advance_;
  AdvanceWindow window_;
  Frame frame_ = Frame::kPart;
  std::uint32_t line_ = 0;
};

}  // namespace kinebus
