// What can break on a board, broken: the right EMCY, and no current that burns.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "vcan_tests/emulator/tests/one_board.hpp"

namespace kinebus::emulator {
namespace {

struct Fault : testing::Test {
  Fault() {
    node.configure(2500, 1);
    node.enable(1);
    before = node.bench.seen.size();
    EXPECT_TRUE(node.bench.emergencies(OneBoard::kId).empty());
    for (int axis = 0; axis < 2; ++axis) {
      node.board.motor(axis).clear_peak();
      node.bench.move(OneBoard::kId, axis, 200'000, 60'000, 500'000);
    }
    node.bench.run(200ms);
  }
  void expect(std::uint16_t code, double most_a) {
    double peak = 0;
    for (int axis = 0; axis < 2; ++axis) peak = std::max(peak, node.board.motor(axis).peak_current_a());
    const auto codes = node.bench.emergencies(OneBoard::kId, before);
    std::string list;
    for (const std::uint16_t c : codes) list += fmt::format(" {:04X}", c);
    fmt::print("EMCY{}; peak current {:.2f} A\n", list, peak);
    EXPECT_TRUE(node.told(code, before)) << std::hex << code;
    EXPECT_LT(peak, most_a);
  }
  OneBoard node;
  std::size_t before = 0;
};

TEST_F(Fault, AShortedPhaseIsCutOffBelowEightAmperes) {
  node.board.motor(0).set_winding(0, StepperMotor::Winding::kShorted);
  node.bench.run(100ms);
  expect(0x2320, 8.0);
  EXPECT_FALSE(node.board.pwm(0).sweep().main_output);
  EXPECT_TRUE(node.board.pwm(1).sweep().main_output) << "the other motor holds";
}

TEST_F(Fault, AMissingPhaseIsFound) {
  node.board.motor(1).set_winding(1, StepperMotor::Winding::kOpen);
  node.bench.run(300ms);
  expect(0x3130, 5.0);
}

TEST_F(Fault, ABlockedMotorIsAFollowingError) {
  node.board.motor(0).block(true);
  node.bench.run(500ms);
  expect(0x8611, 5.0);
}

TEST_F(Fault, AnUnpluggedEncoderIsTold) {
  node.board.encoder(1).unplug(true);
  node.bench.run(200ms);
  expect(0x7305, 5.0);
}

TEST_F(Fault, ADipOfTheSupplyIsToldAndStopsOnTheRamp) {
  node.board.set_supply(8);
  node.bench.run(20ms);
  node.board.set_supply(24);
  node.bench.run(400ms);
  expect(0x3220, 5.0);
  EXPECT_TRUE(node.board.pwm(0).sweep().main_output) << "the drives hold";
  EXPECT_LT(std::abs(node.board.motor(0).speed_rad_per_s()), 0.1) << "at rest";
}

TEST_F(Fault, AHotPowerStageIsTold) {
  node.board.set_temperature(0, 95);
  node.bench.run(400ms);
  expect(0x4310, 5.0);
}

TEST_F(Fault, BusOffIsToldWhenTheBusIsBack) {
  node.machine.disturb(0, 32);
  node.bench.write(OneBoard::kId, 0x1017, 0, 2, 10);
  node.bench.run(200ms);
  expect(0x8140, 5.0);
  EXPECT_EQ(node.board.can().counters().bus_offs, 1u);
}

}  // namespace
}  // namespace kinebus::emulator
