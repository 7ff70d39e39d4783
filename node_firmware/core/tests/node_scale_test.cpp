// Linear scales on the carriages (2160h): counted beside the axis, and what they said at the home switch.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint8_t kScaleNode = 3;
constexpr std::uint16_t kScaleA = 0x2160, kScaleB = 0x2960;
constexpr std::int64_t kCountsAMm = 1280;

/// Carriage A has a scale of 0.01 mm on a screw that is 0.14 % too long; B has none.
std::vector<NodeSetup> one_scale() {
  NodeSetup setup{.id = kScaleNode};
  setup.plant[0] = {.switch_input = 1,
                    .switch_counts = -20 * kCountsAMm,
                    .active_above = false,
                    .scale_pulses = 100.0 / static_cast<double>(kCountsAMm),
                    .screw_error = 0.0014};
  return {setup};
}

TEST(NodeScale, ABoardWithoutTheInputRefusesAScaleAndTellsNothingOfIt) {
  Bench bench(one_scale());
  EXPECT_EQ(bench.try_write(kScaleNode, kScaleB, 1, 1, 1), static_cast<std::uint32_t>(AbortCode::kHardware));
  bench.write(kScaleNode, kScaleB, 1, 1, 0);
  bench.send("603#4060210400000000");
  bench.run(5ms);
  EXPECT_EQ(text_of(*bench.last(0x583)), "583#8060210424000008") << "not fitted yet: no data";
  bench.write(kScaleNode, kScaleA, 1, 1, 1);
  EXPECT_EQ(bench.read(kScaleNode, kScaleA, 4), 0);
  bench.send("603#4060210500000000");
  bench.run(5ms);
  EXPECT_EQ(text_of(*bench.last(0x583)), "583#8060210524000008") << "it has not homed";
}

TEST(NodeScale, CountsTheCarriageAndKeepsWhatItWasAtTheEdgeOfTheHomeSwitch) {
  for (const bool inverted : {false, true}) {
    SCOPED_TRACE(inverted);
    Bench bench(one_scale());
    bench.write(kScaleNode, kScaleA, 3, 1, inverted ? 1 : 0);
    bench.write(kScaleNode, kScaleA, 1, 1, 1);
    bench.write(kScaleNode, 0x2130, 1, 1, 1);
    bench.write(kScaleNode, 0x6098, 0, 1, 22);
    bench.write(kScaleNode, 0x607C, 0, 4, 0);
    bench.enable(kScaleNode, 0, 6);
    bench.write(kScaleNode, 0x6040, 0, 2, 0x1F);
    bench.run(20s);
    ASSERT_EQ(bench.statusword(kScaleNode, 0) & 0x3400, 0x1400) << "homed";
    const std::int64_t sign = inverted ? -1 : 1, home = bench.read(kScaleNode, kScaleA, 5);
    // 20 mm down, by a screw that is too long.
    EXPECT_NEAR(static_cast<double>(home * sign), -2002.8, 2);

    bench.write(kScaleNode, 0x6060, 0, 1, 1);
    bench.write(kScaleNode, 0x607A, 0, 4, 150 * kCountsAMm);
    bench.write(kScaleNode, 0x6040, 0, 2, 0x0F);
    bench.write(kScaleNode, 0x6040, 0, 2, 0x1F);
    bench.run(20s);
    EXPECT_EQ(bench.read(kScaleNode, 0x6064, 0), 150 * kCountsAMm) << "the motor is where it was told to be";
    EXPECT_EQ(bench.read(kScaleNode, kScaleA, 5), home);
    EXPECT_NEAR(static_cast<double>((bench.read(kScaleNode, kScaleA, 4) - home) * sign), 15021, 2);

    // Another direction, and nobody knows where home is; the same again loses nothing.
    bench.write(kScaleNode, kScaleA, 1, 1, 1);
    EXPECT_EQ(bench.read(kScaleNode, kScaleA, 5), home);
    bench.write(kScaleNode, kScaleA, 3, 1, inverted ? 0 : 1);
    bench.send("603#4060210500000000");
    bench.run(5ms);
    EXPECT_EQ(text_of(*bench.last(0x583)), "583#8060210524000008");
  }
}

TEST(NodeScale, IsNoPartOfWhatIsStoredOrOfTheFingerprint) {
  Bench bench(one_scale());
  const auto before = bench.read(kScaleNode, 0x2116, 0);
  bench.write(kScaleNode, kScaleA, 1, 1, 1);
  bench.write(kScaleNode, kScaleA, 2, 4, 100'000);
  EXPECT_EQ(bench.read(kScaleNode, 0x2116, 0), before);
  EXPECT_EQ(bench.read(kScaleNode, kScaleA, 2), 100'000);
}

}  // namespace
}  // namespace kinebus::testing_bench
