// Linear scales on the carriages (2160h): counted beside the axis, and what they said at the home switch.

#include "node_firmware/core/tests/lone_bench.hpp"
#include "protocol/canopen/alarm_codes.hpp"

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

/// Homed, and the loop closed: 1 mm at most, 5 mm/s, which is fast.
void close_loop(Bench& bench, std::int64_t most_counts, std::int64_t home_offset = 0) {
  bench.write(kScaleNode, kScaleA, 1, 1, 1);
  bench.write(kScaleNode, kScaleA, 6, 4, kCountsAMm * 65536 / 100);
  bench.write(kScaleNode, kScaleA, 8, 4, 5 * kCountsAMm);
  bench.write(kScaleNode, kScaleA, 7, 4, most_counts);
  bench.write(kScaleNode, 0x2130, 1, 1, 1);
  bench.write(kScaleNode, 0x6098, 0, 1, 22);
  bench.write(kScaleNode, 0x607C, 0, 4, home_offset);
  bench.enable(kScaleNode, 0, 6);
  bench.write(kScaleNode, 0x6040, 0, 2, 0x1F);
  bench.run(20s);
  ASSERT_EQ(bench.statusword(kScaleNode, 0) & 0x3400, 0x1400) << "homed";
  bench.write(kScaleNode, 0x6060, 0, 1, 1);
}
void go_to(Bench& bench, std::int64_t counts, std::chrono::seconds span = 20s) {
  bench.write(kScaleNode, 0x607A, 0, 4, counts);
  bench.write(kScaleNode, 0x6040, 0, 2, 0x0F);
  bench.write(kScaleNode, 0x6040, 0, 2, 0x1F);
  bench.run(span);
}

TEST(NodeScale, ABoardWithoutTheInputRefusesAScaleAndTellsNothingOfIt) {
  Bench bench(one_scale());
  EXPECT_EQ(bench.try_write(kScaleNode, kScaleB, 1, 1, 1), static_cast<std::uint32_t>(AbortCode::kHardware));
  bench.write(kScaleNode, kScaleB, 1, 1, 0);
  for (const int kind : {24, 32 + 24})
    EXPECT_EQ(bench.try_write(kScaleNode, kScaleB, 1, 1, kind),
              static_cast<std::uint32_t>(AbortCode::kHardware));
  for (const int kind : {2, 7, 31, 32, 33, 39})
    EXPECT_EQ(bench.try_write(kScaleNode, kScaleB, 1, 1, kind),
              static_cast<std::uint32_t>(AbortCode::kInvalidValue))
        << kind;
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

TEST(NodeScale, OneThatWasSilentForAWhileKnowsNoMoreWhereHomeIs) {
  Bench bench(one_scale());
  close_loop(bench, 0);
  EXPECT_NE(bench.read(kScaleNode, kScaleA, 5), 0);
  bench.node(0).lose_scale(0);
  bench.run(10ms);  // it counts again
  bench.send("603#4060210500000000");
  bench.run(5ms);
  EXPECT_EQ(text_of(*bench.last(0x583)), "583#8060210524000008");
  bench.send("603#4060210400000000");
  bench.run(5ms);
  EXPECT_EQ(text_of(*bench.last(0x583)).substr(0, 6), "583#43");
}

TEST(NodeScale, SilentWhileItLeadsTheAxisItStopsWhatMoves) {
  Bench bench(one_scale());
  close_loop(bench, kCountsAMm / 2);
  bench.write(kScaleNode, 0x607A, 0, 4, 150 * kCountsAMm);
  bench.write(kScaleNode, 0x6040, 0, 2, 0x0F);
  bench.write(kScaleNode, 0x6040, 0, 2, 0x1F);
  bench.run(300ms);
  EXPECT_FALSE(bench.node(0).path().stop_latched());
  bench.plant_on = false;  // nobody counts any more
  for (int i = 0; i < 3; ++i) {
    bench.node(0).lose_scale(0);
    bench.run(1ms);
  }
  bench.run(100ms);
  EXPECT_TRUE(bench.node(0).path().stop_latched());
  EXPECT_EQ(get_u16_le(bench.last(0x083)->data), emcy::kIncrementalEncoder);
  EXPECT_EQ(bench.read(kScaleNode, 0x2120, static_cast<std::uint8_t>(NodeCounter::kDriveFaults)), 1);
}

TEST(NodeScale, SilentItStopsNobodyWhoDoesNotMoveOrIsNotLedByIt) {
  for (const bool led : {false, true}) {
    SCOPED_TRACE(led);
    Bench bench(one_scale());
    close_loop(bench, led ? kCountsAMm / 2 : 0);
    if (!led) go_to(bench, 150 * kCountsAMm, 0s);
    bench.run(300ms);
    bench.plant_on = false;
    bench.node(0).lose_scale(0);
    bench.send("603#4060210400000000");
    bench.run(5ms);
    EXPECT_EQ(text_of(*bench.last(0x583)), "583#8060210424000008") << "it counts nothing";
    bench.run(100ms);
    EXPECT_EQ(bench.read(kScaleNode, 0x2120, static_cast<std::uint8_t>(NodeCounter::kDriveFaults)), 0);
    EXPECT_FALSE(bench.node(0).path().stop_latched());
  }
}

TEST(NodeScale, OnPinsThatTheMotorsEncoderHasItIsOneOrTheOther) {
  for (const auto input : {ScaleInput::kQuadratureOrEncoder, ScaleInput::kAbsoluteOrEncoder}) {
    const bool quadrature = input == ScaleInput::kQuadratureOrEncoder;
    Lone lone(
        {.node_id = 1, .scale_inputs = {ScaleInput::kNone, input}, .may_fit_scale = &Node::may_fit_scale});
    EXPECT_EQ(lone.write(kScaleB, 1, 1, quadrature ? 24 : 1),
              static_cast<std::uint32_t>(AbortCode::kHardware));
    EXPECT_EQ(lone.write(0x2950, 6, 1, 1), 0u);
    EXPECT_EQ(lone.write(kScaleB, 1, 1, quadrature ? 1 : 24),
              static_cast<std::uint32_t>(AbortCode::kDeviceState));
    EXPECT_EQ(lone.write(0x2950, 6, 1, 0), 0u);
    EXPECT_EQ(lone.write(0x2150, 6, 1, 1), 0u) << "the other axis' encoder is none of its business";
    EXPECT_EQ(lone.write(kScaleB, 1, 1, quadrature ? 1 : 24), 0u);
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

TEST(NodeScale, ClosedTheLoopLeadsTheMotorToWhereTheScaleHasTheAxisAndTheCommandStays) {
  Bench bench(one_scale());
  close_loop(bench, kCountsAMm);
  const std::int64_t home = bench.read(kScaleNode, kScaleA, 5);
  go_to(bench, 150 * kCountsAMm);
  EXPECT_EQ(bench.read(kScaleNode, 0x6064, 0), 150 * kCountsAMm) << "told as commanded";
  EXPECT_NEAR(static_cast<double>(bench.read(kScaleNode, kScaleA, 4) - home), 15'000, 2)
      << "0.21 mm of the screw are taken back";
  EXPECT_NEAR(static_cast<double>(bench.read(kScaleNode, kScaleA, 9)), -0.0014 * 150 * kCountsAMm, 15);
  EXPECT_FALSE(bench.node(0).path().stop_latched());
  // Opened, the motor stays where it is: no step.
  const std::int64_t there = bench.position(0, 0);
  bench.write(kScaleNode, kScaleA, 7, 4, 0);
  bench.run(2s);
  EXPECT_EQ(bench.position(0, 0), there);
}

TEST(NodeScale, WhereZeroIsDoesNotMatterToTheLoop) {
  for (const std::int64_t offset : {5'000, -5'000}) {
    Bench bench(one_scale());
    close_loop(bench, kCountsAMm, offset);
    go_to(bench, 150 * kCountsAMm);
    EXPECT_FALSE(bench.node(0).path().stop_latched());
    EXPECT_NEAR(static_cast<double>(bench.read(kScaleNode, kScaleA, 9)),
                -0.0014 * static_cast<double>(150 * kCountsAMm + offset), 15);
  }
}

TEST(NodeScale, OpenedOnItsWayTheMotorIsLedNoFarther) {
  Bench bench(one_scale());
  close_loop(bench, kCountsAMm);
  bench.write(kScaleNode, kScaleA, 8, 4, 20);
  go_to(bench, 150 * kCountsAMm, 5s);
  const std::int64_t before = bench.node(0).correction(bench.local(0), 0);
  bench.run(100ms);
  ASSERT_NE(bench.node(0).correction(bench.local(0), 0), before) << "it is still led";
  bench.write(kScaleNode, kScaleA, 7, 4, 0);
  bench.run(20ms);
  const std::int64_t there = bench.node(0).correction(bench.local(0), 0);
  bench.run(3s);
  EXPECT_EQ(bench.node(0).correction(bench.local(0), 0), there);
}

TEST(NodeScale, LedByItTheMotorIsNeverFasterThanItsRateAndHasNoStep) {
  Bench bench(one_scale());
  close_loop(bench, kCountsAMm);
  bench.write(kScaleNode, kScaleA, 8, 4, kCountsAMm / 20);
  std::int64_t last = bench.node(0).correction(bench.local(0), 0);
  double fastest = 0;
  bench.write(kScaleNode, 0x607A, 0, 4, 150 * kCountsAMm);
  bench.write(kScaleNode, 0x6040, 0, 2, 0x0F);
  bench.write(kScaleNode, 0x6040, 0, 2, 0x1F);
  bench.run(20s, 1ms, [&] {
    const std::int64_t now = bench.node(0).correction(bench.local(0), 0);
    fastest = std::max(fastest, std::abs(static_cast<double>(now - last)) / 4294967296.0 * 1000);
    last = now;
  });
  EXPECT_GT(fastest, 0);
  EXPECT_LT(fastest, 1.1 * static_cast<double>(kCountsAMm) / 20) << "counts a second";
}

TEST(NodeScale, OneThatStandsWhileTheAxisMovesStopsItOnThePathAndNothingLosesPower) {
  auto setup = one_scale();
  setup[0].plant[0].scale_pulses = 1e-9;  // it never counts
  Bench bench(setup);
  close_loop(bench, kCountsAMm / 2);
  const std::size_t from = bench.seen.size();
  go_to(bench, 150 * kCountsAMm, 8s);
  EXPECT_TRUE(bench.node(0).path().stop_latched());
  EXPECT_TRUE(bench.was_seen(0x083, from));
  EXPECT_EQ(get_u16_le(bench.last(0x083)->data), emcy::kIncrementalEncoder);
  EXPECT_EQ(std::ranges::count_if(bench.seen, [](const Bench::Seen& seen) { return seen.frame.id == 0x083; }),
            1)
      << "told once";
  EXPECT_EQ(bench.read(kScaleNode, 0x2120, static_cast<std::uint8_t>(NodeCounter::kDriveFaults)), 1);
  EXPECT_LT(bench.read(kScaleNode, 0x6064, 0), 10 * kCountsAMm) << "0.7 mm and the way of the stop";
  EXPECT_EQ(bench.statusword(kScaleNode, 0) & 0x6F, 0x27) << "it holds";
}

TEST(NodeScale, FartherAwayThanMayBeCorrectedStopsToo) {
  auto setup = one_scale();
  setup[0].plant[0].screw_error = 0.05;
  Bench bench(setup);
  close_loop(bench, kCountsAMm / 2);
  go_to(bench, 50 * kCountsAMm, 15s);
  EXPECT_TRUE(bench.node(0).path().stop_latched());
  EXPECT_EQ(get_u16_le(bench.last(0x083)->data), emcy::kFollowingError);
  EXPECT_EQ(bench.statusword(kScaleNode, 0) & 0x6F, 0x27);
}

}  // namespace
}  // namespace kinebus::testing_bench
