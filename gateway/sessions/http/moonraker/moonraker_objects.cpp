// The machine as Klipper's objects. A field that Kinebus does not know is not there.

#include <array>

#include "gateway/sessions/http/moonraker/moonraker.hpp"

namespace kinebus::http {
namespace {

std::string extruder_name(std::uint32_t index) {
  return index == 0 ? "extruder" : "extruder" + std::to_string(index);
}

struct Machine {
  const joblink::Status& status;
  const joblink::MachineInfo& info;
  Server& server;
};

std::string fan_name(const joblink::Output& fan) {
  return fan.index() == 0 ? "fan" : "fan_generic " + fan.name();
}

Json position(const joblink::Pose& pose) {
  return {pose.x_mm(), pose.y_mm(), pose.z_mm(), pose.e_mm()};
}
Json corner(const joblink::Reach& reach, bool upper) {
  Json at = Json::array();
  for (const joblink::Range* range : {&reach.x_mm(), &reach.y_mm(), &reach.z_mm()})
    at.push_back(upper ? range->max() : range->min());
  at.push_back(0.0);
  return at;
}

bool prints(const joblink::Status& status) {
  return job_is_there(status) && !is_paused(status);
}

Json webhooks(const Machine& m) {
  return {{"state", klippy_state(m.status)}, {"state_message", m.status.doing()}};
}
Json toolhead(const Machine& m) {
  return {{"position", position(m.status.machine())},
          {"homed_axes", m.status.positions_known() ? "xyz" : ""},
          {"print_time", m.status.path_time_s()},
          {"estimated_print_time", m.status.path_time_s()},
          {"axis_minimum", corner(m.info.reach(), false)},
          {"axis_maximum", corner(m.info.reach(), true)},
          {"max_velocity", m.info.tool_speed_mm_per_s()},
          {"max_accel", m.info.tool_accel_mm_per_s2()},
          {"extruder", extruder_name(m.status.hotend_in_use())},
          {"stalls", m.status.counters().starvation_holds()}};
}
Json gcode_move(const Machine& m) {
  return {{"speed_factor", m.status.feed_override()},
          {"homing_origin", {0.0, 0.0, 0.0, 0.0}},
          {"position", position(m.status.machine())},
          {"gcode_position", position(m.status.tool())}};
}
Json motion_report(const Machine& m) {
  return {{"live_position", position(m.status.machine())}};
}
Json print_stats(const Machine& m) {
  const joblink::Status& s = m.status;
  const char* state = !job_is_there(s) ? m.server.job_end() : is_paused(s) ? "paused" : "printing";
  return {{"filename", s.job()},
          {"state", state},
          {"total_duration", s.elapsed_s()},
          {"print_duration", s.elapsed_s()},
          {"message", s.doing()},
          {"info", {{"total_layer", nullptr}, {"current_layer", nullptr}}}};
}
Json virtual_sdcard(const Machine& m) {
  return {{"file_path", job_is_there(m.status) ? Json(m.status.job()) : Json(nullptr)},
          {"progress", m.status.progress()},
          {"is_active", prints(m.status)}};
}
Json pause_resume(const Machine& m) {
  return {{"is_paused", is_paused(m.status)}};
}
Json display_status(const Machine& m) {
  return {{"progress", m.status.progress()}, {"message", m.status.doing()}};
}
/// Names as Klipper's clients send them back: EXCLUDE_OBJECT NAME=.
Json exclude_object(const Machine& m) {
  Json objects = Json::array(), excluded = Json::array();
  for (const joblink::PrintObject& object : m.status.objects()) {
    objects.push_back({{"name", object.name()}});
    if (object.left_out()) excluded.push_back(object.name());
  }
  return {{"objects", objects}, {"excluded_objects", excluded}, {"current_object", nullptr}};
}
Json idle_timeout(const Machine& m) {
  const bool idle = m.status.state() == joblink::STATE_OFF;
  return {{"state", prints(m.status) ? "Printing"
                    : idle           ? "Idle"
                                     : "Ready"},
          {"printing_time", m.status.elapsed_s()}};
}
Json heaters(const Machine& m) {
  Json heaters = Json::array(), sensors = Json::array();
  for (const joblink::Heater& heater : m.status.heaters()) heaters.push_back(klipper_heater(heater));
  sensors = heaters;
  for (const joblink::Sensor& sensor : m.status.sensors()) sensors.push_back(klipper_sensor(sensor));
  return {{"available_heaters", heaters}, {"available_sensors", sensors}};
}
/// What the lines of printer.gcode.script may be beside G-code (moonraker_printer.cpp).
Json gcode(const Machine&) {
  return {{"commands",
           {{"PAUSE", {{"help", "Holds the job on its path"}}},
            {"RESUME", {{"help", "Goes on with the job"}}},
            {"CANCEL_PRINT", {{"help", "Ends the job"}}},
            {"EXCLUDE_OBJECT", {{"help", "NAME=: leaves an object of the print out"}}},
            {"SDCARD_PRINT_FILE", {{"help", "FILENAME=: starts a stored job"}}},
            {"SET_HEATER_TEMPERATURE", {{"help", "HEATER= TARGET="}}},
            {"TURN_OFF_HEATERS", {{"help", "All heaters off"}}},
            {"FIRMWARE_RESTART", {{"help", "Clears a stop or an alarm"}}}}}};
}
Json macro(const Machine&) {
  return Json::object();
}
Json configfile(const Machine& m) {
  Json settings = {{"printer",
                    {{"kinematics", m.info.kinematics()},
                     {"max_velocity", m.info.tool_speed_mm_per_s()},
                     {"max_accel", m.info.tool_accel_mm_per_s2()}}},
                   {"virtual_sdcard", Json::object()},
                   {"pause_resume", Json::object()},
                   {"exclude_object", Json::object()},
                   {"display_status", Json::object()},
                   {"gcode_macro pause", Json::object()},
                   {"gcode_macro resume", Json::object()},
                   {"gcode_macro cancel_print", Json::object()}};
  for (const joblink::HeaterInfo& heater : m.info.heaters()) {
    joblink::Heater named;
    named.set_kind(heater.kind());
    named.set_index(heater.index());
    named.set_name(heater.name());
    Json& of = settings[klipper_heater(named)];
    of = {{"min_temp", 0.0}, {"max_temp", heater.max_celsius()}};
    if (heater.kind() == joblink::HEATER_HOTEND) of["filament_diameter"] = m.info.filament_diameter_mm();
  }
  return {{"config", settings},
          {"settings", settings},
          {"save_config_pending", false},
          {"warnings", Json::array()}};
}

struct Object {
  const char* name;
  Json (*made)(const Machine&);
};
constexpr std::array kObjects{
    Object{"webhooks", webhooks},
    Object{"gcode", gcode},
    Object{"configfile", configfile},
    Object{"toolhead", toolhead},
    Object{"gcode_move", gcode_move},
    Object{"motion_report", motion_report},
    Object{"heaters", heaters},
    Object{"print_stats", print_stats},
    Object{"virtual_sdcard", virtual_sdcard},
    Object{"pause_resume", pause_resume},
    Object{"display_status", display_status},
    Object{"idle_timeout", idle_timeout},
    Object{"exclude_object", exclude_object},
    Object{"gcode_macro PAUSE", macro},
    Object{"gcode_macro RESUME", macro},
    Object{"gcode_macro CANCEL_PRINT", macro},
};

/// Those whose names are the machine's.
Json named_objects(const joblink::Status& status) {
  Json objects = Json::object();
  for (const joblink::Heater& heater : status.heaters()) {
    Json& object = objects[klipper_heater(heater)];
    object = {{"temperature", heater.actual_celsius()}, {"target", heater.target_celsius()}};
    if (heater.has_power()) object["power"] = heater.power();
  }
  for (const joblink::Output& fan : status.fans()) objects[fan_name(fan)] = {{"speed", fan.ratio()}};
  for (const joblink::Output& pin : status.outputs())
    objects["output_pin " + pin.name()] = {{"value", pin.ratio()}};
  for (const joblink::Sensor& sensor : status.sensors())
    objects[klipper_sensor(sensor)] = {{"temperature", sensor.celsius()}};
  return objects;
}

Json fields_of(Json object, const Json& wanted) {
  if (!wanted.is_array()) return object;
  Json some = Json::object();
  for (const Json& field : wanted)
    if (field.is_string() && object.contains(field.get<std::string>()))
      some[field.get<std::string>()] = object[field.get<std::string>()];
  return some;
}

}  // namespace

std::string klipper_heater(const joblink::Heater& heater) {
  if (heater.kind() == joblink::HEATER_HOTEND) return extruder_name(heater.index());
  if (heater.kind() == joblink::HEATER_BED && heater.index() == 0) return "heater_bed";
  return "heater_generic " + heater.name();
}
std::string klipper_sensor(const joblink::Sensor& sensor) {
  return "temperature_sensor " + sensor.name();
}

const char* klippy_state(const joblink::Status& status) {
  switch (status.state()) {
    case joblink::STATE_STOPPING:
    case joblink::STATE_STOPPED:
    case joblink::STATE_ALARM:
      return "shutdown";
    default:
      return "ready";
  }
}

std::vector<std::string> moonraker_object_names(Caller& caller) {
  std::vector<std::string> names;
  names.reserve(kObjects.size());
  for (const Object& object : kObjects) names.emplace_back(object.name);
  const Json named = named_objects(machine_status(caller));
  for (const auto& [name, object] : named.items()) names.push_back(name);
  return names;
}

Json moonraker_objects(Caller& caller, const Json& wanted) {
  const joblink::Status status = machine_status(caller);
  const joblink::MachineInfo info = machine_info(caller);
  const Machine machine{status, info, caller.server()};
  const Json named = named_objects(status);
  Json found = Json::object();
  for (const auto& [name, fields] : wanted.items()) {
    for (const Object& object : kObjects)
      if (name == object.name) found[name] = fields_of(object.made(machine), fields);
    if (named.contains(name)) found[name] = fields_of(named[name], fields);
  }
  return found;
}

}  // namespace kinebus::http
