// The page that Prometheus reads, of a machine made up here.

#include "gateway/sessions/http/metrics/metrics.hpp"

#include <gtest/gtest.h>

#include "gateway/sessions/http/tests/http_rig.hpp"
#include "gateway/sessions/http/wire/exposition.hpp"

namespace kinebus::http {
namespace {

bool has(const std::string& page, const std::string& line) {
  return ("\n" + page).find("\n" + line + "\n") != std::string::npos;
}

TEST(Metrics, TextOfPeopleStaysWithinItsLabel) {
  Exposition out;
  out.gauge("a_ratio", "Help").sample(0.25, {{"name", "a\"b\\c\nd"}, {"of", "x"}}).sample(1);
  EXPECT_EQ(out.take(),
            "# HELP a_ratio Help\n# TYPE a_ratio gauge\na_ratio{name=\"a\\\"b\\\\c\\nd\",of=\"x\"} "
            "0.25\na_ratio 1\n");
}

TEST(Metrics, WhatIsNotKnownIsLeftOutAndUnitsAreSi) {
  joblink::Status status;
  status.set_state(joblink::STATE_HELD);
  status.set_positions_known(true);
  status.mutable_machine()->set_z_mm(-1500);
  status.set_job("hull \"2\".gcode");
  status.set_elapsed_s(7.5);
  auto& bed = *status.add_heaters();
  bed.set_name("bed");
  bed.set_actual_celsius(59.5);
  auto& node = *status.add_nodes();
  node.set_id(3);
  node.set_nmt_state(5);
  node.add_axes()->set_fault(true);
  node.add_axes()->set_stage_celsius(41);
  MetricsBeside beside{.version = "1.2", .listing = {}, .runs = {}};
  beside.runs.begun = 12;
  beside.runs.by_result[static_cast<std::size_t>(RunResult::kCancelled)] = {4, 90.5};
  const std::string page = metrics_page(status, {}, beside);
  for (const char* line :
       {"kinebus_state{state=\"held\"} 1", "kinebus_state{state=\"bring_up\"} 0",
        "kinebus_tool_position_meters{axis=\"z\"} -1.5", "kinebus_job{job=\"hull \\\"2\\\".gcode\"} 1",
        "kinebus_job_elapsed_seconds 7.5", "kinebus_heater_celsius{heater=\"bed\"} 59.5",
        "kinebus_node_operational{node=\"3\"} 1", "kinebus_axis_fault{node=\"3\",axis=\"A\"} 1",
        "kinebus_axis_fault{node=\"3\",axis=\"B\"} 0", "kinebus_axis_stage_celsius{node=\"3\",axis=\"B\"} 41",
        "kinebus_runs_begun_total 12", "kinebus_runs{result=\"cancelled\"} 4",
        "kinebus_runs_seconds{result=\"cancelled\"} 90.5"})
    EXPECT_TRUE(has(page, line)) << line << " is not in\n" << page;
  for (const char* part : {"\nkinebus_heater_power_ratio", "\nkinebus_node_clock_error_seconds", "nan",
                           "\nkinebus_axis_stage_celsius{node=\"3\",axis=\"A\"}"})
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  status.set_positions_known(false);
  status.clear_job();
  EXPECT_EQ(metrics_page(status, {}, beside).find("\nkinebus_tool_position_meters{"), std::string::npos);
  EXPECT_TRUE(has(metrics_page(status, {}, beside), "kinebus_job{job=\"\"} 0"));
}

TEST(Metrics, AreForWhoHasTheKey) {
  HttpRig rig;
  EXPECT_EQ(rig.ask("GET /metrics HTTP/1.1\r\nHost: kinebus\r\n\r\n").status, 401);
  const Response page = rig.get("/metrics");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.head.find("Content-Type: text/plain; version=0.0.4"), std::string::npos) << page.head;
  EXPECT_TRUE(has(page.body, "kinebus_state{state=\"off\"} 1")) << page.body;
  EXPECT_EQ(rig.send("POST", "/metrics", "{}").status, 405);
}

}  // namespace
}  // namespace kinebus::http
