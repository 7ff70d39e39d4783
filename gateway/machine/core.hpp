#pragma once
// The inside of Gateway: how the parts are joined. What a part does, and what it has to remember for that, is
// the part's own; here is which of them works in which state of the machine, and what follows when it is
// done.
//   core.cpp           frames, time                core_states.cpp     the steps of each state
//   core_commands.cpp  one handler a command       core_lines.cpp      lines of print hosts and the console
//   core_recovery.cpp  interrupted jobs            core_heat_hold.cpp  a heater's fault in a job, no filament
//   core_heat_tuning.cpp  a heater that is measured
//   core_aside.cpp        a job that is set aside: parked, filament changed, standby
//   core_probe.cpp     probing
//   core_status.cpp    the snapshot

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/bus_nodes/bring_up.hpp"
#include "gateway/bus_nodes/clearing.hpp"
#include "gateway/bus_nodes/homing.hpp"
#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/bus_nodes/rest.hpp"
#include "gateway/devices/devices.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/machine/bus_session.hpp"
#include "gateway/machine/bus_voice.hpp"
#include "gateway/machine/current_state.hpp"
#include "gateway/machine/foreign_frames.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/machine/heat_hold.hpp"
#include "gateway/machine/lines/line_desk.hpp"
#include "gateway/machine/manual_motion.hpp"
#include "gateway/machine/node_watch.hpp"
#include "gateway/machine/position.hpp"
#include "gateway/machine/print_job.hpp"
#include "gateway/machine/recovery.hpp"
#include "gateway/machine/stall_recovery.hpp"
#include "gateway/motors/motor_currents.hpp"
#include "gateway/motors/motor_settings.hpp"
#include "gateway/motors/parameter_watch.hpp"
#include "gateway/motors/scale_readings.hpp"
#include "gateway/run/bed_level.hpp"
#include "gateway/run/heat.hpp"
#include "gateway/status/event_queue.hpp"
#include "gateway/stream/path_rate.hpp"
#include "gateway/stream/stream_group.hpp"

namespace kinebus {

class Gateway::Core {
 public:
  Core(const MachineDescription& machine, Options options, std::optional<Devices> devices);

  // core.cpp
  void on_frame(BusTime when, const CanFrame& frame);
  void on_frame_sent(BusTime when, const CanFrame& frame);
  std::optional<CanFrame> next_frame(BusTime now);
  std::optional<CanFrame> next_plain_frame(BusTime now);  ///< without the session's vouchers
  BusTime next_deadline() const;
  BusTime sync_due() const { return voice_.sync_due(); }
  void on_time(BusTime now);
  void on_stall(BusTime now, BusTime length, const Sentence& why);
  void on_bus_failure(BusTime now, std::string_view what);

  // core_commands.cpp
  Result<void, Refusal> may(CommandKind command) const;
  Result<void, Refusal> carry_out(Command command);
  Result<void, Refusal> take_line(std::string_view line, std::uint32_t number);
  std::size_t line_room();
  bool lines_open() const;
  bool lines_idle() const;
  void close_lines();
  void leave_lines();
  void skip_heating();
  void forget_line_modes();
  const gcode::WorkOffsets& work_offsets() const { return lines_.work_offsets(); }
  HotendTargets hotends_found() const { return heat_.hotends_found(); }
  const BedLevel& bed() const { return bed_; }

  // core_recovery.cpp
  Result<void, Refusal> recover(journal::State state, std::unique_ptr<ByteSource> job);
  std::optional<journal::Record> next_journal_record() { return journal_.pop(); }
  void on_journal_stored(std::uint64_t count) { journal_.on_stored(count); }

  // core_status.cpp
  MachineStatus status() const;
  void watch_currents() { currents_.watch(now_); }
  std::optional<PlannedPose> planned_pose(PathTime tau) const { return runner_->planned_pose(tau); }

  // text_session.cpp
  Result<std::string, Refusal> text_line(std::string_view line);
  std::string position_text();
  std::string settings_text() const;
  std::string mesh_text() const;
  /// EXCLUDE_OBJECT and M486 of a session, of the job that runs; nullopt: the line is none of them.
  std::optional<Result<void, Refusal>> object_line(std::string_view line);
  std::string currents_text() const;
  /// The joint that moves for this axis of the pose and for no other; none on a mechanism that couples them.
  std::optional<std::size_t> motor_of_axis(std::size_t axis) const;
  Result<std::string, Refusal> set_currents(std::string_view words);
  /// M303.
  Result<std::string, Refusal> measure_heater(std::string_view words);
  /// M956 S1 begins, S0 ends; alone it tells what was found.
  Result<std::string, Refusal> vibration(std::optional<double> what);

  MachineState state() const { return state_.now(); }
  std::optional<MachineEvent> next_event() { return events_.pop(); }
  PathTime path_time(BusTime at) const { return rate_.tau(at); }

 private:
  using Done = Result<void, Refusal>;

  // The handlers: the command may be given in the present state.
  Done on(command::BringUp& asked);
  Done on(command::Home& asked);
  Done on(command::GoToReference& asked);
  Done on(command::Jog& asked);
  Done on(command::Run& asked);
  Done on(command::OpenLines& asked);
  Done on(command::Hold& asked);
  Done on(command::Resume& asked);
  Done on(command::Cancel& asked);
  Done on(command::Stop& asked);
  Done on(command::Clear& asked);
  Done on(command::SetFeedOverride& asked);
  Done on(command::MotorsOff& asked);
  Done on(command::SetTemperature& asked);
  Done on(command::SetFan& asked) { return heat_.set_fan(asked.index, asked.ratio); }
  Done on(command::SetOutput& asked) { return heat_.set_output(asked.index, asked.ratio); }
  Done on(command::SetSpindle& asked) { return heat_.set_spindle(asked.rpm); }
  Done on(command::SetWorkOffset& asked);
  Done on(command::SetMotorCurrents& asked) { return motors_.set(asked.motors); }
  Done on(command::TuneMotor& asked) { return motors_.tune(asked.joint); }
  Done on(command::JogMotor& asked);
  Done on(command::TuneHeater& asked);
  Done on(command::ExcludeObject& asked);
  Done on(command::MovePin& asked);
  Done on(command::StepAside& asked);
  Done on(command::MoveFilament& asked);

  void enter(MachineState state) { state_.enter(now_, state); }
  void begin_bring_up();
  void begin_homing();
  double printed_top_mm() const;
  /// Refused: the part of the interrupted job is higher than homing spares.
  Done may_home() const;
  void begin_move(canonical::Command move, const Pose& from);
  Done jog_on(const command::Jog& asked);
  void end_jog();
  void cut_heat(const Sentence& why);
  /// Stops everything on the path; with `fault` the machine ends in kAlarm. `by_absence`: the nodes have
  /// stopped because they did not hear the gateway.
  void stop_all(bool fault, bool by_absence = false);
  Done carry_out_at_rest(const canonical::Line& command);
  Done choose_hotend(int hotend);
  Done level_at_rest(const canonical::Mesh& command, std::uint32_t line);

  // What each state does as time passes (core.cpp).
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
  void step_after_stall();
  Done resume();
  void finish_motion();
  void fail_motion();
  void watch_nodes();
  void watch_idle_heat();
  void tell_of_tuning();
  void tell_of_the_unmeasured();
  void tell_of_pin();
  void feed_heat_ahead();
  void follow_extruder();
  void watch_parameters();
  void on_foreign_stop(std::uint8_t node);
  void on_foreign_command(const ForeignFrame& foreign);
  void take_stream_status(NodeLink& link);
  void follow(const NodeWatch::Verdict& verdict);

  // Faults of devices (core_heat_hold.cpp).
  void watch_devices();
  void watch_filament();
  void watch_cold_feed();
  bool hold_for_heat(const DeviceFault& fault);
  bool homes_without(const DeviceFault& fault);
  void hold_for(const DeviceFault& fault);
  /// Why the job that is held cannot go on.
  std::optional<DeviceFault> out_of_order() const;
  void tell(const DeviceFault& fault);
  void step_heat_hold();
  void begin_lift();
  void finish_lift();
  void step_mending();

  // A job that is set aside (core_aside.cpp).
  Done step_aside(HeatHold::Aside why);
  void add_parking(const Pose& from, std::vector<canonical::Line>& moves);
  void finish_aside();
  void watch_standby();

  // Probing (core_probe.cpp).
  void serve_probe();
  void step_probed();
  void finish_probe();
  void give_up_probing();
  void give_up_thread();

  // Interruption and resume (core_recovery.cpp).
  /// A job is interrupted: it can go on, or be cancelled.
  bool interrupted() const;
  /// The stream is gone; what the job has left from `tau` on is kept.
  void interrupt(PathTime tau);
  Done go_on();
  Done begin_return();
  void step_recovery();
  void finish_recovery();
  void finish_return();
  void give_up_job();
  void end_override();
  void report_progress(MachineStatus& s) const;
  void report_objects(MachineStatus& s) const;
  void begin_job(const Pose& start);
  void note_progress();

  /// The nodes are on, and nothing else is asked of them.
  bool may_glance() const;
  /// Records of a run may go to the nodes.
  bool streams_flow() const { return state_.streams() && !position_.stream_lost() && !rest_.reading(); }
  JointVector joints_now() const { return position_.joints(*runner_, rate_.tau(now_)); }
  Result<Pose, Refusal> machine_pose() const { return position_.pose(joints_now()); }

  MachineDescription machine_;
  Options options_;
  Sentence defect_;  ///< why the description has no kinematics: every command is refused with it
  std::unique_ptr<LevelledKinematics> kinematics_;
  MachineCounters counters_;

  std::vector<NodeAxes> axes_;
  std::deque<NodeLink> links_;
  PathRate rate_;
  StreamGroup group_;
  Devices devices_;
  Heat heat_;
  EventQueue events_;
  journal::Queue journal_;
  BedLevel bed_;

  CurrentState state_;
  BusVoice voice_;
  BusSession session_;
  NodeWatch watch_;
  ParameterWatch parameters_;
  BringUp bring_up_;
  MachineHoming homing_;
  MotorSettings motors_;
  MotorCurrents currents_;
  ScaleReadings scales_;
  Position position_;
  Rest rest_;
  Clearing clearing_;
  HeatHold heat_hold_;
  std::unique_ptr<bodies::PrintedPart> printed_;  ///< on the table; nullptr: the machine does not look at it
  ManualMotion hand_;
  PrintJob print_;
  LineDesk lines_;
  Recovery recovery_;
  StallRecovery stall_;

  Runner* runner_ = &hand_.runner();  ///< whose motion it is
  BusTime now_{0};
  BusTime served_{0};     ///< the last on_time()
  BusTime started_{0};    ///< of the move under way
  ForeignOrders orders_;  ///< of other devices in motion
  UselessFrames useless_;
  bool remote_told_ = false;  ///< a remote frame was passed over, since the last bring-up
  bool probe_asked_ = false;  ///< its node is to answer
  bool probe_rests_ = false;  ///< its move has come to rest where it touched
  bool pin_by_hand_ = false;  ///< its pin moves, and no job looks at it
  ContactProbe::Pin pin_told_ = ContactProbe::Pin::kNone;
  bool fault_ = false;      ///< the stop under way ends in an alarm
  bool beds_stay_ = false;  ///< that alarm is of a device: a bed that is in order keeps the part on it
  BusTime heat_idle_since_{0}, next_flow_{0};
  BusTime waits_since_{0};             ///< the job that is held or set aside
  bool stands_by_ = false;             ///< its hot ends are at pause.standby_c
  bool standby_due_ = false;           ///< as soon as it is set aside
  std::optional<HeaterId> tuned_;      ///< whose measurement is told of
  std::vector<bool> unmeasured_told_;  ///< of heaters that have a target, in the machine file's order
  TuningStage tuning_told_ = TuningStage::kNone;
  MachineState held_from_ = MachineState::kRunning;  ///< what resume goes back to
  double override_ = 1;
};

}  // namespace kinebus
