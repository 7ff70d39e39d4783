#include "vcan_tests/campaign/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace kinebus {
namespace {

void add(CampaignSummary& summary, const FaultResult& result) {
  auto& row = summary.rows[static_cast<std::size_t>(result.plan.faults.at(0).kind)];
  ++row.runs;
  ++row.outcomes[static_cast<std::size_t>(result.outcome)];
  if (!result.violations.empty()) ++row.violations;
  if (result.path_um > row.path_um) row.path_um = result.path_um, row.path_seed = result.seed;
  row.astray_um = std::max(row.astray_um, result.astray_um);
  row.skew_us = std::max(row.skew_us, result.skew_us);
  row.rest_ms = std::max(row.rest_ms, result.rest_ms);
  row.ramp_ms = std::max(row.ramp_ms, result.ramp_ms);
  row.step_ratio = std::max(row.step_ratio, result.step_ratio);
  row.known_counts = std::max(row.known_counts, result.known_counts);
  row.margin_k = std::min(row.margin_k, result.margin_k);
  ++summary.runs;
  summary.machine_s += result.machine_s;
  summary.cpu_s += result.cpu_s;
  constexpr std::size_t kMostTold = 100;
  if (!result.violations.empty() && summary.failed.size() < kMostTold) summary.failed.push_back(result);
}

}  // namespace

CampaignSummary run_campaign(const CampaignOptions& options) {
  const MachineDescription machine = campaign_machine();
  const MachineDescription printer = campaign_machine(FaultKind::kSensorOpen);
  const auto made = make_kinematics(machine);
  if (!made) return {};
  const Kinematics& kinematics = **made;
  const auto nodes = static_cast<int>(machine.nodes.size());
  const auto began = std::chrono::steady_clock::now();

  CampaignSummary summary;
  std::mutex mutex;  // of summary and on_result
  std::atomic<std::uint64_t> next{0};
  const auto work = [&] {
    for (;;) {
      const std::uint64_t place = next.fetch_add(1);
      const std::chrono::duration<double> past = std::chrono::steady_clock::now() - began;
      if (place >= options.seeds || (options.limit_s > 0 && past.count() > options.limit_s)) return;
      const std::uint64_t seed = options.first_seed + place;
      const FaultPlan plan = draw_faults(seed, nodes, options.only);
      const MachineDescription& of = of_heat(plan.faults[0].kind) ? printer : machine;
      FaultResult result = run_faults(of, kinematics, plan);
      const bool twice = options.repeat_every > 0 && place % options.repeat_every == 0;
      if (twice && run_faults(of, kinematics, plan).trace_hash != result.trace_hash)
        result.violations.emplace_back("the same seed gave another trace");
      const std::lock_guard lock(mutex);
      summary.repeated += twice ? 1 : 0;
      add(summary, result);
      if (options.on_result) options.on_result(result);
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 1; i < options.threads; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  std::sort(summary.failed.begin(), summary.failed.end(),
            [](const FaultResult& a, const FaultResult& b) { return a.seed < b.seed; });
  return summary;
}

std::string replay_command(std::uint64_t seed, FaultKind only) {
  std::string command = fmt::format("kinebus-campaign --seed {} --seeds 1 --tell", seed);
  if (only != FaultKind::kCount) command += fmt::format(" --only {}", to_string(only));
  return command;
}

std::string to_table(const CampaignSummary& summary) {
  std::string text = fmt::format("{:<20}{:>6}", "fault", "runs");
  for (int i = 0; i < kFaultOutcomes; ++i)
    text += fmt::format("{:>12}", to_string(static_cast<FaultOutcome>(i)));
  text += fmt::format("{:>8}{:>9}{:>10}{:>9}{:>9}{:>9}{:>7}{:>8}{:>9}\n", "failed", "path um", "astray um",
                      "skew us", "rest ms", "ramp ms", "step", "counts", "margin K");
  for (int kind = 0; kind < kFaultKinds; ++kind) {
    const auto& row = summary.rows[static_cast<std::size_t>(kind)];
    if (row.runs == 0) continue;
    text += fmt::format("{:<20}{:>6}", to_string(static_cast<FaultKind>(kind)), row.runs);
    for (const std::uint64_t count : row.outcomes)
      text += count == 0 ? fmt::format("{:>12}", ".") : fmt::format("{:>12}", count);
    text += fmt::format("{:>8}{:>9.2f}{:>10}{:>9.2f}{:>9.1f}{:>9.3f}{:>7.2f}{:>8.2f}{:>9}\n", row.violations,
                        row.path_um, row.astray_um > 0 ? fmt::format("{:.0f}", row.astray_um) : ".",
                        row.skew_us, row.rest_ms, row.ramp_ms, row.step_ratio, row.known_counts,
                        row.margin_k < 1000 ? fmt::format("{:.1f}", row.margin_k) : ".");
  }
  text +=
      "path: tool from plan while positions are known; astray: after lost steps, unseen until homing; skew: "
      "path "
      "time\nbetween nodes; rest: cause to all at rest; ramp: E-stop input to all ramping; step: change of "
      "velocity, "
      "of the stop limit;\ncounts: a position said to be known, from the truth; margin: the hottest block "
      "below its limit\n";
  text += fmt::format(
      "{} runs, {} of them twice with the same trace, {:.0f} s of machine time at {:.0f} x real time a "
      "core\n",
      summary.runs, summary.repeated, summary.machine_s,
      summary.cpu_s > 0 ? summary.machine_s / summary.cpu_s : 0);
  return text;
}

}  // namespace kinebus
