// What Prometheus reads of a fleet, and how much of it.

#include "gateway/fleet/wall/fleet_metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace kinebus::fleet {
namespace {

Queue::Seen seen(int number, const std::string& state, bool answers, double seen_s) {
  return {
      .view = {.machine = {.name = "machine" + std::to_string(number)}, .answers = answers, .state = state},
      .seen_s = seen_s};
}
bool has(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(FleetMetrics, CountMachinesByStateAndJobsByResult) {
  FleetNumbers numbers{.database = true,
                       .jobs = {.jobs = {{"queued", 7}, {"started", 2}, {"complete", 30}, {"failed", 1}},
                                .begun = 33,
                                .oldest_waiting_s = 120.5}};
  numbers.machines = {seen(0, "ready", true, 1), seen(1, "ready", true, 2), seen(2, "running", true, 99),
                      seen(3, "unreachable", false, 3), seen(4, "dreaming", true, 1)};
  const std::string text = fleet_metrics(numbers);
  for (const char* line :
       {"kinebus_fleet_database_up 1", "kinebus_fleet_machines{state=\"ready\"} 2",
        "kinebus_fleet_machines{state=\"running\"} 0", "kinebus_fleet_machines{state=\"silent\"} 1",
        "kinebus_fleet_machines{state=\"unreachable\"} 1", "kinebus_fleet_machines{state=\"other\"} 1",
        "kinebus_fleet_jobs{state=\"queued\"} 7", "kinebus_fleet_jobs{state=\"assigned\"} 0",
        "kinebus_fleet_oldest_waiting_seconds 120.5", "kinebus_fleet_oldest_report_seconds 99",
        "kinebus_fleet_jobs_begun_total 33", "kinebus_fleet_jobs_ended_total{result=\"complete\"} 30",
        "kinebus_fleet_jobs_ended_total{result=\"refused\"} 0"})
    EXPECT_TRUE(has(text, line)) << line << "\nin\n" << text;
  EXPECT_EQ(text.find("broker"), std::string::npos) << "nobody asked for it";
}

TEST(FleetMetrics, OfAThousandMachinesHaveAsManyLinesAsOfOne) {
  const auto lines_of = [](int machines) {
    FleetNumbers numbers{.database = true, .broker = true};
    for (int i = 0; i < machines; ++i)
      numbers.machines.push_back(seen(i, "state " + std::to_string(i), true, 1));
    const std::string text = fleet_metrics(numbers);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines_of(1), lines_of(1000));
  EXPECT_LT(lines_of(1000), 60);
}

TEST(FleetMetrics, WhatIsNotKnownIsLeftOut) {
  const std::string text = fleet_metrics({.broker = false});
  EXPECT_TRUE(has(text, "kinebus_fleet_database_up 0"));
  EXPECT_TRUE(has(text, "kinebus_fleet_broker_up 0"));
  EXPECT_EQ(text.find("kinebus_fleet_machines"), std::string::npos);
  EXPECT_EQ(text.find("kinebus_fleet_jobs"), std::string::npos);
}

}  // namespace
}  // namespace kinebus::fleet
