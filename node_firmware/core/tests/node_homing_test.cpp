// Homing that goes wrong, waits, or is asked for again, by its switch's edges one by one.

#include "node_firmware/core/tests/drive_bench.hpp"
#include "node_firmware/core/tests/lone_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr int kAttained = 0x1000, kFailed = 0x2000, kWaits = 0x4000, kRests = 0x0400;

struct HomingByHand : testing::Test {
  HomingByHand() {
    for (const int axis : {0, 1}) {
      const auto at = [&](int index) { return static_cast<std::uint16_t>(index + axis * 0x800); };
      EXPECT_EQ(lone.write(at(0x6098), 0, 1, 20), 0u);
      EXPECT_EQ(lone.write(at(0x6060), 0, 1, 6), 0u);
    }
    enable(0);
  }
  void enable(int axis) {
    lone.power(axis);
    lone.control(0x0F, axis);
  }
  /// The home switch of an axis, past its debouncing.
  void home_switch(bool active, int axis = 0) {
    lone.node.on_switch(lone.now, axis, active);
    lone.wait(1ms);
  }
  int status(int axis = 0) {
    return static_cast<int>(lone.read(static_cast<std::uint16_t>(0x6041 + axis * 0x800), 0)) &
           (kAttained | kFailed | kWaits | kRests);
  }
  void start(int axis = 0) {
    lone.control(0x0F, axis);
    lone.control(0x1F, axis);
    lone.wait(100ms);
  }
  double counts(int axis = 0) {
    return std::ldexp(static_cast<double>(lone.node.position(lone.now, axis)), -32);
  }
  /// From the seeking to home.
  void find() {
    home_switch(true);
    lone.wait(150ms);
    home_switch(false);
    lone.wait(150ms);
    home_switch(true);
    lone.wait(150ms);
  }
  Lone lone;
};

TEST_F(HomingByHand, EveryEdgeIsWaitedForAndTheLastOneIsHome) {
  start();
  EXPECT_EQ(status(), 0);
  home_switch(true);
  lone.wait(50ms);
  EXPECT_EQ(status(), 0) << "it leaves";
  const double there = counts();
  lone.wait(50ms);
  EXPECT_LT(counts(), there);
  home_switch(false);
  lone.wait(150ms);
  EXPECT_EQ(status(), 0) << "it enters, slowly";
  const std::int64_t before = lone.node.position(lone.now, 0);
  lone.wait(10ms);
  EXPECT_NEAR(std::ldexp(static_cast<double>(lone.node.position(lone.now, 0) - before), -32), 38.4, 2.0);
  const double edge = counts();
  home_switch(true);
  lone.wait(150ms);
  EXPECT_EQ(status(), kAttained | kRests);
  EXPECT_EQ(lone.read(0x2140, 6), 1);
  EXPECT_NEAR(static_cast<double>(lone.read(0x6064, 0)), counts() - edge, 1.0);
}

TEST_F(HomingByHand, ASwitchThatBouncesWhileItStopsIsAnErrorAndNoHome) {
  start();
  home_switch(true);
  ASSERT_TRUE(lone.node.moving(lone.now));
  home_switch(false);
  lone.wait(150ms);
  EXPECT_EQ(status(), kFailed | kWaits | kRests) << "its switch came where it must not";
  EXPECT_EQ(lone.read(0x2140, 6), 0);
  EXPECT_EQ(lone.told(node_emcy::kHoming), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kHomingErrors), 1);
  EXPECT_NE(lone.read(0x1001, 0), 0);
  // Asked for again it begins without the error, and ends at home.
  start();
  EXPECT_EQ(status(), 0);
  EXPECT_EQ(lone.read(0x1001, 0), 0);
  find();
  EXPECT_EQ(status(), kAttained | kRests);
}

TEST_F(HomingByHand, ASwitchThatStaysActiveIsAnError) {
  lone.control(0x07);
  ASSERT_EQ(lone.write(0x2140, 10, 4, 500), 0u);
  home_switch(true);
  lone.control(0x0F);
  start();
  lone.wait(100ms);
  EXPECT_EQ(status(), kFailed | kWaits | kRests);
  EXPECT_NEAR(counts(), -500, 1.0) << "no farther than it may back off";
  EXPECT_EQ(lone.read(0x2140, 6), 0);
}

TEST_F(HomingByHand, AWayWithoutASwitchIsAnErrorOfItsOwn) {
  lone.control(0x07);
  ASSERT_EQ(lone.write(0x2140, 9, 4, 500), 0u);
  lone.control(0x0F);
  start();
  lone.wait(100ms);
  EXPECT_EQ(status(), kFailed | kRests);
  EXPECT_NEAR(counts(), 500, 1.0);
}

TEST_F(HomingByHand, AskedForAgainItIsNotAtHomeUntilItHasFoundIt) {
  start();
  find();
  ASSERT_EQ(status(), kAttained | kRests);
  home_switch(false);
  start();
  EXPECT_EQ(status(), 0);
  lone.control(0x0F);
  lone.wait(150ms);
  EXPECT_EQ(status(), kRests) << "it was ended before";
  start();
  find();
  EXPECT_EQ(status(), kAttained | kRests);
}

TEST_F(HomingByHand, ACarriageThatIsToStayWaitsOnItsSwitch) {
  lone.control(0x0F);
  lone.control(0x81F);
  lone.wait(100ms);
  home_switch(true);
  lone.wait(500ms);
  EXPECT_EQ(status() & ~kRests, kWaits);
  const double here = counts();
  lone.wait(1s);
  EXPECT_EQ(counts(), here);
  lone.control(0x1F);
  lone.wait(100ms);
  EXPECT_EQ(status(), 0);
  EXPECT_LT(counts(), here) << "it leaves";
}

TEST_F(HomingByHand, OneOfTwoCarriagesLeavesItsSwitchAtATime) {
  enable(1);
  home_switch(true, 0);
  home_switch(true, 1);
  start(0);
  start(1);
  EXPECT_LT(counts(0), 0) << "it leaves";
  EXPECT_EQ(counts(1), 0) << "it waits";
  EXPECT_EQ(status(1) & ~kRests, kWaits);
  home_switch(false, 0);
  lone.wait(150ms);
  EXPECT_EQ(counts(1), 0) << "the other one comes back to its edge yet";
  home_switch(true, 0);
  lone.wait(150ms);
  EXPECT_EQ(status(0), kAttained | kRests);
  EXPECT_LT(counts(1), 0) << "its turn";
  EXPECT_EQ(status(1), 0);
}

TEST_F(HomingByHand, ASwitchOfTheOtherAxisIsNone) {
  start();
  home_switch(true, 1);
  lone.wait(150ms);
  const double here = counts();
  lone.wait(100ms);
  EXPECT_GT(counts(), here) << "it seeks on";
  EXPECT_EQ(status(), 0);
}

TEST_F(HomingByHand, WhatIsNotHomingTakesNoHomeFromItsSwitch) {
  home_switch(true);
  home_switch(false);
  home_switch(true);
  lone.wait(100ms);
  EXPECT_EQ(lone.read(0x2140, 6), 0);
  EXPECT_EQ(status(), kRests);
  EXPECT_EQ(counts(), 0);
}

/// The first axis by its limit switches; node_drive_test has the second.
class HomingAtALimit : public DriveTest, public testing::WithParamInterface<int> {};

TEST_P(HomingAtALimit, ItsOwnSwitchStopsNobodyAndTheOtherOneStopsAll) {
  const bool up = GetParam() == 18;
  bench.plant_on = false;
  bench.write(kId, 0x2130, 4, 1, 3);
  bench.write(kId, 0x2130, 5, 1, 5);
  bench.write(kId, 0x6098, 0, 1, GetParam());
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(300ms);
  EXPECT_GT(up ? counts() : -counts(), 5'000);
  const int own = up ? 3 : 4, other = up ? 4 : 3;
  const auto edge = [&](int input, bool level) {
    bench.node().on_switch(bench.local(), input, level);
    bench.run(10us);  // the bench hears of its deadline
    bench.run(200ms);
  };
  edge(own, true);
  EXPECT_FALSE(bench.node().path().stop_latched()) << "it is what it looks for";
  edge(own, false);
  EXPECT_EQ(status() & 0x3400, 0x1400);
  control(0x0F);
  control(0x1F);
  bench.run(300ms);
  edge(other, true);
  EXPECT_TRUE(bench.node().path().stop_latched());
  EXPECT_FALSE(bench.node().moving(bench.local()));
}
INSTANTIATE_TEST_SUITE_P(BothEnds, HomingAtALimit, testing::Values(17, 18));

}  // namespace
}  // namespace kinebus::testing_bench
