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

// The comparator speaks for 1 us, at every place of the control interrupt where an interrupt can come: the
// outputs stay off from then on.
TEST_F(Fault, ABreakIsNotUndoneWhereverInTheControlInterruptItComes) {
  Board& board = node.board;
  constexpr int kControl = kFirstInterrupt + 18;
  const auto to_control = [&] {
    while (board.cpu().nvic().active_exception() == kControl) board.run(board.now() + 1);
    while (board.cpu().nvic().active_exception() != kControl) board.run(board.now() + 1);
  };
  int breaks = 0;
  for (Cycle into = 0;; into += 12) {
    to_control();
    const Cycle at = board.now() + into;
    while (board.now() < at && board.cpu().nvic().active_exception() == kControl) board.run(board.now() + 1);
    if (board.now() < at) break;  // the interrupt has ended before
    ASSERT_TRUE(board.pwm(0).sweep().main_output);
    board.pwm(0).set_break_level(false, board.now());
    board.run(board.now() + 168);
    board.pwm(0).set_break_level(true, board.now());
    ++breaks;
    for (const Cycle end = board.now() + 3 * 8400; board.now() < end; board.run(board.now() + 20))
      ASSERT_FALSE(board.pwm(0).sweep().main_output) << into << " cycles into the interrupt";
    node.bench.run(120ms);  // what a fault has left is gone
    node.write(0, 0x6040, 0, 2, 0x80);
    node.bench.enable(OneBoard::kId, 0, 1);
  }
  fmt::print("{} breaks\n", breaks);
  EXPECT_GT(breaks, 100);
  EXPECT_TRUE(node.told(0x2320, before));
}

TEST_F(Fault, PowerComesBackWithoutAVoltageThatWasOfBefore) {
  Board& board = node.board;
  const auto voltage = [&](int phase) {  // of the two half-bridges, in counts of the timer
    const auto& compare = board.pwm(0).sweep().compare;
    const auto first = static_cast<std::size_t>(2 * phase);
    return std::abs(static_cast<int>(compare[first]) - static_cast<int>(compare[first + 1]));
  };
  for (int i = 0; i < 1000 && voltage(0) + voltage(1) < 400; ++i) node.bench.run(1ms);
  ASSERT_GE(voltage(0) + voltage(1), 400) << "turning";
  board.pwm(0).set_break_level(false, board.now());
  board.run(board.now() + 168);
  board.pwm(0).set_break_level(true, board.now());
  node.bench.run(200ms);
  ASSERT_FALSE(board.pwm(0).sweep().main_output);
  for (const int word : {0x80, 0x06}) node.write(0, 0x6040, 0, 2, word);
  // By hand from here, to see the first cycle with power.
  constexpr std::array<std::uint8_t, 2> kWords{0x07, 0x0F};
  for (const std::uint8_t word : kWords)
    node.bench.send(CanFrame::make(0x600 + OneBoard::kId, {0x2B, 0x40, 0x60, 0, word, 0, 0, 0}));
  bool on = false;
  for (int i = 0; i < 2'000 && !on; ++i) {
    node.bench.run(20us);
    on = board.pwm(0).sweep().main_output;
  }
  ASSERT_TRUE(on);
  EXPECT_LE(voltage(0), 2);
  EXPECT_LE(voltage(1), 2);
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

TEST_F(Fault, AnExceptionOfTheProcessorLetsGoOfTheMotorsAndStartsTheProgramAnew) {
  // The node id came by LSS: kept from now on.
  for (int axis = 0; axis < 2; ++axis) node.write(axis, 0x6040, 0, 2, 0);
  for (const CanFrame& lss :
       {CanFrame::make(0x7E5, {4, 1, 0, 0, 0, 0, 0, 0}), CanFrame::make(0x7E5, {23, 0, 0, 0, 0, 0, 0, 0}),
        CanFrame::make(0x7E5, {4, 0, 0, 0, 0, 0, 0, 0})}) {
    node.bench.send(lss);
    node.bench.run(50ms);
  }
  Board& board = node.board;
  for (const bool hard_fault : {true, false}) {
    const std::uint64_t resets = board.resets();
    node.bench.enable(OneBoard::kId, 0, 1);
    node.bench.run(200ms);
    EXPECT_GT(std::abs(board.motor(0).current_a(0)) + std::abs(board.motor(0).current_a(1)), 1.0);
    const std::size_t from = node.bench.seen.size();
    if (hard_fault) {
      board.cpu().nvic().pend(kHardFault);
    } else {
      // An interrupt for which the program has no handler.
      constexpr int kTim2 = 28;
      board.cpu().nvic().write(0xE100, 1u << kTim2, board.now());
      board.cpu().nvic().pend(kFirstInterrupt + kTim2);
    }
    node.bench.run(5ms);
    EXPECT_EQ(board.resets(), resets + 1);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_FALSE(board.pwm(axis).sweep().main_output);
      EXPECT_NEAR(board.motor(axis).current_a(0), 0, 0.01);
      EXPECT_NEAR(board.motor(axis).current_a(1), 0, 0.01);
    }
    node.bench.run(100ms);
    const auto boot_up =
        std::find_if(node.bench.seen.begin() + static_cast<std::ptrdiff_t>(from), node.bench.seen.end(),
                     [](const GatewayBench::Seen& s) { return s.frame == CanFrame::make(0x705, {0}); });
    ASSERT_NE(boot_up, node.bench.seen.end()) << "the gateway learns of it";
    EXPECT_EQ(node.bench.statusword(OneBoard::kId, 0) & 0x4F, 0x40) << "switched off";
    EXPECT_EQ(board.watchdog_resets(), 0u);
    node.bench.send(nmt_frame(NmtCommand::kStart, OneBoard::kId));
    node.bench.run(20ms);
  }
}

TEST_F(Fault, BusOffIsToldWhenTheBusIsBack) {
  node.machine.disturb(0, 32);
  node.bench.write(OneBoard::kId, 0x1802, 5, 2, 10);  // it speaks often, also in motion
  node.bench.run(200ms);
  expect(0x8140, 5.0);
  EXPECT_EQ(node.board.can().counters().bus_offs, 1u);
}

}  // namespace
}  // namespace kinebus::emulator
