#include "tools/cli/explain_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace kinebus {
namespace {

using nlohmann::json;

std::string when(double s) {
  return fmt::format("{:7.3f} s before the end", -s);
}

struct Told {
  double s = 0;
  std::set<int> nodes;
  std::string text;
  std::string words;  ///< the text without "node N", where it is about a node
  bool alarm = false;
  int times = 0;
};

/// What several nodes say at one time, or one says again and again, is one line.
std::vector<Told> in_order(const json& events) {
  constexpr double kAtOneTime_s = 1;
  std::vector<Told> told;
  for (const json& e : events) {
    Told row;
    row.s = e.at("s");
    row.text = row.words = e.at("words");
    row.alarm = e.at("kind") == "alarm";
    row.times = 1;
    const int node = e.value("node", 0);
    const std::string name = fmt::format("node {}", node);
    if (node != 0 && row.words.starts_with(name)) {
      row.nodes.insert(node);
      row.words.erase(0, name.size() + (row.words.substr(name.size()).starts_with(": ") ? 2 : 1));
    }
    const auto same = std::find_if(told.rbegin(), told.rend(), [&](const Told& before) {
      return before.words == row.words && before.alarm == row.alarm && row.s - before.s < kAtOneTime_s;
    });
    if (same == told.rend()) {
      told.push_back(std::move(row));
    } else {
      same->nodes.merge(row.nodes);
      ++same->times;
    }
  }
  return told;
}

void explain_order(const json& report) {
  fmt::print("\nIn order\n");
  for (const Told& row : in_order(report.at("events"))) {
    const std::string text =
        row.nodes.size() > 1 ? fmt::format("nodes {}: {}", fmt::join(row.nodes, ", "), row.words) : row.text;
    const auto repeated = row.times - static_cast<int>(std::max<std::size_t>(row.nodes.size(), 1));
    fmt::print("  {}: {}{}{}\n", when(row.s), row.alarm ? "ALARM " : "", text,
               row.alarm && repeated > 0 ? " (several times)" : "");
  }
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
  std::set<std::string> given;
  for (const json& e : report.at("events")) {
    const std::string advice = e.value("advice", "");
    // What came before a gateway's death was answered by then.
    if (died || e.at("kind") != "alarm" || advice.empty() || !given.insert(advice).second) continue;
    fmt::print("  {}{}.\n", static_cast<char>(std::toupper(static_cast<unsigned char>(advice[0]))),
               advice.substr(1));
  }
  if (!died)
    fmt::print("  Then: kinebus clear, and kinebus resume to go on with the job{}.\n",
               report.at("job").get<std::string>().empty() ? " if one was under way" : "");
  fmt::print("  The frames of the last minute are in {} (can-utils and Wireshark read it).\n",
             report.at("frames").get<std::string>());
}

/// Throws: it is none, and what is not as a report has it.
json read_report(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(
        fmt::format("{}: no report of the flight recorder (flight-*.json): {}", path, why));
  };
  json report;
  try {
    report = json::parse(file);
  } catch (const json::parse_error& error) {
    refuse(fmt::format("at byte {} it is no JSON", error.byte));
  }
  if (!report.is_object()) refuse("it is no object");
  const auto expect = [&](const char* key, json::value_t type, const char* what) {
    if (!report.contains(key)) refuse(fmt::format("it has no \"{}\"", key));
    if (report[key].type() != type && !(type == json::value_t::number_float && report[key].is_number()))
      refuse(fmt::format("\"{}\" is not {}", key, what));
  };
  for (const char* key : {"machine", "cause", "frames"}) expect(key, json::value_t::string, "a text");
  for (const char* key : {"emergencies", "events", "samples"}) expect(key, json::value_t::array, "a list");
  expect("end_unix_s", json::value_t::number_float, "a number");
  return report;
}

void explain_report(const json& report) {
  const bool died = report.at("cause") == "the gateway died";
  const auto end = static_cast<std::time_t>(report.at("end_unix_s").get<double>());
  fmt::print("{}: the minute up to {:%Y-%m-%d %H:%M:%S}\nWritten because: {}\n",
             report.at("machine").get<std::string>(), fmt::localtime(end),
             report.at("cause").get<std::string>());
  explain_cause(report, died);
  explain_motion(report, died);
  explain_order(report);
  explain_next(report, died);
}

int explain(const std::string& path) {
  const json report = read_report(path);
  try {
    explain_report(report);
  } catch (const json::exception&) {
    throw std::runtime_error(path +
                             ": a value of this report is missing, or of another kind than the recorder's");
  }
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
