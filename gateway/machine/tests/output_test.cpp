// Outputs that a job switches on its way.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kFeed_mm_per_s = 40;

/// Where along X the output was when it changed.
std::vector<double> switched_at(MachineRig& rig, const std::string& job) {
  std::vector<double> places;
  if (!rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(job), "part"})) return places;
  double before = 0;
  rig.run_until(
      [&] {
        const MachineStatus status = rig.gateway->status();
        if (status.outputs[0].ratio != before) places.push_back(status.pose[kX]);
        before = status.outputs[0].ratio;
        return status.state == MachineState::kReady && !places.empty();
      },
      60s);
  return places;
}

TEST(Outputs, SwitchWithinAMillisecondOfTheirPlaceOnThePath) {
  MachineDescription machine = default_m1();
  machine.outputs = {{.name = "laser", .index = 0}};
  MachineRig rig(machine);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  // Straight on, so that the tool passes the places at its feed.
  const std::string job =
      "G64\nG1 X-30 F2400\nM62 P0\nG1 X-13.7\nM63 P0\nG1 X0.2\nM67 E0 Q0.5\nG1 X20.3\nM65 P0\nG1 X40\n";
  const std::vector<double> expected = {-30, -13.7, 0.2, 20.3};
  const std::vector<double> places = switched_at(rig, job);
  ASSERT_EQ(places.size(), expected.size()) << rig.story();
  double worst_ms = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double late_ms = 1000 * (places[i] - expected[i]) / kFeed_mm_per_s;
    EXPECT_NEAR(late_ms, 0, 1) << i;
    worst_ms = std::max(worst_ms, std::abs(late_ms));
  }
  RecordProperty("worst_us", static_cast<int>(1000 * worst_ms));
  std::printf("outputs: at most %.3f ms from their place\n", worst_ms);
}

TEST(Outputs, ComeWithThePathAtAnotherRate) {
  MachineDescription machine = default_m1();
  machine.outputs = {{.name = "laser", .index = 0}};
  MachineRig rig(machine);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.4}));
  const std::vector<double> places = switched_at(rig, "G1 X-30 F2400\nG1 X5\nM62 P0\nG1 X40\n");
  ASSERT_EQ(places.size(), 1u) << rig.story();
  EXPECT_NEAR(places[0], 5, 0.001 * kFeed_mm_per_s * 0.4);
}

}  // namespace
}  // namespace kinebus
