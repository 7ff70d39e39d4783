#include "protocol/motion/session_guard.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

#include "protocol/bytes.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {
namespace {

using Answer = SessionGuard::Answer;
constexpr SipHashKey kKey{0x1122334455667788, 0x99AABBCCDDEEFF00};
constexpr std::uint8_t kNode = 2;
constexpr bool kMoves = true, kRests = false;

CanFrame rate_of(std::uint8_t counter, RateCommand::Kind kind = RateCommand::Kind::kRate) {
  return encode(RateCommand{.kind = kind, .counter = counter, .rate_q15 = 100, .start = BusTime{1'000'000}});
}
const CanFrame kStopped = nmt_frame(NmtCommand::kStop, kNode);
const CanFrame kMode = sdo::frame_of(0x602, 0x2F, object::kModeOfOperation, 1);
using Told = std::array<std::uint8_t, 5>;
const CanFrame kRamp = sdo::frame_of(0x602, 0x2B, object::kStopRamp, 2);

struct Bench {
  SessionGuard guard;
  VoucherWriter gateway{kKey};

  Bench() {
    const std::array<std::uint64_t, 4> parts{kKey.low & 0xFFFFFFFF, kKey.low >> 32, kKey.high & 0xFFFFFFFF,
                                             kKey.high >> 32};
    for (std::uint8_t i = 0; i < 4; ++i)
      EXPECT_EQ(guard.write(i + 1, static_cast<std::uint32_t>(parts[i]), kRests), AbortCode::kNone);
    EXPECT_EQ(guard.write(5, 1, kRests), AbortCode::kNone);
  }
  Answer alone(const CanFrame& frame, bool moves = kMoves) { return guard.judge(frame, kNode, moves); }
  Answer vouched(const CanFrame& frame, bool moves = kMoves) {
    EXPECT_EQ(guard.judge(gateway.vouch_for(frame), kNode, moves), Answer::kPass);
    return guard.judge(frame, kNode, moves);
  }
};

TEST(SessionGuard, WithoutAKeyEverybodyIsObeyed) {
  SessionGuard guard;
  for (const CanFrame& frame : {kStopped, kRamp, rate_of(1)})
    EXPECT_EQ(guard.judge(frame, kNode, kMoves), Answer::kObey);
}

TEST(SessionGuard, InMotionWhatNobodyVouchesForIsRefused) {
  Bench bench;
  for (const CanFrame& frame :
       {kStopped, nmt_frame(NmtCommand::kResetNode, kAllNodes), kRamp, rate_of(1),
        CanFrame::make(0x202, {0, 0, 15, 0, 7, 7}), encode(SyncStamp{1, 1, BusTime{5}})}) {
    EXPECT_EQ(bench.alone(frame), Answer::kRefuse) << frame.id;
    EXPECT_EQ(bench.vouched(frame), Answer::kObey) << frame.id;
  }
  EXPECT_EQ(bench.guard.refused(), 6u);
}

TEST(SessionGuard, OthersFramesAndReadingAreNotItsBusiness) {
  Bench bench;
  EXPECT_EQ(bench.alone(nmt_frame(NmtCommand::kStop, kNode + 1)), Answer::kObey);
  EXPECT_EQ(bench.alone(sdo::frame_of(0x603, 0x2B, object::kStopRamp, 2)), Answer::kObey);
  EXPECT_EQ(bench.alone(sdo::frame_of(0x602, 0x40, object::kStopRamp)), Answer::kObey);
  EXPECT_EQ(bench.guard.refused(), 0u);
}

TEST(SessionGuard, AStopIsObeyedWhoeverAsksForIt) {
  Bench bench;
  EXPECT_EQ(bench.alone(rate_of(1, RateCommand::Kind::kStop)), Answer::kObey);
  EXPECT_EQ(bench.alone(rate_of(1, RateCommand::Kind::kClear)), Answer::kRefuse);
}

TEST(SessionGuard, AtRestOnlyPathTimeIsGuarded) {
  Bench bench;
  EXPECT_EQ(bench.alone(kStopped, kRests), Answer::kObey);
  EXPECT_EQ(bench.alone(kRamp, kRests), Answer::kObey);
  EXPECT_EQ(bench.alone(rate_of(1), kRests), Answer::kRefuse);
  EXPECT_EQ(bench.alone(sdo::frame_of(0x602, 0x21, object::kRateCommand, 8), kRests), Answer::kRefuse);
}

TEST(SessionGuard, ARecordedOrderIsNoOrder) {
  Bench bench;
  const CanFrame voucher = bench.gateway.vouch_for(rate_of(1));
  EXPECT_EQ(bench.alone(voucher), Answer::kPass);
  EXPECT_EQ(bench.alone(rate_of(1)), Answer::kObey);
  // At once: a doubled frame, which is done already. Later, behind others: refused.
  EXPECT_EQ(bench.alone(rate_of(1)), Answer::kPass);
  EXPECT_EQ(bench.vouched(rate_of(2)), Answer::kObey);
  EXPECT_EQ(bench.alone(voucher), Answer::kPass);
  EXPECT_EQ(bench.alone(rate_of(1)), Answer::kRefuse);
  // Nor does it vouch for another frame.
  EXPECT_EQ(bench.alone(bench.gateway.vouch_for(rate_of(3))), Answer::kPass);
  EXPECT_EQ(bench.alone(rate_of(4)), Answer::kRefuse);
}

TEST(SessionGuard, LostVouchersAndFalseOnesBetweenDoNotEndTheSession) {
  Bench bench;
  for (int i = 0; i < 70'000; ++i) {
    static_cast<void>(bench.gateway.vouch_for(rate_of(1)));
    if (i % 30'000 != 0) continue;
    EXPECT_EQ(bench.vouched(rate_of(1)), Answer::kObey) << i;
  }
  const CanFrame voucher = bench.gateway.vouch_for(rate_of(2));
  EXPECT_EQ(bench.alone(voucher), Answer::kPass);
  for (std::uint8_t i = 0; i < 3; ++i)
    EXPECT_EQ(bench.alone(CanFrame::make(kVoucherCobId, {i, 0xFF, 0, 0, 0, 0, 0, i})), Answer::kPass);
  EXPECT_EQ(bench.alone(rate_of(2)), Answer::kObey);
}

TEST(SessionGuard, EachOrderIsToldOnceInAMotion) {
  Bench bench;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(bench.alone(kStopped), Answer::kRefuse);
    EXPECT_EQ(bench.alone(kRamp), Answer::kRefuse);
    EXPECT_EQ(bench.alone(kMode), Answer::kRefuse);
  }
  EXPECT_EQ(bench.guard.next_refusal(), (Told{0, 0x00, 0x00, 2, kNode}));
  EXPECT_EQ(bench.guard.next_refusal(), (Told{0, 0x02, 0x06, 0x13, 0x21}));
  EXPECT_EQ(bench.guard.next_refusal(), (Told{0, 0x02, 0x06, 0x60, 0x60}));
  EXPECT_EQ(bench.guard.next_refusal(), std::nullopt);
  EXPECT_EQ(bench.alone(kStopped, kRests), Answer::kObey);
  EXPECT_EQ(bench.alone(kStopped), Answer::kRefuse);
  EXPECT_TRUE(bench.guard.next_refusal());
  EXPECT_EQ(bench.guard.refused(), 10u);
}

// Whoever writes to many objects neither fills the bus with EMCYs nor hides another kind of order.
TEST(SessionGuard, ManyOrdersOfAKindLeaveRoomForTheOthers) {
  Bench bench;
  for (std::uint16_t index = 0x6000; index < 0x6100; ++index)
    EXPECT_EQ(bench.alone(sdo::frame_of(0x602, 0x2B, {index, 0}, 1)), Answer::kRefuse);
  for (const CanFrame& frame : {kStopped, rate_of(1), CanFrame::make(0x202, {0, 0, 15, 0, 7, 7})})
    EXPECT_EQ(bench.alone(frame), Answer::kRefuse);
  std::vector<unsigned> told;
  while (const auto refusal = bench.guard.next_refusal())
    told.push_back(get_u16_le(std::span(*refusal).subspan(1)));
  EXPECT_EQ(told,
            (std::vector<unsigned>{0x602, 0x602, 0x602, 0x602, 0x602, 0x602, 0x000, kRateCobId, 0x202}));
  EXPECT_EQ(bench.guard.refused(), 0x103u);
}

TEST(SessionGuard, AGatewayThatWasSilentIsBackWithItsNextVoucher) {
  Bench bench;
  const CanFrame recorded = bench.gateway.vouch_for(rate_of(1));
  EXPECT_EQ(bench.alone(recorded), Answer::kPass);
  EXPECT_EQ(bench.alone(rate_of(1)), Answer::kObey);
  EXPECT_EQ(bench.vouched(rate_of(2)), Answer::kObey);
  bench.guard.lapse();
  EXPECT_FALSE(bench.guard.in_force());
  EXPECT_EQ(bench.alone(encode(SyncStamp{1, 1, BusTime{5}})), Answer::kObey) << "of a new gateway, perhaps";
  EXPECT_EQ(bench.alone(recorded), Answer::kPass);
  EXPECT_EQ(bench.alone(rate_of(1)), Answer::kObey);
  EXPECT_FALSE(bench.guard.in_force()) << "a recorded voucher is none";
  EXPECT_EQ(bench.alone(kRamp), Answer::kObey);
  EXPECT_EQ(bench.guard.next_refusal(), std::nullopt);
  EXPECT_EQ(bench.vouched(encode(SyncStamp{2, 1, BusTime{6}})), Answer::kObey);
  EXPECT_TRUE(bench.guard.in_force());
  EXPECT_EQ(bench.guard.next_refusal(), (Told{0, 0x80, 0x00, 0x02, 0x06})) << "what was obeyed meanwhile";
  EXPECT_EQ(bench.alone(kRamp), Answer::kRefuse);
  EXPECT_EQ(bench.guard.next_refusal(), (Told{0, 0x02, 0x06, 0x13, 0x21}));
  EXPECT_EQ(bench.guard.next_refusal(), std::nullopt);
}

TEST(SessionGuard, WithoutASessionNothingLapses) {
  SessionGuard guard;
  guard.lapse();
  EXPECT_FALSE(guard.in_force());
  EXPECT_EQ(guard.judge(kStopped, kNode, kMoves), Answer::kObey);
}

TEST(SessionGuard, TheKeyIsChangedAtRestOnly) {
  Bench bench;
  EXPECT_EQ(bench.guard.write(5, 0, kMoves), AbortCode::kDeviceState);
  EXPECT_TRUE(bench.guard.in_force());
  EXPECT_EQ(bench.guard.write(5, 1, kRests), AbortCode::kInvalidValue);  // without a key
  EXPECT_TRUE(bench.guard.in_force());
  EXPECT_EQ(bench.guard.write(5, 0, kRests), AbortCode::kNone);
  EXPECT_FALSE(bench.guard.in_force());
  EXPECT_EQ(bench.alone(kStopped), Answer::kObey);
}

}  // namespace
}  // namespace kinebus
