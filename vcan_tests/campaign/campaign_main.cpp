// kinebus-campaign: thousands of simulated faults, and what came of them.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <string_view>
#include <thread>

#include "vcan_tests/campaign/campaign.hpp"

namespace {

constexpr const char* kUsage =
    "kinebus-campaign [--seed FIRST] [--seeds N] [--threads M] [--only FAULT] [--limit SECONDS] [--tell]\n"
    "Runs N seeds: each a machine in virtual time, a job, and faults drawn from the seed. Prints fault kinds "
    "against\n"
    "outcomes, the worst of each kind, and the command that replays each seed in which a checker "
    "complained.\n"
    "--tell: what happens in each run, in words. Exit status 1: a checker complained.\n";

bool number(std::string_view text, std::uint64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

void tell(const kinebus::FaultPlan& plan) {
  const kinebus::MachineDescription machine = kinebus::campaign_machine(plan.faults.at(0).kind);
  const auto kinematics = kinebus::make_kinematics(machine);
  if (!kinematics) return;
  const kinebus::FaultResult result = kinebus::run_faults(machine, **kinematics, plan, true);
  for (const std::string& line : result.story) fmt::print("{}\n", line);
  fmt::print("seed {}: {}, path {:.2f} um, skew {:.2f} us, at rest after {:.1f} ms, trace {:016x}\n",
             result.seed, to_string(result.outcome), result.path_um, result.skew_us, result.rest_ms,
             result.trace_hash);
}

int campaign(int argc, char** argv) {
  kinebus::CampaignOptions options;
  options.threads = std::max(1u, std::thread::hardware_concurrency());
  bool story = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const std::string_view value = i + 1 < argc ? argv[i + 1] : "";
    std::uint64_t n = 0;
    if (word == "--tell") {
      story = true;
      continue;
    }
    ++i;
    if (word == "--only") {
      options.only = kinebus::fault_kind_of(value);
      if (options.only != kinebus::FaultKind::kCount) continue;
      fmt::print(stderr, "--only {}: no such fault; the faults are:", value);
      for (int kind = 0; kind < kinebus::kFaultKinds; ++kind)
        fmt::print(stderr, " {}", to_string(static_cast<kinebus::FaultKind>(kind)));
      fmt::print(stderr, "\n");
      return 2;
    }
    if (!number(value, n)) {
      fmt::print(stderr, "{}", kUsage);
      return 2;
    }
    if (word == "--seed")
      options.first_seed = n;
    else if (word == "--seeds")
      options.seeds = n;
    else if (word == "--threads")
      options.threads = static_cast<unsigned>(n);
    else if (word == "--limit")
      options.limit_s = static_cast<double>(n);
    else {
      fmt::print(stderr, "{}", kUsage);
      return 2;
    }
  }
  if (story)
    for (std::uint64_t seed = options.first_seed; seed < options.first_seed + options.seeds; ++seed)
      tell(kinebus::draw_faults(seed, static_cast<int>(kinebus::campaign_machine().nodes.size()),
                                options.only));
  // As they are found: a campaign of thousands takes an hour.
  options.on_result = [&](const kinebus::FaultResult& result) {
    if (result.violations.empty()) return;
    fmt::print(stderr, "seed {}: {}\n    again: {}\n", result.seed, fmt::join(result.violations, "; "),
               kinebus::replay_command(result.seed, options.only));
  };
  const kinebus::CampaignSummary summary = run_campaign(options);
  fmt::print("{}", to_table(summary));
  for (const kinebus::FaultResult& result : summary.failed) {
    fmt::print("FAILED seed {} ({})\n", result.seed, to_string(result.plan.faults[0].kind));
    for (const std::string& words : result.violations) fmt::print("    {}\n", words);
    fmt::print("    again: {}\n", kinebus::replay_command(result.seed, options.only));
  }
  return summary.failed.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return campaign(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinebus-campaign: %s\n", error.what());
    return 2;
  }
}
