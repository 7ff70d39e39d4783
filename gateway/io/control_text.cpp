#include "gateway/io/control_text.hpp"

#include <nlohmann/json.hpp>

#include <numbers>

namespace kinebus {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

nlohmann::json pose_json(const PoseVector& pose) {
  return {{"x", pose[kX]},
          {"y", pose[kY]},
          {"z", pose[kZ]},
          {"a", pose[kA] * kDegrees},
          {"c", pose[kC] * kDegrees},
          {"e", pose[kE]}};
}

nlohmann::json node_json(const NodeStatus& node) {
  return {{"id", node.id},
          {"present", node.present},
          {"nmt", node.nmt_state},
          {"statusword", node.statusword},
          {"inputs", node.inputs},
          {"synchronised", node.synchronised},
          {"sync_error_us", node.sync_error_us},
          {"queue", node.queue_records},
          {"stopped", node.stopped},
          {"records_sent", node.records_sent},
          {"emergencies", node.emergencies}};
}

nlohmann::json counters_json(const MachineCounters& c) {
  return {{"frames_sent", c.frames_sent},       {"frames_received", c.frames_received},
          {"segments_sent", c.segments_sent},   {"malformed_frames", c.malformed_frames},
          {"foreign_frames", c.foreign_frames}, {"sequence_errors", c.sequence_errors},
          {"underruns", c.underruns},           {"checkpoint_errors", c.checkpoint_errors},
          {"sdo_aborts", c.sdo_aborts},         {"sdo_timeouts", c.sdo_timeouts},
          {"bus_slowdowns", c.bus_slowdowns},   {"starvation_holds", c.starvation_holds}};
}

nlohmann::json heater_json(const HeaterStatus& heater) {
  return {{"actual", heater.actual_celsius}, {"target", heater.target_celsius}};
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

nlohmann::json to_json(const MachineStatus& status) {
  nlohmann::json nodes = nlohmann::json::array();
  for (const NodeStatus& node : status.nodes) nodes.push_back(node_json(node));
  nlohmann::json joints = nlohmann::json::array();
  for (int i = 0; i < status.joint_count; ++i) joints.push_back(status.joints[static_cast<std::size_t>(i)]);
  return {{"state", to_string(status.state)},
          {"at_rest", at_rest(status.state)},
          {"ready", status.state == MachineState::kReady},
          {"off", status.state == MachineState::kOff},
          {"trouble", status.state == MachineState::kStopped || status.state == MachineState::kAlarm},
          {"held", status.state == MachineState::kHeld},
          {"doing", status.doing},
          {"positions_known", status.positions_known},
          {"pose", pose_json(status.pose)},
          {"machine_pose", pose_json(status.machine_pose)},
          {"joints", joints},
          {"path_time_s", status.path_time_s},
          {"rate", status.rate},
          {"feed_override", status.feed_override},
          {"job", status.job},
          {"line", status.line},
          {"progress", status.progress},
          {"elapsed_s", status.elapsed_s},
          {"remaining_s", status.remaining_s},
          {"hotend", heater_json(status.hotend)},
          {"bed", heater_json(status.bed)},
          {"fan", status.fan},
          {"bus_load", status.bus_load},
          {"bus_load_peak", status.bus_load_peak},
          {"nodes", nodes},
          {"counters", counters_json(status.counters)}};
}

nlohmann::json to_json(const MachineEvent& event) {
  static constexpr const char* kKinds[] = {"state", "alarm", "message", "problem", "finished"};
  return {{"kind", kKinds[static_cast<std::size_t>(event.kind)]},
          {"when_s", to_seconds(event.when)},
          {"state", to_string(event.state)},
          {"code", event.code},
          {"node", event.node},
          {"line", event.line},
          {"words", event.words},
          {"advice", event.advice}};
}

}  // namespace kinebus
