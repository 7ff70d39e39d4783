// What a real chip does and a friendly one does not: long flash times, faults and resets, a bus that is not
// there, a crystal that stops, a supply that dips.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "node_firmware/core/reset_report.hpp"
#include "vcan_tests/emulator/tests/one_board.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kDeviceState = 0x0800'0022;

// 100 us a word and 0.5 s an erase, in which no control interrupt comes.
TEST(Silicon, NoFlashIsWrittenWhileAMotorHasPower) {
  OneBoard node;
  node.configure(1500, 0);
  node.enable(1);
  Board& board = node.board;
  const std::uint64_t erases = board.flash().erases(), words = board.flash().programs();
  EXPECT_EQ(node.bench.try_write(OneBoard::kId, 0x1010, 1, 4, 0x65766173), kDeviceState);
  EXPECT_EQ(node.bench.try_write(OneBoard::kId, 0x1011, 1, 4, 0x64616F6C), kDeviceState);
  EXPECT_EQ(node.bench.try_write(OneBoard::kId, 0x1F51, 1, 1, 0), kDeviceState);
  const std::size_t from = node.bench.seen.size();
  for (const CanFrame& lss :
       {CanFrame::make(0x7E5, {4, 1, 0, 0, 0, 0, 0, 0}), CanFrame::make(0x7E5, {23, 0, 0, 0, 0, 0, 0, 0}),
        CanFrame::make(0x7E5, {4, 0, 0, 0, 0, 0, 0, 0})}) {
    node.bench.send(lss);
    node.bench.run(20ms);
  }
  const CanFrame refused = CanFrame::make(0x7E4, {23, 255, 1, 0, 0, 0, 0, 0});
  EXPECT_TRUE(std::any_of(node.bench.seen.begin() + static_cast<std::ptrdiff_t>(from), node.bench.seen.end(),
                          [&](const GatewayBench::Seen& s) { return s.frame == refused; }));
  EXPECT_EQ(board.flash().erases(), erases);
  EXPECT_EQ(board.flash().programs(), words);
  // Without power all of it is written, as slowly as a chip may, and the watchdog waits.
  for (int axis = 0; axis < 2; ++axis) node.write(axis, 0x6040, 0, 2, 0);
  node.bench.run(20ms);
  const Cycle began = board.now();
  for (int i = 0; i < 8; ++i) {
    node.write(0, 0x6081, 0, 4, 1000 + i);
    node.bench.send(CanFrame::make(0x605, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
    node.bench.run(1s);
    ASSERT_NE(node.bench.last(0x585), nullptr);
    EXPECT_EQ(*node.bench.last(0x585), CanFrame::make(0x585, {0x60, 0x10, 0x10, 1, 0, 0, 0, 0})) << i;
  }
  EXPECT_GT(board.flash().programs(), words + 8);
  EXPECT_GT(board.now(), began);
  EXPECT_EQ(board.resets(), 0u);
  EXPECT_TRUE(node.bench.emergencies(OneBoard::kId).empty());
}

/// A board that has kept its id, and motors that hold.
struct Trace : testing::Test {
  Trace() {
    for (const CanFrame& lss :
         {CanFrame::make(0x7E5, {4, 1, 0, 0, 0, 0, 0, 0}), CanFrame::make(0x7E5, {23, 0, 0, 0, 0, 0, 0, 0}),
          CanFrame::make(0x7E5, {4, 0, 0, 0, 0, 0, 0, 0})}) {
      node.bench.send(lss);
      node.bench.run(200ms);
    }
    node.configure(1500, 0);
    node.enable(1);
    EXPECT_TRUE(bridges_on());
    EXPECT_EQ(last_reset(1), 0) << "power-on";
  }
  bool bridges_on() { return node.board.pwm(0).sweep().main_output && node.board.pwm(1).sweep().main_output; }
  std::int64_t last_reset(std::uint8_t sub) { return node.bench.read(OneBoard::kId, 0x2121, sub); }
  std::string ask(const char* letter) {
    node.board.console().take_sent();
    node.board.console().receive(letter);
    node.bench.run(50ms);
    return node.board.console().take_sent();
  }
  /// After a reset: the code is told and over, and in the history.
  void expect_told(std::uint16_t code) {
    EXPECT_TRUE(node.told(code)) << std::hex << code;
    EXPECT_EQ(node.bench.read(OneBoard::kId, 0x1001, 0), 0);
    ASSERT_EQ(node.bench.read(OneBoard::kId, 0x1003, 0), 1);
    EXPECT_EQ(node.bench.read(OneBoard::kId, 0x1003, 1) & 0xFFFF, code);
  }
  OneBoard node;
};

TEST_F(Trace, OfAHardFaultIsItsPlaceItsRegistersAndItsReason) {
  Board& board = node.board;
  const std::uint32_t pc = board.cpu().pc(), lr = board.cpu().lr();
  board.cpu().nvic().set_fault_status(0x8200, 0x4000'0000, 0x2002'0000);
  board.cpu().nvic().pend(kHardFault);
  node.bench.run(200ms);
  EXPECT_EQ(board.resets(), 1u);
  EXPECT_FALSE(bridges_on());
  expect_told(0x6100);
  EXPECT_EQ(last_reset(1), 4) << "by the program";
  EXPECT_EQ(last_reset(2), kHardFault);
  EXPECT_EQ(last_reset(3), pc);
  EXPECT_EQ(last_reset(4), lr);
  EXPECT_EQ(last_reset(5), 0x8200);
  EXPECT_EQ(last_reset(6), 0x4000'0000);
  EXPECT_EQ(last_reset(7), 0x2002'0000);
  const std::string text = ask("r");
  std::array<char, 80> first{};
  std::snprintf(first.data(), first.size(), "reset by program fault 3 PC %08X LR %08X ", pc, lr);
  EXPECT_EQ(text.rfind(first.data(), 0), 0u) << text;
  EXPECT_NE(text.find("CFSR 00008200 HFSR 40000000 at 20020000\r\n"), std::string::npos) << text;
  // The next one tells of itself alone.
  board.cpu().nvic().write(0xED0C, 0x05FA'0004, board.now());
  node.bench.run(200ms);
  EXPECT_EQ(board.resets(), 2u);
  EXPECT_EQ(last_reset(2), 0);
  EXPECT_EQ(node.bench.read(OneBoard::kId, 0x1003, 0), 0);
}

TEST_F(Trace, OfAControlThatStandsStillIsTheWatchdog) {
  constexpr std::uint32_t kDisableIrqs = 0xE180, kAdc = 1u << 18;
  node.board.cpu().nvic().write(kDisableIrqs, kAdc, node.board.now());
  node.bench.run(500ms);
  EXPECT_EQ(node.board.watchdog_resets(), 1u);
  EXPECT_FALSE(bridges_on());
  expect_told(0x6100);
  EXPECT_EQ(last_reset(1), 3);
  EXPECT_EQ(node.bench.read(OneBoard::kId, 0x2120, 19), 1);
  EXPECT_EQ(ask("r"), "reset by watchdog\r\n");
}

TEST_F(Trace, OfABrownOutIsAnUndervoltage) {
  node.board.set_chip_supply(1.75);
  node.board.set_chip_supply(3.3);
  node.bench.run(200ms);
  EXPECT_FALSE(bridges_on());
  expect_told(0x3220);
  EXPECT_EQ(last_reset(1), 2);
  EXPECT_EQ(ask("r"), "reset by brown-out\r\n");
}

TEST_F(Trace, OfACrystalThatStopsIsTheClockSecuritySystem) {
  node.board.set_crystal(false);
  node.bench.run(1ms);
  EXPECT_FALSE(bridges_on());
  node.board.set_crystal(true);
  node.bench.run(200ms);
  expect_told(0x6100);
  EXPECT_EQ(last_reset(2), kNmi);
}

TEST_F(Trace, OfASupplyBelowTwoVoltsNineIsItsDetector) {
  node.board.set_chip_supply(2.85);
  node.bench.run(1ms);
  EXPECT_FALSE(bridges_on());
  node.board.set_chip_supply(3.3);
  node.bench.run(200ms);
  expect_told(0x6100);
  EXPECT_EQ(last_reset(2), kFirstInterrupt + 1);
}

// At another speed its bits would be of another length, and keep all others from the bus.
TEST(Silicon, WithAnotherCrystalOrNoneItShowsSoAndStaysOffTheBus) {
  constexpr std::uint32_t kRecordedReason = 0x2000'0044;  // behind the handover (sections.ld)
  struct Case {
    std::uint32_t crystal_hz;
    bool swings;
    std::uint32_t reason;
  };
  for (const Case& c : {Case{12'000'000, true, fault_reason::kOtherCrystal},
                        Case{25'000'000, true, fault_reason::kOtherCrystal},
                        Case{8'000'000, false, fault_reason::kNoClock}}) {
    SCOPED_TRACE(c.crystal_hz);
    Board board(firmware_image(), {.unique_id = {1, 2, 3}, .crystal_hz = c.crystal_hz});
    board.set_crystal(c.swings);
    int flashes = 0;
    bool lit = board.led_lit();
    for (int ms = 0; ms < 3000 && board.resets() == 0; ++ms) {
      board.run(board.now() + kCoreHz / 1000);
      if (!lit && board.led_lit()) ++flashes;
      lit = board.led_lit();
    }
    EXPECT_EQ(flashes, 16) << "four rounds of four";
    EXPECT_EQ(board.resets(), 1u);
    EXPECT_EQ(board.cpu().peek(kRecordedReason), c.reason);
    EXPECT_FALSE(board.can().listening());
    for (const auto& request : board.can().take_requests()) EXPECT_TRUE(request.abort) << "it says nothing";
  }
}

// No edge of the crystal comes to the meter: a mistake there must not keep a good board from the bus.
TEST(Silicon, ACrystalThatCannotBeMeasuredIsToldAndTakenForItsOwn) {
  OneBoard node({.measures_crystal = false});
  EXPECT_EQ(node.board.resets(), 0u);
  EXPECT_TRUE(node.board.can().listening());
  EXPECT_EQ(node.bench.read(OneBoard::kId, 0x2121, 2), fault_reason::kUnmeasuredCrystal);
  EXPECT_EQ(node.bench.read(OneBoard::kId, 0x1003, 1) & 0xFFFF, emcy::kCrystal);
}

TEST(Silicon, WithoutABusANodeStartsAndSaysSoAndJoinsWhenItComes) {
  ElfImage image = firmware_image();
  const std::string path = KINEBUS_FIRMWARE_IMAGE;
  const ElfImage boot = load_elf(path.substr(0, path.rfind('/')) + "/kinebus-boot.elf");
  image.pieces.insert(image.pieces.end(), boot.pieces.begin(), boot.pieces.end());
  Board board(image, {.unique_id = {1, 2, 3}});
  board.can().set_dominant(true, board.now());
  board.set_usb_cable(true);
  const auto run = [&](std::uint32_t ms) { board.run(board.now() + ms * (kCoreHz / 1000)); };
  run(100);
  EXPECT_TRUE(board.usb_device_seen());
  board.console().receive("c");
  run(50);
  EXPECT_EQ(board.console().take_sent(), "CAN overruns 0 bus-off 0 passive 0 NO BUS\r\n");
  // Two short flashes a second.
  int flashes = 0;
  bool lit = board.led_lit();
  for (int i = 0; i < 105; ++i) {
    run(10);
    if (!lit && board.led_lit()) ++flashes;
    lit = board.led_lit();
  }
  EXPECT_EQ(flashes, 2);
  EXPECT_EQ(board.resets(), 0u);
  EXPECT_FALSE(board.can().listening());
  board.can().set_dominant(false, board.now());
  run(20);
  EXPECT_TRUE(board.can().listening());
  board.can().take_requests();
  board.deliver(board.now() + 1000, CanFrame::make(0x7E5, {76, 0, 0, 0, 0, 0, 0, 0}));
  run(20);
  const auto answers = board.can().take_requests();
  ASSERT_FALSE(answers.empty());
  EXPECT_EQ(answers[0].frame.id, 0x7E4u) << "an unconfigured node answers LSS";
  board.console().receive("c");
  run(50);
  EXPECT_EQ(board.console().take_sent(), "CAN overruns 0 bus-off 0 passive 0\r\n");
  EXPECT_EQ(board.resets(), 0u);
}

}  // namespace
}  // namespace kinebus::emulator
