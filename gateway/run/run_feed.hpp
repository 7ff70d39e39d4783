#pragma once
// The phases of a job on their way into the stream, and which place of the job each path time is. After a
// stop the motion goes on from exactly there, as a new run that begins at rest.

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/jobs/job_place.hpp"
#include "gateway/motion/start_ramp.hpp"
#include "gateway/stream/stream_group.hpp"

namespace kinebus {

class RunFeed {
 public:
  /// How path time maps to places of the job, as long as this run is streamed.
  struct Run {
    PathTime start{0};
    JobPlace from;      ///< the place at `start`
    double ramp_s = 0;  ///< from rest to the planned speed; 0: planned from rest
    friend bool operator==(const Run&, const Run&) = default;
  };

  explicit RunFeed(StreamGroup& group) : group_(group) {}

  /// A new job: no phase is there yet.
  void reset();

  // Forward: pipeline -> add() -> pump() -> group.
  /// The job's next phase.
  void add(const Phase& phase);
  /// All phases added are in the group, which wants more (or has no run yet).
  bool wants_phase(PathTime tau) const;
  /// Into the group, as far as it wants. Begins and releases the run with its first phase.
  Result<void, StreamError> pump(PathTime tau);
  bool pending() const { return next_ < originals_.size() || at_piece_ < pieces_.size(); }
  /// Of the phases added, what is not in the group, s.
  double pending_s() const;
  /// A run is in the group.
  bool streaming() const { return streaming_; }
  /// Of the last run.
  PathTime run_start() const { return run_.start; }
  /// The run in the group is done; all phases added are.
  void end_run();
  /// The run that began in the last pump(), once.
  std::optional<Run> take_begun() { return std::exchange(begun_, std::nullopt); }

  // Places.
  /// Phases of the job that were added.
  std::uint64_t added() const { return first_ + originals_.size(); }
  JobPlace place(PathTime tau) const;
  /// Planned time of the job's motion up to there, s.
  double done_s(PathTime tau) const;
  /// When a phase of the job begins in path time; nothing: the group does not have it yet, or not any more.
  std::optional<PathTime> start_of(std::uint64_t phase) const;
  /// Forgets what lies before `tau`: no node will ask for it.
  void forget_before(PathTime tau);
  /// The planned pose at `tau`; for a while back and as far ahead as is planned.
  std::optional<PosePoint> pose(PathTime tau, Frame& frame, std::uint32_t& line) const;

  // Interruption.
  /// The run was lost at `tau`: what follows there is kept.
  void suspend(PathTime tau);
  /// The run was ended at a place that is none of the job: what is left of what was added is dropped.
  void cut();
  /// What was suspended goes on, from rest, as a run of its own.
  void go_on(double ramp_s) { ramp_s_ = ramp_s; }
  /// Where the tool is to stand before it goes on; false: the job has not moved yet.
  bool rest_pose(Pose& pose, Frame& frame, std::uint32_t& line) const;
  /// All filament positions from now on are greater by this, mm.
  void shift_extruder(double by_mm) { extruder_shift_mm_ += by_mm; }
  double extruder_shift_mm() const { return extruder_shift_mm_; }

  // After a restart of the gateway: the job is read again from its beginning.
  /// Phases added are taken as done, up to this place.
  void replay_to(const JobPlace& place);
  /// The same, up to the place that `target` is in this run.
  void replay_to(const Run& run, PathTime target);
  bool replaying() const { return replaying_; }
  /// The job goes on with this one of its phases: those before it were not all given out.
  void skip_to(std::uint64_t phases);
  /// The job has no more phases: its end is the place.
  void end_replay();

 private:
  struct Piece {  ///< what the group gets: an original phase, or part of one at another speed
    PathTime start{0};
    double start_s = 0;  ///< since the run's start
    std::uint64_t ordinal = 0;
    double from_s = 0;  ///< into the original; counts when not ramped
    bool ramped = false;
    Phase phase;
  };
  struct Original {
    Phase phase;
    double job_s = 0;  ///< planned time of the job before it
  };

  const Original& original(std::uint64_t ordinal) const { return originals_[ordinal - first_]; }
  const Piece* covering(PathTime tau) const;
  static PathTime end_of(const Piece& piece);
  double original_time(const Piece& piece, double into_s) const;
  void cut_next();
  void keep_from(const JobPlace& place);
  void drop_first();
  void replay(const Phase& phase);
  void begin_run();
  Phase shifted(Phase phase) const;

  StreamGroup& group_;
  std::deque<Original> originals_;  ///< from the one in motion on, and for a while back
  std::uint64_t first_ = 0;         ///< ordinal of originals_[0]
  std::size_t next_ = 0;            ///< of originals_: next to be cut into pieces
  double next_from_s_ = 0;          ///< into it
  std::deque<Piece> pieces_;
  std::size_t at_piece_ = 0;  ///< of pieces_: next for the group
  std::vector<Phase> cut_;
  std::optional<Phase> passed_;  ///< the last original that was forgotten
  StartRamp ramp_;
  double ramp_s_ = 0;  ///< of the next run
  double fed_s_ = 0;   ///< of the run, cut into pieces
  double job_s_ = 0;   ///< of the job, added
  double extruder_shift_mm_ = 0;
  bool streaming_ = false;  ///< a run is begun
  bool released_ = false;   ///< its start is named
  Run run_;
  std::optional<Run> begun_;

  bool replaying_ = false, replays_run_ = false;
  JobPlace replay_place_;
  PathTime replay_target_{0};
};

}  // namespace kinebus
