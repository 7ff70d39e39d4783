#pragma once
// The inside of Gateway: the parts, and how they are joined. Implementation in core_*.cpp, by what calls it.

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/jobs/bus_load.hpp"
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
  Result<void, Refusal> stop(std::string why);
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

  // core_status.cpp
  MachineStatus status() const;
  std::optional<PlannedPose> planned_pose(PathTime tau) const { return runner_.planned_pose(tau); }

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
  void alarm(AlarmCode code, std::string words, std::uint8_t node = 0, std::uint32_t line = 0);
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
  void step_cancel();
  void step_stop();
  void step_clear();
  void begin_standstill(After after);
  void report_problems();
  void finish_motion();
  void remember_positions();

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
  Result<PoseVector, Refusal> machine_pose() const;
  void start_move(canonical::Command move, const PoseVector& from);

  MachineDescription machine_;
  Options options_;
  std::string defect_;  ///< why the description has no kinematics: every command is refused with it
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
  Runner runner_;
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
  BusTime entered_{0}, rest_since_{0}, clearing_since_{0}, next_repeat_{0};
  std::vector<std::array<AxisState, kAxesPerNode>> positions_;  ///< where the nodes rest, by node

  // The job.
  std::unique_ptr<ByteSource> job_;
  std::string job_name_;
  std::unique_ptr<Preflight> preflight_;
  std::size_t problems_reported_ = 0;
  JobReport job_report_;
  LiveLines live_lines_;
  gcode::CommandBuffer live_commands_;  ///< of the line at work
  bool lines_closing_ = false;
  bool job_follows_ = false;  ///< the move to the bed reference is under way, then comes the job
  BusTime job_started_{0};
  double override_ = 1;
};

}  // namespace kinebus
