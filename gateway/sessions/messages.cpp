#include "gateway/sessions/messages.hpp"

#include <algorithm>
#include <utility>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

void set_heater(joblink::Heater& message, const HeaterStatus& heater) {
  message.set_actual_celsius(heater.actual_celsius);
  message.set_target_celsius(heater.target_celsius);
  if (heater.power) message.set_power(*heater.power);
  if (heater.measured != Measured::kNotTold) message.set_measured(heater.measured == Measured::kYes);
}

static_assert(static_cast<int>(TuningStage::kFailed) == joblink::TUNING_FAILED);

void set_tuning(joblink::HeaterTuning& message, const HeaterTuning& tuning) {
  message.set_stage(static_cast<joblink::TuningStage>(tuning.stage));
  message.set_celsius(tuning.celsius);
  message.set_power_w(tuning.model.power_w);
  message.set_capacity_j_per_k(tuning.model.capacity_j_per_k);
  message.set_loss_w_per_k(tuning.model.loss_w_per_k);
  message.set_lag_s(tuning.model.lag_s);
  message.set_dead_s(tuning.model.dead_s);
  if (!tuning.failure.empty()) *message.mutable_failure() = to_message(tuning.failure);
}

void set_output(joblink::Output& message, const OutputStatus& output) {
  message.set_name(shown(output.name));
  message.set_index(output.index);
  message.set_ratio(output.ratio);
}

constexpr std::uint16_t kStateBits = 0x6F;  // CiA 402
constexpr bool operation_enabled(std::uint16_t statusword) {
  return (statusword & kStateBits) == 0x27;
}
constexpr bool in_fault(std::uint16_t statusword) {
  return (statusword & 0x4F) == 0x08 || (statusword & 0x4F) == 0x0F;
}

void set_node(joblink::NodeStatus& message, const NodeStatus& node, bool moves) {
  message.set_id(node.id);
  message.set_present(node.present);
  message.set_nmt_state(node.nmt_state);
  message.set_inputs(node.inputs);
  message.set_synchronised(node.synchronised);
  message.set_sync_error_s(node.sync_error_us * 1e-6);
  message.set_queue_records(static_cast<std::uint32_t>(std::max(node.queue_records, 0)));
  message.set_queue_capacity(static_cast<std::uint32_t>(node.queue_capacity));
  message.set_stopped(node.stopped);
  message.set_records_sent(node.records_sent);
  message.set_emergencies(node.emergencies);
  for (std::size_t axis = 0; node.has_axes && axis < node.statusword.size(); ++axis) {
    joblink::AxisStatus& a = *message.add_axes();
    a.set_statusword(node.statusword[axis]);
    a.set_enabled(node.present && operation_enabled(node.statusword[axis]));
    a.set_fault(node.present && in_fault(node.statusword[axis]));
    if (node.off_course[axis]) a.set_off_course(*node.off_course[axis]);
    if (node.by_scale_mm[axis]) a.set_by_scale_mm(*node.by_scale_mm[axis]);
    if (node.current_a[axis]) a.set_current_a(*node.current_a[axis]);
    a.set_run_current_a(node.run_current_a[axis]);
    a.set_hold_current_a(node.hold_current_a[axis]);
    if (a.enabled()) a.set_configured_current_a(moves ? a.run_current_a() : a.hold_current_a());
    if (node.stage_celsius[axis]) a.set_stage_celsius(*node.stage_celsius[axis]);
    a.set_position_counts(node.position_counts[axis]);
    a.set_measures(node.measures[axis]);
  }
}

}  // namespace

bool at_rest(MachineState state) {
  switch (state) {
    case MachineState::kOff:
    case MachineState::kUnhomed:
    case MachineState::kReady:
    case MachineState::kHeld:
    case MachineState::kStopped:
    case MachineState::kAlarm:
      return true;
    default:
      return false;
  }
}

void set_pose(joblink::Pose& message, const Pose& pose) {
  message.set_x_mm(pose[kX]);
  message.set_y_mm(pose[kY]);
  message.set_z_mm(pose[kZ]);
  message.set_a_rad(pose[kA]);
  message.set_c_rad(pose[kC]);
  message.set_e_mm(pose[kE]);
}

Pose pose_of(const joblink::Pose& message) {
  return {message.x_mm(), message.y_mm(), message.z_mm(), message.a_rad(), message.c_rad(), message.e_mm()};
}

joblink::Status to_message(const MachineStatus& s) {
  joblink::Status m;
  m.set_time_s(to_seconds(s.now));
  m.set_state(static_cast<joblink::State>(s.state));
  m.set_state_words(std::string(to_string(s.state)));
  m.set_doing(shown(s.doing));
  if (!s.doing.empty()) *m.mutable_doing_said() = to_message(s.doing);
  m.set_at_rest(at_rest(s.state));
  m.set_positions_known(s.positions_known);
  set_pose(*m.mutable_tool(), s.pose);
  set_pose(*m.mutable_machine(), s.machine_pose);
  if (s.measured_pose) set_pose(*m.mutable_measured_tool(), *s.measured_pose);
  for (int i = 0; i < s.joint_count; ++i) m.add_joints(s.joints[static_cast<std::size_t>(i)]);
  m.set_path_time_s(s.path_time_s);
  m.set_rate(s.rate);
  m.set_feed_override(s.feed_override);
  m.set_job(shown(s.job));
  m.set_interrupted(s.interrupted);
  m.set_filament_change(s.filament_change);
  m.set_line(s.line);
  m.set_progress(s.progress);
  m.set_elapsed_s(s.elapsed_s);
  if (s.job_filament_mm) m.set_job_filament_mm(*s.job_filament_mm);
  m.set_remaining_s(s.remaining_s);
  m.set_work_system(s.work_system);
  set_pose(*m.mutable_work_offset(), s.work_offset);
  set_heater(*m.mutable_hotend(), s.heater(kFirstHotend));
  set_heater(*m.mutable_bed(), s.heater(kFirstBed));
  m.mutable_bed()->set_kind(joblink::HEATER_BED);
  m.set_hotend_in_use(s.tool.index);
  for (const NamedHeaterStatus& heater : s.heaters) {
    joblink::Heater& h = *m.add_heaters();
    set_heater(h, heater);
    h.set_kind(static_cast<joblink::HeaterKind>(heater.id.kind));
    h.set_index(heater.id.index);
    h.set_name(shown(heater.name));
    if (heater.tuning.stage != TuningStage::kNone) set_tuning(*h.mutable_tuning(), heater.tuning);
  }
  for (const OutputStatus& fan : s.fans) {
    set_output(*m.add_fans(), fan);
    if (fan.index == 0) m.set_fan(fan.ratio);
  }
  for (const OutputStatus& output : s.outputs) set_output(*m.add_outputs(), output);
  for (const InputStatus& input : s.inputs) {
    joblink::Input& told = *m.add_inputs();
    told.set_name(shown(input.name));
    told.set_index(input.index);
    if (input.level != InputLevel::kUnknown) told.set_on(input.level == InputLevel::kOn);
  }
  for (const SensorStatus& sensor : s.sensors) {
    joblink::Sensor& told = *m.add_sensors();
    told.set_name(shown(sensor.name));
    told.set_celsius(sensor.celsius);
  }
  for (const FilamentStatus& filament : s.filaments) {
    joblink::FilamentSensor& told = *m.add_filament_sensors();
    told.set_name(shown(filament.name));
    told.set_condition(static_cast<joblink::FilamentCondition>(filament.condition));
    if (filament.condition != FilamentCondition::kInOrder)
      *told.mutable_words() = to_message(sentence(filament.condition));
  }
  for (const ObjectStatus& object : s.objects) {
    constexpr int kListed = 100;
    if (m.objects_size() == kListed) break;
    joblink::PrintObject& told = *m.add_objects();
    told.set_name(shown(object.name));
    told.set_left_out(object.left_out);
  }
  if (s.probe_touches) m.set_probe_touches(*s.probe_touches);
  m.set_probe_pin(static_cast<joblink::ProbePin>(s.probe_pin));
  m.set_spindle_rpm(s.spindle.actual_rpm);
  m.set_spindle_target_rpm(s.spindle.target_rpm);
  m.set_bus_load(s.bus_load);
  m.set_bus_load_peak(s.bus_load_peak);
  for (const NodeStatus& node : s.nodes) set_node(*m.add_nodes(), node, s.rate > 0);
  joblink::Counters& c = *m.mutable_counters();
  c.set_frames_sent(s.counters.frames_sent);
  c.set_frames_received(s.counters.frames_received);
  c.set_segments_sent(s.counters.segments_sent);
  c.set_malformed_frames(s.counters.malformed_frames);
  c.set_foreign_frames(s.counters.foreign_frames);
  c.set_sequence_errors(s.counters.sequence_errors);
  c.set_underruns(s.counters.underruns);
  c.set_checkpoint_errors(s.counters.checkpoint_errors);
  c.set_sdo_aborts(s.counters.sdo_aborts);
  c.set_sdo_timeouts(s.counters.sdo_timeouts);
  c.set_bus_slowdowns(s.counters.bus_slowdowns);
  c.set_starvation_holds(s.counters.starvation_holds);
  return m;
}

joblink::Event to_message(const MachineEvent& event) {
  joblink::Event m;
  m.set_kind(static_cast<joblink::EventKind>(event.kind));
  m.set_time_s(to_seconds(event.when));
  m.set_state(static_cast<joblink::State>(event.state));
  m.set_code(event.code);
  m.set_node(event.node);
  m.set_line(event.line);
  m.set_words(shown(event.words));
  m.set_advice(shown(event.advice));
  *m.mutable_said() = to_message(event.words);
  if (!event.advice.empty()) *m.mutable_advice_said() = to_message(event.advice);
  return m;
}

}  // namespace kinebus
