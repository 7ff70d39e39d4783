#include "protocol/canopen/lss.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

constexpr LssIdentity kIdentity{0x4B494E45, 0x402, 0x10000, 0xDEADBEEF};

std::string ask(LssSlave& slave, const char* request) {
  EXPECT_TRUE(slave.on_frame(parse_frame(request).value()));
  const auto reply = slave.next_frame();
  return reply ? std::string(to_text(*reply).view()) : "none";
}

TEST(LssSlave, IsConfiguredWhenSwitchedToGlobally) {
  LssSlave slave(kIdentity, kUnconfiguredNodeId);
  EXPECT_EQ(ask(slave, "7E5#1105000000000000"), "none") << "waiting";
  ask(slave, "7E5#0401000000000000");
  EXPECT_EQ(ask(slave, "7E5#5E00000000000000"), "7E4#5EFF000000000000");
  EXPECT_EQ(ask(slave, "7E5#1180000000000000"), "7E4#1101000000000000") << "128 is no node id";
  EXPECT_EQ(ask(slave, "7E5#1105000000000000"), "7E4#1100000000000000");
  EXPECT_EQ(ask(slave, "7E5#1300000000000000"), "7E4#1300000000000000");
  EXPECT_EQ(ask(slave, "7E5#1300030000000000"), "7E4#1301000000000000") << "only 1 Mbit/s";
  EXPECT_EQ(ask(slave, "7E5#1700000000000000"), "none");
  EXPECT_TRUE(slave.take_store_request());
  slave.finish_store(true);
  EXPECT_EQ(std::string(to_text(*slave.next_frame()).view()), "7E4#1700000000000000");
  EXPECT_FALSE(slave.take_node_id());
  ask(slave, "7E5#0400000000000000");
  EXPECT_EQ(slave.take_node_id(), 5);
  EXPECT_FALSE(slave.take_node_id());
}

TEST(LssSlave, IsSelectedByItsWholeIdentityOnly) {
  LssSlave slave(kIdentity, 7);
  ask(slave, "7E5#40454E494B000000");
  ask(slave, "7E5#4102040000000000");
  ask(slave, "7E5#4200000100000000");
  EXPECT_EQ(ask(slave, "7E5#43EFBEADDE000000"), "7E4#4400000000000000");
  EXPECT_EQ(ask(slave, "7E5#5D00000000000000"), "7E4#5DEFBEADDE000000");
  ask(slave, "7E5#0400000000000000");
  ask(slave, "7E5#40454E494B000000");
  ask(slave, "7E5#4103040000000000");
  ask(slave, "7E5#4200000100000000");
  EXPECT_EQ(ask(slave, "7E5#43EFBEADDE000000"), "none");
  EXPECT_FALSE(slave.configuring());
}

TEST(LssSlave, AConfiguredNodeKeepsItsIdUntilReset) {
  LssSlave slave(kIdentity, 7);
  ask(slave, "7E5#0401000000000000");
  ask(slave, "7E5#1105000000000000");
  ask(slave, "7E5#0400000000000000");
  EXPECT_FALSE(slave.take_node_id());
  EXPECT_EQ(slave.active_node_id(), 7);
  slave.activate();
  EXPECT_EQ(slave.active_node_id(), 5);
}

TEST(LssSlave, AnswersIdentificationByRanges) {
  LssSlave slave(kIdentity, kUnconfiguredNodeId);
  EXPECT_EQ(ask(slave, "7E5#4C00000000000000"), "7E4#5000000000000000");
  ask(slave, "7E5#46454E494B000000");
  ask(slave, "7E5#4702040000000000");
  ask(slave, "7E5#4800000000000000");
  ask(slave, "7E5#49FFFFFFFF000000");
  ask(slave, "7E5#4A000000DE000000");
  EXPECT_EQ(ask(slave, "7E5#4BFFFFFFDE000000"), "7E4#4F00000000000000");
}

/// A master and nodes on a bus, in virtual time.
struct Bus {
  LssMaster master;
  std::vector<LssSlave> slaves;
  LocalTime now{0};
  int requests = 0;
  LssMaster::Status run() {
    while (master.status() == LssMaster::Status::kBusy) {
      bool moved = false;
      if (const auto frame = master.next_frame()) {
        moved = true;
        ++requests;
        for (auto& slave : slaves) slave.on_frame(*frame);
      }
      for (auto& slave : slaves)
        if (const auto frame = slave.next_frame()) {
          moved = true;
          master.on_frame(*frame);
        }
      if (moved) continue;
      now = master.next_deadline();
      master.on_time(now);
    }
    return master.status();
  }
};

TEST(Lss, FastscanFindsAndNumbersEveryNode) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    Bus bus;
    const unsigned count = 1 + seed % 4;
    for (unsigned i = 0; i < count; ++i)
      bus.slaves.emplace_back(LssIdentity{seed % 3 == 0 ? static_cast<std::uint32_t>(random()) : kIdentity[0],
                                          0x402, 0x10000, static_cast<std::uint32_t>(random())},
                              kUnconfiguredNodeId);
    for (std::uint8_t id = 1; id <= count; ++id) {
      bus.master.fastscan(bus.now);
      ASSERT_EQ(bus.run(), LssMaster::Status::kDone) << "seed " << seed;
      bus.master.inquire_identity(bus.now, 3);
      ASSERT_EQ(bus.run(), LssMaster::Status::kDone);
      EXPECT_EQ(bus.master.value(), bus.master.identity()[3]);
      bus.master.configure_node_id(bus.now, id);
      ASSERT_EQ(bus.run(), LssMaster::Status::kDone);
      bus.master.switch_all(bus.now, false);
      bus.run();
    }
    bus.master.fastscan(bus.now);
    EXPECT_EQ(bus.run(), LssMaster::Status::kNotFound);
    unsigned ids = 0;
    for (auto& slave : bus.slaves) ids |= 1u << slave.take_node_id().value_or(0);
    EXPECT_EQ(ids, (2u << count) - 2u) << "each id once";
    EXPECT_LE(bus.requests, static_cast<int>(count) * 140);
  }
}

TEST(Lss, SelectTellsWhoIsNotThere) {
  Bus bus;
  bus.slaves.emplace_back(kIdentity, 4);
  bus.master.select(bus.now, kIdentity);
  EXPECT_EQ(bus.run(), LssMaster::Status::kDone);
  bus.master.configure_node_id(bus.now, 200);
  EXPECT_EQ(bus.run(), LssMaster::Status::kRefused);
  EXPECT_EQ(bus.master.error_code(), 1);
  bus.master.inquire_node_id(bus.now);
  EXPECT_EQ(bus.run(), LssMaster::Status::kDone);
  EXPECT_EQ(bus.master.value(), 4u);
  bus.master.switch_all(bus.now, false);
  bus.run();
  bus.master.select(bus.now, {1, 2, 3, 4});
  EXPECT_EQ(bus.run(), LssMaster::Status::kNotFound);
  bus.master.store(bus.now);
  EXPECT_EQ(bus.run(), LssMaster::Status::kTimeout);
}

}  // namespace
}  // namespace kinebus
