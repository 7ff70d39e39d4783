#pragma once
// text -> interpreter -> planner -> shaper -> phases, step by step, with the commands that are no motion in
// between, each at its place on the path. Memory does not grow with the job.
//
// A job is a chain of runs. A run is motion from rest to rest; between two runs stand the commands for which
// motion must have come to rest (barriers: dwell, waits, pauses). Commands that need no rest (M104, M106,
// messages) are events: they name the path time of their run at which they fall due, and motion goes on.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "gateway/jobs/job_place.hpp"
#include "gateway/jobs/melt_rule.hpp"
#include "gateway/jobs/problem.hpp"
#include "gateway/kinematics/geometry.hpp"
#include "gateway/motion/planner.hpp"
#include "gateway/shaping/motion_shaper.hpp"
#include "gateway/shaping/shaped_limits.hpp"

namespace kinebus {

class JobPipeline {
 public:
  enum class Step : std::uint8_t {
    kPhase,    ///< phase() is the next piece of motion of this run
    kEvent,    ///< command() falls due at event_s() of the run; motion goes on
    kRunEnd,   ///< all phases of the run were given out (only after at least one); it ends at rest
    kBarrier,  ///< command() is to be carried out at rest, before the next step is asked for
    kMelt,     ///< at rest: filament is fed next, and the text has not waited for the hot end to melt it
    kProbed,   ///< the move of a probe, begun at a barrier, ended at its target, if not before: probed()
    kEnd,      ///< the job is over
    kProblem,  ///< problem(): a line is refused. The next step goes on with the line after it.
    kMore,     ///< the budget is used up, or the text is on its way: call again
    kStarved,  ///< live commands only: all that was added is used, and what follows is not known yet
  };

  JobPipeline(const MachineDescription& machine, const Kinematics& kinematics);

  /// A job's text. The machine stands at `start` (Frame::kMachine). `source` must outlive the job and be at
  /// its beginning. `offsets`: of G54 .. G59.3, as the machine has them.
  void start_job(ByteSource& source, const Pose& start, const gcode::WorkOffsets& offsets = {});
  /// Motion put in by hand (jog, reference): the commands, then the end.
  void start_commands(std::vector<canonical::Line> commands, const Pose& start);

  /// Commands that come over time, by add(), until end_live(). What was added is given out as far as it can
  /// be planned without knowing what follows; settle_live() gives out the rest, to a stop.
  void start_live(const Pose& start);
  void add(const canonical::Line& line);
  void settle_live();
  /// Plans what was added, as far as no rest comes before it.
  void plan_live();
  /// A rest comes before what is added now.
  bool rest_first() const { return stage_ != Stage::kFeeding; }
  /// Of the motion that was not given out.
  Planner::Ahead ahead();
  void end_live() { text_done_ = true; }
  /// Commands added and not yet used.
  std::size_t waiting() const { return commands_.size() - next_command_; }
  /// All that was added is used and given out.
  bool live_idle() const;

  /// Does work worth at most about `budget` lines (and takes the lines done off it).
  Step next(int& budget);

  const Phase& phase() const { return phase_; }
  const canonical::Line& command() const { return command_; }
  double event_s() const { return event_s_; }
  const Problem& problem() const { return problem_; }
  /// How the move of the probe has ended, before the next step is asked for; until kProbed it may be cut
  /// short.
  void probed(const gcode::ProbeResult& result);
  /// What the input of an AwaitInput was, before the next step is asked for; otherwise the text goes on as if
  /// it had come.
  void input_read(double value);
  /// What is taken for it where nobody can measure: contact at the table's surface if the move goes through
  /// it, else at its target.
  gcode::ProbeResult assumed_probe() const;
  /// Where the probe touched since a mesh was begun, or since the job was: table coordinates.
  const std::vector<Vector3>& touched() const { return touched_; }
  /// The text's wait for the hot end was cut short.
  void melt_not_awaited() { melt_.not_awaited(); }
  /// At rest, behind a command: the tool's place is named so from here on.
  void stands(const Pose& pose, Frame frame);
  /// Where a probe's move ends, or would have.
  const canonical::Probe& probe() const { return probe_; }
  /// What was accepted without effect since the last call, once for each code.
  std::vector<gcode::Note> take_notes();

  /// Motion ends of the phases given out, s of the present run.
  double run_s() const { return run_s_; }
  std::uint32_t lines() const { return lines_; }  ///< lines read so far
  std::uint64_t bytes() const { return bytes_; }  ///< bytes read so far
  const Planner& planner() const { return planner_; }
  /// Of E in phases given out to E as planned, at rest: what shaping has cut off corners was not fed.
  double filament_offset_mm() const { return shaper_.filament_offset_mm(); }
  /// Feed override above 1, for motion that is not planned yet. 1 and below is a matter of path time, not of
  /// planning.
  void set_feed_scale(double scale) { feed_scale_ = scale; }
  double feed_scale() const { return feed_scale_; }
  /// Motion commands planned so far: where a change of the scale takes effect.
  std::uint64_t moves_taken() const { return moves_taken_; }
  /// Changes of the scale that a reading of this job before this one had, in their order.
  void replay_feed_scales(std::vector<FeedScale> scales) { scales_.assign(scales.begin(), scales.end()); }

  // Objects of the print (pipeline_objects.cpp).
  /// Those that the text has named so far.
  std::span<const gcode::PrintObject> objects() const;
  /// What is not read yet of an object is left out. The place tells where, for another reading of the job.
  Result<LeftOut, Sentence> leave_out(const std::string& name);
  void replay_left_out(const std::vector<LeftOut>& all) { left_out_.assign(all.begin(), all.end()); }

 private:
  enum class Stage : std::uint8_t {
    kFeeding,   ///< commands go into the planner
    kDraining,  ///< a barrier or the end was met: the planner gives out what it holds
    kSettled,   ///< nothing is left in the planner: events, the run's end, the barrier
    kProbes,    ///< a probe's move is to be planned
    kProbed,    ///< and is given out: how it ended is to be told
    kEnded,
  };

  void begin(const Pose& start);
  void refuse(std::uint32_t line, std::uint32_t column, Sentence words);
  void number_commands();
  std::uint32_t line_of(std::uint32_t place);
  bool pull_phase();
  // pipeline_advance.cpp: pressure advance, input shaping
  void begin_advance();
  bool take_advance(const canonical::Line& line);
  void limit_filament(const AdvanceModel& model);
  bool take_shaping(const canonical::Line& line);
  void begin_shaping(std::uint32_t line);
  bool push_planned();
  void check_shaped();
  std::optional<Step> take_phase();
  std::optional<Step> settle();
  bool take_known();
  void read_text(int& budget);
  std::uint64_t steps_read() const { return reader_->lines() + reader_->steps(); }
  void leave_out_again();
  void take(const canonical::Line& line);
  void take_motion(const canonical::Line& line);
  void add_to_planner(const canonical::Line& line);
  void drain(std::optional<canonical::Line> barrier);
  void plan_probe();
  // pipeline_thread.cpp
  void watch_thread(const Phase& phase);
  void check_thread();
  void watch_tap(const Phase& phase, double end);
  void start_at(const Pose& pose, Frame frame, std::uint32_t line);
  void home(const canonical::Home& home, std::uint32_t line);

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  Planner planner_;
  MotionShaper shaper_;
  ShapedLimits shaped_limits_;
  AdvanceModel advance_;            ///< of the commands taken
  VibrationDescription vibration_;  ///< the same
  canonical::InputShaping asked_shaping_;
  bool shaping_ = false;  ///< phases go through the shaper
  struct AdvanceFrom {
    std::uint32_t line = 0;
    AdvanceModel model;
  };
  std::deque<AdvanceFrom> advances_;  ///< for the phases of later lines
  Phase planned_{};                   ///< on its way from the planner to the shaper
  /// In force, and how its motion is planned.
  struct Thread {
    canonical::SpindleSync sync{};
    double fastest_per_s = 0;
    std::uint32_t line = 0;  ///< as a place
    bool slows = false;      ///< behind its speed, before the end
    bool slowed = false;     ///< and was as fast again
    bool corners = false;    ///< more than one move: path mode says how fast they are
    double way_mm = 0;       ///< of a tap, so far
    double fast_mm = -1;     ///< where it was as fast as its thread
    bool slow_turn = false;  ///< slower to turn back than the spindle
  } thread_;
  void check_tap(const Thread& thread);
  bool over_limit_ = false;  ///< the last shaped phase was: one report for each time
  std::unique_ptr<gcode::Interpreter> interpreter_;
  std::unique_ptr<gcode::JobReader> reader_;
  ByteSource* source_ = nullptr;
  std::vector<char> text_;  ///< read, not yet interpreted: from text_at_ to text_end_
  std::size_t text_at_ = 0, text_end_ = 0;

  // Inside, a command's line is its place in the order in which lines are carried out, which loops and
  // subroutines make differ from the text's. While it is the same, nothing is noted.
  struct Place {
    std::uint32_t place = 0, line = 0;
  };
  std::deque<Place> places_;  ///< from here on: this line

  gcode::CommandBuffer commands_;  ///< interpreted, not yet taken: from next_command_ on
  std::size_t next_command_ = 0;
  std::deque<canonical::Line> first_;             ///< go before commands_ (G28)
  std::deque<canonical::Line> events_;            ///< wait for the motion of a later line
  std::optional<canonical::PathMode> path_mode_;  ///< in force: the planner forgets it at reset
  canonical::Limits limits_{};                    ///< the same

  Stage stage_ = Stage::kEnded;
  bool in_run_ = false;       ///< phases of this run were given out
  bool text_done_ = true;     ///< nothing more to read
  bool ends_ = false;         ///< draining towards the job's end
  bool phase_waits_ = false;  ///< phase_ was pulled; events due before it go first
  bool melt_due_ = false;     ///< draining towards kMelt
  MeltRule melt_;
  std::optional<canonical::Line> barrier_;
  canonical::Probe probe_;
  std::uint32_t probe_line_ = 0;  ///< as a place
  Pose probe_start_{};            ///< in its frame
  bool probing_ = false;          ///< its move is on the way
  std::vector<Vector3> touched_;
  std::optional<Problem> refused_;  ///< waits to be given out
  Phase phase_{};
  canonical::Line command_;
  double event_s_ = 0, run_s_ = 0, feed_scale_ = 1;
  std::uint64_t moves_taken_ = 0;
  std::deque<FeedScale> scales_;
  std::deque<LeftOut> left_out_;  ///< by a reading before this one, to come
  Problem problem_;
  std::uint32_t lines_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace kinebus
