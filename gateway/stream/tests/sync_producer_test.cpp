#include "gateway/stream/sync_producer.hpp"

#include <gtest/gtest.h>

namespace kinebus::testing {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(StampedSyncProducer, StampsTheInstantAtWhichSyncReallyWentOut) {
  StampedSyncProducer sync({.epoch = 3});
  sync.start(milliseconds{10});
  EXPECT_FALSE(sync.next_frame(milliseconds{9}));
  EXPECT_EQ(sync.next_deadline(), milliseconds{10});
  const auto frame = sync.next_frame(milliseconds{10});
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame, CanFrame::make(0x080, {1}));
  EXPECT_FALSE(sync.next_frame(milliseconds{11})) << "no stamp before the SYNC is out";
  sync.on_frame_sent(microseconds{10'137}, *frame);
  const auto stamp = sync.next_frame(milliseconds{11});
  ASSERT_TRUE(stamp);
  EXPECT_EQ(decode_sync_stamp(*stamp, milliseconds{11}),
            (SyncStamp{.counter = 1, .epoch = 3, .time = microseconds{10'137}}));
  EXPECT_FALSE(sync.next_frame(milliseconds{12}));
  EXPECT_EQ(sync.next_deadline(), milliseconds{60});
}

TEST(StampedSyncProducer, CounterGoesRoundFrom240To1) {
  StampedSyncProducer sync;
  sync.start(BusTime{0});
  std::uint8_t last = 0;
  for (int k = 0; k < 500; ++k) {
    const auto frame = sync.next_frame(k * milliseconds{50});
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->data[0], last == 240 ? 1 : last + 1);
    last = frame->data[0];
  }
  EXPECT_EQ(sync.counters().unstamped, 499u);
}

TEST(StampedSyncProducer, PassesOverPeriodsThatWereMissed) {
  StampedSyncProducer sync;
  sync.start(BusTime{0});
  ASSERT_TRUE(sync.next_frame(milliseconds{170}));
  EXPECT_EQ(sync.counters().late, 3u);
  EXPECT_FALSE(sync.next_frame(milliseconds{170}));
  EXPECT_EQ(sync.next_deadline(), milliseconds{200});
}

TEST(StampedSyncProducer, IgnoresTheSendingOfAnOlderSync) {
  StampedSyncProducer sync;
  sync.start(BusTime{0});
  const auto old = *sync.next_frame(BusTime{0});
  ASSERT_TRUE(sync.next_frame(milliseconds{50}));
  sync.on_frame_sent(milliseconds{51}, old);
  EXPECT_FALSE(sync.next_frame(milliseconds{52}));
}

TEST(StampedSyncProducer, OneThatGoesOutALittleLateIsFollowedInTime) {
  StampedSyncProducer sync;
  sync.start(milliseconds{10});
  ASSERT_TRUE(sync.next_frame(milliseconds{13}));
  EXPECT_EQ(sync.next_deadline(), milliseconds{60});
  EXPECT_EQ(sync.counters().late, 0u);
}

TEST(StampedSyncProducer, StampsOnceAndOnlyForItsOwnSync) {
  StampedSyncProducer sync;
  sync.start(BusTime{0});
  const auto frame = *sync.next_frame(BusTime{0});
  CanFrame extended = frame, other_id = frame, longer = CanFrame::make(kSyncCobId, {frame.data[0], 0});
  extended.extended = true;
  other_id.id = 0x081;
  for (const CanFrame& other : {extended, other_id, longer, CanFrame::make(kSyncCobId, {2})})
    sync.on_frame_sent(milliseconds{1}, other);
  EXPECT_FALSE(sync.next_frame(milliseconds{2}));
  sync.on_frame_sent(milliseconds{3}, frame);
  EXPECT_TRUE(sync.next_frame(milliseconds{4}));
  sync.on_frame_sent(milliseconds{5}, frame);
  EXPECT_FALSE(sync.next_frame(milliseconds{6})) << "told twice";
  EXPECT_EQ(sync.counters().syncs, 1u);
  EXPECT_EQ(sync.counters().stamps, 1u);
  EXPECT_EQ(sync.counters().unstamped, 0u);
}

TEST(StampedSyncProducer, ANewEpochStampsNothingOfTheOldOne) {
  for (const bool was_out : {false, true}) {
    StampedSyncProducer sync({.epoch = 3});
    sync.start(BusTime{0});
    const auto old = *sync.next_frame(BusTime{0});
    if (was_out) sync.on_frame_sent(milliseconds{1}, old);
    sync.restart(4, milliseconds{20});
    if (!was_out) sync.on_frame_sent(milliseconds{2}, old);
    EXPECT_FALSE(sync.next_frame(milliseconds{3}));
    EXPECT_EQ(sync.next_deadline(), milliseconds{20});
    const auto frame = sync.next_frame(milliseconds{20});
    ASSERT_TRUE(frame);
    EXPECT_EQ(*frame, CanFrame::make(kSyncCobId, {2}));
    EXPECT_EQ(sync.counters().unstamped, 0u);
    sync.on_frame_sent(milliseconds{21}, *frame);
    const auto stamp = sync.next_frame(milliseconds{22});
    ASSERT_TRUE(stamp);
    EXPECT_EQ(decode_sync_stamp(*stamp, milliseconds{22})->epoch, 4);
  }
}

TEST(StampedSyncProducer, AShorterPeriodBeginsAtOnceAndALongerOneWithTheNextSync) {
  StampedSyncProducer sync;
  sync.set_period(milliseconds{20}, milliseconds{5});
  EXPECT_EQ(sync.next_deadline(), BusTime::max()) << "not begun";
  EXPECT_EQ(sync.period(), milliseconds{20});
  sync.start(milliseconds{100});
  sync.set_period(milliseconds{10}, milliseconds{50});
  EXPECT_EQ(sync.next_deadline(), milliseconds{60});
  ASSERT_TRUE(sync.next_frame(milliseconds{60}));
  EXPECT_EQ(sync.next_deadline(), milliseconds{70});
  sync.set_period(milliseconds{40}, milliseconds{65});
  EXPECT_EQ(sync.next_deadline(), milliseconds{70});
  sync.next_frame(milliseconds{70});
  EXPECT_EQ(sync.next_deadline(), milliseconds{110});
}

}  // namespace
}  // namespace kinebus::testing
