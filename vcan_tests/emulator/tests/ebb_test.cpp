// The EBB's image on its emulated board: comes up, joins the bus, moves; its steps are judged at the driver's
// pins.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/tests/ebb_bench.hpp"

namespace kinebus::emulator {
namespace {

constexpr double kCount = 4294967296.0;
constexpr Cycle kCyclesPerLocalCount = kMicrosecond / 4;
constexpr int kReceive = kFirstInterrupt + 21;

std::int64_t nearest_step(double counts) {
  return static_cast<std::int64_t>(std::floor(counts / EbbBoard::kCountsPerStep + 0.5));
}

TEST(Ebb, SetsItsClockTreeAndTouchesNothingWithoutItsClock) {
  OneEbb node;
  EXPECT_EQ(node.board.rcc().system_hz(), 64'000'000u);
  EXPECT_EQ(node.board.flash().wait_states(), 2u);
  EXPECT_EQ(node.board.can().bit_rate(), 1'000'000u);
  EXPECT_GE(node.board.can().sample_point(), 0.75);
  EXPECT_LE(node.board.can().sample_point(), 0.88);
  EXPECT_TRUE(node.board.strange_accesses().empty()) << std::hex << node.board.strange_accesses().front();
  EXPECT_TRUE(node.board.lost_accesses().empty()) << std::hex << node.board.lost_accesses().front();
  EXPECT_FALSE(node.board.anything_on());
  EXPECT_EQ(node.board.resets(), 0u);
  EXPECT_EQ(node.board.can().counters().overruns, 0u);
}

// The pins of another chip may be wired to anything, a heater among them.
TEST(Ebb, OnAnotherChipItDrivesNothingAndSaysSo) {
  OneEbb node({}, [](const ElfImage& image, const BoardOptions& options) -> std::unique_ptr<Chip> {
    return std::make_unique<EbbBoard>(image, options, EbbBoard::kG071);
  });
  EXPECT_EQ(node.board.outputs(), 0);
  node.write(0x6060, 0, 1, 1);
  for (const int word : {0x06, 0x07}) node.write(0x6040, 0, 2, word);
  node.bench.run(50ms);
  EXPECT_EQ(node.bench.statusword(kId, 0) & 0x4F, 0x08) << "fault";
  const auto codes = node.bench.emergencies(kId);
  ASSERT_EQ(codes.size(), 1u);
  EXPECT_EQ(codes[0], emcy::kOtherBoard);
  node.bench.run(300ms);
  EXPECT_EQ(node.board.outputs(), 0);
  EXPECT_EQ(node.board.resets(), 0u);
}

TEST(Ebb, TheSecondAxisIsNotThere) {
  OneEbb node;
  node.write(0x6860, 0, 1, 1);
  for (const int word : {0x06, 0x07}) node.write(0x6840, 0, 2, word);
  node.bench.run(50ms);
  EXPECT_EQ(node.bench.statusword(kId, 1) & 0x4F, 0x08) << "fault";
  const auto codes = node.bench.emergencies(kId);
  ASSERT_EQ(codes.size(), 1u);
  EXPECT_EQ(codes[0], emcy::kNoMotor);
  EXPECT_FALSE(node.board.anything_on());
}

TEST(Ebb, MovesToTheStepAndPowerIsTheDrivers) {
  OneEbb node;
  node.bench.enable(kId, 0, 1);
  EXPECT_TRUE(node.board.driver().enabled());
  for (const int target : {48'000, -32'000}) {
    node.bench.move(kId, 0, target, 400'000, 6'400'000);
    node.bench.run(400ms);
    EXPECT_TRUE(node.bench.reached(kId, 0));
    EXPECT_EQ(node.read(0x6064), target);
    EXPECT_EQ(node.board.driver().steps(), target / 16);
  }
  node.expect_good_driver();
  EXPECT_TRUE(node.bench.emergencies(kId).empty());
  node.write(0x6040, 0, 2, 0);
  node.bench.run(20ms);
  EXPECT_FALSE(node.board.driver().enabled());
}

/// Profile position: what is made of a move, and what it takes.
void expect_profile(std::int64_t counts, std::int64_t counts_per_s, std::int64_t counts_per_s2,
                    LocalTime time, double steps_per_s, double within) {
  OneEbb node;
  node.write(0x607F, 0, 4, 3'200'000);
  node.bench.enable(kId, 0, 1);
  node.board.cpu().clear_costs();
  node.bench.move(kId, 0, counts, counts_per_s, counts_per_s2);
  node.bench.run(time);
  double fastest = 0;
  const auto& edges = node.board.driver().edges();
  for (std::size_t i = 1000; i < edges.size(); ++i)
    fastest = std::max(fastest, 1e3 / seconds_of(edges[i].at - edges[i - 1000].at));
  const ExceptionCost& control = node.board.cpu().cost(kControl);
  const ExceptionCost& receive = node.board.cpu().cost(kReceive);
  fmt::print(
      "{:.0f} steps/s; control interrupt {} calls, {} cycles at most of {:.0f} ({:.1f} %); CAN receive {} "
      "cycles "
      "at most; main loop {:.0f} us at most\n",
      fastest, control.calls, control.worst_cycles, kControlClocks,
      100 * control.worst_cycles / kControlClocks, receive.worst_cycles,
      1e6 * seconds_of(node.board.cpu().longest_pass()));
  EXPECT_NEAR(fastest, steps_per_s, within);
  EXPECT_LE(control.worst_cycles, 0.6 * kControlClocks);
  EXPECT_EQ(node.board.driver().steps(), counts / 16);
  node.expect_good_driver();
  EXPECT_TRUE(node.bench.emergencies(kId).empty());
}

TEST(Ebb, TwentyFiveThousandStepsASecondByProfile) {
  expect_profile(400'000, 400'000, 6'400'000, 1400ms, 25'000, 250);
}

TEST(Ebb, StreamedMotionIsExactToTheStepAndItsEdgesWithinTwoMicroseconds) {
  OneEbb node;
  StreamFeed feed{.id = kId};
  node.board.cpu().watch(ebb_image().symbol("_ZN7kinebus13ClockEstimate3fitEv").value_or(0));
  node.bench.bring_up({kId});
  node.write(0x2115, 0, 2, 5);
  node.write(0x607F, 0, 4, 3'200'000);
  node.bench.enable(kId, 0, 7);
  const std::uint32_t debug_path_time = ebb_image().symbol("debug_path_time").value_or(0);
  const auto place = [&](Cycle at) {
    const Cycle now = node.board.now();
    const auto counts =
        node.board.local_counts(now) - static_cast<std::uint32_t>((now - at) / kCyclesPerLocalCount);
    const auto ticks = static_cast<std::int64_t>(node.board.cpu().call(debug_path_time, counts).value_or(0));
    return static_cast<double>(feed.position(0, ticks)) / kCount;
  };
  node.bench.rate(1);
  node.bench.run(300ms);
  node.board.cpu().clear_costs();
  node.bench.send(feed.start(node.bench.read_long(kId, 0x2112) / kPathTicksPerUnit + 62'500));
  for (int i = 0; i < 8; ++i)
    for (const int sign : {1, -1, -1, 1}) node.bench.send(feed.segment(1250, sign * 1'912'345, 0));
  node.bench.send(feed.end());
  double worst_us = 0;
  std::size_t edges = 0, turns = 0;
  bool up = false;
  const auto look = [&] {
    const StepDriver& driver = node.board.driver();
    const Cycle now = node.board.now();
    const double early = place(now - 2 * kMicrosecond), late = place(now);
    EXPECT_GE(driver.steps(), std::min(nearest_step(early - 0.1), nearest_step(late - 0.1)));
    EXPECT_LE(driver.steps(), std::max(nearest_step(early + 0.1), nearest_step(late + 0.1)));
    for (const StepDriver::Edge& edge : driver.edges()) {
      ++edges;
      turns += edge.up != up ? 1 : 0;
      up = edge.up;
      const double border =
          (static_cast<double>(edge.after) + (edge.up ? -0.5 : 0.5)) * EbbBoard::kCountsPerStep;
      // The plan's parabolas are within a tenth of a count of the motion.
      double off_us = 99;
      for (int quarter = 0; quarter < 8 && off_us > 2; ++quarter) {
        const Cycle away = static_cast<Cycle>(quarter + 1) * kCyclesPerLocalCount;
        const double a = place(edge.at - away), b = place(edge.at + away);
        if (std::min(a, b) - 0.1 <= border && border <= std::max(a, b) + 0.1) off_us = 0.25 * (quarter + 1);
      }
      EXPECT_LE(off_us, 2) << "step " << edge.after;
      worst_us = std::max(worst_us, off_us);
    }
    node.board.clear_edges();
  };
  // At the full rate, and along smooth ramps of path time, which take the processor longer.
  node.bench.run(1100ms, 1ms, look);
  for (const auto& [rate_q15, span] :
       {std::pair{std::uint16_t{10'000}, 250ms}, {kFullRateQ15, 250ms}, {0, 300ms}, {kFullRateQ15, 1000ms}}) {
    node.bench.command({.kind = RateCommand::Kind::kSmooth, .rate_q15 = rate_q15, .full_ramp_2ms = 60}, 5ms);
    node.bench.run(span, 1ms, look);
  }
  EXPECT_EQ(node.board.driver().steps(), nearest_step(static_cast<double>(feed.state[0].position) / kCount));
  fmt::print("{} steps, {} turns: each within {:.2f} us of its time; main loop {:.0f} us at most\n", edges,
             turns, worst_us, 1e6 * seconds_of(node.board.cpu().longest_pass()));
  const CallCost& fit = node.board.cpu().watched();
  fmt::print("clock fit: {} calls, {} cycles at most, {:.0f} us with interrupts\n", fit.calls, fit.worst_own,
             1e6 * seconds_of(fit.worst));
  EXPECT_LE(seconds_of(node.board.cpu().longest_pass()), kLongestPass);
  const double late_us = 1e6 * seconds_of(node.board.cpu().cost(kReceive).worst_latency);
  fmt::print("CAN receive interrupt late by {:.1f} us at most\n", late_us);
  EXPECT_LE(late_us, 5) << "what a short window of the clock estimate is sized for";
  EXPECT_GT(edges, 2'500u);
  EXPECT_GT(turns, 4u);
  node.expect_good_driver();
  EXPECT_TRUE(node.bench.emergencies(kId).empty());
}

TEST(Ebb, TwoHundredThousandStepsASecond) {
  expect_profile(1'600'000, 3'200'000, 32'000'000, 1200ms, 200'000, 1'000);
}

// The plan of a stop is there before the one of the motion has come to its end, and before the motor is too
// far beyond where it is to stand.
TEST(Ebb, StopsAProfileFromTwentyFiveThousandStepsASecond) {
  constexpr int kQuickStop = 0x02, kHalt = 0x10F;
  double longest_us = 0;
  for (const int word : {kQuickStop, kHalt})
    for (const auto later : {0us, 1300us, 2600us, 3900us, 5200us}) {
      OneEbb node;
      node.write(0x607F, 0, 4, 3'200'000);
      node.bench.enable(kId, 0, 1);
      node.board.cpu().clear_costs();
      node.bench.move(kId, 0, 8'000'000, 400'000, 6'400'000);
      node.bench.run(400ms + later);
      node.write(0x6040, 0, 2, word);
      node.bench.run(200ms);
      EXPECT_TRUE(node.bench.emergencies(kId).empty()) << std::hex << word;
      EXPECT_LE(seconds_of(node.board.cpu().longest_pass()), kLongestPass);
      longest_us = std::max(longest_us, 1e6 * seconds_of(node.board.cpu().longest_pass()));
      node.board.clear_edges();
      node.bench.run(50ms);
      EXPECT_TRUE(node.board.driver().edges().empty());
      node.expect_good_driver();
    }
  fmt::print("main loop {:.0f} us at most\n", longest_us);
}

TEST(Ebb, StoresItsParametersOverAPowerCycle) {
  OneEbb node({}, &make_board<EbbBoard>, true);
  for (const int value : {12'345, 23'456, 34'567}) {
    node.write(0x6081, 0, 4, value);
    node.bench.send(CanFrame::make(0x600u + kId, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
    node.bench.run(1s);
  }
  EXPECT_EQ(node.board.flash().errors(), 0u);
  node.machine.power_cycle(0);
  node.bench.run(100ms);
  EXPECT_EQ(node.board.watchdog_resets(), 0u);
  node.bench.enable(kId, 0, 1);
  EXPECT_EQ(node.read(0x6081), 34'567);
}

TEST(Ebb, ComesBackFromBusOffAndTellsIt) {
  OneEbb node;
  node.machine.disturb(0, 32);
  node.write(0x1802, 5, 2, 10);  // it speaks often
  node.bench.run(200ms);
  EXPECT_EQ(node.board.can().counters().bus_offs, 1u);
  EXPECT_FALSE(node.board.can().bus_off());
  const auto codes = node.bench.emergencies(kId);
  EXPECT_NE(std::ranges::find(codes, emcy::kBusOffRecovered), codes.end());
}

// The probe is input 1, the filament sensor input 2: their levels are in 60FDh as the switches' polarity
// says.
TEST(Ebb, TellsItsProbeAndItsFilamentSensor) {
  OneEbb node;
  const auto inputs = [&] {
    node.bench.run(30ms);
    return node.read(0x60FD);
  };
  for (int input = 0; input < 3; ++input) node.board.set_input(input, true);
  const std::int64_t all_open = inputs();
  for (int input = 0; input < 3; ++input) {
    node.board.set_input(input, false);
    EXPECT_NE(inputs(), all_open) << "input " << input + 1;
    node.board.set_input(input, true);
    EXPECT_EQ(inputs(), all_open);
  }
}

}  // namespace
}  // namespace kinebus::emulator
