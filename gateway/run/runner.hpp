#pragma once
// Carries a job or a single move out: takes the pipeline's steps, streams motion, executes what stands
// between runs, and says at which rate path time may run.

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/bodies/printed_part.hpp"
#include "gateway/jobs/job_check.hpp"
#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/jobs/journal/journal_state.hpp"
#include "gateway/run/bed_level.hpp"
#include "gateway/run/heat.hpp"
#include "gateway/run/planned_pose.hpp"
#include "gateway/run/run_feed.hpp"
#include "gateway/run/smooth_ramp.hpp"
#include "gateway/run/spindle_follower.hpp"
#include "gateway/run/tap_spindle.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/event_queue.hpp"
#include "gateway/stream/path_rate.hpp"
#include "gateway/stream/stream_group.hpp"

namespace kinebus {

class Runner {
 public:
  enum class Outcome : std::uint8_t { kBusy, kPaused, kDone, kFailed, kEmergencyStop, kProbed };
  struct Failure {
    std::uint32_t line = 0;
    Sentence words;
    bool stream = false;  ///< between gateway and nodes, not in the job
  };
  struct Counters {
    std::uint32_t bus_slowdowns = 0, starvation_holds = 0;
    std::uint32_t live_stops = 0;  ///< planned stops in motion, because the next line had not come yet
  };

  /// All must outlive this. `printed` grows by what is printed, and is cleared where a job or lines say that
  /// the table is empty; nullptr: nobody looks at it.
  Runner(const MachineDescription& machine, const Kinematics& kinematics, StreamGroup& group, PathRate& rate,
         Heat& heat, EventQueue& events, journal::Queue& journal, bodies::PrintedPart* printed = nullptr);

  /// A job's text from its beginning, the machine standing at `start` (Frame::kMachine).
  void start_job(std::unique_ptr<ByteSource> source, const Pose& start, const gcode::WorkOffsets& offsets);
  /// Motion by hand.
  void start_commands(std::vector<canonical::Line> commands, const Pose& start);
  /// Commands that come over time, by add(). When they come too slowly motion ends in a planned stop and goes
  /// on with the next ones. Over after end_live(), when all are carried out.
  void start_live(const Pose& start);
  void add(BusTime now, const canonical::Line& line);
  void end_live() { pipeline_.end_live(); }
  bool live() const { return active_ && live_; }
  /// After the commands of a line: they are planned as far as no rest comes before them.
  void plan_live() { pipeline_.plan_live(); }
  /// Lines that may be added now, of `most`: none when more motion is known than the machine's lead for a
  /// print host, except where a stop on the path needs more.
  std::size_t live_room(BusTime now, std::size_t most);
  /// A wait for a temperature is over, as if it were reached.
  void skip_heating();
  /// Filament that does not melt is about to be fed, so soon that the path has to stop for it now. Up to
  /// where it was fed hot, what was drawn back may return. Where nothing tells how hot it is, it is believed
  /// until it was hot once.
  bool feeds_cold(BusTime now);
  /// Filament was fed hot since the beginning.
  bool feeds() const { return active_ && molten_mm_ > start_[kE] - feed_.extruder_shift_mm(); }
  /// When the next output of the job (M62 to M68) is due by the present rate: it is switched within a
  /// millisecond of its place on the path.
  BusTime next_output(BusTime now) const;
  /// All that was added is carried out, at rest.
  bool live_idle() const {
    return live() && !feed_.streaming() && !feed_.pending() && wait_ == Wait::kNone && pipeline_.live_idle();
  }
  bool active() const { return active_; }

  // Probing: a move that ends where the probe touches. on_time() says kProbed when path time rests behind
  // that: what the nodes hold is to be dropped, and probed() to be told where they stand.
  bool probing() const { return probing_; }
  /// Where levelling commands go; none: they are refused.
  void set_bed(BedLevel* bed) { bed_ = bed; }
  /// As soon as the probe may have told something.
  void look_at_probe(BusTime now);
  /// `stand`: Frame::kMachine.
  Outcome probed(const Pose& stand);
  /// What live lines have to know before the next one is read, for each of their probes and levelling
  /// commands, once: how the probe has ended, or where the tool stands by another name.
  struct Answer {
    std::optional<gcode::ProbeResult> probed{};
    std::optional<PlannedPose> stand{};
    std::optional<double> input{};
  };
  std::vector<Answer> take_answers() { return std::exchange(answers_, {}); }

  // Threads.
  /// The tool goes with the spindle: a hold waits for the end of the pass, and a stop ends the job.
  bool cuts_thread() const;
  /// Within a tap: whoever can wait does, until it is out of the hole.
  bool taps() const { return cuts_thread() && tap_.deep_mm > 0; }

  // Interruption: the stream is lost, the job is not.
  /// What the job has left from path time `tau` on is kept; nothing happens until go_on().
  void suspend(PathTime tau);
  bool suspended() const { return suspended_; }
  /// The pause that it waits in is for a change of filament.
  bool changes_filament() const { return active_ && wait_ == Wait::kPause && filament_change_; }
  /// From rest, with the tool at rest_pose().
  void go_on(BusTime now);
  /// Where the tool has to stand for go_on(), and the line of the job there.
  PlannedPose rest_pose() const;
  /// The filament stands this much further than planned, mm, and is right so.
  void shift_extruder(double by_mm);
  double extruder_shift_mm() const { return feed_.extruder_shift_mm(); }
  PathTime run_start() const { return feed_.run_start(); }
  std::unique_ptr<ByteSource> take_source() { return std::move(source_); }
  JobPlace place(PathTime tau) const { return feed_.place(tau); }

  /// Reads a job again, up to where `state` says that it was, and suspends it there. `tau`: where the nodes'
  /// path time stands, when `state` knows a run. Then replay() until it is no longer busy.
  void start_replay(std::unique_ptr<ByteSource> source, const journal::State& state, PathTime tau);
  /// Worth at most about `budget` lines. kDone: suspended(); kFailed: failure().
  Outcome replay(int budget);

  /// Plans at most about `budget` lines ahead, executes what is due.
  Outcome on_time(BusTime now, int budget);
  /// The last on_time() left lines to plan.
  bool plans_on() const { return plans_on_; }
  const Failure& failure() const { return failure_; }

  /// Feed hold: the rate goes to 0, in a thread behind the pass, and the waits between runs stand still.
  void hold(BusTime now);
  void hold_at_once(BusTime now);  ///< in a thread, too
  /// The same, and what the job commands besides motion waits for go_on(), too.
  void hold_still(BusTime now) {
    hold_at_once(now);
    keep_still();
  }
  /// The move under way goes on, and nothing else is commanded until go_on().
  void keep_still() { still_ = true; }
  /// Goes on after hold() and after a pause of the job.
  void resume(BusTime now);
  /// Above 1: what is planned from now on is planned faster; at most 1: the rate of path time.
  void set_override(double ratio);
  /// What is not planned yet of an object of the print is left out; the journal keeps it.
  Result<void, Sentence> leave_out(const std::string& name);
  std::uint32_t lines_read() const { return pipeline_.lines(); }
  std::span<const gcode::PrintObject> objects() const { return pipeline_.objects(); }
  /// The job is over (done, cancelled, lost); what is queued is the caller's to clear.
  void drop();

  /// No motion is queued or under way: a hold or a cancel needs no ramp.
  bool between_runs() const { return !feed_.streaming(); }
  /// Path time of motion carried out and in all, s: what progress is measured by.
  double done_s(BusTime now) const;
  std::uint32_t line(BusTime now) const;
  std::uint64_t bytes() const { return pipeline_.bytes(); }
  /// The exact planned pose at path time `tau`, by the phases of the last second and all that are queued.
  std::optional<PlannedPose> planned_pose(PathTime tau) const;
  /// The filament that will be fed, mm/s: means over steps of kFlowAheadStep, the first from `now`, as path
  /// time is to go on now. Less than 0: drawn back.
  FlowAhead filament_ahead(BusTime now) const;
  const Sentence& doing() const { return doing_; }
  const Counters& counters() const { return counters_; }

 private:
  /// At rest no joint feels a ramp: path time is let go and caught at once.
  static constexpr std::chrono::milliseconds kRampAtRest{2};
  enum class Wait : std::uint8_t {
    kNone,
    kRunDone,
    kRest,
    kDwell,
    kHeating,
    kMelt,  ///< the hot end is to be hot enough to feed
    kSpindle,
    kPause,
    kPinOut,
    kPinStays,  ///< out, by a word of the job
    kProbeReady,
    kProbeEnd,
    kPinIn,
    kInput
  };
  struct Event {
    std::uint64_t phase;  ///< due when so many phases of the job are done
    canonical::Line line;
  };

  void begin();
  void take_phase();
  Outcome stream(BusTime now);
  bool waits(const canonical::Line& line) const;
  void end_wait();
  void control_rate(BusTime now);
  double wanted_rate(BusTime now);
  bool waits_for_journal(BusTime now) const;
  /// In motion, as gently as the joints have to be treated.
  void change_rate(double rate, BusTime now);
  void settle_when_late(BusTime now);
  double live_left_s(BusTime now) const;
  bool wait_is_over(BusTime now);
  void execute_due(BusTime now);
  void execute(BusTime now, const canonical::Line& line);
  Outcome take(BusTime now, JobPipeline::Step step);
  Outcome barrier(BusTime now);
  Outcome fail(std::uint32_t line, Sentence words, bool stream);
  void begin_probe();
  bool probe_has_answered();
  void arm_probe();
  bool pin_is(ContactProbe::Pin where);
  bool draw_pin_in();
  void move_pin(const canonical::ProbePin& asked);
  void give_up_probe();
  std::chrono::milliseconds probe_ramp(BusTime now) const;
  void end_probe(const gcode::ProbeResult& result);
  // runner_input.cpp
  void begin_input(const canonical::AwaitInput& wait);
  void look_at_input_anew();
  bool input_has_come(BusTime now);
  void end_input(double value);
  // runner_thread.cpp
  void begin_thread(const canonical::SpindleSync& sync);
  bool is_within_thread() const;
  void follow_spindle(BusTime now);
  std::optional<double> thread_rate(BusTime now);
  void lose_thread(double turns);
  // runner_tap.cpp
  /// Under way: where it goes, and how far the spindle is turned back.
  struct Tap {
    double deep_mm = 0;  ///< 0: there is none
    double pitch_mm = 0, feed_per_s = 0;
    double told_rpm = 0;  ///< at first
    TapSpindle spindle;
    PosePoint start{}, ground{};
    PathTime looked{0};               ///< for the corner
    std::optional<PathTime> corner;   ///< where the tool turns back
    std::optional<double> run_in_mm;  ///< what the tool is behind the spindle since its way to full speed
    bool fast_out = false;            ///< behind the corner it was at full speed
  };
  void begin_tap(const canonical::SpindleSync& sync);
  void look_at_spindle();
  void follow_tap(BusTime now);
  std::optional<double> tap_rate(BusTime now);
  void find_corner();
  void turn_spindle_back(BusTime now);
  std::optional<PosePoint> tap_point(PathTime tau) const;
  double tap_way(PathTime tau) const;
  double tap_goal(BusTime at) const;
  PathTime tap_place(double way, PathTime near) const;
  // runner_levelling.cpp
  Outcome level(BusTime now, const canonical::Mesh& mesh, std::uint32_t line);
  void learn(journal::Learned learned);
  bool stand_at(Frame frame, const Pose& pose);
  void check_what_follows();
  bool replay_learned(journal::Learned::What what);
  Outcome probe_outcome(BusTime now);
  std::optional<Failure> wrong_after_probe(JobPipeline::Step step);
  void change_tool(int hotend);
  /// nullptr: nothing is to be waited for.
  const HeaterDescription* awaited(const canonical::Thermal& thermal) const;
  void begin_heating(const canonical::Thermal& thermal);

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  StreamGroup& group_;
  PathRate& rate_;
  Heat& heat_;
  EventQueue& events_out_;
  journal::Queue& journal_;
  bodies::PrintedPart* printed_;
  JobPipeline pipeline_;
  RunFeed feed_;
  SmoothRamp smooth_ramp_;
  SpindleFollower follower_;
  Tap tap_;
  SpindleFollower per_turn_;       ///< of the moves whose feed goes by the measured speed
  std::uint64_t thread_from_ = 0;  ///< the pass's first phase
  bool thread_over_ = false;       ///< its last one came from the pipeline
  bool hold_waits_ = false;        ///< for its end
  std::optional<Sentence> thread_lost_;
  std::unique_ptr<ByteSource> source_;
  Pose start_{};

  bool active_ = false, held_ = false, still_ = false, suspended_ = false, plans_on_ = false;
  bool live_ = false;           ///< commands come over time
  bool noted_ = false;          ///< in the journal: a job, not a motion by hand
  bool started_ = false;        ///< path time was let go for this run
  bool finished_ = false;       ///< the run's last phase came from the pipeline
  bool barrier_waits_ = false;  ///< the pipeline's command is to be carried out first
  std::uint64_t waits_done_ = 0, waits_replayed_ = 0;
  bool stop_asked_ = false;
  bool filament_change_ = false;  ///< the last pause was for one
  /// Each hot end was hot while this moved and used it.
  std::array<bool, kMostOfAKind> has_melted_{};
  double molten_mm_ = 0;  ///< the farthest that filament was fed hot into the one in use, by the plan
  Wait wait_ = Wait::kNone;
  std::deque<Event> events_;
  HeatWait heating_;
  BusTime last_time_{0}, dwell_left_{0}, last_rate_change_{0}, run_noted_{0}, last_added_{0};
  double override_ = 1;
  std::uint32_t last_line_ = 0;
  canonical::AwaitInput awaited_input_;
  Input::Changes input_before_;         ///< since when its changes count
  bool probing_ = false;                ///< from the command on, until its result is known
  bool probe_cut_ = false;              ///< the probe has told: its move ends here
  std::optional<PlannedPose> touched_;  ///< where the tool was
  std::optional<Sentence> probe_wrong_;
  std::vector<Answer> answers_;
  std::vector<journal::Learned> learned_;  ///< of the job that is read again
  std::size_t next_learned_ = 0;
  BedLevel* bed_ = nullptr;
  std::unique_ptr<JobCheck> check_;  ///< of what depends on what a probe has measured; nullptr: nothing does
  Sentence doing_;
  Failure failure_;
  Counters counters_;
};

}  // namespace kinebus
