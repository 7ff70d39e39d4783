// A session: what three nodes with its key do when another device gives them orders in the midst of motion.

#include "node_firmware/core/tests/stream_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint32_t kDeviceState = 0x08000022;

struct SessionTest : StreamTest {
  SessionTest() { bench.begin_session(); }

  void let_move() {
    start_all(1000);
    wave(8);
    end_all();
    bench.run(50ms);
    bench.rate(1.0);
    watch(100ms);
  }
  std::int64_t refused(std::uint8_t id) {
    return bench.read(id, 0x2120, static_cast<std::uint8_t>(NodeCounter::kFramesRefused));
  }
  int told(std::uint8_t id) {
    int times = 0;
    for (const auto& item : bench.seen)
      times += item.frame.id == 0x080u + id && get_u16_le(item.frame.data) == node_emcy::kNotVouched ? 1 : 0;
    return times;
  }
  void expect_goes_on() {
    watch(800ms);
    expect_at_feeds_end();
    for (std::size_t i = 0; i < kNodes; ++i) EXPECT_FALSE(bench.node(i).path().stop_latched());
  }
};

TEST_F(SessionTest, AMotionThatTheMasterVouchesForRunsAsWithoutASession) {
  let_move();
  expect_goes_on();
  for (std::uint8_t id = 1; id <= kNodes; ++id) EXPECT_EQ(refused(id), 0) << int{id};
}

TEST_F(SessionTest, NmtOfAnotherDeviceInMotionIsRefusedEachToldOnceAndTheMotionGoesOn) {
  let_move();
  for (const char* stranger : {"000#0200", "000#8002", "000#8100", "000#8200"}) {
    bench.stranger_sends(frame_of(stranger));
    watch(10ms);
  }
  expect_goes_on();
  EXPECT_EQ(refused(1), 3);
  EXPECT_EQ(refused(2), 4);
  for (std::uint8_t id = 1; id <= kNodes; ++id) EXPECT_EQ(told(id), refused(id)) << int{id};
  EXPECT_EQ(bench.read(1, 0x1001, 0), 0) << "in the history alone";
  // At rest everybody may.
  bench.stranger_sends(frame_of("000#0202"));
  bench.run(10ms);
  EXPECT_EQ(bench.node(1).nmt_state(), NmtState::kStopped);
}

TEST_F(SessionTest, WritesOfAnotherDeviceInMotionAreAnsweredAndNotDone) {
  let_move();
  for (const char* stranger : {"602#2F607000FF000000", "602#2B40600000000000", "602#2313210002000000",
                               "602#2F00180505000000", "602#2F511F0100000000", "602#2311210008000000"}) {
    const std::string text(stranger);
    const std::size_t before = bench.seen.size();
    bench.stranger_sends(frame_of(text));
    watch(5ms);
    ASSERT_TRUE(bench.was_seen(0x582, before)) << text;
    EXPECT_EQ(bench.last(0x582)->data[0], 0x80) << text;
    EXPECT_EQ(get_u32_le(std::span(bench.last(0x582)->data).subspan(4)), kDeviceState) << text;
  }
  EXPECT_EQ(told(2), 6) << "every object";
  expect_goes_on();
}

TEST_F(SessionTest, AForgedRateMovesNobodyAndAForgedStopStopsAll) {
  let_move();
  const auto forged = [&](RateCommand::Kind kind) {
    return encode(RateCommand{.kind = kind,
                              .counter = 9,
                              .rate_q15 = 1000,
                              .full_ramp_2ms = 2,
                              .start = Bench::whole_us(bench.now + 5ms)});
  };
  bench.stranger_sends(forged(RateCommand::Kind::kRate));
  watch(50ms);
  EXPECT_EQ(bench.node(0).path_rate_q32(bench.local(0)), std::uint64_t{1} << 32);
  EXPECT_EQ(told(1), 1);
  bench.stranger_sends(forged(RateCommand::Kind::kStop));
  watch(100ms);
  EXPECT_TRUE(all_rest());
  EXPECT_LE(skew_us(), kSkewUs);
}

TEST_F(SessionTest, RecordedOrdersAreRefusedAlsoWithTheirVouchers) {
  std::vector<CanFrame> recorded;
  let_move();
  // A hold and its end, as a stranger hears them.
  for (const double rate : {0.5, 1.0}) {
    VoucherWriter copy = *bench.vouches;
    bench.rate(rate);
    const CanFrame order = bench.last_sent();
    recorded.push_back(copy.vouch_for(order));
    recorded.push_back(order);
    watch(50ms);
  }
  for (std::size_t i = 0; i < 2; ++i) bench.stranger_sends(recorded[i]);
  watch(50ms);
  EXPECT_EQ(bench.node(0).path_rate_q32(bench.local(0)), std::uint64_t{1} << 32);
  EXPECT_EQ(refused(1), 1);
  expect_goes_on();
}

TEST_F(SessionTest, AForgedStampMovesNoClock) {
  let_move();
  for (int i = 0; i < 20; ++i) {
    bench.stranger_sends(encode(
        SyncStamp{.counter = static_cast<std::uint8_t>(1 + i), .epoch = 1, .time = bench.now + 300us}));
    watch(5ms);
  }
  EXPECT_EQ(told(3), 1);
  expect_goes_on();
}

TEST_F(SessionTest, AResetEndsTheSessionSoThatAnyMasterMayTakeOver) {
  EXPECT_EQ(bench.read(2, 0x2117, 5), 1);
  bench.stranger_sends(frame_of("000#8202"));
  bench.run(50ms);
  EXPECT_EQ(bench.read(2, 0x2117, 5), 0);
  EXPECT_EQ(bench.read(1, 0x2117, 5), 1);
}

}  // namespace
}  // namespace kinebus::testing_bench
