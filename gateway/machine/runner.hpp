#pragma once
// Carries a job or a single move out: takes the pipeline's steps, streams motion, executes what stands
// between runs, and says at which rate path time may run.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/machine/event_queue.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/machine/path_rate.hpp"
#include "gateway/machine/thermal.hpp"
#include "gateway/stream/stream_group.hpp"

namespace kinebus {

class Runner {
 public:
  enum class Outcome : std::uint8_t { kBusy, kPaused, kDone, kFailed, kEmergencyStop };
  struct Failure {
    std::uint32_t line = 0;
    std::string words;
    bool stream = false;  ///< between gateway and nodes, not in the job
  };
  struct Counters {
    std::uint32_t bus_slowdowns = 0, starvation_holds = 0;
    std::uint32_t live_stops = 0;  ///< planned stops in motion, because the next line had not come yet
  };

  Runner(const MachineDescription& machine, const Kinematics& kinematics, StreamGroup& group, PathRate& rate,
         ThermalDevice& thermal, EventQueue& events);

  /// A job's text from its beginning, the machine standing at `start` (Frame::kMachine).
  void start_job(std::unique_ptr<ByteSource> source, const PoseVector& start);
  /// Motion by hand.
  void start_commands(std::vector<canonical::Line> commands, const PoseVector& start);
  /// Commands that come over time, by add(). When they come too slowly motion ends in a planned stop and goes
  /// on with the next ones. Over after end_live(), when all are carried out.
  void start_live(const PoseVector& start);
  void add(BusTime now, const canonical::Line& line);
  void end_live() { pipeline_.end_live(); }
  bool live() const { return active_ && live_; }
  std::size_t live_waiting() const { return pipeline_.waiting(); }  ///< commands not yet planned
  /// All that was added is carried out, at rest.
  bool live_idle() const { return live() && !streaming_ && wait_ == Wait::kNone && pipeline_.live_idle(); }
  bool active() const { return active_; }

  /// Plans at most about `budget` lines ahead, executes what is due.
  Outcome on_time(BusTime now, int budget);
  const Failure& failure() const { return failure_; }

  /// Feed hold: the rate goes to 0 and the waits between runs stand still.
  void hold(BusTime now);
  /// Goes on after hold() and after a pause of the job.
  void resume(BusTime now);
  /// Above 1: what is planned from now on is planned faster; at most 1: the rate of path time.
  void set_override(double ratio);
  /// The job is over (done, cancelled, lost); what is queued is the caller's to clear.
  void drop();

  /// No motion is queued or under way: a hold or a cancel needs no ramp.
  bool between_runs() const { return !streaming_; }
  /// Path time of motion carried out and in all, s: what progress is measured by.
  double done_s(BusTime now) const;
  std::uint32_t line(BusTime now) const;
  std::uint64_t bytes() const { return pipeline_.bytes(); }
  /// The exact planned pose at path time `tau`, by the phases of the last second and all that are queued.
  std::optional<PlannedPose> planned_pose(PathTime tau) const;
  const std::string& doing() const { return doing_; }
  const Counters& counters() const { return counters_; }

 private:
  enum class Wait : std::uint8_t { kNone, kRunDone, kRest, kDwell, kHeating, kPause };
  struct PlannedPhase {
    PathTime start;  ///< of the run that it belongs to
    double start_s;  ///< since then
    Phase phase;
  };
  struct Event {
    PathTime due;
    canonical::Line line;
  };

  static PathTime end_of(const PlannedPhase& phase);
  void begin();
  void control_rate(BusTime now);
  void settle_when_late(BusTime now);
  bool wait_is_over(BusTime now);
  void execute_due(BusTime now);
  void execute(BusTime now, const canonical::Line& line);
  Outcome take(BusTime now, JobPipeline::Step step);
  Outcome barrier(BusTime now);
  Outcome fail(std::uint32_t line, std::string words, bool stream);
  void begin_heating(const canonical::Thermal& thermal);

  const MachineDescription& machine_;
  StreamGroup& group_;
  PathRate& rate_;
  ThermalDevice& thermal_;
  EventQueue& events_out_;
  JobPipeline pipeline_;
  std::unique_ptr<ByteSource> source_;

  bool active_ = false, held_ = false;
  bool live_ = false;       ///< commands come over time
  bool streaming_ = false;  ///< a run is in the group
  bool started_ = false;    ///< path time was let go for this run
  bool finished_ = false;   ///< the run's last phase is in the group
  bool stop_asked_ = false;
  Wait wait_ = Wait::kNone;
  std::deque<Event> events_;
  std::deque<PlannedPhase> planned_;
  TemperatureWait heating_;
  std::optional<BusTime> in_window_since_;
  BusTime last_time_{0}, dwell_left_{0}, last_rate_change_{0}, last_added_{0};
  double override_ = 1;
  double finished_runs_s_ = 0;
  std::uint32_t last_line_ = 0;
  std::string doing_;
  Failure failure_;
  Counters counters_;
};

}  // namespace kinebus
