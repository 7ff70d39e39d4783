// A fault on one board while two boards run a stream: the right EMCY, and both stop on the path, together. A
// carriage never stops alone.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "vcan_tests/emulator/tests/one_board.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::array<std::uint8_t, 2> kIds{5, 6};  // the first one gets the fault

EmulatedNodeOptions board_options(std::uint8_t id) {
  EmulatedNodeOptions options;
  options.node_id = id;
  options.clock_drift_ppm = id == kIds[0] ? 20 : -20;
  options.board.unique_id = {1, 2, id};
  return options;
}

struct TwoBoards {
  TwoBoards() : machine(firmware_image(), {board_options(kIds[0]), board_options(kIds[1])}), bench(machine) {
    bench.bring_up({kIds[0], kIds[1]});
    for (std::size_t node = 0; node < 2; ++node) {
      feed[node].id = kIds[node];
      configure(static_cast<int>(node));
      bench.send(feed[node].start(bench.read_long(kIds[node], 0x2112) / kPathTicksPerUnit + 20'000));
      // 80 ms to 87,000 counts/s, cruising, and back to rest.
      bench.send(feed[node].segment(5'000, 150'000, -120'000));
      for (int i = 0; i < 12; ++i) bench.send(feed[node].segment(5'000, 0, 0));
      bench.send(feed[node].segment(5'000, -150'000, 120'000));
      bench.send(feed[node].end());
    }
    bench.run(20ms);
    bench.rate(1);
    bench.run(600ms, 5ms, [&] { look(); });
    EXPECT_TRUE(codes().empty());
    EXPECT_GT(std::abs(machine.board(0).motor(0).speed_rad_per_s()), 5.0) << "it moves";
    for (int node = 0; node < 2; ++node)
      for (int axis = 0; axis < 2; ++axis) machine.board(node).motor(axis).clear_peak();
  }
  void configure(int node) {
    const std::uint8_t id = kIds[static_cast<std::size_t>(node)];
    bench.write(id, 0x2115, 0, 2, 5);
    for (int axis = 0; axis < 2; ++axis) {
      const auto at = [&](int index) { return static_cast<std::uint16_t>(index + 0x800 * axis); };
      const StepperParameters& p = machine.board(node).motor(axis).parameters();
      bench.write(id, at(0x2150), 2, 2, std::lround(p.resistance_ohm * 1e3));
      bench.write(id, at(0x2150), 3, 2, std::lround(p.inductance_h * 1e6));
      bench.write(id, at(0x2150), 4, 2, std::lround(p.torque_nm_per_a / p.pole_pairs * 1e6));
      bench.write(id, at(0x2150), 6, 1, 1);
      bench.write(id, at(0x2140), 2, 2, 2500);
      bench.write(id, at(0x2140), 3, 2, 2500);
      bench.enable(id, axis, 7);
    }
  }
  /// The EMCY codes of both.
  std::vector<std::uint16_t> codes() const {
    auto all = bench.emergencies(kIds[0]);
    for (const std::uint16_t code : bench.emergencies(kIds[1])) all.push_back(code);
    return all;
  }
  PathTime tau(int node) { return machine.path_time(node, bench.now); }
  void look() {
    skew_us = std::max(skew_us, std::abs(static_cast<double>((tau(0) - tau(1)).count())) / 16);
    for (int axis = 0; axis < 2; ++axis) {
      const auto command = machine.commanded(1, axis);
      ASSERT_TRUE(command.has_value());
      const double apart = machine.board(1).true_counts(axis) - static_cast<double>(*command) / 4294967296.0;
      others_counts = std::max(others_counts, std::abs(apart));
    }
  }
  /// Runs on until all should have stopped, and looks at what the fault has led to.
  void expect(std::uint16_t code, double most_a, std::array<bool, 2> keeps_power) {
    bench.run(600ms, 1ms, [&] { look(); });
    const std::array<PathTime, 2> stopped{tau(0), tau(1)};
    bench.run(100ms, 5ms, [&] { look(); });
    double peak_a = 0;
    for (int node = 0; node < 2; ++node)
      for (int axis = 0; axis < 2; ++axis)
        peak_a = std::max(peak_a, machine.board(node).motor(axis).peak_current_a());
    const auto told = bench.emergencies(kIds[0]);
    std::string list;
    for (const std::uint16_t c : told) list += fmt::format(" {:04X}", c);
    fmt::print(
        "EMCY{}: path times within {:.2f} us, the other board's rotors within {:.1f} counts, peak current "
        "{:.2f} A\n",
        list, skew_us, others_counts, peak_a);
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.front(), code) << std::hex << told.front();
    EXPECT_LE(skew_us, 2.0);
    EXPECT_LE(others_counts, 51.2) << "two tenths of a full step";
    EXPECT_LT(peak_a, most_a);
    for (int node = 0; node < 2; ++node) {
      const auto n = static_cast<std::size_t>(node);
      EXPECT_EQ(tau(node), stopped[n]) << "path time stands still";
      for (int axis = 0; axis < 2; ++axis) {
        if (node == 0 && !keeps_power[static_cast<std::size_t>(axis)]) continue;
        const auto command = machine.commanded(node, axis);
        ASSERT_TRUE(command.has_value());
        EXPECT_NEAR(static_cast<double>(*command) / 4294967296.0,
                    static_cast<double>(feed[n].position(axis, tau(node).count())) / 4294967296.0, 1.0)
            << "the stop is on the path";
      }
    }
    for (int axis = 0; axis < 2; ++axis)
      EXPECT_EQ(machine.board(0).pwm(axis).sweep().main_output, keeps_power[static_cast<std::size_t>(axis)]);
    EXPECT_TRUE(machine.board(1).pwm(0).sweep().main_output && machine.board(1).pwm(1).sweep().main_output)
        << "the others hold";
  }

  EmulatedMachine machine;
  GatewayBench bench;
  std::array<StreamFeed, 2> feed;
  double skew_us = 0, others_counts = 0;
};

TEST(StopTogether, AShortedPhase) {
  TwoBoards two;
  two.machine.board(0).motor(0).set_winding(1, StepperMotor::Winding::kShorted);
  two.expect(0x2320, 8.0, {false, true});
}

TEST(StopTogether, AMissingPhase) {
  TwoBoards two;
  two.machine.board(0).motor(0).set_winding(0, StepperMotor::Winding::kOpen);
  two.expect(0x3130, 5.0, {false, true});
}

TEST(StopTogether, ABlockedMotor) {
  TwoBoards two;
  two.machine.board(0).motor(0).block(true);
  two.expect(0x8611, 5.0, {true, true});
}

TEST(StopTogether, AnUnpluggedEncoder) {
  TwoBoards two;
  two.machine.board(0).encoder(0).unplug(true);
  two.expect(0x7305, 5.0, {true, true});
}

TEST(StopTogether, ADipOfTheSupply) {
  TwoBoards two;
  two.machine.board(0).set_supply(8);
  two.bench.run(20ms, 1ms, [&] { two.look(); });
  two.machine.board(0).set_supply(24);
  two.expect(0x3220, 5.0, {true, true});
}

TEST(StopTogether, HeatThatWouldBurnStopsFirstAndLetsGoOnlyThen) {
  TwoBoards two;
  two.machine.board(0).set_temperature(0, 120);
  two.expect(0x4310, 5.0, {true, true});
  two.bench.run(1600ms);
  EXPECT_FALSE(two.machine.board(0).pwm(0).sweep().main_output);
  EXPECT_TRUE(two.machine.board(0).pwm(1).sweep().main_output) << "the motor with cool MOSFETs holds";
  EXPECT_EQ(two.bench.statusword(kIds[0], 0) & 0x4F, 0x08) << "fault";
}

TEST(StopTogether, ASupplyThatWouldBreakTheBridgesStopsThePathAndLetsGo) {
  TwoBoards two;
  two.machine.board(0).set_supply(35.5);
  two.expect(0x3210, 5.0, {false, false});
}

}  // namespace
}  // namespace kinebus::emulator
