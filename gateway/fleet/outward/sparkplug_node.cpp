#include "gateway/fleet/outward/sparkplug_node.hpp"

namespace kinebus::fleet {
namespace {

constexpr const char* kDeathSequence = "bdSeq";
constexpr const char* kRebirth = "Node Control/Rebirth";

sparkplug::Payload::Metric& add(sparkplug::Payload& payload, const char* name, sparkplug::DataType type) {
  sparkplug::Payload::Metric& metric = *payload.add_metrics();
  metric.set_name(name);
  metric.set_datatype(static_cast<std::uint32_t>(type));
  return metric;
}

void add_machine(sparkplug::Payload& payload, const MachineView& view) {
  add(payload, "State", sparkplug::STRING).set_string_value(view.state);
  add(payload, "Job", sparkplug::INT64).set_long_value(static_cast<std::uint64_t>(view.job));
  add(payload, "Progress", sparkplug::DOUBLE).set_double_value(view.progress);
  add(payload, "Words", sparkplug::STRING).set_string_value(view.words);
}

void add_properties(sparkplug::Payload& payload, const Machine& machine) {
  add(payload, "Properties/Kind", sparkplug::STRING).set_string_value(machine.kind);
  add(payload, "Properties/Material", sparkplug::STRING).set_string_value(machine.material);
  add(payload, "Properties/Nozzle mm", sparkplug::DOUBLE).set_double_value(machine.nozzle_mm);
}

}  // namespace

SparkplugNode::SparkplugNode(const std::string& group, const std::string& node, std::uint64_t connections)
    : prefix_("spBv1.0/" + group + "/"), node_(node), connections_(connections) {}

/// Sequence and time, last of all: what is sent has the number after what was sent before it.
std::string SparkplugNode::sealed(sparkplug::Payload& payload, std::uint64_t now_ms) {
  payload.set_timestamp(now_ms);
  for (sparkplug::Payload::Metric& metric : *payload.mutable_metrics()) metric.set_timestamp(now_ms);
  payload.set_seq(sequence_);
  sequence_ = (sequence_ + 1) % 256;
  return payload.SerializeAsString();
}

MqttMessage SparkplugNode::death(std::uint64_t now_ms) const {
  sparkplug::Payload payload;
  payload.set_timestamp(now_ms);
  add(payload, kDeathSequence, sparkplug::INT64).set_long_value(death_sequence_);
  return {.topic = topic("NDEATH"), .payload = payload.SerializeAsString(), .qos = 1};
}

std::vector<MqttMessage> SparkplugNode::birth(std::uint64_t now_ms,
                                              const std::vector<MachineView>& machines) {
  sequence_ = 0;
  born_.clear();
  sparkplug::Payload payload;
  add(payload, kDeathSequence, sparkplug::INT64).set_long_value(death_sequence_);
  add(payload, kRebirth, sparkplug::BOOLEAN).set_boolean_value(false);
  std::vector<MqttMessage> messages{{.topic = topic("NBIRTH"), .payload = sealed(payload, now_ms)}};
  for (const MachineView& machine : machines)
    if (machine.answers) messages.push_back(show(now_ms, machine));
  return messages;
}

MqttMessage SparkplugNode::show(std::uint64_t now_ms, const MachineView& machine) {
  bool& born = born_[machine.machine.name];
  const char* const type = !machine.answers ? "DDEATH" : born ? "DDATA" : "DBIRTH";
  const bool first = machine.answers && !born;
  born = machine.answers;
  sparkplug::Payload payload;
  if (machine.answers) add_machine(payload, machine);
  if (first) add_properties(payload, machine.machine);
  return {.topic = topic(type) + "/" + machine.machine.name, .payload = sealed(payload, now_ms)};
}

bool SparkplugNode::is_rebirth(std::string_view payload) const {
  sparkplug::Payload command;
  if (!command.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return false;
  for (const sparkplug::Payload::Metric& metric : command.metrics())
    if (metric.name() == kRebirth && metric.boolean_value()) return true;
  return false;
}

}  // namespace kinebus::fleet
