// The Octopus' image on its emulated board: comes up, homes, moves; its steps are judged at the drivers'
// pins.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/tests/octopus_bench.hpp"

namespace kinebus::emulator {
namespace {

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

TEST(Octopus, OneImageIsForCrystalsOf12And8Mhz) {
  for (const std::uint32_t hz : octopus::kCrystals) {
    OneOctopus node({.crystal_hz = hz});
    EXPECT_EQ(node.board.rcc().system_hz(), 168'000'000u) << hz;
    EXPECT_EQ(node.board.rcc().usb_hz(), 48'000'000u) << hz;
    EXPECT_TRUE(node.board.lost_accesses().empty());
  }
  OctopusBoard other(octopus_image(), {.unique_id = {1, 2, 3}, .crystal_hz = 25'000'000});
  other.run(kCoreHz / 2);
  EXPECT_FALSE(other.can().listening());
  for (const auto& request : other.can().take_requests()) EXPECT_TRUE(request.abort) << "it says nothing";
  EXPECT_FALSE(other.anything_on());
}

// No edge of the crystal comes to the meter: a mistake there must not keep a good board from the bus.
TEST(Octopus, ACrystalThatCannotBeMeasuredIsToldAndTakenForItsOwn) {
  OneOctopus node({.measures_crystal = false});
  EXPECT_EQ(node.board.rcc().system_hz(), 168'000'000u);
  EXPECT_EQ(node.board.resets(), 0u);
  EXPECT_EQ(node.bench.read(kId, 0x2121, 2), fault_reason::kUnmeasuredCrystal);
  EXPECT_EQ(node.bench.read(kId, 0x1003, 1) & 0xFFFF, emcy::kCrystal);
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
  EXPECT_EQ(codes[0], emcy::kOtherBoard);
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

// A sector of 128 KiB takes two seconds to erase, in which the processor stands still.
TEST(Octopus, StoresItsParametersWhileNoDriverIsEnabled) {
  OneOctopus node({}, &make_board<OctopusBoard>, true);
  node.write(0, 0x6081, 0, 4, 12'345);
  node.bench.send(CanFrame::make(0x600u + kId, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
  node.bench.run(5s);
  node.machine.power_cycle(0);
  node.bench.run(node.board.boot_time() + 100ms);
  EXPECT_EQ(node.board.watchdog_resets(), 0u);
  node.bench.enable(kId, 0, 1);
  EXPECT_EQ(node.read(0, 0x6081), 12'345);
  node.bench.move(kId, 0, 16'000, 100'000, 1'000'000);
  node.bench.run(400ms);
  EXPECT_EQ(node.board.driver(0).steps(), 1'000);
}

}  // namespace
}  // namespace kinebus::emulator
