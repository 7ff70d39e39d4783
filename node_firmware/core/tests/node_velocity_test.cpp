// Profile velocity (mode 3): ramps, limits, what ends it, and what the statusword says of it.

#include "node_firmware/core/tests/drive_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr int kReached = 1 << 10, kLimited = 1 << 11, kStands = 1 << 12;

struct VelocityTest : DriveTest {
  VelocityTest() {
    bench.write(kId, 0x6083, 0, 4, 400'000);
    bench.write(kId, 0x6084, 0, 4, 800'000);
    bench.enable(kId, 0, 3);
  }
  void ask(std::int64_t counts_per_s) { bench.write(kId, 0x60FF, 0, 4, counts_per_s); }
  std::int64_t speed() { return static_cast<std::int32_t>(bench.read(kId, 0x606C, 0)); }
  /// Of the motor, counts/s, over 100 ms.
  double measured() {
    const double before = counts();
    bench.run(100ms);
    return (counts() - before) * 10;
  }
};

TEST_F(VelocityTest, EveryTargetIsReachedByARampAndHeld) {
  EXPECT_EQ(status() & (kReached | kStands), kReached | kStands);
  double before = 0;
  for (const int to : {40'000, 100'000, 20'000, -60'000, -1, 5, 0}) {
    ask(to);
    if (std::abs(to) > 10'000) {
      bench.run(5ms);
      EXPECT_FALSE(status() & kReached) << to;
    }
    // From a crawl to a whole count it creeps.
    const double fastest = std::max({std::abs(before), std::abs(1.0 * to), 1.0 * Trapezoid::kCreepSpeed});
    watch(700ms, fastest, 800'000);
    EXPECT_NEAR(measured(), to, 10) << to;
    EXPECT_NEAR(static_cast<double>(speed()), to, 2);
    EXPECT_EQ(speed(), static_cast<std::int32_t>(bench.read(kId, 0x606B, 0)));
    EXPECT_TRUE(status() & kReached) << to;
    EXPECT_EQ((status() & kStands) != 0, to == 0);
    EXPECT_FALSE(status() & kLimited);
    before = to;
  }
}

TEST_F(VelocityTest, RampsAreThoseOf6083hAnd6084hAndNoSteeperThan60C5hAnd60C6h) {
  const auto ramp_ms = [&](int to) {
    ask(to);
    int ms = 0;
    // Not by SDO, which takes a while.
    const auto reached = [&] { return (bench.node().axis(0).statusword(bench.local()) & kReached) != 0; };
    for (; ms < 2000 && !reached(); ++ms) bench.run(1ms);
    return ms;
  };
  EXPECT_NEAR(ramp_ms(100'000), 250, 4);
  EXPECT_NEAR(ramp_ms(20'000), 100, 4);
  bench.write(kId, 0x6083, 0, 4, 100'000);
  EXPECT_NEAR(ramp_ms(60'000), 400, 4);
  ask(0);
  bench.run(1s);
  bench.write(kId, 0x60C5, 0, 4, 50'000);
  bench.write(kId, 0x60C6, 0, 4, 200'000);
  EXPECT_NEAR(ramp_ms(40'000), 800, 4);
  EXPECT_NEAR(ramp_ms(0), 200, 4);
}

TEST_F(VelocityTest, ItsTargetReachedIsToldAtOnce) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  ask(40'000);
  bench.run(95ms);
  ASSERT_TRUE(bench.last(0x181));
  EXPECT_FALSE(get_u16_le(bench.last(0x181)->data) & kReached);
  bench.run(8ms);
  EXPECT_TRUE(get_u16_le(bench.last(0x181)->data) & kReached) << "TPDO1, by change";
}

TEST_F(VelocityTest, NoTargetIsFasterThan607Fh) {
  bench.write(kId, 0x607F, 0, 4, 50'000);
  for (const std::int64_t to :
       {std::int64_t{90'000}, std::int64_t{0x7FFF'FFFF}, -std::int64_t{0x8000'0000}}) {
    ask(to);
    watch(800ms, 50'000, 800'000);
    EXPECT_NEAR(measured(), to > 0 ? 50'000 : -50'000, 10);
    EXPECT_EQ(status() & (kReached | kLimited), kLimited);
  }
  ask(30'000);
  bench.run(600ms);
  EXPECT_EQ(status() & (kReached | kLimited), kReached);
}

TEST_F(VelocityTest, StandsAtItsSoftwareLimitAndOnlyTheWayBackIsOpen) {
  bench.write(kId, 0x6098, 0, 1, 37);
  ask(0);
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(20ms);
  control(0x0F);
  bench.write(kId, 0x607D, 1, 4, -3'000);
  bench.write(kId, 0x607D, 2, 4, 5'000);
  bench.write(kId, 0x6060, 0, 1, 3);
  for (const auto& [to, limit] : {std::pair{40'000, 5'000}, {90'000, 5'000}, {-40'000, -3'000}}) {
    ask(to);
    bench.run(700ms);
    EXPECT_EQ(static_cast<std::int32_t>(bench.read(kId, 0x6064, 0)), limit);
    EXPECT_EQ(status() & (kReached | kLimited | kStands), kLimited | kStands) << to;
  }
  ask(0);
  bench.run(5ms);
  EXPECT_EQ(status() & (kReached | kLimited | kStands), kReached | kStands);
}

TEST_F(VelocityTest, HaltAndDisablingAreRampsAndWhatFollowsTheirEnd) {
  ask(50'000);
  bench.run(300ms);
  control(0x10F);
  watch(300ms, 50'000, 800'000);
  EXPECT_NEAR(measured(), 0, 0.1);
  EXPECT_EQ(status() & (kReached | kStands), kReached | kStands) << "a halt has come to its end";
  control(0x0F);
  bench.run(300ms);
  EXPECT_NEAR(measured(), 50'000, 10) << "and ends with its bit";
  control(0x07);
  watch(300ms, 50'000, 6'400'000);
  EXPECT_NEAR(measured(), 0, 0.1);
  control(0x0F);
  bench.run(300ms);
  EXPECT_NEAR(measured(), 50'000, 10) << "its target is in force";
  control(0x0B);
  watch(300ms, 50'000, 6'400'000);
  EXPECT_NEAR(measured(), 0, 0.1) << "quick stop";
}

TEST_F(VelocityTest, NothingBeginsAgainBehindAStopOfAllOrAnotherMode) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  ask(50'000);
  bench.run(300ms);
  bench.node().on_axis_trouble(bench.local(), 0, 0x7305);
  watch(300ms, 50'000, 6'400'000);
  EXPECT_NEAR(measured(), 0, 0.1);
  ask(50'000);
  bench.run(100ms);
  EXPECT_NEAR(measured(), 0, 0.1) << "the stop is latched";
  ask(0);
  bench.node().on_axis_trouble_gone(0x7305);
  control(0x8F);
  control(0x0F);
  EXPECT_NEAR(measured(), 0, 0.1);
  ask(50'000);
  bench.run(300ms);
  EXPECT_NEAR(measured(), 50'000, 10);
  bench.write(kId, 0x6060, 0, 1, 1);
  watch(300ms, 50'000, 800'000);
  EXPECT_EQ(bench.read(kId, 0x6061, 0), 1);
  bench.write(kId, 0x6060, 0, 1, 3);
  bench.run(100ms);
  EXPECT_NEAR(measured(), 0, 0.1) << "a velocity of before the other mode";
}

TEST_F(VelocityTest, AMasterThatLeavesItToNmtIsAnsweredAs6007hSays) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  ask(50'000);
  bench.run(300ms);
  bench.send(nmt_frame(NmtCommand::kStop, kAllNodes));
  watch(200ms, 50'000, 6'400'000);
  EXPECT_NEAR(measured(), 0, 0.1);
}

}  // namespace
}  // namespace kinebus::testing_bench
