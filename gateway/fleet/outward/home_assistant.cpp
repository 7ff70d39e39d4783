#include "gateway/fleet/outward/home_assistant.hpp"

#include <nlohmann/json.hpp>

namespace kinebus::fleet {
namespace {

using nlohmann::json;

std::string state_topic(const std::string& group, const Machine& machine) {
  return "kinebus/" + group + "/" + machine.name;
}

json sensor(const std::string& id, const char* key, const char* name) {
  return {{"platform", "sensor"},
          {"name", name},
          {"unique_id", id + "_" + key},
          {"value_template", std::string("{{ value_json.") + key + " }}"}};
}

std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

MqttMessage home_assistant_device(const std::string& group, const Machine& machine) {
  const std::string id = "kinebus_" + group + "_" + machine.name;
  json progress = sensor(id, "progress", "Progress");
  progress["unit_of_measurement"] = "%";
  const json device{
      {"device",
       {{"identifiers", json::array({id})},
        {"name", machine.name},
        {"manufacturer", "Kinebus"},
        {"model", machine.kind}}},
      {"origin", {{"name", "kinebus-fleet"}}},
      {"state_topic", state_topic(group, machine)},
      {"availability",
       {{{"topic", state_topic(group, machine)}, {"value_template", "{{ value_json.answers }}"}}}},
      {"payload_available", "yes"},
      {"payload_not_available", "no"},
      {"components",
       {{"state", sensor(id, "state", "State")}, {"job", sensor(id, "job", "Job")}, {"progress", progress}}}};
  return {
      .topic = "homeassistant/device/" + id + "/config", .payload = dumped(device), .qos = 1, .retain = true};
}

MqttMessage home_assistant_state(const std::string& group, const MachineView& view) {
  const json state{{"answers", view.answers ? "yes" : "no"},
                   {"state", view.state},
                   {"job", view.job},
                   {"progress", static_cast<int>(view.progress * 100)},
                   {"words", view.words}};
  return {.topic = state_topic(group, view.machine), .payload = dumped(state), .retain = true};
}

}  // namespace kinebus::fleet
