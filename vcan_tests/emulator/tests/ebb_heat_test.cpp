// The EBB's other image, a heat node: it heats a hot end, by CANopen alone, and what takes the power.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/tests/heat_master.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kHeat = 20;

const ElfImage& heat_image() {
  static const ElfImage loaded = load_elf(KINEBUS_EBB_HEAT_IMAGE);
  return loaded;
}

struct HeatedEbb {
  explicit HeatedEbb(double hot_end_c = 22, BoardMaker make = &make_board<EbbHeatBoard>,
                     bool keeps_id = false)
      : machine(heat_image(), {EmulatedNodeOptions{
                                  .board = {}, .node_id = kHeat, .keeps_node_id = keeps_id, .make = make}}),
        bench(machine),
        board(machine.board<EbbBoard>(0)),
        master(bench, kHeat) {
    board.heated().hot_end().begin_at(hot_end_c);
    bench.run(20ms);
  }
  void expect_good_chip() {
    EXPECT_TRUE(board.strange_accesses().empty()) << std::hex << board.strange_accesses().front();
    EXPECT_TRUE(board.lost_accesses().empty()) << std::hex << board.lost_accesses().front();
    EXPECT_EQ(board.adc().refused(), 0u);
    EXPECT_EQ(board.resets(), 0u);
    EXPECT_EQ(board.can().counters().overruns, 0u);
  }
  double power_after_s(const std::function<void()>& what) {
    return master.power_after_s([this] { return board.heater_on(); }, what);
  }
  EmulatedMachine machine;
  GatewayBench bench;
  EbbBoard& board;
  HeatMaster master;
};

TEST(EbbHeat, ComesUpAndDrivesNothing) {
  HeatedEbb ebb;
  EXPECT_EQ(ebb.master.raw(0x1018, 2), 0x404u);
  EXPECT_EQ(ebb.board.rcc().system_hz(), 64'000'000u);
  EXPECT_TRUE(ebb.board.adc().running());
  ebb.bench.run(300ms);
  EXPECT_FALSE(ebb.board.anything_on());
  EXPECT_EQ(ebb.board.servo().width_us, 0);
  ebb.expect_good_chip();
}

TEST(EbbHeat, HeatsTo210AndAnOpenSensorTakesThePower) {
  // Still warm from a print.
  HeatedEbb ebb(170);
  ebb.master.describe(1);
  ebb.master.start();
  EXPECT_NEAR(ebb.master.measured_c(), 170, 1.5);
  ebb.board.cpu().clear_costs();
  ebb.master.write(0x7402, 1, 2, 2100);
  double c = 0;
  for (int s = 0; s < 110 && c < 209.5; s += 2) c = ebb.master.heat_for(2s);
  EXPECT_NEAR(c, 210, 1);
  ebb.master.heat_for(5s);
  EXPECT_NEAR(ebb.master.measured_c(), 210, 1);
  EXPECT_NEAR(ebb.board.heated().hot_end().block(), 210, 2);
  // Fan 2 is free: half of full.
  ebb.master.write(0x6411, 2, 2, 16'384);
  ebb.bench.run(500ms);
  int on = 0, looks = 0;
  ebb.bench.run(2s, 500us, [&] {
    ++looks;
    on += ebb.board.fan_on(1) ? 1 : 0;
  });
  EXPECT_NEAR(static_cast<double>(on) / looks, 0.5, 0.03);
  EXPECT_FALSE(ebb.board.fan_on(0));
  const double longest_pass_ms = seconds_of(ebb.board.cpu().longest_pass()) * 1e3;
  fmt::print("EBB as a heat node: main loop {:.1f} ms at most\n", longest_pass_ms);
  // Of the frames that come meanwhile the ring takes 128: 6 ms of the shortest.
  EXPECT_LT(longest_pass_ms, 6);

  EXPECT_EQ(ebb.master.try_write(0x1010, 1, 4, 0x65766173), HeatMaster::kDeviceState) << "it heats";
  EXPECT_EQ(ebb.master.try_write(0x1F51, 1, 1, 0), HeatMaster::kDeviceState) << "it heats";
  EXPECT_TRUE(ebb.master.emergencies().empty());
  // With all its power on.
  ebb.master.write(0x7402, 1, 2, 2300);
  ebb.bench.run(500ms);
  ASSERT_TRUE(ebb.board.heater_on());
  const double off_s =
      ebb.power_after_s([&] { EXPECT_EQ(ebb.board.heated().plant().command("sensor 1 open"), ""); });
  fmt::print("power off {:.0f} ms after the sensor was opened\n", 1e3 * off_s);
  EXPECT_LE(off_s, 0.5);
  const auto codes = ebb.master.emergencies();
  ASSERT_EQ(codes.size(), 1u);
  EXPECT_EQ(codes[0], emcy::kSensorOpen);
  ebb.master.heat_for(3s);
  EXPECT_FALSE(ebb.board.heater_on()) << "it stays";
  EXPECT_LT(ebb.board.heated().hot_end().hottest(), 216);
  ebb.expect_good_chip();
}

TEST(EbbHeat, NobodyIsLeftHeatingAlone) {
  HeatedEbb ebb;
  ebb.master.describe(1);
  ebb.master.start();
  ebb.master.write(0x7402, 1, 2, 2100);
  ebb.master.heat_for(3s);
  EXPECT_GT(ebb.power_after_s([] {}), 0.9) << "it heats";
  ebb.bench.run(4500ms);
  EXPECT_LE(ebb.power_after_s([] {}), 0.5);
  const auto codes = ebb.master.emergencies();
  ASSERT_FALSE(codes.empty());
  EXPECT_EQ(codes[0], emcy::kHeartbeat);
}

/// A resistance thermometer on the board's MAX31865 instead of a thermistor on TH0.
struct WithResistanceThermometer : HeatedEbb {
  explicit WithResistanceThermometer(double hot_end_c, bool pt1000 = false, std::uint8_t wires = 2)
      : HeatedEbb(hot_end_c) {
    const double ohm_0 = pt1000 ? 1000 : 100, reference = pt1000 ? 4300 : 430;
    board.heated().plant().plug(0, {.ohm_0 = ohm_0, .reference_ohm = reference, .max31865 = true});
    board.max31865().reference_ohm = reference;
    board.max31865().wires = wires;
    board.max31865().lead_ohm = wires == 2 ? 0 : 1.5;
    master.describe(0);
    master.write(0x2200, 1, 1, 1);
    master.write(0x2201, 1, 4, std::lround(1000 * reference));
    master.write(0x220D, 1, 1, wires);
    master.write(0x220E, 0, 1, 50);
    master.write(0x220A, 1, 2, -50);
    master.write(0x6110, 1, 2, pt1000 ? 33 : 30);
    master.start();
  }
  /// With all its power on.
  void heat_up() {
    master.write(0x7402, 1, 2, 2100);
    bench.run(1s);
    ASSERT_TRUE(board.heater_on());
    ASSERT_TRUE(master.emergencies().empty());
  }
  /// Off so soon after `what`, and for good, with that word.
  void expect_off(double most_s, std::uint16_t code, const std::function<void()>& what) {
    heat_up();
    double off_s = power_after_s(what);
    if (most_s > 0.9) off_s += power_after_s([] {});
    fmt::print("power off {:.0f} ms later\n", 1e3 * off_s);
    EXPECT_LE(off_s, most_s);
    bench.run(500ms);
    const auto codes = master.emergencies();
    ASSERT_EQ(codes.size(), 1u);
    EXPECT_EQ(codes[0], code);
    EXPECT_LE(power_after_s([] {}), 0) << "it stays off";
    EXPECT_EQ(board.max31865().mistakes(), 0u);
    expect_good_chip();
  }
};

TEST(EbbResistance, HeatsABlockTo210ByAPt100AndABrokenWireTakesThePower) {
  WithResistanceThermometer ebb(170);
  EXPECT_NEAR(ebb.master.measured_c(), 170, 0.5);
  EXPECT_EQ(ebb.board.max31865_spi().clock_hz(), 4e6);
  EXPECT_EQ(ebb.board.max31865_spi().mode(), 3);
  ebb.board.cpu().clear_costs();
  ebb.master.write(0x7402, 1, 2, 2100);
  double c = 0;
  for (int s = 0; s < 110 && c < 209.5; s += 2) c = ebb.master.heat_for(2s);
  EXPECT_NEAR(c, 210, 1);
  ebb.master.heat_for(8s);
  EXPECT_NEAR(ebb.master.measured_c(), 210, 1);
  EXPECT_NEAR(ebb.board.heated().hot_end().block(), 210, 2);
  EXPECT_TRUE(ebb.master.emergencies().empty());
  const double longest_pass_ms = seconds_of(ebb.board.cpu().longest_pass()) * 1e3;
  fmt::print("EBB with a Pt100: main loop {:.1f} ms at most\n", longest_pass_ms);
  EXPECT_LT(longest_pass_ms, 6);
  EXPECT_GT(ebb.board.max31865().conversions(), 400u);
  ebb.master.write(0x7402, 1, 2, 2300);
  ebb.bench.run(500ms);
  ASSERT_TRUE(ebb.board.heater_on());
  const double off_s =
      ebb.power_after_s([&] { EXPECT_EQ(ebb.board.heated().plant().command("sensor 1 open"), ""); });
  fmt::print("power off {:.0f} ms after the wire broke\n", 1e3 * off_s);
  EXPECT_LE(off_s, 0.1);
  const auto codes = ebb.master.emergencies();
  ASSERT_EQ(codes.size(), 1u);
  EXPECT_EQ(codes[0], emcy::kSensorOpen);
  EXPECT_EQ(ebb.master.raw(0x6150, 1) & 0xFF, 3u) << "not valid, above what can be measured";
  ebb.master.heat_for(3s);
  EXPECT_FALSE(ebb.board.heater_on()) << "it stays";
  EXPECT_LT(ebb.board.heated().hot_end().hottest(), 216);
  EXPECT_EQ(ebb.board.max31865().mistakes(), 0u);
  ebb.expect_good_chip();
}

TEST(EbbResistance, MeasuresBothElementsByTwoThreeAndFourWires) {
  for (const bool pt1000 : {false, true})
    for (const std::uint8_t wires : std::array<std::uint8_t, 3>{2, 3, 4}) {
      WithResistanceThermometer ebb(200, pt1000, wires);
      EXPECT_NEAR(ebb.master.measured_c(), 200, 0.7) << pt1000 << ' ' << int{wires};
      EXPECT_EQ(ebb.board.max31865().mistakes(), 0u);
    }
}

// It is made in the main loop: a long one is a reset by the watchdog.
TEST(EbbResistance, ItsTableTakesNoLongerThanAThermistors) {
  struct Case {
    std::uint8_t path;
    std::uint16_t element;
  };
  for (const Case each : {Case{0, 10'004}, Case{0, 33}, Case{1, 30}, Case{1, 33}}) {
    HeatedEbb ebb;
    ebb.master.enter_pre_operational();
    ebb.master.write(0x2200, 1, 1, each.path);
    if (each.path != 0) ebb.master.write(0x2201, 1, 4, each.element == 30 ? 430'000 : 4'300'000);
    ebb.board.cpu().clear_costs();
    ebb.master.write(0x6110, 1, 2, each.element);
    ebb.bench.run(100ms);
    const double longest_pass_ms = seconds_of(ebb.board.cpu().longest_pass()) * 1e3;
    fmt::print("table of sensor {}, path {}: {:.1f} ms\n", each.element, each.path, longest_pass_ms);
    EXPECT_LT(longest_pass_ms, 26);
    ebb.expect_good_chip();
  }
}

TEST(EbbResistance, WhateverBreaksTakesThePowerAndSaysWhat) {
  using Wires = Max31865Chip::Wires;
  struct Case {
    const char* what;
    double most_s;
    std::uint16_t code;
    std::function<void(Max31865Chip&)> breaks;
  };
  const std::array cases{
      Case{"short", 0.1, emcy::kSensorShort, [](Max31865Chip& c) { c.state = Wires::kElementShort; }},
      // Found in a cycle of its own.
      Case{"wire", 1.2, emcy::kSensorOpen, [](Max31865Chip& c) { c.state = Wires::kForceOpen; }},
      Case{"ground", 1.2, emcy::kSensorShort, [](Max31865Chip& c) { c.state = Wires::kGrounded; }},
      Case{"voltage", 0.1, emcy::kSensorSilent, [](Max31865Chip& c) { c.voltage = true; }},
      Case{"gone", 0.1, emcy::kSensorSilent, [](Max31865Chip& c) { c.absent = true; }},
      Case{"gone, line low", 0.1, emcy::kSensorSilent, [](Max31865Chip& c) { c.absent = c.line_low = true; }},
      Case{"converter stands", 0.2, emcy::kSensorSilent, [](Max31865Chip& c) { c.stands = true; }},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.what);
    WithResistanceThermometer ebb(170);
    ebb.expect_off(each.most_s, each.code, [&] { each.breaks(ebb.board.max31865()); });
  }
}

TEST(EbbResistance, WithoutItsChipNothingHeatsAndNoOtherSensorHasOne) {
  WithResistanceThermometer ebb(170);
  ebb.board.max31865().absent = true;
  ebb.master.enter_pre_operational();
  ebb.bench.run(1s);
  EXPECT_NE(ebb.master.raw(0x6150, 1) & 1, 0u);
  static_cast<void>(ebb.master.try_write(0x7402, 1, 2, 2100));
  EXPECT_LE(ebb.power_after_s([] {}), 0);
  ebb.master.write(0x2200, 2, 1, 1);
  ebb.master.write(0x2201, 2, 4, 430'000);
  EXPECT_NE(ebb.master.try_write(0x6110, 2, 2, 30), 0u) << "there is none for sensor 2";
  ebb.master.write(0x2200, 2, 1, 0);
  EXPECT_NE(ebb.master.try_write(0x220E, 0, 1, 55), 0u) << "no such mains";
}

// The pins of another chip may be wired to anything, a heater among them.
TEST(EbbHeat, OnAnotherChipItDrivesNothingAndMeasuresNothing) {
  HeatedEbb ebb(22, [](const ElfImage& image, const BoardOptions& options) -> std::unique_ptr<Chip> {
    return std::make_unique<EbbHeatBoard>(image, options, EbbBoard::kG071);
  });
  ebb.master.describe(1);
  ebb.master.start();
  static_cast<void>(ebb.master.try_write(0x7402, 1, 2, 2100));
  ebb.bench.run(1s);
  EXPECT_EQ(ebb.board.outputs(), 0);
  EXPECT_FALSE(ebb.board.adc().running());
  const auto codes = ebb.master.emergencies();
  ASSERT_FALSE(codes.empty());
  EXPECT_EQ(codes[0], emcy::kSensorSilent);
  ebb.expect_good_chip();
}

TEST(EbbHeat, AProbesServoItsLineAndTheFilamentsSwitch) {
  HeatedEbb ebb;
  ebb.board.set_input(0, false);
  ebb.board.set_input(1, true);
  ebb.master.enter_pre_operational();
  ebb.master.write(0x2260, 0, 1, 1);
  ebb.master.write(0x2250, 1, 1, 1);
  ebb.bench.run(100ms);
  EXPECT_EQ(ebb.board.servo().width_us, 0) << "nothing moves before a command";
  EXPECT_EQ(ebb.master.raw(0x2258, 1) & 0xFF, 0u);
  ebb.master.write(0x2261, 0, 1, 1);
  ebb.bench.run(60ms);
  // The maker's 10 degrees: 647 us, and 50 Hz.
  EXPECT_NEAR(ebb.board.servo().width_us, 647, 10);
  EXPECT_NEAR(ebb.board.servo().period_us, 20'000, 1);
  ebb.board.set_input(0, true);
  ebb.board.set_input(1, false);
  ebb.bench.run(50ms);
  EXPECT_EQ(ebb.master.raw(0x2264) & 0xFF, 1u);
  EXPECT_EQ(ebb.master.raw(0x2258, 1) & 0xFF, 1u) << "no filament";
  ebb.expect_good_chip();
}

// What the tool feels, as energy over frequency, while it heats.
TEST(EbbHeat, ItsAccelerometerIsReadWithoutALossAndSumsUpWhatTheToolFeels) {
  constexpr double kHz = 53, kAmplitude = 2000, kTurn = 2 * std::numbers::pi;
  HeatedEbb ebb(170);
  ebb.board.accelerometer().plant().feels = [](double t) {
    return heat::AccelerometerPlant::Vector{0, kAmplitude * std::sin(kTurn * kHz * t), 0};
  };
  ebb.master.describe(1);
  ebb.master.start();
  ebb.board.cpu().clear_costs();
  ebb.master.write(0x7402, 1, 2, 2100);
  EXPECT_EQ(ebb.board.spi().clock_hz(), 4e6);
  EXPECT_EQ(ebb.board.spi().mode(), 3);
  EXPECT_EQ(ebb.master.raw(0x2270) & 0xFF, 1u) << "ready";
  const std::uint64_t lost_before = ebb.board.accelerometer().lost();
  ebb.master.write(0x2271, 0, 1, 1);
  ebb.master.heat_for(6s);
  EXPECT_EQ(ebb.board.accelerometer().lost(), lost_before);
  EXPECT_EQ(ebb.board.accelerometer().mistakes(), 0u);
  EXPECT_EQ(ebb.master.raw(0x2270) & 0xFF, 2u) << "measures";
  EXPECT_GE(ebb.master.raw(0x2273) & 0xFFFF, 5u);
  EXPECT_NEAR(ebb.master.raw(0x2272) / 1e3, ebb.board.accelerometer().plant().rate(), 4);
  ebb.master.write(0x2271, 0, 1, 2);
  const double band_hz = ebb.board.accelerometer().plant().rate() / 8192;
  const auto energy = [&](double hz, std::uint8_t axis) {
    ebb.master.write(0x2276, 0, 2, std::lround(hz / band_hz));
    return std::ldexp(static_cast<double>(ebb.master.raw(0x2277, axis)),
                      static_cast<int>(ebb.master.raw(0x2278, axis) & 0xFF));
  };
  const double there = energy(kHz, 2);
  EXPECT_GT(there, 1000 * energy(kHz + 5, 2));
  EXPECT_GT(there, 1000 * energy(kHz, 1)) << "the other direction";
  const double longest_pass_ms = seconds_of(ebb.board.cpu().longest_pass()) * 1e3;
  fmt::print("EBB as a heat node, accelerometer too: main loop {:.1f} ms at most\n", longest_pass_ms);
  EXPECT_LT(longest_pass_ms, 6);
  EXPECT_TRUE(ebb.master.emergencies().empty());

  ebb.board.accelerometer().plant().silent = true;
  ebb.master.heat_for(1s);
  EXPECT_EQ(ebb.master.raw(0x2270) & 0xFF, 3u) << "silent";
  ebb.board.accelerometer().plant().silent = false;
  ebb.master.heat_for(2s);
  EXPECT_EQ(ebb.master.raw(0x2270) & 0xFF, 1u) << "found again";
  ebb.expect_good_chip();
}

// What was described stays, and nothing heats by itself.
TEST(EbbHeat, KeepsItsSettingsThroughAPowerCut) {
  HeatedEbb ebb(22, &make_board<EbbHeatBoard>, true);
  ebb.master.enter_pre_operational();
  ebb.master.write(0x2211, 1, 2, 2750);
  ebb.bench.send(CanFrame::make(0x600u + kHeat, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
  ebb.bench.run(3s);
  ebb.machine.power_cycle(0);
  ebb.bench.run(ebb.board.boot_time() + 200ms);
  EXPECT_EQ(ebb.master.raw(0x2211, 1) & 0xFFFF, 2750u);
  EXPECT_EQ(ebb.board.watchdog_resets(), 0u);
  EXPECT_FALSE(ebb.board.anything_on());
}

}  // namespace
}  // namespace kinebus::emulator
