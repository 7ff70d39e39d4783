// Set-points that come with SYNC, cyclic synchronous and interpolated: joined without a step, within the
// limits, watched.

#include "node_firmware/core/tests/drive_bench.hpp"

namespace kinebus::testing_bench {
namespace {

TEST_F(DriveTest, CyclicPositionsAreJoinedBySyncWithoutAStep) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 10);
  bench.enable(kId, 0, 8);
  bench.start_sync(10ms);
  std::int32_t wanted = 0;
  std::int64_t last = bench.position(0, 0);
  for (int i = 0; i < 100; ++i) {
    wanted += 200 + i;
    CanFrame rpdo{.id = 0x301, .length = 8};
    put_i32_le(rpdo.data, wanted);
    bench.send(rpdo);
    bench.run(10ms, 1ms, [&] {
      const std::int64_t here = bench.position(0, 0);
      EXPECT_LE(std::abs(here - last), from_counts(40));
      last = here;
    });
  }
  bench.run(30ms);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), wanted);
  EXPECT_EQ(status() & 0x1000, 0x1000);
}

TEST_F(DriveTest, ACyclicTargetFarAwayIsApproachedAtTheMaximumSpeed) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 10);
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);  // nobody minds how far behind it is
  bench.enable(kId, 0, 8);
  bench.start_sync(10ms);
  bench.write(kId, 0x607A, 0, 4, 50'000'000);
  watch(200ms, 576'000, 6'400'000);
  EXPECT_GT(counts(), 40'000);
  EXPECT_TRUE(status() & (1 << 11));
}

TEST_F(DriveTest, ACyclicJumpOfSetPointsIsMadeWithinTheLimitsAndEndsThere) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 2);
  bench.write(kId, 0x60C5, 0, 4, 2'000'000);
  bench.write(kId, 0x60C6, 0, 4, 4'000'000);
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  bench.enable(kId, 0, 8);
  bench.start_sync(2ms);
  for (const int to : {100'000, -3'000, -2'999, 40}) {
    const double from = counts();
    bench.write(kId, 0x607A, 0, 4, to);
    double last = counts(), last_speed = 0;
    bench.run(1500ms, 1ms, [&] {
      const double speed = (counts() - last) * 1000;
      EXPECT_LE(std::abs(speed), 576'000 * 1.001);
      EXPECT_LE(std::abs(speed - last_speed), 4'000 * 1.01 + 20);
      EXPECT_LE(counts(), std::max<double>(from, to) + 1);
      EXPECT_GE(counts(), std::min<double>(from, to) - 1);
      last = counts();
      last_speed = speed;
    });
    EXPECT_EQ(bench.read(kId, 0x6064, 0), to);
    EXPECT_FALSE(status() & (1 << 11));
    EXPECT_TRUE(status() & (1 << 10));
  }
}

TEST_F(DriveTest, CyclicSetPointsAsFarAsNumbersGoAreMadeWithinTheLimits) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 2);
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  bench.enable(kId, 0, 8);
  bench.start_sync(2ms);
  for (const std::int64_t to :
       {std::int64_t{0x7FFF'FFFF}, -std::int64_t{0x7FFF'FFFF}, std::int64_t{5'000'000}}) {
    const double from = counts();
    bench.write(kId, 0x607A, 0, 4, static_cast<std::uint32_t>(to));
    double last = counts(), last_speed = 1e9;
    bench.run(400ms, 1ms, [&] {
      const double speed = (counts() - last) * 1000;
      EXPECT_LE(std::abs(speed), 576'000 * 1.001);
      if (last_speed < 1e8) {
        EXPECT_LE(std::abs(speed - last_speed), 6'400 * 1.01 + 20);
      }
      last = counts();
      last_speed = speed;
    });
    EXPECT_EQ(counts() > from, static_cast<double>(to) > from) << to;
  }
}

TEST_F(DriveTest, AJumpOfInterpolatedSetPointsIsMadeWithinTheLimitsToo) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C0, 0, 2, 0);
  bench.write(kId, 0x60C2, 1, 1, 2);
  bench.write(kId, 0x60C5, 0, 4, 2'000'000);
  bench.write(kId, 0x60C6, 0, 4, 4'000'000);
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  bench.enable(kId, 0, 7);
  control(0x1F);
  bench.start_sync(2ms);
  for (const int to : {100'000, -3'000}) {
    bench.write(kId, 0x60C1, 1, 4, to);
    watch(1500ms, 576'000, 4'000'000);
    EXPECT_EQ(bench.read(kId, 0x6064, 0), to);
  }
}

TEST_F(DriveTest, ALateOrMissingSyncDoesNotStopACyclicMotion) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 10);
  bench.enable(kId, 0, 8);
  std::int32_t wanted = 0;
  for (int i = 0; i < 100; ++i) {
    wanted += std::min(i, 30) * 80;
    CanFrame rpdo{.id = 0x301, .length = 8};
    put_i32_le(rpdo.data, wanted);
    bench.send(rpdo);
    if (i % 20 != 19) bench.send(CanFrame::make(0x080, {static_cast<std::uint8_t>(i + 1)}));
    bench.run(i % 20 == 9 ? 14ms : 10ms);
  }
  EXPECT_FALSE(bench.last(0x081));
  EXPECT_NEAR(counts(), wanted, 1200);
}

TEST_F(DriveTest, ACyclicSetPointFarBeyondTheFollowingErrorWindowStopsTheAxisAndIsTold) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 2);
  bench.enable(kId, 0, 8);
  bench.start_sync(2ms);
  bench.run(10ms);
  bench.write(kId, 0x607A, 0, 4, 100'000);
  watch(300ms, 200'000, 6'400'000);
  watch(100ms, 1, 1);
  EXPECT_LT(counts(), 3'000);
  ASSERT_TRUE(bench.last(0x081));
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0x8611);
  EXPECT_TRUE(status() & (1 << 13));
  EXPECT_TRUE(bench.node().drive(0).power);
  // A master that has understood takes the set-point back, and lifts the stop.
  bench.write(kId, 0x607A, 0, 4, bench.read(kId, 0x6064, 0));
  bench.command(RateCommand::Kind::kClear);
  bench.run(20ms);
  EXPECT_FALSE(status() & (1 << 13));
  EXPECT_EQ(bench.read(kId, 0x1001, 0), 0);
  bench.write(kId, 0x607A, 0, 4, bench.read(kId, 0x6064, 0) + 100);
  bench.run(100ms);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), bench.read(kId, 0x607A, 0));
}

TEST_F(DriveTest, SyncThatEndsInTheMidstOfACyclicMotionIsAnsweredByARampAndTold) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 10);
  bench.enable(kId, 0, 8);
  bench.start_sync(10ms);
  std::int32_t wanted = 0;
  for (int i = 0; i < 50; ++i) {
    wanted += std::min(i, 30) * 80;
    CanFrame rpdo{.id = 0x301, .length = 8};
    put_i32_le(rpdo.data, wanted);
    bench.send(rpdo);
    bench.run(10ms);
  }
  bench.stop_sync();
  double last = counts(), last_speed = -1;
  bench.run(200ms, 1ms, [&] {
    const double speed = (counts() - last) * 1000;
    if (last_speed >= 0) {
      EXPECT_LE(std::abs(speed - last_speed), 6'400 * 1.01 + 20);
    }
    last = counts();
    last_speed = speed;
  });
  EXPECT_FALSE(bench.node().moving(bench.local()));
  ASSERT_TRUE(bench.last(0x081));
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0x8700);
  EXPECT_TRUE(bench.node().drive(0).power);
}

TEST_F(DriveTest, ACyclicWayWithinTheLimitsIsReachedAtEverySync) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 4);
  bench.enable(kId, 0, 8);
  bench.start_sync(4ms);
  bench.run(20ms);
  for (int i = 0; i <= 628; ++i) {
    CanFrame rpdo{.id = 0x301, .length = 8};
    put_i32_le(rpdo.data,
               static_cast<std::int32_t>(std::lround(30'000 * (1 - std::cos(i * 2 * M_PI / 628)))));
    bench.send(rpdo);
    bench.run(4ms);
    EXPECT_FALSE(bench.node().axis(0).statusword(bench.local()) & (1 << 11)) << i;
  }
  bench.run(20ms);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), bench.read(kId, 0x607A, 0));
}

TEST_F(DriveTest, PeriodsOfSyncAreTheSameInWhateverUnitTheyAreTold) {
  struct Period {
    int value, exponent;
  };
  const std::vector<std::vector<Period>> same{
      {{100, -3}, {10, -2}, {1, -1}}, {{10, -1}, {1, 0}, {100, -2}}, {{100, -1}, {10, 0}, {1, 1}, {1, 2}}};
  std::vector<std::vector<double>> of_period;
  for (const auto& periods : same) {
    std::vector<double> first;
    for (const Period& period : periods) {
      Bench other({{.id = kId, .plant = {plant(), plant(2)}}});
      other.write(kId, 0x60C2, 1, 1, period.value);
      other.write(kId, 0x60C2, 2, 1, period.exponent);
      other.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
      other.enable(kId, 0, 8);
      other.send(nmt_frame(NmtCommand::kStart, kAllNodes));
      other.start_sync(100ms);
      std::vector<double> way;
      for (int i = 1; i < 12; ++i) {
        other.write(kId, 0x607A, 0, 4, i * 1'000);
        other.run(99ms - (other.now.count() % 100'000'000) * 1ns + 1ms);
        way.push_back(std::ldexp(static_cast<double>(other.position(0, 0)), -32));
      }
      if (first.empty()) first = way;
      EXPECT_EQ(way, first) << period.value << "e" << period.exponent;
    }
    of_period.push_back(first);
  }
  EXPECT_NE(of_period[0], of_period[1]);
  EXPECT_NE(of_period[1], of_period[2]);
}

}  // namespace
}  // namespace kinebus::testing_bench
