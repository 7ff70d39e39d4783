// Filament sensors: the rule apart, and on the node with filament that runs out, jams and slips.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "node_firmware/heat/filament_watch.hpp"
#include "node_firmware/heat/tests/heat_node_bench.hpp"

namespace kinebus::heat {
namespace {

/// An extruder whose place the master tells every 0.1 s, and the plant's filament behind it.
struct Feed {
  explicit Feed(FilamentSettings settings = {.kind = FilamentKind::kMotion}) { watch.configure(settings); }
  /// 0.1 s.
  void move(double mm) {
    for (int i = 0; i < 10; ++i) {
      mm_at += mm / 10;
      plant.step(mm_at);
      watch.on_sample(plant.level(), plant.take_edges());
    }
    watch.on_commanded(
        static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(1000 * mm_at)) + 0x7FFF'0000u));
  }
  /// mm until it is out of order; `most`: not within so many.
  double until_known(double mm_per_move, double most) {
    const double from = mm_at;
    while (watch.state() == FilamentState::kInOrder && mm_at - from < most) move(mm_per_move);
    return mm_at - from;
  }
  FilamentWatch watch;
  FilamentPlant plant;
  double mm_at = 0;
};

TEST(Filament, WhatGoesAsItShouldIsInOrderThroughAnyRetractions) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    Feed feed;
    const double speed = 0.02 + 1.5 * unit(random) * unit(random), back = 0.2 + 6 * unit(random);
    while (feed.mm_at < 3000 * speed) {
      for (double t = unit(random) * 30; t > 0; --t) feed.move(speed);
      feed.move(-back);
      feed.move(back);
      ASSERT_EQ(feed.watch.state(), FilamentState::kInOrder) << seed << ": " << feed.mm_at;
    }
  }
}

TEST(Filament, AJamIsKnownWithinItsLengthAndTwoEdges) {
  for (const double speed : {0.05, 0.3, 1.0})
    for (double phase = 0; phase < 6; phase += 0.37) {
      Feed feed;
      while (feed.mm_at < 40 + phase) feed.move(speed);
      feed.plant.share = 0;
      EXPECT_LE(feed.until_known(speed, 100), 7 + 2 * 2.93 + speed) << phase;
      EXPECT_EQ(feed.watch.state(), FilamentState::kStands);
    }
}

TEST(Filament, AJamAmongRetractionsIsKnownToo) {
  Feed feed;
  while (feed.mm_at < 40) feed.move(0.5);
  feed.plant.share = 0;
  double fed = 0;
  while (feed.watch.state() == FilamentState::kInOrder && fed < 100) {
    feed.move(0.5);
    fed += 0.5;
    feed.move(-1);
    feed.move(1);
  }
  EXPECT_LE(fed, 7 + 2 * 2.93 + 0.5);
}

TEST(Filament, WhatSlipsIsKnownWithinOneAndAQuarterWindows) {
  for (double phase = 0; phase < 9; phase += 0.9) {
    Feed feed({.kind = FilamentKind::kMotion, .um_per_edge = 2880, .stands_um = 20'000});
    while (feed.mm_at < 60 + phase) feed.move(0.3);
    feed.plant.share = 0.35;
    EXPECT_LE(feed.until_known(0.3, 200), 1.25 * 30 + 0.3) << phase;
    EXPECT_EQ(feed.watch.state(), FilamentState::kSlips);
  }
}

TEST(Filament, WhatAWheelHasToldStaysUntilItIsReset) {
  Feed feed;
  feed.plant.share = 0;
  static_cast<void>(feed.until_known(0.5, 100));
  feed.plant.share = 1;
  for (int i = 0; i < 100; ++i) feed.move(0.5);
  EXPECT_EQ(feed.watch.state(), FilamentState::kStands);
  feed.watch.reset();
  EXPECT_GE(feed.until_known(0.5, 200), 199.9);
}

TEST(Filament, ASwitchIsBelievedAfterItHasSettled) {
  for (const bool inverted : {false, true}) {
    FilamentWatch watch;
    watch.configure({.kind = FilamentKind::kSwitch, .inverted = inverted});
    const bool there = !inverted;
    for (int i = 0; i < 10; ++i) watch.on_sample(there, 0);
    for (int i = 0; i < 4; ++i) watch.on_sample(!there, 0);
    EXPECT_EQ(watch.state(), FilamentState::kInOrder);
    watch.on_sample(there, 0);
    for (int i = 0; i < 5; ++i) watch.on_sample(!there, 0);
    EXPECT_EQ(watch.state(), FilamentState::kOut);
    for (int i = 0; i < 5; ++i) watch.on_sample(there, 0);
    EXPECT_EQ(watch.state(), FilamentState::kInOrder) << "put in again";
  }
}

class FilamentOnTheNode : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(bench.write({0x2250, 1}, 1, 1), 0u);
    ASSERT_EQ(bench.write({0x2250, 2}, 2, 1), 0u);
    bench.set_up();
  }
  /// The master's word and the gears, `seconds` at `mm_per_s`.
  void feed(double seconds, double mm_per_s) {
    for (int i = 0; i < static_cast<int>(seconds * 10 + 0.5); ++i) {
      at += 0.1 * mm_per_s;
      bench.plant.turn_extruder(at);
      bench.run(0.1);
      CanFrame frame{.id = 0x400u + HeatNodeBench::kId, .length = 8};
      const auto um = static_cast<std::uint32_t>(std::llround(1000 * at));
      put_u32_le(frame.data, um);
      put_u32_le(std::span(frame.data).subspan(4), um);
      bench.send(frame);
    }
  }
  /// As TPDO1 has told it last.
  int told(int sensor) const {
    int state = -1;
    for (const CanFrame& frame : bench.seen)
      if (frame.id == 0x180u + HeatNodeBench::kId) state = frame.data[static_cast<std::size_t>(4 + sensor)];
    return state;
  }
  HeatNodeBench bench;
  double at = 0;
};

TEST_F(FilamentOnTheNode, TellsAtOnceWhatItFinds) {
  feed(20, 4);
  EXPECT_EQ(told(1), 0);
  EXPECT_EQ(told(2), 0);
  EXPECT_NEAR(static_cast<std::int32_t>(*bench.read({0x2257, 2})) / 1000.0, 80, 4);
  ASSERT_EQ(bench.plant.command("filament out"), "");
  feed(0.2, 4);
  EXPECT_EQ(told(1), 1);
  ASSERT_EQ(bench.plant.command("filament ok"), "");
  feed(1, 4);
  EXPECT_EQ(told(1), 0);
  ASSERT_EQ(bench.plant.command("filament jammed"), "");
  feed(4, 4);
  EXPECT_EQ(told(2), 2);
  ASSERT_EQ(bench.plant.command("filament slips"), "");
  ASSERT_EQ(bench.write({0x2259, 2}, 1, 1), 0u);
  feed(12, 4);
  EXPECT_EQ(told(2), 3);
  ASSERT_EQ(bench.plant.command("filament ok"), "");
  ASSERT_EQ(bench.write({0x2259, 2}, 1, 1), 0u);
  feed(20, 4);
  EXPECT_EQ(told(2), 0);
}

TEST_F(FilamentOnTheNode, RefusesWhatNoSensorIsLikeAndSettingsInOperation) {
  EXPECT_EQ(bench.write({0x2250, 1}, 0, 1), 0x0800'0022u) << "in operation";
  bench.nmt(NmtCommand::kEnterPreOperational);
  EXPECT_EQ(bench.write({0x2250, 1}, 3, 1), 0x0609'0031u);
  EXPECT_EQ(bench.write({0x2252, 2}, 0, 4), 0x0609'0032u);
  EXPECT_EQ(bench.write({0x2259, 2}, 2, 1), 0x0609'0031u);
}

}  // namespace
}  // namespace kinebus::heat
