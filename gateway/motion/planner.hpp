#pragma once
// The planner: canonical motion commands in, phases (pose(tau) with constant path acceleration) out.
//
//   canonical lines -> path (lines, blends, merged curves, arcs) -> limits along it -> look-ahead -> phases
//
// Pull style and streaming: memory does not grow with the job. The caller feeds while wants_more(), and pulls
// phases with next(). What comes out never needs more deceleration than the machine has, whatever follows:
// the end of what is known is always planned as a stop.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "gateway/gcode/canonical.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/trajectory.hpp"
#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

/// Why a move cannot be planned. `line` is the job's line (1-based).
struct PlanError {
  enum class Kind : std::uint8_t {
    kPose,       ///< the path leaves where the kinematics works: see `pose`
    kFrame,      ///< a move in another frame than the path's, without a SetPosition between
    kBadNumber,  ///< not a number, or a feed or a duration that is not > 0
    kArc,        ///< centre, normal and target do not make an arc
  };
  Kind kind{};
  std::uint32_t line = 0;
  PoseError pose{};
};
Sentence to_string(const PlanError& error);

class Planner {
 public:
  struct Options {
    /// Look-ahead, in pieces of path (a printed line is about two). 4096 pieces of 10 um still hold the 15 mm
    /// that M1 needs to stop from full speed.
    std::size_t window_pieces = 4096;
  };
  struct Counters {
    std::uint64_t moves = 0;           ///< motion commands with a length
    std::uint64_t merged_moves = 0;    ///< of those, the ones that became part of a merged curve
    std::uint64_t blends = 0;          ///< corners rounded
    std::uint64_t pieces = 0;          ///< pieces of path planned
    std::uint64_t phases = 0;          ///< phases given out
    std::uint64_t forced_flushes = 0;  ///< pieces given out slower than possible, because the window was full
  };

  /// `kinematics` must outlive the planner. The path starts at pose 0, Frame::kMachine, until a SetPosition.
  Planner(const Kinematics& kinematics, const MotionLimits& limits);
  Planner(const Kinematics& kinematics, const MotionLimits& limits, Options options);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Takes Traverse, Feed, Arc, PathMode, SetPosition, Limits and Override (its feed part); all other
  /// commands are of no concern here and ignored. After an error the planner refuses everything until
  /// reset(). No allocation once the window has been filled once.
  Result<void, PlanError> add(const canonical::Line& line);

  /// What filament may do in the moves added from here on, before which the path rests. Stays in force over
  /// reset().
  Result<void, PlanError> limit_filament(const FilamentLimits& limits);
  /// Other limits of the machine (the same ones of jerk stay), from the reset() on that must follow. What
  /// filament was limited to besides is forgotten.
  void limit_machine(const MotionLimits& limits);

  /// Plans all that was added to a stop at its end. The last phase carries `last`. More may be added
  /// afterwards (it starts from rest there), but only after all phases have been pulled.
  Result<void, PlanError> finish();

  /// Plans what was added so far. Input that comes slowly needs it: without, pieces are planned in batches,
  /// and the newest of them become final only with those that follow.
  void plan_known();

  /// Time from here to a stop at the end of all that was added and not pulled, s; and of the part that
  /// nothing added later can change. Within 50 ms and a few percent. Cost: a look at each piece held, once
  /// for 50 ms of motion added.
  struct Ahead {
    double final_s = 0, all_s = 0;
  };
  Ahead ahead();

  /// Feed more (true) or pull phases first (false). Feeding beyond is allowed, but makes the window grow.
  bool wants_more() const;

  /// The next phase, if one is final. False: feed more, or finish().
  bool next(Phase& phase);

  /// All that was added has been given out (after finish()).
  bool idle() const;

  /// Where the programmed path ends now, and in which frame.
  const Pose& end_pose() const;
  Frame end_frame() const;

  /// Forgets all planned motion (cancel, alarm); the path starts at `pose`. Limits and modes return to their
  /// defaults.
  void reset(const Pose& pose, Frame frame);

  const Counters& counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinebus
