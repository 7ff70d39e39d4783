// Seeds of the campaign, and the promises that its table rests on.

#include <gtest/gtest.h>

#include "vcan_tests/sim/faults/campaign.hpp"

namespace kinebus {
namespace {

std::string complaints(const CampaignSummary& summary, FaultKind only = FaultKind::kCount) {
  std::string text;
  for (const FaultResult& result : summary.failed) {
    for (const std::string& words : result.violations) text += words + "; ";
    text += "\n  again: " + replay_command(result.seed, only) + "\n";
  }
  return text;
}

TEST(Campaign, EveryFaultComesToWhatIsPromised) {
  // One of each kind; kinebus-campaign runs more, and vcan_tests/README.md lists the seeds that are open.
  const CampaignSummary summary =
      run_campaign({.first_seed = 33, .seeds = kFaultKinds, .threads = 2, .repeat_every = 11});
  EXPECT_TRUE(summary.failed.empty()) << complaints(summary);
  EXPECT_EQ(summary.repeated, 3u);
  for (const auto& row : summary.rows) EXPECT_EQ(row.runs, 1u);
}

TEST(Campaign, AnEmergencyStopRampsAllNodesWithinTwoMillisecondsAndAFrame) {
  const CampaignSummary summary = run_campaign(
      {.first_seed = 1004, .seeds = 6, .threads = 2, .only = FaultKind::kEmergencyStop, .repeat_every = 0});
  EXPECT_TRUE(summary.failed.empty()) << complaints(summary, FaultKind::kEmergencyStop);
  const auto& row = summary.rows[static_cast<std::size_t>(FaultKind::kEmergencyStop)];
  EXPECT_GT(row.ramp_ms, 0);
  EXPECT_LE(row.ramp_ms, 2.14);
  EXPECT_LE(row.rest_ms, 150);
  EXPECT_LE(row.path_um, 5);
}

TEST(Campaign, ASeedIsOnePlanWhateverTheOrder) {
  for (std::uint64_t seed = 1; seed < 100; ++seed) {
    const FaultPlan a = draw_faults(seed, 3), b = draw_faults(seed, 3);
    ASSERT_EQ(a.faults.size(), b.faults.size());
    EXPECT_EQ(a.faults[0].kind, b.faults[0].kind);
    EXPECT_EQ(a.faults[0].after, b.faults[0].after);
    EXPECT_EQ(a.faults[0].strength, b.faults[0].strength);
  }
}

TEST(Campaign, FaultsHaveNamesAndComeInTurn) {
  for (int kind = 0; kind < kFaultKinds; ++kind) {
    const auto fault = static_cast<FaultKind>(kind);
    EXPECT_EQ(fault_kind_of(to_string(fault)), fault);
    EXPECT_EQ(draw_faults(static_cast<std::uint64_t>(kind + kFaultKinds), 3).faults[0].kind, fault);
  }
  EXPECT_EQ(fault_kind_of("nonsense"), FaultKind::kCount);
}

}  // namespace
}  // namespace kinebus
