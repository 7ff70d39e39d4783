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

}  // namespace
}  // namespace kinebus::testing
