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
#include "gateway/shaping/tip_flow.hpp"

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
/// `along_tip`: filament that is fed forward while the tool moves follows the shaped tip's own way instead,
/// so that a bead is as wide as planned where shaping cuts a corner off:
///
///   E' = |sum over pulses: weight * planned E' * direction|
///
/// What corners cut off is not fed: E ends each run by filament_offset_mm() off its plan.
///
/// Pressure advance adds to E what AdvanceWindow makes of A(v) about each instant, shaped in the same way: 0
/// wherever nothing was printed for the length of window and shaper. It begins before the tool moves and ends
/// after it: the run is longer by twice the window's reach.
class PathShaper {
 public:
  using Shapers = std::array<InputShaper, 3>;  ///< X Y Z
  /// Where what is averaged is curved, cubics keep within this of its acceleration: 1 % of a gentle
  /// printer's.
  static constexpr double kAccelTolerance = 10;

  PathShaper() : PathShaper(Shapers{}) {}
  explicit PathShaper(const Shapers& shapers, const AdvanceWindow& window = {}, bool along_tip = false,
                      double filament_offset_mm = 0);

  /// Beads and filament alone, which meet at rest, rest so long between each other.
  void set_pause(double seconds) { pause_s_ = seconds; }

  /// Of the phases pushed from here on. Where it changes, no filament may be flowing: A is continuous then.
  /// It rests there for the pause.
  void set_advance(const AdvanceModel& model) { advance_ = model; }
  const AdvanceWindow& advance_window() const { return window_; }
  /// The model that was set for what begins with the phase given out last, or went on with it.
  const AdvanceModel& advance() const { return advance_out_; }
  /// Of E given out to E as planned, at rest.
  double filament_offset_mm() const { return offset_; }

  /// Not all shapers are a single pulse at 0. Otherwise there is no reason to push anything.
  bool active() const { return taps_.size() > 1; }
  /// By how much runs become longer.
  double duration_s() const { return taps_.back().delay_s; }

  /// Phases in their order, from rest to the one marked `last`. Only when next() has said no. beads: what of
  /// its filament they take, where that is not all that is fed while the tool moves.
  void push(const Phase& phase, const PhaseAdvance::Filament* beads = nullptr);
  /// False: what comes next depends on a phase that was not pushed, or nothing is left.
  bool next(Phase& phase);

  /// What beads take of the filament of the phase given out last; along the tip only.
  const PhaseAdvance::Filament& beads() const { return beads_out_; }

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
    double e_start = 0;              ///< as planned
    PhaseAdvance advance;
    PhaseAdvance::Filament beads{};
    std::array<double, 3> advance_before{};  ///< the sum of the advance by axis at its start
    bool curved = false;
    bool along_tip = false;             ///< its filament is no part of `before`
    std::array<double, 3> direction{};  ///< of the tip in its middle
    AdvanceModel model;
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
    TipFlow flow{};
  };

  void begin(const Phase& phase);
  std::optional<Phase> pause_before(const Phase& phase) const;
  void append(const Phase& phase, const PhaseAdvance::Filament& beads);
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
  void go_on();
  void rebase();
  bool bent() const;
  TipFlow flow_at(double t) const;
  double follow_tip(double h, Knot& end) const;
  std::uint32_t line() const;
  static void hermite(const Knot& a, const Knot& b, double h, PathPiece& piece);

  std::vector<Tap> taps_;   ///< by rising delay
  std::size_t centre_ = 0;  ///< the tap nearest to the mean
  GrowingRing<Source> sources_;
  std::optional<Phase> waiting_;  ///< begins the next stretch
  PhaseAdvance::Filament waiting_beads_{}, beads_out_{};
  bool moving_ = false;           ///< a stretch is begun
  bool ended_ = false;            ///< its last source is known
  bool last_ = false;             ///< and ends the run
  double now_s_ = 0, end_s_ = 0;  ///< given out, planned
  Knot knot_{};                   ///< at now_s_
  Pose start_{}, stop_{};
  std::array<double, 3> filament_start_{}, filament_stop_{};  ///< by axis
  std::array<double, 3> advance_stop_{};                      ///< the same for the sum of the advance
  AdvanceModel advance_, advance_out_;
  AdvanceWindow window_;
  bool along_tip_ = false;
  double since_fed_s_ = 0;                       ///< planned, behind the last that fed along the tip
  double pause_s_ = 0, offset_ = 0, plain_ = 0;  ///< plain_: filament that does not follow the tip, at now_s_
  Frame frame_ = Frame::kPart;
  std::uint32_t line_ = 0;
};

}  // namespace kinebus
