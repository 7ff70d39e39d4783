// What a frame is that the gateway has not sent: which of them only it may send, and what is told of the
// others.

#include "gateway/machine/foreign_frames.hpp"

#include <gtest/gtest.h>

#include <string>

#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using Kind = ForeignFrame::Kind;
using AtRest = ForeignFrame::AtRest;

/// Node 3 has axes, node 20 has none.
ForeignFrame look(const std::string& text) {
  std::deque<NodeLink> links;
  links.emplace_back(3);
  NodeFunctions none;
  none.axis_pairs = 0;
  links.emplace_back(20, none);
  const auto frame = parse_frame(text);
  EXPECT_TRUE(frame) << text;
  return look_at_foreign(frame.value_or(CanFrame{}), links);
}

TEST(ForeignFrames, WhatOnlyAGatewaySaysIsThatOfAnother) {
  for (const char* frame : {"080#01", "080#", "77F#05"}) EXPECT_EQ(look(frame).kind, Kind::kGateway) << frame;
  for (const std::uint32_t id : {kRateCobId, kSyncStampCobId, kVoucherCobId})
    EXPECT_EQ(look_at_foreign({.id = id, .length = 8}, {}).kind, Kind::kGateway) << id;
  EXPECT_EQ(look("703#05").kind, Kind::kNone) << "a node's heartbeat";
  EXPECT_EQ(look("00000080#01").kind, Kind::kNone) << "29 bits: nobody's here";
  EXPECT_EQ(look("080#R").kind, Kind::kNone) << "remote";
}

TEST(ForeignFrames, ARecordIsOneForANodeOfTheMachineAlone) {
  for (const char* frame : {"403#0000000000000000", "503#0000000000000000"}) {
    EXPECT_EQ(look(frame).kind, Kind::kRecord) << frame;
    EXPECT_EQ(look(frame).node, 3);
    EXPECT_NE(look(frame).words.find("node 3"), std::string::npos);
  }
  for (const char* frame : {"404#0000000000000000", "504#0000000000000000", "400#00", "500#00"})
    EXPECT_EQ(look(frame).kind, Kind::kNone) << frame;
}

TEST(ForeignFrames, AWriteIsAnOrderAndAReadIsNone) {
  const ForeignFrame order = look("603#2B13210002000000");
  EXPECT_EQ(order.kind, Kind::kOrder);
  EXPECT_EQ(order.node, 3);
  EXPECT_EQ(order.at_rest, AtRest::kNothing);
  EXPECT_NE(order.words.find("object 2113h:0 of node 3"), std::string::npos) << order.words;
  EXPECT_EQ(look("603#C213210002000000").kind, Kind::kOrder) << "in blocks";
  EXPECT_EQ(look("614#2B13210002000000").kind, Kind::kOrder) << "a node without axes";
  for (const char* frame : {"603#4013210000000000", "603#0000000000000000", "604#2B13210002000000",
                            "603#2B132100020000", "583#2B13210002000000"})
    EXPECT_EQ(look(frame).kind, Kind::kNone) << frame;
}

TEST(ForeignFrames, TheSameOrderIsKnownByItsNodeAndObjectNotByItsValue) {
  EXPECT_EQ(look("603#2B13210002000000").order, look("603#2B13210009000000").order);
  EXPECT_NE(look("603#2B13210002000000").order, look("603#2B14210002000000").order);
  EXPECT_NE(look("603#2B13210002000000").order, look("603#2B13210102000000").order);
  EXPECT_NE(look("603#2B13210002000000").order, look("614#2B13210002000000").order);
  EXPECT_NE(look("203#0F000F00").order, look("214#0F000F00").order);
  EXPECT_NE(look("203#0F000F00").order, look("303#0F000F00").order);
}

TEST(ForeignFrames, AMotorMayLoseItsCurrentByItsControlword) {
  for (const char* frees : {"603#2B40600006000000", "603#2B40680006000000", "603#2B4060000E000000",
                            "203#06000F00", "203#0F000600", "203#00000000"})
    EXPECT_EQ(look(frees).at_rest, AtRest::kFreesMotors) << frees;
  for (const char* keeps : {"603#2B4060000F000000", "603#2B4060001F000000", "603#2B40680F0F000000",
                            "203#0F000F00", "203#1F001F00", "303#0000000000000000", "603#2B41600006000000",
                            "603#2B40610006000000", "203#0600", "214#00000000", "614#2B40600006000000"}) {
    EXPECT_EQ(look(keeps).kind, Kind::kOrder) << keeps;
    EXPECT_EQ(look(keeps).at_rest, AtRest::kNothing) << keeps;
  }
  EXPECT_EQ(look("204#00000000").kind, Kind::kNone) << "of no node of this machine";
}

TEST(ForeignFrames, NmtIsAnOrderForAllOrForANodeOfTheMachine) {
  EXPECT_EQ(look("000#0200").kind, Kind::kOrder);
  EXPECT_NE(look("000#0200").words.find("all nodes"), std::string::npos);
  EXPECT_EQ(look("000#8103").node, 3);
  EXPECT_NE(look("000#8103").words.find("node 3"), std::string::npos);
  EXPECT_NE(look("000#8103").order, look("000#0203").order);
  for (const char* frame : {"000#0204", "000#02", "000#020000"})
    EXPECT_EQ(look(frame).kind, Kind::kNone) << frame;
}

TEST(ForeignFrames, LssIsToldAtRestToo) {
  EXPECT_EQ(look("7E5#0401000000000000").kind, Kind::kOrder);
  EXPECT_EQ(look("7E5#0401000000000000").at_rest, AtRest::kIsTold);
  EXPECT_EQ(look("7E4#0401000000000000").kind, Kind::kNone);
}

TEST(ForeignFrames, SixOrdersASecondAreToldEachOnce) {
  ForeignOrders orders;
  for (std::uint64_t order = 0; order < 6; ++order) {
    EXPECT_TRUE(orders.is_news(1s, order)) << order;
    EXPECT_FALSE(orders.is_news(1s, order)) << "again";
  }
  EXPECT_FALSE(orders.is_news(1s, 6)) << "more than a person reads";
  EXPECT_FALSE(orders.is_news(2s - 1ns, 0));
  EXPECT_TRUE(orders.is_news(2s, 0)) << "a second later";
  EXPECT_FALSE(orders.is_news(2s, 0));
  EXPECT_TRUE(orders.is_news(2s, 6));
}

TEST(ForeignFrames, TwoHundredUselessOnesWithinASecondAreManyAndToldOnce) {
  UselessFrames useless;
  for (int i = 1; i < 200; ++i) EXPECT_FALSE(useless.are_many(1s));
  EXPECT_TRUE(useless.are_many(2s - 1ns));
  for (int i = 0; i < 500; ++i) EXPECT_FALSE(useless.are_many(3s)) << "told";
  useless.forget();
  for (int i = 1; i < 200; ++i) EXPECT_FALSE(useless.are_many(5s));
  EXPECT_FALSE(useless.are_many(6s)) << "a second later they are counted anew";
  for (int i = 2; i < 200; ++i) EXPECT_FALSE(useless.are_many(6s));
  EXPECT_TRUE(useless.are_many(6s));
}

}  // namespace
}  // namespace kinebus
