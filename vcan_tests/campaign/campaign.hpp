#pragma once
// Many seeds on several threads, and what came of them: a table of fault kinds against outcomes, with the
// worst of each kind, and every seed in which a checker complained.

#include <functional>
#include <string>
#include <vector>

#include "vcan_tests/campaign/fault_run.hpp"

namespace kinebus {

struct CampaignOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 100;
  unsigned threads = 1;
  FaultKind only = FaultKind::kCount;  ///< kCount: every kind in turn
  /// One seed in so many runs twice: the same seed must give the same trace. 0: none.
  std::uint64_t repeat_every = 50;
  double limit_s = 0;  ///< of real time; no further seed begins after it. 0: none
  std::function<void(const FaultResult&)> on_result{};  ///< one at a time
};

struct CampaignSummary {
  struct Row {
    std::uint64_t runs = 0, violations = 0;
    std::array<std::uint64_t, kFaultOutcomes> outcomes{};
    double path_um = 0, astray_um = 0, skew_us = 0, rest_ms = 0, ramp_ms = 0, step_ratio = 0,
           known_counts = 0, margin_k = 1000;
    std::uint64_t path_seed = 0;
  };
  std::array<Row, kFaultKinds> rows{};
  std::uint64_t runs = 0, repeated = 0;
  double machine_s = 0, cpu_s = 0;
  std::vector<FaultResult> failed;  ///< the first hundred of them
};

CampaignSummary run_campaign(const CampaignOptions& options);
std::string to_table(const CampaignSummary& summary);
/// The command that replays one seed, bit for bit.
std::string replay_command(std::uint64_t seed, FaultKind only);

}  // namespace kinebus
