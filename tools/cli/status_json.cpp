#include "tools/cli/status_json.hpp"

#include <nlohmann/json.hpp>

namespace kinebus {
namespace {

using nlohmann::json;
constexpr double kDegrees = 57.29577951308232;

json pose_json(const joblink::Pose& pose) {
  return {{"x", pose.x_mm()},
          {"y", pose.y_mm()},
          {"z", pose.z_mm()},
          {"a", pose.a_rad() * kDegrees},
          {"c", pose.c_rad() * kDegrees},
          {"e", pose.e_mm()}};
}

json heater_json(const joblink::Heater& heater) {
  return {{"actual", heater.actual_celsius()}, {"target", heater.target_celsius()}};
}

json node_json(const joblink::NodeStatus& node) {
  json statusword = json::array(), current = json::array(), off_course = json::array();
  for (const joblink::AxisStatus& axis : node.axes()) {
    statusword.push_back(axis.statusword());
    current.push_back(axis.current_a());
    off_course.push_back(axis.has_off_course() ? json(axis.off_course()) : json(nullptr));
  }
  return {{"id", node.id()},
          {"present", node.present()},
          {"nmt", node.nmt_state()},
          {"statusword", statusword},
          {"current_a", current},
          {"off_course", off_course},
          {"inputs", node.inputs()},
          {"synchronised", node.synchronised()},
          {"sync_error_us", node.sync_error_s() * 1e6},
          {"queue", node.queue_records()},
          {"stopped", node.stopped()},
          {"records_sent", node.records_sent()},
          {"emergencies", node.emergencies()}};
}

json counters_json(const joblink::Counters& c) {
  return {{"frames_sent", c.frames_sent()},       {"frames_received", c.frames_received()},
          {"segments_sent", c.segments_sent()},   {"malformed_frames", c.malformed_frames()},
          {"foreign_frames", c.foreign_frames()}, {"sequence_errors", c.sequence_errors()},
          {"underruns", c.underruns()},           {"checkpoint_errors", c.checkpoint_errors()},
          {"sdo_aborts", c.sdo_aborts()},         {"sdo_timeouts", c.sdo_timeouts()},
          {"bus_slowdowns", c.bus_slowdowns()},   {"starvation_holds", c.starvation_holds()}};
}

}  // namespace

json to_json(const joblink::Status& s) {
  json nodes = json::array(), joints = json::array(), clients = json::array();
  for (const joblink::NodeStatus& node : s.nodes()) nodes.push_back(node_json(node));
  for (const double joint : s.joints()) joints.push_back(joint);
  for (const joblink::ClientInfo& client : s.clients())
    clients.push_back({{"id", client.id()},
                       {"name", client.name()},
                       {"transport", client.transport()},
                       {"control", client.id() == s.controller()}});
  return {{"state", s.state_words()},
          {"at_rest", s.at_rest()},
          {"ready", s.state() == joblink::STATE_READY},
          {"off", s.state() == joblink::STATE_OFF},
          {"trouble", s.state() == joblink::STATE_STOPPED || s.state() == joblink::STATE_ALARM},
          {"held", s.state() == joblink::STATE_HELD},
          {"doing", s.doing()},
          {"positions_known", s.positions_known()},
          {"pose", pose_json(s.tool())},
          {"machine_pose", pose_json(s.machine())},
          {"joints", joints},
          {"path_time_s", s.path_time_s()},
          {"rate", s.rate()},
          {"feed_override", s.feed_override()},
          {"job", s.job()},
          {"line", s.line()},
          {"progress", s.progress()},
          {"elapsed_s", s.elapsed_s()},
          {"remaining_s", s.remaining_s()},
          {"hotend", heater_json(s.hotend())},
          {"bed", heater_json(s.bed())},
          {"fan", s.fan()},
          {"spindle_rpm", s.spindle_rpm()},
          {"spindle_target_rpm", s.spindle_target_rpm()},
          {"bus_load", s.bus_load()},
          {"bus_load_peak", s.bus_load_peak()},
          {"nodes", nodes},
          {"counters", counters_json(s.counters())},
          {"clients", clients}};
}

}  // namespace kinebus
