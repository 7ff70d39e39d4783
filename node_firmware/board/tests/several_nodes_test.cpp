// Several nodes of a board behind one CAN controller, one clock and one flash.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "node_firmware/board/node_images.hpp"
#include "node_firmware/board/node_program.hpp"
#include "node_firmware/board/tests/fake_drivers.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

struct SeveralNodes : testing::Test {
  SeveralNodes() {
    program.begin(1, options(6), {}, plans[1], kPlaces);
    run(20ms);
  }
  NodeOptions options(std::uint8_t id) { return {.node_id = id, .id_from_board = id != 5}; }
  void run(LocalTime time) {
    for (LocalTime t{0}; t < time; t += 500us) {
      fake::pass_time(500us);
      program.pass();
    }
  }
  int said(std::uint32_t id) {
    return static_cast<int>(std::ranges::count(can.sent, id, [](const CanFrame& f) { return f.id; }));
  }

  /// The board's input 1 is the second node's first.
  static constexpr std::array<std::int8_t, 2> kPlaces{-1, 0};
  fake::Can can;
  fake::Switches switches;
  std::array<MotionPlanExchange, 2> plans;
  NodeProgram<fake::Can, fake::Switches, fake::Counter, 2> program{options(5), {}, can, switches, plans[0]};
};

TEST_F(SeveralNodes, EachAnswersUnderItsIdAndHearsWhatIsItsOwn) {
  for (const std::uint32_t id : {0x705u, 0x706u})
    EXPECT_EQ(std::ranges::count(can.sent, CanFrame::make(id, {0})), 1) << "boot-up of " << std::hex << id;
  for (const int id : {0x000, 0x080, 0x7E5, 0x605, 0x606, 0x205, 0x206})
    EXPECT_TRUE(can.heard(id)) << std::hex << id;
  EXPECT_FALSE(can.heard(0x607));
  for (std::size_t i = 0; i < can.accepted.size(); ++i)
    EXPECT_EQ(std::ranges::count(can.accepted, can.accepted[i]), 1) << "told to the controller once";
  can.sent.clear();
  can.arrive(CanFrame::make(0x606, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0}));
  run(2ms);
  EXPECT_EQ(said(0x586), 1);
  EXPECT_EQ(said(0x585), 0);
  program.end(1);
  run(20ms);
  EXPECT_FALSE(can.heard(0x606));
}

TEST_F(SeveralNodes, WhatOneSaysTheOtherHears) {
  // Node 6 watches the heartbeat of node 5, 100 ms; nothing of it comes from the bus.
  can.arrive(CanFrame::make(0x606, {0x23, 0x16, 0x10, 1, 100, 0, 5, 0}));
  can.arrive(CanFrame::make(0x605, {0x2B, 0x17, 0x10, 0, 50, 0, 0, 0}));
  run(1s);
  EXPECT_FALSE(can.told(0x8130));
  can.arrive(CanFrame::make(0x605, {0x2B, 0x17, 0x10, 0, 0, 0, 0, 0}));
  run(300ms);
  EXPECT_TRUE(can.told(0x8130)) << "now it is missed";
}

TEST_F(SeveralNodes, AnEdgeIsThoseNodesInputsThatItIsWiredTo) {
  for (const int id : {0x605, 0x606})
    can.arrive(CanFrame::make(static_cast<std::uint32_t>(id), {0x2B, 0x32, 0x21, 1, 0, 0, 0, 0}));
  run(2ms);
  switches.in.push_back({fake::Counter::now, 1, true});
  run(5ms);
  const auto active = [&](std::uint32_t id) {
    can.sent.clear();
    can.arrive(CanFrame::make(0x600 + id, {0x40, 0x33, 0x21, 0, 0, 0, 0, 0}));
    run(2ms);
    for (const CanFrame& frame : can.sent)
      if (frame.id == 0x580 + id) return static_cast<int>(frame.data[4]);
    return -1;
  };
  EXPECT_EQ(active(6), 1) << "its first";
  EXPECT_EQ(active(5), 2) << "the second of the node that has them all";
  // A node that begins later knows the level.
  program.begin(1, options(6), {}, plans[1], kPlaces);
  run(5ms);
  EXPECT_EQ(active(6), 1);
}

TEST_F(SeveralNodes, TheirCommonClockCountsASyncAndAStampOnce) {
  for (const int id : {0x605, 0x606})
    can.arrive(CanFrame::make(static_cast<std::uint32_t>(id), {0x2F, 0x19, 0x10, 0, 240, 0, 0, 0}));
  can.arrive(CanFrame::make(0x000, {1, 0}));
  run(5ms);
  for (std::uint8_t n = 1; n <= 40; ++n) {
    const BusTime at = program.now() + 1h;
    can.arrive(CanFrame::make(0x080, {n}));
    can.arrive(encode(SyncStamp{.counter = n, .epoch = 1, .time = at}), fake::Counter::now + 400);
    run(20ms);
  }
  const ClockEstimate& clock = program.node(0).path().clock();
  EXPECT_EQ(clock.counters().stamps_used, 40u);
  EXPECT_EQ(clock.counters().stamps_unmatched, 0u);
  EXPECT_EQ(clock.counters().syncs_doubled, 0u);
  EXPECT_EQ(&program.node(1).path().clock(), &clock);
  for (const std::size_t i : {0, 1}) EXPECT_TRUE(program.node(i).path().clock().synchronised());
}

struct Flash final : FlashPages {
  std::array<std::array<std::uint8_t, 4096>, 2> pages{};
  Flash() {
    for (auto& page : pages) page.fill(0xFF);
  }
  std::span<const std::uint8_t> page(std::size_t which) const override { return pages[which]; }
  bool erase(std::size_t which) override {
    pages[which].fill(0xFF);
    return true;
  }
  bool program(std::size_t which, std::uint32_t offset, std::uint32_t word) override {
    put_u32_le(std::span(pages[which]).subspan(offset), word);
    return true;
  }
};

TEST(NodeImages, EachNodesImageStaysWhenAnotherIsSaved) {
  Flash flash;
  PageStore store(flash);
  const std::vector<std::uint8_t> alone(21, 7);
  store.load();
  ASSERT_TRUE(store.save(alone));
  const NodeImages<3> images(store);
  const auto is = [&](std::size_t number, std::size_t length, std::uint8_t value) {
    const auto image = images.load()[number];
    return image.size() == length && std::ranges::all_of(image, [&](std::uint8_t b) { return b == value; });
  };
  EXPECT_TRUE(is(0, 21, 7)) << "of a board with one node";
  EXPECT_TRUE(is(1, 0, 0));
  // Until both pages have been full several times.
  for (int round = 0; round < 60; ++round) {
    const auto value = static_cast<std::uint8_t>(round);
    const std::vector<std::uint8_t> image(100 + static_cast<std::size_t>(round), value);
    ASSERT_TRUE(images.save(static_cast<std::size_t>(round % 2 + 1), image));
    EXPECT_TRUE(is(0, 21, 7));
    EXPECT_TRUE(is(static_cast<std::size_t>(round % 2 + 1), image.size(), value));
    if (round > 0) {
      EXPECT_TRUE(is(static_cast<std::size_t>((round + 1) % 2 + 1), image.size() - 1,
                     static_cast<std::uint8_t>(value - 1)));
    }
  }
}

}  // namespace
}  // namespace kinebus
