#include "gateway/fleet/wall/fleet_metrics.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "gateway/sessions/http/wire/exposition.hpp"

namespace kinebus::fleet {
namespace {

using http::Exposition;

/// As gateways say them; what a newer one may say besides is "other".
constexpr std::array<std::string_view, 14> kStates{
    "off",     "bring-up", "not homed", "homing",     "ready",    "moving",  "checking the job",
    "running", "holding",  "held",      "cancelling", "stopping", "stopped", "alarm"};
constexpr std::array<std::string_view, 3> kUnknown{"unreachable", "silent", "other"};
constexpr std::array<std::string_view, 3> kNotOver{"queued", "assigned", "started"};
constexpr std::array<std::string_view, 5> kResults{"complete", "cancelled", "refused", "failed",
                                                   "interrupted"};

std::string_view state_of(const Queue::Seen& seen) {
  if (seen.seen_s > kSilentAfterS) return "silent";
  if (!seen.view.answers) return "unreachable";
  const auto* const found = std::find(kStates.begin(), kStates.end(), seen.view.state);
  return found == kStates.end() ? "other" : *found;
}

void add_machines(Exposition& out, const std::vector<Queue::Seen>& machines) {
  std::map<std::string_view, int> count;
  double oldest_s = 0;
  for (const Queue::Seen& seen : machines) {
    ++count[state_of(seen)];
    oldest_s = std::max(oldest_s, seen.seen_s);
  }
  out.gauge("kinebus_fleet_machines",
            "Machines by state; silent: its agent has told nothing for 15 s, unreachable: its gateway does "
            "not answer it");
  for (const std::string_view state : kStates) out.sample(count[state], {{"state", state}});
  for (const std::string_view state : kUnknown) out.sample(count[state], {{"state", state}});
  out.gauge("kinebus_fleet_oldest_report_seconds",
            "Age of the oldest last report of an agent about a machine")
      .sample(oldest_s);
}

void add_jobs(Exposition& out, const Queue::Numbers& numbers) {
  const auto count = [&](std::string_view state) {
    const auto found = numbers.jobs.find(std::string(state));
    return found == numbers.jobs.end() ? 0.0 : static_cast<double>(found->second);
  };
  out.gauge("kinebus_fleet_jobs", "Jobs that are not over by state");
  for (const std::string_view state : kNotOver) out.sample(count(state), {{"state", state}});
  out.gauge("kinebus_fleet_oldest_waiting_seconds",
            "Since the oldest job that waits was added; 0: none waits")
      .sample(numbers.oldest_waiting_s);
  out.counter("kinebus_fleet_jobs_begun_total",
              "Starts that a machine has taken into its history; a job that was released or asked for again "
              "may have more than one")
      .sample(static_cast<double>(numbers.begun));
  out.counter("kinebus_fleet_jobs_ended_total", "Jobs that are over by result");
  for (const std::string_view result : kResults) out.sample(count(result), {{"result", result}});
}

}  // namespace

std::string fleet_metrics(const FleetNumbers& numbers) {
  Exposition out;
  out.gauge("kinebus_fleet_database_up", "The queue's database answers").sample(numbers.database ? 1 : 0);
  // A database that does not even say no keeps the one who asks waiting: this stands still then.
  out.gauge("kinebus_fleet_looked_timestamp_seconds", "When these numbers were asked for, since 1970")
      .sample(numbers.looked_unix_s);
  if (numbers.broker)
    out.gauge("kinebus_fleet_broker_up", "The broker answers: a login, then pings")
        .sample(*numbers.broker ? 1 : 0);
  if (numbers.database) {
    add_machines(out, numbers.machines);
    add_jobs(out, numbers.jobs);
  }
  return out.take();
}

}  // namespace kinebus::fleet
