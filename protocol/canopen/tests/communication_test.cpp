// NMT, heartbeat, SYNC and EMCY.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "protocol/can/candump.hpp"
#include "protocol/canopen/crc.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/heartbeat.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/sync.hpp"

namespace kinebus {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

std::string str(const std::optional<CanFrame>& frame) {
  return frame ? std::string(to_text(*frame).view()) : "none";
}
CanFrame frame(const char* text) {
  return parse_frame(text).value();
}

TEST(Nmt, SlaveFollowsCommandsForItAndForAll) {
  NmtSlave slave;
  EXPECT_FALSE(slave.on_frame(frame("000#0100"))) << "not before boot-up";
  EXPECT_EQ(str(slave.boot(2)), "702#00");
  EXPECT_EQ(slave.state(), NmtState::kPreOperational);
  EXPECT_FALSE(slave.on_frame(frame("000#0103")));
  EXPECT_EQ(slave.on_frame(frame("000#0102")), NmtCommand::kStart);
  EXPECT_TRUE(slave.allows_pdo());
  EXPECT_EQ(slave.on_frame(frame("000#0200")), NmtCommand::kStop);
  EXPECT_FALSE(slave.allows_sdo());
  EXPECT_EQ(slave.on_frame(frame("000#8000")), NmtCommand::kEnterPreOperational);
  EXPECT_FALSE(slave.on_frame(frame("000#0700")));
  EXPECT_FALSE(slave.on_frame(frame("000#01")));
  EXPECT_EQ(slave.on_frame(frame("000#8202")), NmtCommand::kResetCommunication);
  EXPECT_EQ(slave.state(), NmtState::kInitialising);
}

TEST(Nmt, ErrorBehaviourMovesTheState) {
  NmtSlave slave;
  slave.boot(1);
  slave.on_frame(nmt_frame(NmtCommand::kStart, 1));
  slave.on_error(1);
  EXPECT_EQ(slave.state(), NmtState::kOperational);
  slave.on_error(0);
  EXPECT_EQ(slave.state(), NmtState::kPreOperational);
  slave.on_error(2);
  EXPECT_EQ(slave.state(), NmtState::kStopped);
}

TEST(Heartbeat, ProducerKeepsItsPeriod) {
  HeartbeatProducer producer;
  producer.set_period(milliseconds{500}, LocalTime{0});
  EXPECT_EQ(str(producer.next_frame(LocalTime{0}, NmtState::kPreOperational, 3)), "703#7F");
  EXPECT_EQ(str(producer.next_frame(milliseconds{499}, NmtState::kPreOperational, 3)), "none");
  EXPECT_EQ(str(producer.next_frame(milliseconds{510}, NmtState::kOperational, 3)), "703#05");
  EXPECT_EQ(producer.next_deadline(), LocalTime{milliseconds{1000}})
      << "late by 10 ms is not later ever after";
  producer.set_period(milliseconds{0}, milliseconds{600});
  EXPECT_EQ(producer.next_deadline(), kNever);
}

TEST(Heartbeat, ConsumerTellsComingChangingAndGoing) {
  HeartbeatConsumer consumer;
  ASSERT_TRUE(consumer.configure(0, 0x007F'03E8));
  EXPECT_FALSE(consumer.configure(1, 0x007F'0100));
  EXPECT_EQ(consumer.next_deadline(), kNever);
  EXPECT_FALSE(consumer.on_frame(LocalTime{0}, frame("701#05")));
  EXPECT_EQ(consumer.on_frame(LocalTime{0}, frame("77F#00"))->kind, HeartbeatConsumer::Event::Kind::kBootUp);
  EXPECT_EQ(consumer.on_frame(milliseconds{100}, frame("77F#05"))->kind,
            HeartbeatConsumer::Event::Kind::kStateChanged);
  EXPECT_FALSE(consumer.on_time(milliseconds{1099}));
  const auto lost = consumer.on_time(milliseconds{1100});
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->kind, HeartbeatConsumer::Event::Kind::kLost);
  EXPECT_EQ(lost->node, 127);
  EXPECT_FALSE(consumer.on_time(milliseconds{1200})) << "once";
  EXPECT_EQ(consumer.on_frame(milliseconds{1300}, frame("77F#05"))->kind,
            HeartbeatConsumer::Event::Kind::kStarted);
}

TEST(Sync, ProducerCountsOneToTwoHundredForty) {
  PlainSyncProducer producer;
  producer.start(milliseconds{10});
  EXPECT_EQ(str(producer.next_frame(milliseconds{9})), "none");
  EXPECT_EQ(str(producer.next_frame(milliseconds{10})), "080#01");
  EXPECT_EQ(producer.next_deadline(), BusTime{milliseconds{60}});
  EXPECT_EQ(str(producer.next_frame(milliseconds{63})), "080#02");
  EXPECT_EQ(producer.next_deadline(), BusTime{milliseconds{110}}) << "on the grid";
  for (int i = 3; i <= 240; ++i) producer.next_frame(milliseconds{10 + 50 * (i - 1)});
  EXPECT_EQ(producer.last_counter(), 240);
  EXPECT_EQ(str(producer.next_frame(milliseconds{60'000})), "080#01");
  EXPECT_GT(producer.next_deadline(), BusTime{milliseconds{60'000}});
}

TEST(Sync, ConsumerChecksTheCounterByte) {
  EXPECT_EQ(decode_sync(frame("080#F0")).counter, 240);
  EXPECT_FALSE(decode_sync(frame("080#F0")).length_error);
  EXPECT_TRUE(decode_sync(frame("080#")).length_error);
  EXPECT_TRUE(decode_sync(frame("080#00")).length_error);
  EXPECT_TRUE(decode_sync(frame("080#F1")).length_error);
  EXPECT_TRUE(decode_sync(frame("080#01"), cob_id::kSync, 0).length_error);
  EXPECT_FALSE(decode_sync(frame("081#01")).is_sync);
}

TEST(Emcy, EncodesAndDecodes) {
  const Emergency emergency{3, node_emcy::kStarved, 0x81, {1, 2, 3, 4, 5}};
  EXPECT_EQ(str(encode(emergency)), "083#01FF810102030405");
  EXPECT_EQ(decode_emcy(encode(emergency)), emergency);
  EXPECT_FALSE(decode_emcy(frame("080#0000000000000000")));
  EXPECT_FALSE(decode_emcy(frame("083#00")));
}

TEST(Emcy, ProducerKeepsRegisterHistoryAndInhibitTime) {
  EmcyProducer producer;
  producer.set_inhibit_time(milliseconds{10});
  producer.raise(emcy::kOverCurrent, {0x80});
  producer.raise(emcy::kHeartbeat);
  EXPECT_EQ(producer.error_register(), emcy::kGeneric | emcy::kCurrent | emcy::kCommunication);
  EXPECT_EQ(str(producer.next_frame(LocalTime{0}, 1)), "081#1023038000000000");
  EXPECT_EQ(str(producer.next_frame(milliseconds{5}, 1)), "none");
  EXPECT_EQ(producer.next_deadline(), LocalTime{milliseconds{10}});
  EXPECT_EQ(str(producer.next_frame(milliseconds{10}, 1)), "081#3081130000000000");
  EXPECT_EQ(producer.history_length(), 2);
  EXPECT_EQ(producer.history(0), 0x8130u);
  EXPECT_EQ(producer.history(1), 0x0080'2310u);
  producer.clear(emcy::kOverCurrent);
  EXPECT_EQ(str(producer.next_frame(milliseconds{20}, 1)), "081#0000110000000000");
  producer.clear_all();
  EXPECT_EQ(str(producer.next_frame(milliseconds{30}, 1)), "081#0000000000000000");
  producer.clear_history();
  EXPECT_EQ(producer.history_length(), 0);
}

TEST(Emcy, UrgentOnesOvertakeAndAlwaysFindRoom) {
  EmcyProducer producer;
  producer.set_inhibit_time(milliseconds{10});
  for (int i = 0; i < 12; ++i) producer.raise(emcy::kHeartbeat);
  EXPECT_EQ(producer.lost(), 4u);
  producer.raise(node_emcy::kStarved, {7}, true);
  EXPECT_EQ(producer.next_deadline(), LocalTime::min());
  EXPECT_EQ(str(producer.next_frame(LocalTime{0}, 2)), "082#01FF910700000000");
  producer.raise(node_emcy::kStarved, {8}, true);
  EXPECT_EQ(str(producer.next_frame(LocalTime{0}, 2)), "082#01FF910800000000") << "no inhibit time";
}

TEST(Crc, KnownCheckValues) {
  const std::string digits = "123456789";
  const std::vector<std::uint8_t> bytes(digits.begin(), digits.end());
  Crc16 crc16;
  crc16.add(bytes);
  EXPECT_EQ(crc16.value(), 0x31C3);
  Crc32 crc32;
  crc32.add(bytes);
  EXPECT_EQ(crc32.value(), 0xCBF43926u);
}

}  // namespace
}  // namespace kinebus
