// The console's answers.

#include "node_firmware/board/console.hpp"

#include <gtest/gtest.h>

#include "node_firmware/board/tests/fake_drivers.hpp"

namespace kinebus {
namespace {

struct Talk : testing::Test {
  std::string say(std::string_view letters) {
    const Console::Subject subject{.node = node,
                                   .motors = motors,
                                   .cycles = {100, 200},
                                   .control_interrupts = 300,
                                   .can = events,
                                   .off_the_bus = true,
                                   .serial = 4'000'000'000,
                                   .image_bytes = 1234};
    for (const char letter : letters) console.hear(letter, subject);
    std::string text(console.waiting().begin(), console.waiting().end());
    console.forget();
    return text;
  }
  LocalTime now{0};
  LoneNode node{NodeOptions{.node_id = 5}, now};
  MotorSupervision motors{BridgeFacts{0, 20'000}};
  CanEvents events{1, 2, 3};
  Console console;
};

TEST_F(Talk, OneLetterAsks) {
  EXPECT_EQ(say("c"), "CAN overruns 1 bus-off 2 passive 3 OFF THE BUS\r\n");
  EXPECT_EQ(say("t"), "control cycles last 100 worst 200 interrupts 300\r\n");
  EXPECT_EQ(say("v"), "Kinebus node, serial 4000000000 image bytes 1234\r\n");
  EXPECT_EQ(say("?"), "s state, c CAN, r reset, t timing, v version, DFU: USB boot loader\r\n");
  const std::string state = say("s");
  EXPECT_EQ(state.rfind("node 5 NMT 127 supply mV 0\r\nA: state", 0), 0u) << state;
  EXPECT_NE(state.find("\r\nB: state"), std::string::npos) << state;
}

TEST_F(Talk, ABusThatIsNotThereIsSaid) {
  const Console::Subject subject{.node = node, .motors = motors, .cycles = {}, .can = events, .no_bus = true};
  console.hear('c', subject);
  const std::string text(console.waiting().begin(), console.waiting().end());
  EXPECT_EQ(text, "CAN overruns 1 bus-off 2 passive 3 NO BUS\r\n");
}

TEST_F(Talk, WhyTheProgramBeganAnew) {
  EXPECT_EQ(say("r"), "reset by power-on\r\n");
  const LoneNode again{NodeOptions{.node_id = 5,
                                   .reset = {.cause = ResetCause::kSoftware,
                                             .reason = 3,
                                             .pc = 0x0802'1234,
                                             .lr = 0x0802'5679,
                                             .cfsr = 0x8200,
                                             .hfsr = 0x4000'0000,
                                             .address = 0x2002'0000}},
                       now};
  const Console::Subject subject{.node = again, .motors = motors, .cycles = {}, .can = events};
  console.hear('r', subject);
  const std::string text(console.waiting().begin(), console.waiting().end());
  EXPECT_EQ(text,
            "reset by program fault 3 PC 08021234 LR 08025679 CFSR 00008200 HFSR 40000000 at 20020000\r\n");
}

TEST_F(Talk, AnAnswerThatIsNotReadWhollyGoesOnWhereItWas) {
  say("");
  const Console::Subject subject{
      .node = node, .motors = motors, .cycles = {}, .can = events, .serial = 7, .image_bytes = 8};
  console.hear('v', subject);
  const std::string all(console.waiting().begin(), console.waiting().end());
  console.sent(10);
  EXPECT_EQ(std::string(console.waiting().begin(), console.waiting().end()), all.substr(10));
  console.sent(all.size() - 10);
  EXPECT_TRUE(console.waiting().empty());
}

TEST_F(Talk, TheChipsBootLoaderIsAskedForInFullAndOnlyWithoutPower) {
  say("DF");
  EXPECT_FALSE(console.system_boot_requested());
  say("sDF");
  say("s");
  EXPECT_FALSE(console.system_boot_requested());
  fake::enable(node, now, 1);
  EXPECT_EQ(say("DFU"), "refused: an axis has power\r\n");
  EXPECT_FALSE(console.system_boot_requested());
  LoneNode idle{NodeOptions{.node_id = 6}, now};
  const Console::Subject subject{.node = idle, .motors = motors, .cycles = {}, .can = events};
  for (const char letter : {'D', 'F', 'U'}) console.hear(letter, subject);
  EXPECT_TRUE(console.system_boot_requested());
}

}  // namespace
}  // namespace kinebus
