// The Octopus' fifth node: its image heats a hot end, by CANopen alone, while axes move; and what takes the
// power.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/tests/heat_master.hpp"
#include "vcan_tests/emulator/tests/octopus_bench.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kHeat = kId + 4;
constexpr std::uint32_t kDeviceState = HeatMaster::kDeviceState;

struct HeatedOctopus : OneOctopus {
  /// Hot end and bed described.
  explicit HeatedOctopus(double hot_end_c = 22)
      : OneOctopus({}, &make_board<OctopusBoard>, false, hot_end_c) {
    master.describe(2);
    bench.write(kHeat, 0x2211, 2, 2, 1300);
    master.start();
  }
  std::uint32_t raw(std::uint16_t index, std::uint8_t sub) { return master.raw(index, sub); }
  double measured_c() { return master.measured_c(); }
  double heat_for(BusTime span) { return master.heat_for(span); }
  /// Of the hot end.
  double power_after_s(const std::function<void()>& what) {
    return master.power_after_s([this] { return board.heater_on(0); }, what);
  }
  HeatMaster master{bench, kHeat};
};

TEST(OctopusHeat, HeatsTo210HoldsWhileAxesMoveAndAnOpenSensorTakesThePower) {
  // Still warm from a print: the emulator needs three seconds for one of heating.
  HeatedOctopus octopus(170);
  EXPECT_NEAR(octopus.measured_c(), 170, 1.5);
  EXPECT_EQ(octopus.raw(0x2221, 3) & 0xFF, 0u) << "nothing is on the third input";
  octopus.bench.write(kHeat, 0x7402, 1, 2, 2100);
  double c = 0, hottest = 0;
  for (int s = 0; s < 110 && c < 209.5; s += 2) c = octopus.heat_for(2s);
  EXPECT_NEAR(c, 210, 1);
  octopus.heat_for(5s);
  EXPECT_NEAR(octopus.measured_c(), 210, 1);
  EXPECT_NEAR(octopus.board.heated().hot_end().block(), 210, 2);

  // Six axes as fast as they go: neither minds the other.
  for (int axis = 0; axis < 8; ++axis) {
    octopus.write(axis, 0x607F, 0, 4, 3'200'000);
    octopus.enable(axis, 1);
  }
  EXPECT_EQ(octopus.bench.try_write(kHeat, 0x1010, 1, 4, 0x65766173), kDeviceState)
      << "flash, and motors have power";
  for (int axis = 0; axis < 6; ++axis) octopus.move(axis, 3'200'000, 3'200'000, 32'000'000);
  octopus.bench.run(150ms);
  octopus.board.cpu().clear_costs();
  octopus.bench.run(300ms);
  const ExceptionCost control = octopus.board.cpu().cost(kControl);
  const double average = static_cast<double>(control.cycles) / static_cast<double>(control.calls);
  const double longest_pass_ms = seconds_of(octopus.board.cpu().longest_pass()) * 1e3;
  octopus.bench.run(1200ms, 10ms,
                    [&] { hottest = std::max(hottest, octopus.board.heated().hot_end().block()); });
  EXPECT_NEAR(octopus.measured_c(), 210, 1);
  for (int axis = 0; axis < 6; ++axis)
    EXPECT_EQ(octopus.board.driver(axis).steps(), 200'000) << "axis " << axis;
  fmt::print(
      "210 C with six axes at 200,000 steps/s: control {:.1f} % of the processor, {:.1f} % at most, main "
      "loop "
      "{:.1f} ms at most\n",
      100 * average / kControlPeriod, 100 * control.worst_cycles / kControlPeriod, longest_pass_ms);
  EXPECT_LE(average, 0.6 * kControlPeriod);
  EXPECT_LE(control.worst_cycles, 0.6 * kControlPeriod);
  EXPECT_LT(longest_pass_ms, 4);
  octopus.expect_good_drivers();

  // Flash holds the processor up: not while something heats.
  for (int axis = 0; axis < 8; ++axis) octopus.write(axis, 0x6040, 0, 2, 0);
  octopus.bench.run(100ms);
  EXPECT_EQ(octopus.bench.try_write(kId, 0x1010, 1, 4, 0x65766173), kDeviceState);
  EXPECT_EQ(octopus.bench.try_write(kHeat, 0x1010, 1, 4, 0x65766173), kDeviceState);

  EXPECT_TRUE(octopus.bench.emergencies(kHeat).empty());
  const double off_s =
      octopus.power_after_s([&] { EXPECT_EQ(octopus.board.heated().plant().command("sensor 1 open"), ""); });
  fmt::print("power off {:.0f} ms after the sensor was opened\n", 1e3 * off_s);
  EXPECT_LE(off_s, 0.5);
  const auto codes = octopus.bench.emergencies(kHeat);
  ASSERT_EQ(codes.size(), 1u);
  EXPECT_EQ(codes[0], emcy::kSensorOpen);
  octopus.heat_for(3s);
  EXPECT_FALSE(octopus.board.heater_on(0)) << "it stays";
  EXPECT_LT(octopus.board.heated().hot_end().hottest(), 214);
  EXPECT_EQ(octopus.board.resets(), 0u);
  EXPECT_TRUE(octopus.board.strange_accesses().empty());
  EXPECT_TRUE(octopus.board.lost_accesses().empty());
}

TEST(OctopusHeat, NobodyIsLeftHeatingAlone) {
  HeatedOctopus octopus;
  octopus.bench.write(kHeat, 0x7402, 1, 2, 2100);
  octopus.heat_for(3s);
  EXPECT_GT(octopus.power_after_s([] {}), 0.9) << "it heats";
  // 2242h: 5 s without a master.
  octopus.bench.run(4500ms);
  EXPECT_LE(octopus.power_after_s([] {}), 0.5);
  const auto codes = octopus.bench.emergencies(kHeat);
  ASSERT_FALSE(codes.empty());
  EXPECT_EQ(codes[0], emcy::kHeartbeat);

  // An emergency stop of an axis pair of the board reaches it, though no bus brings it.
  octopus.heat_for(1s);
  octopus.bench.write(kHeat, 0x7402, 1, 2, 2100);
  octopus.heat_for(1s);
  octopus.board.set_input(0, true);
  octopus.bench.write(kId + 3, 0x2131, 3, 1, 1);
  octopus.bench.write(kId + 3, 0x2130, 3, 1, static_cast<int>(SwitchFunction::kEmergencyStop));
  octopus.bench.run(50ms);
  EXPECT_LE(octopus.power_after_s([&] { octopus.board.set_input(0, false); }), 0.01);
  EXPECT_EQ(octopus.raw(0x7402, 1) & 0xFFFF, 0u);
}

// A BLTouch's servo and its line, by CANopen alone.
TEST(OctopusHeat, ServoPulsesMoveAProbesPinAndItsLineIsRead) {
  OneOctopus octopus;
  OctopusBoard& board = octopus.board;
  const auto read = [&](std::uint16_t index) {
    return get_u32_le(octopus.bench.upload(kHeat, index, 0).bytes().subspan(4)) & 0xFFFF;
  };
  board.set_input(8, false);
  octopus.bench.send(nmt_frame(NmtCommand::kEnterPreOperational, kHeat));
  octopus.bench.run(5ms);
  EXPECT_EQ(octopus.bench.try_write(kHeat, 0x2261, 0, 1, 1), kDeviceState) << "none is fitted";
  octopus.bench.write(kHeat, 0x2260, 0, 1, 1);
  octopus.bench.run(100ms);
  EXPECT_EQ(board.servo().width_us, 0) << "nothing moves before a command";
  octopus.bench.write(kHeat, 0x2261, 0, 1, 1);
  octopus.bench.run(60ms);
  // The maker's 10 degrees: 647 us, and 50 Hz.
  EXPECT_NEAR(board.servo().width_us, 647, 10);
  EXPECT_NEAR(board.servo().period_us, 20'000, 1);
  EXPECT_EQ(read(0x2262), 3u);
  octopus.bench.run(1s);
  EXPECT_NEAR(board.servo().width_us, 1162, 10);
  EXPECT_EQ(read(0x2262), 2u) << "the line is low: it is out";
  board.set_input(8, true);
  octopus.bench.run(50ms);
  EXPECT_EQ(read(0x2264), 1u);
  octopus.bench.write(kHeat, 0x2261, 0, 1, 2);
  octopus.bench.run(4s);
  EXPECT_EQ(read(0x2262), 6u) << "the line stays high: an alarm";
  EXPECT_NEAR(board.servo().width_us, 1472, 10);
}

// What was described stays, and nothing heats by itself.
TEST(OctopusHeat, KeepsItsSettingsThroughAPowerCut) {
  OneOctopus octopus({}, &make_board<OctopusBoard>, true);
  octopus.bench.send(nmt_frame(NmtCommand::kEnterPreOperational, kHeat));
  octopus.bench.run(5ms);
  octopus.bench.write(kHeat, 0x2211, 1, 2, 2750);
  octopus.write(0, 0x6081, 0, 4, 11'111);
  octopus.bench.send(CanFrame::make(0x600u + kHeat, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
  octopus.bench.run(3s);
  octopus.bench.send(CanFrame::make(0x600u + kId, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
  octopus.bench.run(3s);
  octopus.machine.power_cycle(0);
  octopus.bench.run(octopus.board.boot_time() + 200ms);
  EXPECT_EQ(octopus.board.watchdog_resets(), 0u);
  const CanFrame limit = octopus.bench.upload(kHeat, 0x2211, 1);
  EXPECT_EQ(get_u16_le(limit.bytes().subspan(4)), 2750);
  EXPECT_EQ(octopus.read(0, 0x6081), 11'111);
  EXPECT_FALSE(octopus.board.anything_on());
}

}  // namespace
}  // namespace kinebus::emulator
