#include "gateway/io/control_commands.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <numbers>
#include <string_view>

#include "gateway/io/control_text.hpp"

namespace kinebus {
namespace {

using nlohmann::json;
constexpr double kRadians = std::numbers::pi / 180.0;

json failure(std::string words) {
  return {{"ok", false}, {"error", std::move(words)}};
}

json reply(const Result<void, Refusal>& result) {
  if (result) return {{"ok", true}};
  return failure(result.error().words);
}

double number(const json& request, const char* key, double otherwise = 0) {
  return request.value(key, otherwise);
}

json jog(const json& request, Gateway& gateway) {
  static constexpr std::array<const char*, kPoseAxes> kKeys{"x", "y", "z", "a", "c", "e"};
  JogRequest jog;
  bool turns_only = true, any = false;
  for (std::size_t axis = 0; axis < kKeys.size(); ++axis) {
    const double value = number(request, kKeys[axis]);
    const bool rotary = axis == kA || axis == kC;
    jog.delta[axis] = rotary ? value * kRadians : value;
    any = any || value != 0;
    turns_only = turns_only && (rotary || value == 0);
  }
  if (!any) return failure("jog: expected a distance other than 0 for at least one of x y z a c e");
  const double speed = number(request, "speed");
  if (!(speed >= 0)) return failure("jog: speed must not be negative");
  jog.speed_per_s = turns_only ? speed * kRadians : speed;
  return reply(gateway.jog(jog));
}

json run(const json& request, Gateway& gateway, JobFolder& jobs) {
  const std::string name = request.value("name", "");
  auto source = jobs.open(name);
  if (!source) return failure(source.error());
  return reply(gateway.run(std::move(*source), name));
}

json list_jobs(const JobFolder& jobs) {
  json list = json::array();
  for (const auto& entry : jobs.list()) list.push_back({{"name", entry.name}, {"bytes", entry.bytes}});
  return {{"ok", true}, {"jobs", list}};
}

json remove_job(const json& request, JobFolder& jobs) {
  if (std::string error = jobs.remove(request.value("name", "")); !error.empty()) return failure(error);
  return {{"ok", true}};
}

json console(const json& request, Gateway& gateway) {
  const auto answer = gateway.text_line(request.value("line", ""));
  if (!answer) return failure(answer.error().words);
  return {{"ok", true}, {"text", *answer}};
}

json understood(const json& request, Gateway& gateway, JobFolder& jobs) {
  const std::string word = request.value("do", "");
  if (word == "status") return {{"ok", true}, {"status", to_json(gateway.status())}};
  if (word == "bring-up") return reply(gateway.bring_up());
  if (word == "home") return reply(gateway.home());
  if (word == "reference") return reply(gateway.go_to_reference());
  if (word == "jog") return jog(request, gateway);
  if (word == "run") return run(request, gateway, jobs);
  if (word == "hold") return reply(gateway.hold());
  if (word == "resume") return reply(gateway.resume());
  if (word == "cancel") return reply(gateway.cancel());
  if (word == "stop") return reply(gateway.stop());
  if (word == "clear") return reply(gateway.clear());
  if (word == "override") return reply(gateway.set_feed_override(number(request, "ratio", 1)));
  if (word == "motors-off") return reply(gateway.motors_off());
  if (word == "hotend" || word == "bed")
    return reply(gateway.set_temperature(word == "bed", number(request, "celsius")));
  if (word == "jobs") return list_jobs(jobs);
  if (word == "delete") return remove_job(request, jobs);
  if (word == "console") return console(request, gateway);
  return failure(
      "no command \"" + word +
      "\"; expected one of status bring-up home reference jog upload run hold resume cancel stop clear "
      "override motors-off hotend bed jobs delete console watch");
}

}  // namespace

json carry_out(const json& request, Gateway& gateway, JobFolder& jobs) {
  if (!request.is_object()) return failure("expected a JSON object such as {\"do\": \"status\"}");
  try {
    return understood(request, gateway, jobs);
  } catch (const json::exception& error) {
    return failure(std::string("a member has the wrong type: ") + error.what());
  }
}

}  // namespace kinebus
