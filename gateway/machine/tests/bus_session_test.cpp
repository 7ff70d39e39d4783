// Keys of sessions, and vouchers before the frames that nodes want vouched for.

#include "gateway/machine/bus_session.hpp"

#include <gtest/gtest.h>

#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/object_addresses.hpp"

namespace kinebus {
namespace {

const SipHashKey kSecret{.low = 1, .high = 2};
const CanFrame kOrder = nmt_frame(NmtCommand::kStart, 1);
const CanFrame kHeartbeat = heartbeat_frame(NmtState::kOperational, 1);

/// All that is sent where `frame` is the next and only one.
std::vector<CanFrame> sent(BusSession& session, const CanFrame& frame) {
  std::vector<CanFrame> all;
  bool given = false;
  const auto next = [&]() -> std::optional<CanFrame> {
    if (given) return std::nullopt;
    given = true;
    return frame;
  };
  while (const auto out = session.next_frame(next)) all.push_back(*out);
  return all;
}
SipHashKey key_in(const BusSession& session) {
  const auto writes = session.key_writes();
  if (writes.size() != 5) return {};
  const auto part = [&](std::size_t i) { return static_cast<std::uint64_t>(writes[i].value); };
  return {part(0) | part(1) << 32, part(2) | part(3) << 32};
}

TEST(BusSession, AnOpenBusHasNeitherKeysNorVouchers) {
  BusSession open(BusTrust::kOpen, {});
  open.begin();
  EXPECT_TRUE(open.key_writes().empty());
  EXPECT_EQ(sent(open, kOrder), std::vector<CanFrame>{kOrder});
  BusSession early(BusTrust::kSession, kSecret);
  EXPECT_TRUE(early.key_writes().empty()) << "no bring-up has begun";
  EXPECT_EQ(sent(early, kOrder), std::vector<CanFrame>{kOrder});
}

TEST(BusSession, EveryBringUpHasAKeyOfItsOwnInFourPartsThatComesIntoForceLast) {
  BusSession session(BusTrust::kSession, kSecret), again(BusTrust::kSession, kSecret),
      other(BusTrust::kSession, {.low = 1, .high = 3});
  for (BusSession* each : {&session, &again, &other}) each->begin();
  const auto writes = session.key_writes();
  ASSERT_EQ(writes.size(), 5U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(writes[i].address.index, object::kSessionKey.index);
    EXPECT_EQ(writes[i].address.subindex, object::kSessionKey.subindex + i);
    EXPECT_LE(writes[i].value, 0xFFFF'FFFFLL);
    EXPECT_GE(writes[i].value, 0);
  }
  EXPECT_EQ(writes[4].address.index, object::kSessionInForce.index);
  EXPECT_EQ(writes[4].value, 1);
  const SipHashKey first = key_in(session);
  EXPECT_EQ(first, key_in(again));
  EXPECT_NE(first, key_in(other)) << "of another secret";
  EXPECT_NE(first.low, first.high);
  session.begin();
  EXPECT_NE(key_in(session), first);
}

TEST(BusSession, WhatANodeWantsVouchedForIsGoodForWhoHoldsTheKey) {
  BusSession session(BusTrust::kSession, kSecret);
  session.begin();
  EXPECT_EQ(sent(session, kHeartbeat), std::vector<CanFrame>{kHeartbeat});
  VoucherReader node;
  node.begin(key_in(session));
  const auto frames = sent(session, kOrder);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(node.on_frame(frames[0]));
  EXPECT_EQ(frames[1], kOrder);
  EXPECT_EQ(node.look(frames[1]), VoucherReader::Verdict::kVouched);
}

TEST(BusSession, UntilAllNodesHoldTheNewKeyFramesAreVouchedForWithTheOldOnesToo) {
  BusSession session(BusTrust::kSession, kSecret);
  VoucherReader old_node, new_node;
  session.begin();
  old_node.begin(key_in(session));
  session.begin();
  new_node.begin(key_in(session));
  auto frames = sent(session, kOrder);
  ASSERT_EQ(frames.size(), 3U);
  for (VoucherReader* node : {&old_node, &new_node}) {
    for (std::size_t i = 0; i < 2; ++i) node->on_frame(frames[i]);
    EXPECT_EQ(node->look(frames[2]), VoucherReader::Verdict::kVouched);
  }
  session.settle();
  frames = sent(session, nmt_frame(NmtCommand::kStop, 1));
  ASSERT_EQ(frames.size(), 2U);
  for (VoucherReader* node : {&old_node, &new_node}) node->on_frame(frames[0]);
  EXPECT_EQ(old_node.look(frames[1]), VoucherReader::Verdict::kRefused);
  EXPECT_EQ(new_node.look(frames[1]), VoucherReader::Verdict::kVouched);
  session.settle();
  EXPECT_EQ(sent(session, kOrder).size(), 2U) << "settled already";
}

TEST(BusSession, OfBringUpsThatFailedNoMoreKeysAreKeptThanANodeKeepsVouchers) {
  BusSession session(BusTrust::kSession, kSecret);
  for (std::size_t i = 1; i <= 6; ++i) {
    session.begin();
    EXPECT_EQ(sent(session, kOrder).size(), std::min(i, VoucherReader::kKept) + 1);
  }
  VoucherReader node;
  node.begin(key_in(session));
  const auto frames = sent(session, kOrder);
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) node.on_frame(frames[i]);
  EXPECT_EQ(node.look(frames.back()), VoucherReader::Verdict::kVouched) << "the last key is among them";
}

}  // namespace
}  // namespace kinebus
