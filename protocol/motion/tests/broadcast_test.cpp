#include "protocol/motion/broadcast.hpp"

#include <gtest/gtest.h>

#include "protocol/canopen/emcy.hpp"

namespace kinebus {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::seconds;

constexpr BusTime kNow = hours{100} + microseconds{123'456};

CanFrame emergency_with(const StopRequest& stop) {
  return encode(Emergency{3, 0xFF06, 0x81, encode(stop)});
}

TEST(Broadcast, WhatIsEncodedIsDecodedWhereverTheCountersWrap) {
  for (BusTime at = kNow; at < kNow + seconds{40}; at += microseconds{333'337}) {
    const RateCommand rate{RateCommand::Kind::kRate, 11, 12'345, 50, at};
    EXPECT_EQ(decode_rate_command(encode(rate), at - seconds{2}), rate);
    EXPECT_EQ(decode_rate_command(encode(rate), at + seconds{7}), rate);
    const StopRequest stop{StopReason::kLimitSwitch, 1, at};
    EXPECT_EQ(decode_stop_request(emergency_with(stop), at + seconds{5}), stop);
    const SyncStamp stamp{240, 251, at + BusTime{999}};
    EXPECT_EQ(decode_sync_stamp(encode(stamp), at + seconds{1000}), stamp);
  }
}

TEST(Broadcast, OneWrongBitAnywhereIsFound) {
  const CanFrame rate = encode(RateCommand{RateCommand::Kind::kStop, 3, 0, 50, kNow});
  const CanFrame stamp = encode(SyncStamp{7, 1, kNow + BusTime{42}});
  const CanFrame stop = emergency_with({StopReason::kStarved, 0, kNow});
  for (std::size_t bit = 0; bit < 64; ++bit) {
    const auto flipped = [bit](CanFrame frame) {
      frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1u << bit % 8));
      return frame;
    };
    EXPECT_FALSE(decode_rate_command(flipped(rate), kNow)) << bit;
    EXPECT_FALSE(decode_sync_stamp(flipped(stamp), kNow)) << bit;
    // The first three bytes say why in words; the stop itself is in the five others.
    EXPECT_EQ(decode_stop_request(flipped(stop), kNow).has_value(), bit < 24) << bit;
  }
}

TEST(Broadcast, AStreamStatusTellsItselfWhetherItHasACheck) {
  StreamStatus plain{101, 77, StreamStatus::kRunning | StreamStatus::kReordered, 3, 0xFEDC'BA98};
  const std::uint64_t raw = encode(plain);
  EXPECT_EQ(raw & 0x80, 0u) << "what a node has always told";
  EXPECT_EQ(raw >> 32, 0xFEDC'BA98u);
  EXPECT_FALSE(decode_stream_status(raw).tail_check);
  EXPECT_EQ(decode_stream_status(raw).path_units, 0xFEDC'BA98u);
  for (const std::uint8_t check : std::initializer_list<std::uint8_t>{0x00, 0x5A, 0xFF}) {
    StreamStatus checked = plain;
    checked.tail_check = check;
    const StreamStatus told = decode_stream_status(encode(checked));
    EXPECT_EQ(told.tail_check, check);
    EXPECT_EQ(told.next_sequence, 101);
    EXPECT_EQ(told.free_records, 77);
    EXPECT_EQ(told.flags, plain.flags);
    EXPECT_EQ(told.sync_error_us, 3);
    EXPECT_EQ(told.path_units, 0xDC'BA98u);
  }
}

TEST(Broadcast, PathTimeOfAStatusIsThatNearestToWhatIsKnown) {
  for (const std::int64_t units : {std::int64_t{5}, std::int64_t{0xFF'FFFE}, std::int64_t{0x1'0000'0003}})
    for (const std::int64_t apart :
         {std::int64_t{-8'000'000}, std::int64_t{-1}, std::int64_t{0}, std::int64_t{8'000'000}})
      for (const bool checked : {false, true}) {
        StreamStatus status{.path_units = static_cast<std::uint32_t>(units + apart)};
        if (checked) status.tail_check = 0xA5;
        EXPECT_EQ(decode_stream_status(encode(status)).path_near(units), units + apart) << checked;
      }
  EXPECT_EQ((StreamStatus{.path_units = 0x8000'0000}).path_near(0x1'0000'0000), 0x8000'0000);
}

TEST(Broadcast, FramesOfOthersAreNoCommands) {
  for (const std::uint8_t byte : std::initializer_list<std::uint8_t>{0x00, 0xFF}) {
    CanFrame frame{.id = kRateCobId, .length = 8};
    frame.data.fill(byte);
    EXPECT_FALSE(decode_rate_command(frame, kNow));
    EXPECT_FALSE(decode_sync_stamp(frame, kNow));
    frame.id = 0x0B1;
    EXPECT_FALSE(decode_stop_request(frame, kNow));
  }
}

}  // namespace
}  // namespace kinebus
