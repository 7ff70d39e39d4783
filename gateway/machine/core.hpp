#pragma once
// The inside of Gateway: the parts, and how they are joined. Implementation in core_*.cpp, by what calls it.

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/jobs/bus_load.hpp"
#include "gateway/jobs/hashed_source.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/jobs/live_lines.hpp"
#include "gateway/jobs/preflight.hpp"
#include "gateway/machine/bring_up.hpp"
#include "gateway/machine/event_queue.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/machine/homing.hpp"
#include "gateway/machine/node_link.hpp"
#include "gateway/machine/path_rate.hpp"
#include "gateway/machine/runner.hpp"
#include "gateway/machine/standstill.hpp"
#include "gateway/machine/thermal.hpp"
#include "gateway/stream/stream_group.hpp"
#include "gateway/stream/sync_producer.hpp"
#include "protocol/canopen/heartbeat.hpp"

namespace kinebus {

class Gateway::Core {
 public:
  Core(const MachineDescription& machine, Options options);

  // core_frames.cpp
  void on_frame(BusTime when, const CanFrame& frame);
  void on_frame_sent(BusTime when, const CanFrame& frame);
  std::optional<CanFrame> next_frame(BusTime now);
  BusTime next_deadline() const;

  // core_time.cpp
  void on_time(BusTime now);
  void on_bus_failure(BusTime now, std::string_view what);

  // core_commands.cpp
  Result<void, Refusal> bring_up();
  Result<void, Refusal> home();
  Result<void, Refusal> go_to_reference();
  Result<void, Refusal> jog(const JogRequest& request);
  Result<void, Refusal> run(std::unique_ptr<ByteSource> job, std::string name);
  Result<void, Refusal> hold();
  Result<void, Refusal> resume();
  Result<void, Refusal> cancel();
  Result<void, Refusal> stop(Sentence why);
  Result<void, Refusal> clear();
  Result<void, Refusal> set_feed_override(double ratio);
  Result<void, Refusal> motors_off();
  Result<void, Refusal> set_temperature(bool bed, double celsius);

  // core_lines.cpp
  Result<void, Refusal> open_lines(std::string name);
  Result<void, Refusal> take_line(std::string_view line, std::uint32_t number);
  std::size_t line_room() const;
  bool lines_open() const;
  bool lines_idle() const;
  void close_lines();
  void forget_line_modes();
  const gcode::WorkOffsets& work_offsets() const { return live_lines_.work_offsets(); }

  // core_resume.cpp
  Result<void, Refusal> recover(journal::State state, std::unique_ptr<ByteSource> job);
  std::optional<journal::Record> next_journal_record() { return journal_.pop(); }
  void on_journal_stored(std::uint64_t count) { journal_.on_stored(count); }

  // core_status.cpp
  MachineStatus status() const;
  std::optional<PlannedPose> planned_pose(PathTime tau) const { return runner_->planned_pose(tau); }

  // text_session.cpp
  Result<std::string, Refusal> text_line(std::string_view line);

  MachineState state() const { return state_; }
  std::optional<MachineEvent> next_event() { return events_.pop(); }
  PathTime path_time(BusTime at) const { return rate_.tau(at); }

 private:
  /// Why nodes are brought to a standstill, and so what comes after.
  enum class After : std::uint8_t { kBringUp, kHoming, kCancel, kClear };

  Result<void, Refusal> check(MachineCommand command) const;
  void enter(MachineState state);
  Result<void, Refusal> begin_bring_up();
  void begin_homing();
  void alarm(AlarmCode code, Sentence words, std::uint8_t node = 0, std::uint32_t line = 0);
  /// Stops everything on the path; with `fault` the machine ends in kAlarm.
  void stop_all(bool fault);

  // What each state does as time passes (core_time.cpp).
  void step_bring_up();
  void step_homing();
  void step_standstill();
  void finish_standstill();
  void step_checking();
  void step_running();
  void step_hold();
  void step_held();
  void step_cancel();
  void step_stop();
  void step_clear();
  void begin_standstill(After after);
  void report_problems();
  void finish_motion();
  void remember_positions();

  // Interruption and resume (core_resume.cpp).
  /// A job is interrupted: it can go on, or be cancelled.
  bool interrupted() const {
    const bool nodes_lost = state_ == MachineState::kOff || state_ == MachineState::kBringUp;
    return recovery_ || (print_.active() && (print_.suspended() || nodes_lost));
  }
  /// The stream is gone; what the job has left from `tau` on is kept.
  void interrupt(PathTime tau);
  /// The path time at which the nodes were found, of those that lie in the run from `start` on.
  PathTime found_tau(PathTime start, PathTime otherwise) const;
  Result<void, Refusal> go_on();
  Result<void, Refusal> begin_return();
  void note_found();
  void step_recovery();
  void finish_recovery();
  void finish_return();
  void give_up_job();
  void begin_job(const PoseVector& start);
  void note_progress();
  void try_by_itself();
  /// Distance of where the axes stand from the joints' values, counts: the filament's, and the greatest
  /// other.
  struct Distance {
    double filament = 0, others = 0;
  };
  Distance distance_from(const JointVector& wanted, const PlannedPose& place) const;
  std::vector<canonical::Line> heating() const;
  void add_approach(std::vector<canonical::Line>& commands, const PoseVector& from, PoseVector target) const;

  // What the nodes say (core_nodes.cpp).
  void watch_nodes();
  void take_emergencies(NodeLink& link);
  void take_stream_status(NodeLink& link);
  bool check_clock(const NodeLink& link, const StreamStatus& status);

  /// Path time stands; notes since when.
  bool standing();
  /// Records of a run may go to the nodes.
  bool streams_flow() const;
  JointVector joints_now() const;
  void set_off_course(MachineStatus& status, std::size_t link) const;
  Result<PoseVector, Refusal> machine_pose() const;
  void start_move(canonical::Command move, const PoseVector& from);

  MachineDescription machine_;
  Options options_;
  Sentence defect_;  ///< why the description has no kinematics: every command is refused with it
  std::unique_ptr<Kinematics> kinematics_;

  std::vector<NodeAxes> axes_;
  std::deque<NodeLink> links_;
  PathRate rate_;
  StampedSyncProducer sync_;
  HeartbeatProducer heartbeat_;
  StreamGroup group_;
  SimulatedThermal thermal_;
  EventQueue events_;
  BringUp bring_up_;
  MachineHoming homing_;
  Standstill standstill_;
  journal::Queue journal_;
  Runner hand_;              ///< moves by hand, and the ways to a job's place
  Runner print_;             ///< the job
  Runner* runner_ = &hand_;  ///< whose motion it is
  BusLoad load_;
  MachineCounters counters_;

  MachineState state_ = MachineState::kOff;
  BusTime now_{0};
  bool speaking_ = false;       ///< SYNC and heartbeat are sent
  bool homed_ = false;          ///< positions of all joints are known
  bool fault_ = false;          ///< the stop under way ends in an alarm
  bool stream_lost_ = false;    ///< what the nodes hold is not what was sent: the run cannot go on
  bool need_bring_up_ = false;  ///< a node was lost or restarted
  bool clearing_ = false;       ///< clear() was given, the nodes are not through with it
  int repeats_ = 0;             ///< of controlwords, while clearing
  MachineState held_from_ = MachineState::kRunning;  ///< what resume() goes back to
  After after_ = After::kBringUp;
  BusTime served_{0};           ///< the last on_time()
  BusTime spoke_{0};            ///< when SYNC began, or the last bring-up ended
  BusTime streaming_since_{0};  ///< path time runs; the present, when it does not
  BusTime entered_{0}, rest_since_{0}, clearing_since_{0}, next_repeat_{0};
  std::vector<std::array<AxisState, kAxesPerNode>> positions_;  ///< where the nodes rest, by node

  // The job.
  std::unique_ptr<HashedSource> job_;
  std::string job_name_;
  std::unique_ptr<Preflight> preflight_;
  std::size_t problems_reported_ = 0;
  JobReport job_report_;
  gcode::WorkOffsets job_offsets_{};  ///< of the job that is checked or begins
  LiveLines live_lines_;
  gcode::CommandBuffer live_commands_;  ///< of the line at work
  bool lines_closing_ = false;
  bool job_follows_ = false;  ///< the move to the bed reference is under way, then comes the job
  BusTime job_started_{0};
  std::uint64_t job_bytes_ = 0, job_hash_ = 0;

  // Interruption.
  struct Recovery {  ///< what the gateway before has left
    journal::State state;
    std::unique_ptr<ByteSource> job;
    bool replaying = false;
  };
  std::optional<Recovery> recovery_;
  bool job_failed_ = false;     ///< the job itself is wrong: it cannot go on
  bool going_on_ = false;       ///< resume() was given: bring-up, homing and return follow one another
  bool by_itself_ = false;      ///< nobody has given it
  bool asked_itself_ = false;   ///< once is enough
  bool returning_ = false;      ///< the move to the interrupted job's place is under way
  bool filament_lost_ = false;  ///< nobody knows where it stands
  PathTime tau_before_{0};      ///< of the gateway itself, before a bring-up
  std::optional<journal::Thermal>
      heat_wanted_;             ///< what the interrupted job wants, when heaters were switched off
  bool spindle_first_ = false;  ///< held, and goes on as soon as the spindle turns as it did
  journal::Thermal heat_noted_;
  BusTime progress_due_{0};
  std::optional<BusTime> found_noted_;
  double override_ = 1;
};

}  // namespace kinebus
