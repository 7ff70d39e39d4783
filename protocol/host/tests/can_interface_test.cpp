#include "protocol/host/can_interface.hpp"

#include <gtest/gtest.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

#include <cstring>
#include <random>
#include <vector>

namespace kinebus {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <typename T>
Bytes bytes_of(const T& value) {
  Bytes bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

void add(Bytes& to, unsigned type, const Bytes& value) {
  const rtattr head{static_cast<unsigned short>(sizeof(rtattr) + value.size()),
                    static_cast<unsigned short>(type)};
  const Bytes front = bytes_of(head);
  to.insert(to.end(), front.begin(), front.end());
  to.insert(to.end(), value.begin(), value.end());
  while (to.size() % RTA_ALIGNTO != 0) to.push_back(0);
}

/// As a kernel tells of can0.
Bytes told(std::uint32_t bit_rate, std::uint32_t restart_ms, std::uint32_t queue, std::uint32_t mode = 0,
           unsigned flags = IFF_UP) {
  can_bittiming timing{};
  timing.bitrate = bit_rate;
  Bytes data, info, list;
  add(data, IFLA_CAN_BITTIMING, bytes_of(timing));
  add(data, IFLA_CAN_CTRLMODE, bytes_of(can_ctrlmode{.mask = mode, .flags = mode}));
  add(data, IFLA_CAN_STATE, bytes_of(std::uint32_t{CAN_STATE_ERROR_ACTIVE}));
  add(data, IFLA_CAN_RESTART_MS, bytes_of(restart_ms));
  add(info, IFLA_INFO_KIND, Bytes{'c', 'a', 'n', 0});
  add(info, IFLA_INFO_DATA | NLA_F_NESTED, data);
  add(list, IFLA_IFNAME, Bytes{'c', 'a', 'n', '0', 0});
  add(list, IFLA_TXQLEN, bytes_of(queue));
  add(list, IFLA_LINKINFO, info);
  ifinfomsg link{};
  link.ifi_flags = flags;
  nlmsghdr head{};
  head.nlmsg_type = RTM_NEWLINK;
  head.nlmsg_len = static_cast<std::uint32_t>(NLMSG_LENGTH(sizeof link) + list.size());
  Bytes message = bytes_of(head);
  for (const Bytes& part : {bytes_of(link), list}) message.insert(message.end(), part.begin(), part.end());
  return message;
}

CanInterface read(const Bytes& message) {
  return read_link(message).value_or(CanInterface{});
}

TEST(CanInterface, AGoodOneNeedsNothing) {
  const CanInterface can = read(told(1'000'000, 100, 10));
  EXPECT_EQ(can.kind, "can");
  EXPECT_TRUE(can.up);
  EXPECT_EQ(can.bit_rate, 1'000'000u);
  EXPECT_EQ(can.restart_ms, 100u);
  EXPECT_EQ(can.transmit_queue, 10u);
  EXPECT_EQ(obstacle("can0", can), "");
  EXPECT_TRUE(advice("can0", can).empty());
}

TEST(CanInterface, AnotherBitRateAndOneThatOnlyListensAreInTheWay) {
  EXPECT_EQ(obstacle("can0", read(told(500'000, 100, 10))),
            "CAN interface can0 is set to 500000 bit/s, and every node speaks 1000000: ip link set can0 "
            "down; ip link set "
            "can0 type can bitrate 1000000 restart-ms 100; ip link set can0 up");
  EXPECT_NE(obstacle("can1", read(told(1'000'000, 100, 10, CAN_CTRLMODE_LISTENONLY))).find("only listens"),
            std::string::npos);
}

TEST(CanInterface, WhatWillBeMissedIsSaidWithTheCommand) {
  const auto dead = advice("can0", read(told(1'000'000, 0, 10)));
  ASSERT_EQ(dead.size(), 1u);
  EXPECT_NE(dead[0].find("restart-ms 100"), std::string::npos);
  const auto narrow = advice("can0", read(told(1'000'000, 100, 3)));
  ASSERT_EQ(narrow.size(), 1u);
  EXPECT_NE(narrow[0].find("txqueuelen 64"), std::string::npos);
  const auto down = advice("can0", read(told(0, 0, 10, 0, 0)));
  ASSERT_EQ(down.size(), 1u);
  EXPECT_NE(down[0].find("is down"), std::string::npos);
}

// Linux refuses restart-ms there, and with it all that stands in the same line.
TEST(CanInterface, OfGsUsbNothingIsAskedThatItsDriverDoesNotHave) {
  CanInterface can = read(told(1'000'000, 0, 10));
  can.driver = "gs_usb";
  EXPECT_TRUE(advice("can0", can).empty());
  can.bit_rate = 500'000;
  EXPECT_EQ(obstacle("can0", can),
            "CAN interface can0 is set to 500000 bit/s, and every node speaks 1000000: ip link set can0 "
            "down; ip link set can0 type can bitrate 1000000; ip link set can0 up");
  can.up = false;
  EXPECT_EQ(
      advice("can0", can).at(0),
      "CAN interface can0 is down: ip link set can0 down; ip link set can0 type can bitrate 1000000; ip "
      "link set can0 up");
}

TEST(CanInterface, AWrongAnswerIsNoneOrAnEmptyOne) {
  const Bytes good = told(1'000'000, 100, 10);
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(read_link(std::span(good).first(size))) << size;
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    Bytes bad = good;
    bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
    const auto read = read_link(bad);
    if (read) static_cast<void>(advice("can0", *read).size());
  }
}

}  // namespace
}  // namespace kinebus
