// The Octopus' image on its emulated board: comes up, homes, moves; its steps are judged at the drivers'
// pins.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"
#include "vcan_tests/emulator/tests/gateway_bench.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kId = 7;
constexpr double kCount = 4294967296.0;
constexpr Cycle kMicrosecond = kCoreHz / 1'000'000, kCyclesPerLocalCount = kMicrosecond / 4;
constexpr int kControl = kFirstInterrupt + 57;
constexpr double kControlPeriod = 64.0 * kMicrosecond;

const ElfImage& octopus_image() {
  static const ElfImage loaded = load_elf(KINEBUS_OCTOPUS_IMAGE);
  return loaded;
}

struct OneOctopus {
  explicit OneOctopus(const BoardOptions& options = {}, BoardMaker make = &make_board<OctopusBoard>,
                      bool keeps_id = false)
      : machine(
            octopus_image(),
            {EmulatedNodeOptions{.board = options, .node_id = kId, .keeps_node_id = keeps_id, .make = make}}),
        bench(machine),
        board(machine.board<OctopusBoard>(0)) {
    bench.send(nmt_frame(NmtCommand::kStart, kId));
    bench.run(20ms);
  }
  void write(int axis, int index, std::uint8_t sub, int size, std::int64_t value) {
    bench.write(kId, static_cast<std::uint16_t>(index + 0x800 * axis), sub, size, value);
  }
  std::int64_t read(int axis, int index) {
    return bench.read(kId, static_cast<std::uint16_t>(index + 0x800 * axis), 0);
  }
  void expect_good_drivers() {
    for (int axis = 0; axis < 2; ++axis) {
      const auto& shortest = board.driver(axis).shortest();
      EXPECT_GE(shortest.high, 19 * kMicrosecond / 10) << "axis " << axis;
      EXPECT_GE(shortest.low, 19 * kMicrosecond / 10);
      EXPECT_GE(shortest.set_up, 19 * kMicrosecond / 10);
      EXPECT_GE(shortest.hold, 19 * kMicrosecond / 10);
      EXPECT_EQ(board.driver(axis).while_disabled(), 0u);
    }
  }
  EmulatedMachine machine;
  GatewayBench bench;
  OctopusBoard& board;
};

std::int64_t nearest_step(double counts) {
  return static_cast<std::int64_t>(std::floor(counts / OctopusBoard::kCountsPerStep + 0.5));
}

TEST(Octopus, SetsTheClockTreeOfItsCrystalAndTouchesNothingWithoutItsClock) {
  OneOctopus node;
  EXPECT_EQ(node.board.rcc().system_hz(), 168'000'000u);
  EXPECT_EQ(node.board.rcc().apb1_hz(), 42'000'000u);
  EXPECT_EQ(node.board.rcc().apb2_hz(), 84'000'000u);
  EXPECT_EQ(node.board.rcc().usb_hz(), 48'000'000u);
  EXPECT_EQ(node.board.flash().wait_states(), 5u);
  EXPECT_EQ(node.board.can().bit_rate(), 1'000'000u);
  EXPECT_TRUE(node.board.strange_accesses().empty()) << std::hex << node.board.strange_accesses().front();
  EXPECT_TRUE(node.board.lost_accesses().empty()) << std::hex << node.board.lost_accesses().front();
  EXPECT_FALSE(node.board.anything_on());
  EXPECT_EQ(node.board.resets(), 0u);
}

// The pins of another chip may be wired to anything, a heater among them.
TEST(Octopus, OnAnotherChipItDrivesNothingAndSaysSo) {
  OneOctopus node({}, [](const ElfImage& image, const BoardOptions& options) -> std::unique_ptr<Chip> {
    return std::make_unique<OctopusBoard>(image, options, OctopusBoard::kF405);
  });
  EXPECT_EQ(node.board.outputs(), 0);
  for (int axis = 0; axis < 2; ++axis) {
    node.write(axis, 0x6060, 0, 1, 1);
    for (const int word : {0x06, 0x07}) node.write(axis, 0x6040, 0, 2, word);
    node.bench.run(50ms);
    EXPECT_EQ(node.bench.statusword(kId, axis) & 0x4F, 0x08) << "fault";
  }
  const auto codes = node.bench.emergencies(kId);
  ASSERT_EQ(codes.size(), 2u);
  EXPECT_EQ(codes[0], emcy::kControlHardware);
  node.bench.run(500ms);
  EXPECT_EQ(node.board.outputs(), 0);
  EXPECT_EQ(node.board.resets(), 0u);
}

TEST(Octopus, HomesBothAxesByTheirSwitchesAndMovesToTheStep) {
  BoardOptions options;
  options.axes[0] = {.start_counts = 80'000, .switch_input = 1, .switch_counts = 100'000};
  options.axes[1] = {
      .start_counts = -15'000, .switch_input = 2, .switch_counts = -40'000, .active_above = false};
  OneOctopus node(options);
  for (int axis = 0; axis < 2; ++axis) {
    node.write(axis, 0x6098, 0, 1, axis == 0 ? 20 : 22);
    node.bench.enable(kId, axis, 6);
    EXPECT_TRUE(node.board.driver(axis).enabled());
  }
  for (int axis = 0; axis < 2; ++axis) node.write(axis, 0x6040, 0, 2, 0x1F);
  for (int i = 0; i < 60; ++i) {
    node.bench.run(100ms);
    if ((node.bench.statusword(kId, 0) & node.bench.statusword(kId, 1) & 0x1400) == 0x1400) break;
  }
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_EQ(node.bench.statusword(kId, axis) & 0x3400, 0x1400) << "homed";
    // A carriage goes by steps: it trips its switch with the first one that is beyond.
    const double beyond =
        node.board.true_counts(axis) - options.axes[static_cast<std::size_t>(axis)].switch_counts;
    EXPECT_NEAR(static_cast<double>(node.read(axis, 0x6064)), beyond, 1.5 * OctopusBoard::kCountsPerStep);
  }
  const std::array<std::int64_t, 2> offset{
      node.read(0, 0x6064) - static_cast<std::int64_t>(node.board.driver(0).steps()) * 16,
      node.read(1, 0x6064) - static_cast<std::int64_t>(node.board.driver(1).steps()) * 16};
  for (int axis = 0; axis < 2; ++axis) {
    node.bench.enable(kId, axis, 1);
    node.bench.move(kId, axis, axis == 0 ? -50'000 : 44'444, 400'000, 6'400'000);
  }
  node.bench.run(500ms);
  for (int axis = 0; axis < 2; ++axis) {
    const std::int64_t target = axis == 0 ? -50'000 : 44'444;
    EXPECT_TRUE(node.bench.reached(kId, axis));
    EXPECT_EQ(node.read(axis, 0x6064), target);
    EXPECT_LE(
        std::abs(node.board.driver(axis).steps() * 16 + offset[static_cast<std::size_t>(axis)] - target), 16);
  }
  node.expect_good_drivers();
  EXPECT_TRUE(node.bench.emergencies(kId).empty());
  // Power off is the driver's, too.
  node.write(0, 0x6040, 0, 2, 0);
  node.bench.run(20ms);
  EXPECT_FALSE(node.board.driver(0).enabled());
  EXPECT_TRUE(node.board.driver(1).enabled());
}

/// A stream at rate 1, and where it is at each of the processor's cycles.
struct Streamed {
  Streamed() {
    node.bench.bring_up({kId});
    node.bench.write(kId, 0x2115, 0, 2, 5);
    for (int axis = 0; axis < 2; ++axis) {
      node.write(axis, 0x607F, 0, 4, 3'200'000);
      node.bench.enable(kId, axis, 7);
    }
    debug_path_time = octopus_image().symbol("debug_path_time").value_or(0);
  }
  std::int64_t path_ticks(Cycle at) {
    const Cycle now = node.board.now();
    const auto counts =
        node.board.local_counts(now) - static_cast<std::uint32_t>((now - at) / kCyclesPerLocalCount);
    return static_cast<std::int64_t>(node.board.cpu().call(debug_path_time, counts).value_or(0));
  }
  double place(int axis, Cycle at) {
    return static_cast<double>(feed.position(axis, path_ticks(at))) / kCount;
  }

  OneOctopus node;
  StreamFeed feed{.id = kId};
  std::uint32_t debug_path_time = 0;
};

TEST(Octopus, StreamedMotionIsExactToTheStepAndItsEdgesWithinTwoMicroseconds) {
  Streamed s;
  s.node.bench.rate(1);
  s.node.bench.run(300ms);
  s.node.bench.send(s.feed.start(s.node.bench.read_long(kId, 0x2112) / kPathTicksPerUnit + 62'500));
  // To and fro, the second axis against the first and slower.
  for (int i = 0; i < 8; ++i)
    for (const int sign : {1, -1, -1, 1})
      s.node.bench.send(s.feed.segment(1250, sign * 1'912'345, -sign * 954'321));
  s.node.bench.send(s.feed.end());
  double worst_us = 0;
  std::size_t edges = 0, turns = 0;
  std::array<std::int64_t, 2> farthest{};
  std::array<bool, 2> up{};
  s.node.bench.run(1800ms, 1ms, [&] {
    for (int axis = 0; axis < 2; ++axis) {
      const StepDriver& driver = s.node.board.driver(axis);
      const Cycle now = s.node.board.now();
      const double early = s.place(axis, now - 2 * kMicrosecond), late = s.place(axis, now);
      EXPECT_GE(driver.steps(), std::min(nearest_step(early - 0.1), nearest_step(late - 0.1)));
      EXPECT_LE(driver.steps(), std::max(nearest_step(early + 0.1), nearest_step(late + 0.1)));
      farthest[static_cast<std::size_t>(axis)] =
          std::max(farthest[static_cast<std::size_t>(axis)], std::abs(driver.steps()));
      bool& was_up = up[static_cast<std::size_t>(axis)];
      for (const StepDriver::Edge& edge : driver.edges()) {
        ++edges;
        turns += edge.up != was_up ? 1 : 0;
        was_up = edge.up;
        const double border =
            (static_cast<double>(edge.after) + (edge.up ? -0.5 : 0.5)) * OctopusBoard::kCountsPerStep;
        // The plan's parabolas are within a tenth of a count of the motion.
        double off_us = 99;
        for (int quarter = 0; quarter < 8 && off_us > 2; ++quarter) {
          const Cycle away = static_cast<Cycle>(quarter + 1) * kCyclesPerLocalCount;
          const double a = s.place(axis, edge.at - away), b = s.place(axis, edge.at + away);
          if (std::min(a, b) - 0.1 <= border && border <= std::max(a, b) + 0.1) off_us = 0.25 * (quarter + 1);
        }
        EXPECT_LE(off_us, 2) << "axis " << axis << ", step " << edge.after;
        worst_us = std::max(worst_us, off_us);
      }
    }
    s.node.board.clear_edges();
  });
  for (int axis = 0; axis < 2; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    EXPECT_EQ(s.node.board.driver(axis).steps(),
              nearest_step(static_cast<double>(s.feed.state[a].position) / kCount));
    EXPECT_GT(farthest[a], 100);
  }
  fmt::print("{} steps, {} turns: each within {:.2f} us of its time\n", edges, turns, worst_us);
  EXPECT_GT(edges, 5'000u);
  EXPECT_GT(turns, 8u);
  s.node.expect_good_drivers();
  EXPECT_TRUE(s.node.bench.emergencies(kId).empty());
}

TEST(Octopus, TwoHundredThousandStepsASecondOnBothAxes) {
  OneOctopus node;
  for (int axis = 0; axis < 2; ++axis) {
    node.write(axis, 0x607F, 0, 4, 3'200'000);
    node.bench.enable(kId, axis, 1);
  }
  node.board.cpu().clear_costs();
  for (int axis = 0; axis < 2; ++axis)
    node.bench.move(kId, axis, axis == 0 ? 1'600'000 : -1'600'000, 3'200'000, 32'000'000);
  node.bench.run(1200ms);
  double fastest = 0;
  const auto& edges = node.board.driver(1).edges();
  for (std::size_t i = 1000; i < edges.size(); ++i)
    fastest = std::max(fastest, 1e3 / seconds_of(edges[i].at - edges[i - 1000].at));
  const ExceptionCost& control = node.board.cpu().cost(kControl);
  fmt::print("{:.0f} steps/s; control interrupt {} calls, {} cycles at most of {:.0f} ({:.1f} %)\n", fastest,
             control.calls, control.worst_cycles, kControlPeriod,
             100 * control.worst_cycles / kControlPeriod);
  EXPECT_NEAR(fastest, 200'000, 1'000);
  EXPECT_LE(control.worst_cycles, 0.6 * kControlPeriod);
  EXPECT_EQ(node.board.driver(0).steps(), 100'000);
  EXPECT_EQ(node.board.driver(1).steps(), -100'000);
  node.expect_good_drivers();
  EXPECT_TRUE(node.bench.emergencies(kId).empty());
}

// A sector of 128 KiB takes two seconds to erase, in which the processor stands still.
TEST(Octopus, StoresItsParametersWhileNoDriverIsEnabled) {
  OneOctopus node({}, &make_board<OctopusBoard>, true);
  node.write(0, 0x6081, 0, 4, 12'345);
  node.bench.send(CanFrame::make(0x600u + kId, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
  node.bench.run(5s);
  node.machine.power_cycle(0);
  node.bench.run(100ms);
  EXPECT_EQ(node.board.watchdog_resets(), 0u);
  node.bench.enable(kId, 0, 1);
  EXPECT_EQ(node.read(0, 0x6081), 12'345);
  node.bench.move(kId, 0, 16'000, 100'000, 1'000'000);
  node.bench.run(400ms);
  EXPECT_EQ(node.board.driver(0).steps(), 1'000);
}

}  // namespace
}  // namespace kinebus::emulator
