// Moonraker's API: what was before a client came (temperatures, console), announcements.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gateway/sessions/http/moonraker/moonraker.hpp"

namespace kinebus::http {
namespace {

/// What was sent and said, the oldest first.
void gcode_store(const Call& call) {
  struct Line {
    double unix_s;
    std::string text;
    bool is_command;
  };
  std::vector<Line> lines;
  call.caller.server().link().events().each(0, false, [&](const joblink::Event& event) {
    if (event.kind() == joblink::EVENT_MESSAGE || event.kind() == joblink::EVENT_ALARM ||
        event.kind() == joblink::EVENT_PROBLEM)
      lines.push_back(
          {event.unix_s(), (event.kind() == joblink::EVENT_ALARM ? "!! " : "// ") + event.words(), false});
    return true;
  });
  for (const ConsoleCourse::Line& line : call.caller.server().console().lines())
    lines.push_back({line.unix_s, line.text, line.is_command});
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.unix_s < b.unix_s; });
  const double most = std::max(call.number("count", static_cast<double>(lines.size())), 0.0);
  const std::size_t count = std::min(lines.size(), static_cast<std::size_t>(std::min(most, 1e6)));
  Json store = Json::array();
  for (auto line = lines.end() - static_cast<std::ptrdiff_t>(count); line != lines.end(); ++line)
    store.push_back({{"message", std::move(line->text)},
                     {"time", line->unix_s},
                     {"type", line->is_command ? "command" : "response"}});
  call.done({{"gcode_store", std::move(store)}});
}

double rounded(double value) {
  return std::round(value * 100) / 100;
}

Json courses_json(const TemperatureCourse::Courses& courses) {
  Json store = Json::object();
  for (const auto& [sensor, values] : courses) {
    Json& told = store[sensor];
    for (const TemperatureCourse::Value& value : values) {
      told["temperatures"].push_back(rounded(value.celsius));
      if (value.target_celsius) told["targets"].push_back(rounded(*value.target_celsius));
      if (value.power) told["powers"].push_back(rounded(*value.power));
    }
  }
  return store;
}

void temperature_store(const Call& call) {
  call.caller.beside(
      [courses = call.caller.server().temperatures().all()](JobStore&) { return courses_json(courses); },
      [call](Json store) { call.done(std::move(store)); });
}

/// Nobody announces anything to a gateway that asks nobody.
void announcements(const Call& call) {
  call.done({{"entries", Json::array()}, {"feeds", Json::array()}});
}
void feeds(const Call& call) {
  call.done({{"feeds", Json::array()}});
}
/// Programs that register with Moonraker: none do here.
void extensions(const Call& call) {
  call.done({{"extensions", Json::array()}});
}
void dismiss(const Call& call) {
  call.fail(404, "there is no announcement '" + call.text("entry_id") + "'");
}

}  // namespace

void note_temperatures(Caller& caller, TemperatureCourse& course) {
  const joblink::Status status = machine_status(caller);
  for (const joblink::Heater& heater : status.heaters())
    course.add(klipper_heater(heater), {heater.actual_celsius(), heater.target_celsius(),
                                        heater.has_power() ? std::optional(heater.power()) : std::nullopt});
  for (const joblink::Sensor& sensor : status.sensors())
    course.add(klipper_sensor(sensor), {sensor.celsius()});
}

std::span<const Method> moonraker_store_methods() {
  static constexpr std::array kMethods{
      Method{"server.gcode_store", "GET", "server/gcode_store", gcode_store},
      Method{"server.temperature_store", "GET", "server/temperature_store", temperature_store},
      Method{"server.announcements.list", "GET", "server/announcements/list", announcements},
      Method{"server.announcements.feeds", "GET", "server/announcements/feeds", feeds},
      Method{"server.extensions.list", "GET", "server/extensions/list", extensions},
      Method{"server.announcements.update", "POST", "server/announcements/update", announcements},
      Method{"server.announcements.dismiss", "POST", "server/announcements/dismiss", dismiss},
  };
  return kMethods;
}

}  // namespace kinebus::http
