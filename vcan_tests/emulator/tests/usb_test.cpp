// The image at a computer's USB port while its motors turn: enumeration, console, bus reset, a pulled cable,
// nonsense, and the way into the chip's own boot loader.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "vcan_tests/emulator/tests/one_board.hpp"
#include "vcan_tests/emulator/tests/usb_host.hpp"

namespace kinebus::emulator {
namespace {

constexpr int kControl = kFirstInterrupt + AdcBlock::kIrq, kCanReceive = kFirstInterrupt + 20;

/// Both motors turn, back and forth, as long as the test lasts; whatever USB does, nothing of that changes.
struct Usb : testing::Test {
  Usb() {
    node.configure(1500, 1);
    node.enable(1);
    turn();
    node.bench.run(50ms);
    node.board.cpu().clear_costs();
    began = node.board.now();
    before = node.bench.seen.size();
  }
  void turn() {
    for (int axis = 0; axis < 2; ++axis)
      node.bench.move(OneBoard::kId, axis, axis == 0 ? 500'000 : -500'000, 200'000, 2'000'000);
  }
  void pass(BusTime span) {
    node.bench.run(span, 1ms, [&] {
      for (int axis = 0; axis < 2; ++axis) off_course = std::max(off_course, std::abs(node.error(axis)));
    });
  }
  void TearDown() override {
    const ExceptionCost& control = node.board.cpu().cost(kControl);
    const double periods =
        static_cast<double>(node.board.now() - began) / (static_cast<double>(kCoreHz) / 20'000);
    fmt::print("{} control interrupts, worst {} cycles, {:.2f} us late; rotors at most {:.1f} counts off\n",
               control.calls, control.worst_cycles, static_cast<double>(control.worst_latency) / 168,
               off_course);
    EXPECT_NEAR(static_cast<double>(control.calls), periods, 2) << "no control period is left out";
    EXPECT_LE(control.worst_cycles, 0.35 * 8400);
    EXPECT_LE(static_cast<double>(control.worst_latency) / 168, 1.5) << "us";
    EXPECT_EQ(node.board.cpu().cost(kFirstInterrupt + OtgHs::kIrq).calls, 0u);
    EXPECT_LT(off_course, 0.2 * 256);
    EXPECT_TRUE(node.bench.emergencies(OneBoard::kId, before).empty());
    EXPECT_EQ(node.board.resets(), 0u);
    for (const std::string& violation : node.board.usb().violations()) ADD_FAILURE() << violation;
    EXPECT_TRUE(node.board.strange_accesses().empty());
  }

  OneBoard node{{.unique_id = {0x0012'3456, 0x789A'BCDE, 0xF000'0001}}};
  UsbHost host{node.board, [this](BusTime span) { pass(span); }};
  Cycle began = 0;
  std::size_t before = 0;
  double off_course = 0;
};

TEST_F(Usb, EnumeratesAndAnswersTheConsoleAsUsartDoes) {
  EXPECT_FALSE(host.sees_device()) << "without VBUS nothing is pulled up";
  host.plug();
  ASSERT_TRUE(host.enumerate());
  EXPECT_EQ(host.text(1), "Kinebus");
  EXPECT_EQ(host.text(2), "Kinebus node");
  EXPECT_EQ(host.text(3), "00123456789ABCDEF0000001");
  EXPECT_EQ(host.notification(), (UsbHost::Bytes{0xA1, 0x20, 0, 0, 0, 0, 2, 0, 3, 0}));
  const std::string version = host.ask("v");
  const auto serial = static_cast<std::uint32_t>(node.bench.read(OneBoard::kId, 0x1018, 4));
  EXPECT_EQ(version.find(fmt::format("Kinebus node, serial {} image bytes ", serial)), 0u) << version;
  node.board.console().receive("v");
  pass(20ms);
  EXPECT_EQ(node.board.console().take_sent(), version);
  const std::string state = host.ask("s");
  EXPECT_NE(state.find("node 5 NMT 5"), std::string::npos) << state;
  EXPECT_NE(state.find("\r\nB: state "), std::string::npos) << state;
  EXPECT_GT(state.size(), 128u) << "several packets";
  EXPECT_NE(host.ask("vc").find("CAN overruns 0"), std::string::npos);
  EXPECT_EQ(host.ask("DFU"), "refused: an axis has power\r\n");
}

TEST_F(Usb, ABusResetAndAPulledCableEndWhatWasUnderWayAndNothingElse) {
  host.plug();
  ASSERT_TRUE(host.enumerate());
  ASSERT_TRUE(host.write("sss"));
  EXPECT_EQ(host.read_packet().size(), 63u);
  ASSERT_TRUE(host.enumerate(8)) << "a bus reset in the middle of an answer";
  EXPECT_EQ(host.ask("v").find("Kinebus node"), 0u) << "nothing is left of the answer before";
  ASSERT_TRUE(host.write("s"));
  host.unplug();
  pass(5ms);
  EXPECT_FALSE(host.sees_device());
  host.plug();
  pass(5ms);
  EXPECT_FALSE(host.sees_device()) << "a plug's contacts bounce";
  ASSERT_TRUE(host.enumerate(9));
  EXPECT_EQ(host.ask("c").find("CAN overruns 0"), 0u);
  node.board.usb().suspend();
  pass(20ms);
  EXPECT_EQ(host.ask("v").find("Kinebus node"), 0u) << "after sleep it is what it was";
}

TEST_F(Usb, AHostThatDoesNotReadIsNotHeard) {
  host.plug();
  ASSERT_TRUE(host.enumerate());
  int taken = 0;
  while (taken < 10 && host.write(std::string(64, 's'))) ++taken;
  EXPECT_LT(taken, 3);
  std::string all;
  for (std::string packet = host.read_packet(); !packet.empty() && all.size() < 2000;
       packet = host.read_packet())
    all += packet;
  EXPECT_GE(all.size(), 2000u);
  EXPECT_TRUE(host.command({0x21, 0x22, 0})) << "the terminal is closed";
  ASSERT_TRUE(host.enumerate());
  EXPECT_EQ(host.ask("v").find("Kinebus node"), 0u);
}

TEST_F(Usb, StallsNonsenseAndGoesOn) {
  host.plug();
  ASSERT_TRUE(host.enumerate());
  std::mt19937 random(405);
  for (int i = 0; i < 200; ++i) {
    const auto word = [&] { return static_cast<std::uint16_t>(random()); };
    UsbHost::Request request{static_cast<std::uint8_t>(word()), static_cast<std::uint8_t>(word() % 16),
                             word(), word(), word()};
    // Not what a host would have to follow: address and configuration.
    if (request.type == 0) request.type = 0x40;
    SCOPED_TRACE(fmt::format("request {}: {:02x} {:02x}", i, request.type, request.request));
    ASSERT_EQ(host.setup(request), UsbHost::Answer::kAck);
    if (i % 3 == 0) {
      EXPECT_FALSE(host.command(request));
    }
  }
  EXPECT_EQ(host.ask("v").find("Kinebus node"), 0u);
  EXPECT_FALSE(host.command({0x21, 0x20, 0, 0, 8}, UsbHost::Bytes(8))) << "a line coding has seven bytes";
  EXPECT_TRUE(host.command({0x21, 0x20, 0, 0, 7}, UsbHost::Bytes{0x80, 0x25, 0, 0, 0, 0, 8}));
  EXPECT_EQ(host.read({0xA1, 0x21, 0, 0, 7}), (UsbHost::Bytes{0x80, 0x25, 0, 0, 0, 0, 8}));
  EXPECT_TRUE(host.command({0x02, 3, 0, 0x81}));
  EXPECT_TRUE(host.read_packet().empty()) << "halted";
  EXPECT_TRUE(host.command({0x02, 1, 0, 0x81}));
  host.forget_toggle(1);
  EXPECT_EQ(host.ask("v").find("Kinebus node"), 0u);
}

/// Boot loader and program, as they lie in flash.
ElfImage both() {
  ElfImage program = firmware_image();
  const std::string path = KINEBUS_FIRMWARE_IMAGE;
  const ElfImage boot = load_elf(path.substr(0, path.rfind('/')) + "/kinebus-boot.elf");
  program.pieces.insert(program.pieces.end(), boot.pieces.begin(), boot.pieces.end());
  return program;
}

TEST(SystemBoot, IsEnteredFromTheConsoleOnlyWhenNoAxisHasPower) {
  const ElfImage image = both();
  OneBoard node({}, 1, image);
  UsbHost host(node.board, [&](BusTime span) { node.bench.run(span); });
  host.plug();
  ASSERT_TRUE(host.enumerate());
  node.configure(1500, 0);
  node.enable(1);
  EXPECT_EQ(host.ask("DFU"), "refused: an axis has power\r\n");
  EXPECT_EQ(node.board.resets(), 0u);
  for (int axis = 0; axis < 2; ++axis) node.write(axis, 0x6040, 0, 2, 0);
  node.bench.run(50ms);
  EXPECT_NE(host.ask("DF").find("s state"), 0u) << "half of it is nothing";
  EXPECT_EQ(host.ask("Dv").find("Kinebus node"), 0u);
  EXPECT_EQ(node.board.resets(), 0u);
  host.write("DFU");
  node.bench.run(10ms);
  EXPECT_EQ(node.board.resets(), 1u);
  EXPECT_EQ(node.board.cpu().pc() & ~0x3FFu, CortexM4::kSystemBoot);
  EXPECT_TRUE(node.board.system_boot_selected());
  EXPECT_FALSE(host.sees_device());
  EXPECT_EQ(node.board.watchdog_resets(), 0u);
  node.bench.run(1s);
  EXPECT_EQ(node.board.resets(), 1u) << "no watchdog runs";
  node.board.power_cycle();
  node.bench.run(200ms);
  EXPECT_FALSE(node.board.system_boot_selected());
  ASSERT_TRUE(host.enumerate()) << "the program is back";
}

}  // namespace
}  // namespace kinebus::emulator
