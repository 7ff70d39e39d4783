// The Octopus as four nodes with eight axes: ids, homing, streams, stops, and what all of them cost together.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "protocol/canopen/alarm_codes.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"
#include "protocol/canopen/lss.hpp"
#include "vcan_tests/emulator/tests/octopus_drivers.hpp"

namespace kinebus::emulator {
namespace {

constexpr int kAxes = 8, kNodes = 4;

TEST(OctopusNodes, FiveAnswerByIdsInARowAndSayWhoTheyAre) {
  OneOctopus octopus;
  octopus.bench.run(1s);
  std::array<std::int64_t, kNodes> serial{};
  for (int n = 0; n < kNodes; ++n) {
    const auto id = static_cast<std::uint8_t>(kId + n);
    EXPECT_EQ(octopus.bench.read(id, 0x1018, 2), Stm32f446OctopusBoard::kFacts.product_code);
    serial[static_cast<std::size_t>(n)] = octopus.bench.read(id, 0x1018, 4);
    EXPECT_EQ(serial[static_cast<std::size_t>(n)], serial[0] + n);
    EXPECT_NE(octopus.bench.last(0x700u + id), nullptr) << "heartbeat of node " << int{id};
  }
  const auto heat = static_cast<std::uint8_t>(kId + kNodes);
  EXPECT_EQ(octopus.bench.read(heat, 0x1018, 2), HeatBoard::kFacts.product_code);
  EXPECT_EQ(octopus.bench.read(heat, 0x1018, 4), serial[0] + kNodes);
  EXPECT_EQ(octopus.bench.last(0x700u + heat + 1u), nullptr);
}

// An id that leaves no room for the others is refused; a new one takes them along.
TEST(OctopusNodes, AllFollowTheIdThatTheFirstIsGiven) {
  OneOctopus octopus;
  const auto ask = [&](std::initializer_list<std::uint8_t> bytes) {
    CanFrame frame{.id = 0x7E5, .length = 8};
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    const std::size_t before = octopus.bench.seen.size();
    octopus.bench.send(frame);
    octopus.bench.run(5ms);
    std::vector<CanFrame> replies;
    for (std::size_t i = before; i < octopus.bench.seen.size(); ++i)
      if (octopus.bench.seen[i].frame.id == 0x7E4) replies.push_back(octopus.bench.seen[i].frame);
    return replies;
  };
  EXPECT_TRUE(ask({lss::kSwitchGlobal, 1}).empty());
  auto reply = ask({lss::kConfigureNodeId, 124});
  ASSERT_EQ(reply.size(), 1u) << "one LSS slave on the board";
  EXPECT_EQ(reply[0].data[1], 1) << "refused: 124 to 128";
  reply = ask({lss::kConfigureNodeId, 123});
  ASSERT_EQ(reply.size(), 1u);
  EXPECT_EQ(reply[0].data[1], 0);
  EXPECT_TRUE(ask({lss::kSwitchGlobal, 0}).empty());
  octopus.bench.send(nmt_frame(NmtCommand::kResetCommunication, kId));
  octopus.bench.run(700ms);
  const std::size_t from = octopus.bench.seen.size();
  octopus.bench.run(1s);
  std::set<std::uint32_t> heard;
  for (std::size_t i = from; i < octopus.bench.seen.size(); ++i)
    if ((octopus.bench.seen[i].frame.id & 0x780) == 0x700) heard.insert(octopus.bench.seen[i].frame.id);
  EXPECT_EQ(heard, (std::set<std::uint32_t>{0x77B, 0x77C, 0x77D, 0x77E, 0x77F}));
}

// Plans reach 8.2 ms and are made anew at half of it: no pass of the main loop, whatever it is told, takes so
// long. What is before the first plan does not count: nothing can move then.
TEST(OctopusNodes, NoPassOfTheMainLoopTakesHalfAPlan) {
  OneOctopus octopus;
  const auto longest_ms = [&] {
    const double ms = seconds_of(octopus.board.cpu().longest_pass()) * 1e3;
    octopus.board.cpu().clear_costs();
    return ms;
  };
  const auto lss = [&](std::uint8_t command, std::uint8_t value) {
    octopus.bench.send({.id = 0x7E5, .length = 8, .data = {command, value}});
    octopus.bench.run(5ms);
  };
  longest_ms();
  lss(lss::kSwitchGlobal, 1);
  lss(lss::kConfigureNodeId, 40);
  lss(lss::kSwitchGlobal, 0);
  octopus.bench.send(nmt_frame(NmtCommand::kResetCommunication, kId));
  octopus.bench.run(100ms);
  const double moved = longest_ms();
  octopus.bench.bring_up({40, 41, 42, 43});
  const double brought_up = longest_ms();
  octopus.bench.send(nmt_frame(NmtCommand::kResetNode, kAllNodes));
  octopus.bench.run(100ms);
  const double reset = longest_ms();
  fmt::print("new id {:.1f} ms, bring-up {:.1f} ms, reset of all {:.1f} ms\n", moved, brought_up, reset);
  for (const double ms : {moved, brought_up, reset}) EXPECT_LT(ms, 4);
}

// The switch beside each driver is one of its node's first two inputs.
TEST(OctopusNodes, AllEightAxesHomeByTheirSwitchesAndMove) {
  BoardOptions options;
  for (int axis = 0; axis < kAxes; ++axis)
    options.axes[static_cast<std::size_t>(axis)] = {.start_counts = 10'000.0 * axis,
                                                    .switch_input = axis + 1,
                                                    .switch_counts = 10'000.0 * axis + 7'000 + 999 * axis};
  OneOctopus octopus(options);
  for (int axis = 0; axis < kAxes; ++axis) {
    octopus.write(axis, 0x6098, 0, 1, 20);
    octopus.enable(axis, 6);
  }
  for (int axis = 0; axis < kAxes; ++axis) octopus.write(axis, 0x6040, 0, 2, 0x1F);
  for (int i = 0; i < 40; ++i) {
    octopus.bench.run(100ms);
    std::uint16_t all = 0xFFFF;
    for (int axis = 0; axis < kAxes; ++axis) all &= octopus.statusword(axis);
    if ((all & 0x1400) == 0x1400) break;
  }
  for (int axis = 0; axis < kAxes; ++axis) {
    EXPECT_EQ(octopus.statusword(axis) & 0x3400, 0x1400) << "axis " << axis << " homed";
    const double beyond =
        octopus.board.true_counts(axis) - options.axes[static_cast<std::size_t>(axis)].switch_counts;
    EXPECT_NEAR(static_cast<double>(octopus.read(axis, 0x6064)), beyond, 1.5 * OctopusBoard::kCountsPerStep);
  }
  std::array<std::int64_t, kAxes> before{};
  for (int axis = 0; axis < kAxes; ++axis) {
    before[static_cast<std::size_t>(axis)] =
        octopus.read(axis, 0x6064) - 16 * octopus.board.driver(axis).steps();
    octopus.enable(axis, 1);
    octopus.move(axis, 16'000 * (axis - 4), 200'000, 3'200'000);
  }
  octopus.bench.run(600ms);
  for (int axis = 0; axis < kAxes; ++axis) {
    EXPECT_EQ(octopus.read(axis, 0x6064), 16'000 * (axis - 4));
    EXPECT_LE(std::abs(octopus.board.driver(axis).steps() * 16 + before[static_cast<std::size_t>(axis)] -
                       16'000 * (axis - 4)),
              16);
  }
  octopus.expect_good_drivers();
}

/// A stream to each node at rate 1, and where it is at each of the processor's cycles.
struct Streamed {
  Streamed() {
    node.bench.bring_up({kId, kId + 1, kId + 2, kId + 3});
    for (std::uint8_t n = 0; n < kNodes; ++n) {
      feeds[n].id = static_cast<std::uint8_t>(kId + n);
      node.bench.write(feeds[n].id, 0x2115, 0, 2, 5);
    }
    for (int axis = 0; axis < kAxes; ++axis) {
      node.write(axis, 0x607F, 0, 4, 3'200'000);
      node.enable(axis, 7);
    }
    debug_path_time = octopus_image().symbol("debug_path_time").value_or(0);
    node.board.cpu().clear_costs();
  }
  StreamFeed& feed(int axis) { return feeds[static_cast<std::size_t>(axis / 2)]; }
  std::int64_t path_ticks(Cycle at) {
    const Cycle now = node.board.now();
    const auto counts =
        node.board.local_counts(now) - static_cast<std::uint32_t>((now - at) / kCyclesPerLocalCount);
    return static_cast<std::int64_t>(node.board.cpu().call(debug_path_time, counts).value_or(0));
  }
  double place(int axis, std::int64_t ticks) {
    return static_cast<double>(feed(axis).position(axis % 2, ticks)) / kCount;
  }
  double place(int axis, Cycle at) { return place(axis, path_ticks(at)); }
  /// How far an edge is from when the stream is at its border, microseconds; 99: more than 2.
  double off_us(int axis, const StepDriver::Edge& edge) {
    const double border =
        (static_cast<double>(edge.after) + (edge.up ? -0.5 : 0.5)) * OctopusBoard::kCountsPerStep;
    // 16 ticks of path time are a microsecond at rate 1.
    const std::int64_t ticks = path_ticks(edge.at);
    for (int quarter = 1; quarter <= 8; ++quarter) {
      const double a = place(axis, ticks - 4 * quarter), b = place(axis, ticks + 4 * quarter);
      // The plan's parabolas are within a tenth of a count of the motion.
      if (std::min(a, b) - 0.1 <= border && border <= std::max(a, b) + 0.1) return 0.25 * quarter;
    }
    return 99;
  }

  OneOctopus node;
  std::array<StreamFeed, kNodes> feeds;
  std::uint32_t debug_path_time = 0;
};

TEST(OctopusNodes, StreamsAreExactToTheStepAndAllEdgesWithinTwoMicroseconds) {
  Streamed s;
  s.node.bench.rate(1);
  s.node.bench.run(300ms);
  const std::int64_t start = s.node.bench.read_long(kId, 0x2112) / kPathTicksPerUnit + 62'500;
  // To and fro, each axis in its own way.
  for (int n = 0; n < kNodes; ++n) {
    StreamFeed& feed = s.feeds[static_cast<std::size_t>(n)];
    s.node.bench.send(feed.start(start));
    for (int i = 0; i < 8; ++i)
      for (const int sign : {1, -1, -1, 1})
        s.node.bench.send(
            feed.segment(1250, sign * (1'912'345 - 300'000 * n), -sign * (954'321 + 111'111 * n)));
    s.node.bench.send(feed.end());
  }
  double worst_us = 0;
  std::size_t edges = 0, turns = 0;
  std::array<std::int64_t, kAxes> farthest{};
  std::array<bool, kAxes> up{};
  s.node.bench.run(1900ms, 1ms, [&] {
    for (int axis = 0; axis < kAxes; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const StepDriver& driver = s.node.board.driver(axis);
      const Cycle now = s.node.board.now();
      const double early = s.place(axis, now - 2 * kMicrosecond), late = s.place(axis, now);
      EXPECT_GE(driver.steps(), std::min(nearest_step(early - 0.1), nearest_step(late - 0.1)));
      EXPECT_LE(driver.steps(), std::max(nearest_step(early + 0.1), nearest_step(late + 0.1)));
      farthest[a] = std::max(farthest[a], std::abs(driver.steps()));
      for (const StepDriver::Edge& edge : driver.edges()) {
        ++edges;
        turns += edge.up != up[a] ? 1 : 0;
        up[a] = edge.up;
        const double off = s.off_us(axis, edge);
        EXPECT_LE(off, 2) << "axis " << axis << ", step " << edge.after;
        worst_us = std::max(worst_us, off);
      }
    }
    s.node.board.clear_edges();
  });
  for (int axis = 0; axis < kAxes; ++axis) {
    EXPECT_EQ(
        s.node.board.driver(axis).steps(),
        nearest_step(static_cast<double>(s.feed(axis).state[static_cast<std::size_t>(axis % 2)].position) /
                     kCount));
    EXPECT_GT(farthest[static_cast<std::size_t>(axis)], 100);
  }
  fmt::print("{} steps, {} turns: each within {:.2f} us of its time; main loop {:.1f} ms at most\n", edges,
             turns, worst_us, seconds_of(s.node.board.cpu().longest_pass()) * 1e3);
  EXPECT_GT(edges, 20'000u);
  EXPECT_GT(turns, 32u);
  s.node.expect_good_drivers();
  for (std::uint8_t n = 0; n < kNodes; ++n) EXPECT_TRUE(s.node.bench.emergencies(kId + n).empty());
}

// A controller does not hear what it sends: the other nodes of the board are told by the board.
TEST(OctopusNodes, AStopOfOneStopsTheOthers) {
  OneOctopus octopus;
  octopus.bench.bring_up({kId, kId + 1, kId + 2, kId + 3});
  // Input 3 of the last node, STOP0: an emergency stop, which pulls it low.
  octopus.board.set_input(0, true);
  octopus.bench.write(kId + 3, 0x2131, 3, 1, 1);
  octopus.bench.write(kId + 3, 0x2130, 3, 1, static_cast<int>(SwitchFunction::kEmergencyStop));
  for (const int axis : {0, 2, 5}) {
    octopus.write(axis, 0x607F, 0, 4, 400'000);
    octopus.enable(axis, 1);
  }
  for (const int axis : {0, 2, 5}) octopus.move(axis, 4'000'000, 400'000, 3'200'000);
  octopus.bench.run(300ms);
  for (const int axis : {0, 2, 5})
    EXPECT_GT(octopus.board.driver(axis).steps(), 1'000) << "axis " << axis << " moves";
  const std::size_t from = octopus.bench.seen.size();
  octopus.board.set_input(0, false);
  octopus.bench.run(300ms);
  EXPECT_FALSE(octopus.bench.emergencies(kId + 3, from).empty());
  octopus.board.clear_edges();
  octopus.bench.run(200ms);
  for (const int axis : {0, 2, 5}) {
    EXPECT_TRUE(octopus.board.driver(axis).edges().empty()) << "axis " << axis << " stands";
    EXPECT_TRUE(octopus.board.driver(axis).enabled());
    EXPECT_LT(octopus.board.driver(axis).steps(), 250'000);
  }
}

// Six axes as fast as they go, the two others at rest with power, and a stranger who talks all the time.
TEST(OctopusNodes, SixAxesMakeTwoHundredThousandStepsASecondEach) {
  OneOctopus octopus;
  for (int axis = 0; axis < kAxes; ++axis) {
    octopus.write(axis, 0x607F, 0, 4, 3'200'000);
    octopus.enable(axis, 1);
  }
  const auto way = [](int axis) { return (axis % 2 == 0 ? 1 : -1) * (axis < 6 ? 1'600'000 : 0); };
  for (int axis = 0; axis < kAxes; ++axis) octopus.move(axis, way(axis), 3'200'000, 32'000'000);
  const OctopusLoad load = load_of(octopus, strangers_on(octopus));
  octopus.bench.run(800ms);
  double most = 0;  // steps/s of all in 5 ms
  std::vector<Cycle> all;
  for (int axis = 0; axis < kAxes; ++axis) {
    const auto& edges = octopus.board.driver(axis).edges();
    double fastest = 0;
    for (std::size_t i = 1000; i < edges.size(); ++i)
      fastest = std::max(fastest, 1e3 / seconds_of(edges[i].at - edges[i - 1000].at));
    if (axis < 6) {
      EXPECT_NEAR(fastest, 200'000, 1'000) << "axis " << axis;
    }
    for (const auto& edge : edges) all.push_back(edge.at);
    EXPECT_EQ(octopus.board.driver(axis).steps(), way(axis) / 16) << "axis " << axis;
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 5000; i < all.size(); ++i)
    most = std::max(most, 5e3 / seconds_of(all[i] - all[i - 5000]));
  fmt::print(
      "{:.0f} steps/s of all; control interrupt {:.0f} cycles of {:.0f} ({:.1f} %), {:.0f} at most ({:.1f} "
      "%); "
      "processor awake {:.0f} %, main loop {:.1f} ms at most\n",
      most, load.control * kControlPeriod, kControlPeriod, 100 * load.control,
      load.worst_control * kControlPeriod, 100 * load.worst_control, 100 * load.awake, load.longest_pass_ms);
  EXPECT_GT(most, 1'150'000);
  expect_within_budget(load);
  octopus.expect_good_drivers();
  for (std::uint8_t n = 0; n < kNodes; ++n) {
    EXPECT_TRUE(octopus.bench.emergencies(kId + n).empty());
    EXPECT_EQ(octopus.bench.read(kId + n, 0x2120, 2), 0) << "receive overruns";
  }
}

// While flash is written the processor stands still: only when no motor of the board has power.
TEST(OctopusNodes, EachKeepsItsParametersAndNoneIsWrittenWhileAnotherHasPower) {
  OneOctopus octopus({}, &make_board<OctopusBoard>, true);
  octopus.write(0, 0x6081, 0, 4, 11'111);
  octopus.write(5, 0x6081, 0, 4, 22'222);
  octopus.enable(2, 1);
  constexpr std::int64_t kSave = 0x65766173;
  EXPECT_EQ(octopus.bench.try_write(kId + 2, 0x1010, 1, 4, kSave), 0x0800'0022u);
  octopus.write(2, 0x6040, 0, 2, 0);
  octopus.bench.run(50ms);
  for (const std::uint8_t n : {std::uint8_t{0}, std::uint8_t{2}}) {
    octopus.bench.send(CanFrame::make(0x600u + kId + n, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
    octopus.bench.run(3s);
  }
  octopus.machine.power_cycle(0);
  octopus.bench.run(octopus.board.boot_time() + 200ms);
  EXPECT_EQ(octopus.board.watchdog_resets(), 0u);
  EXPECT_EQ(octopus.read(0, 0x6081), 11'111);
  EXPECT_EQ(octopus.read(5, 0x6081), 22'222);
  EXPECT_NE(octopus.read(2, 0x6081), 22'222);
}

}  // namespace
}  // namespace kinebus::emulator
