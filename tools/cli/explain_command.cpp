#include "tools/cli/explain_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace kinebus {
namespace {

using nlohmann::json;

std::string when(double s) {
  return fmt::format("{:7.3f} s before the end", -s);
}

/// Who asked first for a stop: a node on the bus, or the gateway.
void explain_cause(const json& report, bool died) {
  const json* first_node = nullptr;
  for (const json& e : report.at("emergencies"))
    if (e.value("stops", 0) != 0 && first_node == nullptr) first_node = &e;
  const json* first_alarm = nullptr;
  for (const json& e : report.at("events"))
    if (e.at("kind") == "alarm" && first_alarm == nullptr) first_alarm = &e;
  fmt::print("\nWho stopped first, and why\n");
  if (died)
    fmt::print(
        "  The gateway ended without a word (killed, crashed, or its computer lost power). The nodes miss "
        "its\n"
        "  SYNC after 175 ms and stop together on the path; they hold their places and remember path "
        "time.\n");
  // What was long before a gateway's death has nothing to do with it.
  constexpr double kLongBefore_s = -2;
  if (died && first_node != nullptr && first_node->at("s") < kLongBefore_s) first_node = nullptr;
  if (died && first_alarm != nullptr && first_alarm->at("s") < kLongBefore_s) first_alarm = nullptr;
  if (first_node != nullptr && first_alarm != nullptr && first_alarm->at("s") < first_node->at("s"))
    first_node = nullptr;
  if (first_node != nullptr)
    fmt::print("  {}: {}\n", when(first_node->at("s")), first_node->at("words").get<std::string>());
  if (first_alarm != nullptr && (first_node == nullptr || first_alarm->at("s") < first_node->at("s")))
    fmt::print("  {}: {}\n", when(first_alarm->at("s")), first_alarm->at("words").get<std::string>());
  if (!died && first_node == nullptr && first_alarm == nullptr)
    fmt::print("  Nobody: no alarm is in this record.\n");
}

void explain_motion(const json& report, bool died) {
  fmt::print("\nWhat the machine did\n");
  const json& samples = report.at("samples");
  const json* moving = nullptr;
  const json* at_rest = nullptr;
  double worst_sync_us = 0;
  for (const json& sample : samples) {
    worst_sync_us = std::max(worst_sync_us, sample.at("sync_error_us").get<double>());
    if (sample.at("rate").get<double>() > 0) {
      moving = &sample;
      at_rest = nullptr;
    } else if (moving != nullptr && at_rest == nullptr) {
      at_rest = &sample;
    }
  }
  if (samples.empty()) return fmt::print("  Nothing was sampled.\n");
  if (moving == nullptr) {
    fmt::print("  It stood still all the time.\n");
  } else {
    const auto& pose = moving->at("pose");
    fmt::print(
        "  {}: it moved, in line {} of {}, tool at X{:.3f} Y{:.3f} Z{:.3f}, {:.0f} % of full path rate.\n",
        when(moving->at("s")), moving->at("line").get<int>(),
        report.at("job").get<std::string>().empty() ? "a move by hand" : report.at("job").get<std::string>(),
        pose[0].get<double>(), pose[1].get<double>(), pose[2].get<double>(),
        100 * moving->at("rate").get<double>());
    if (at_rest != nullptr)
      fmt::print("  {}: all carriages at rest on the path, path time {:.6f} s.\n", when(at_rest->at("s")),
                 at_rest->at("path_time_s").get<double>());
    else if (died)
      fmt::print("  The record ends in motion: the nodes came to rest by themselves after it.\n");
  }
  fmt::print("  Clocks of the nodes agreed within {:.0f} us. Positions are {}.\n", worst_sync_us,
             samples.back().at("positions_known").get<int>() != 0 ? "known" : "not known");
}

void explain_next(const json& report, bool died) {
  fmt::print("\nWhat to do next\n");
  if (died)
    fmt::print(
        "  Start the gateway again (systemd does), then: kinebus resume. The job goes on from its exact "
        "place.\n");
  std::string last;
  for (const json& e : report.at("events")) {
    const std::string advice = e.value("advice", "");
    if (e.at("kind") != "alarm" || advice.empty() || advice == last) continue;
    fmt::print("  {}\n", last = advice);
  }
  if (!died)
    fmt::print("  Then: kinebus clear, and kinebus resume to go on with the job{}.\n",
               report.at("job").get<std::string>().empty() ? " if one was under way" : "");
  fmt::print("  The frames of the last minute are in {} (can-utils and Wireshark read it).\n",
             report.at("frames").get<std::string>());
}

int explain(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  const json report = json::parse(file);
  const bool died = report.at("cause") == "the gateway died";
  const auto end = static_cast<std::time_t>(report.at("end_unix_s").get<double>());
  fmt::print("{}: the minute up to {:%Y-%m-%d %H:%M:%S}\nWritten because: {}\n",
             report.at("machine").get<std::string>(), fmt::localtime(end),
             report.at("cause").get<std::string>());
  explain_cause(report, died);
  explain_motion(report, died);
  fmt::print("\nIn order\n");
  for (const json& e : report.at("events"))
    fmt::print("  {}: {}{}\n", when(e.at("s")), e.at("kind") == "alarm" ? "ALARM " : "",
               e.at("words").get<std::string>());
  explain_next(report, died);
  return 0;
}

}  // namespace

void add_explain_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("explain", "Say in words what a flight recorder's report tells");
  auto path = std::make_shared<std::string>();
  command->add_option("report", *path, "flight-*.json")->required()->check(CLI::ExistingFile);
  command->callback([=, &exit_code] { exit_code = explain(*path); });
}

}  // namespace kinebus
