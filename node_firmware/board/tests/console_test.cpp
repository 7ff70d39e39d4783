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
  Node node{NodeOptions{.node_id = 5}, now};
  MotorSupervision motors{BridgeFacts{0, 20'000}};
  CanEvents events{1, 2, 3};
  Console console;
};

TEST_F(Talk, OneLetterAsks) {
  EXPECT_EQ(say("c"), "CAN overruns 1 bus-off 2 passive 3 OFF THE BUS\r\n");
  EXPECT_EQ(say("t"), "control cycles last 100 worst 200 interrupts 300\r\n");
  EXPECT_EQ(say("v"), "Kinebus node, serial 4000000000 image bytes 1234\r\n");
  EXPECT_EQ(say("?"), "s state, c CAN, t timing, v version, DFU: USB boot loader\r\n");
  const std::string state = say("s");
  EXPECT_EQ(state.rfind("node 5 NMT 127 supply mV 0\r\nA: state", 0), 0u) << state;
  EXPECT_NE(state.find("\r\nB: state"), std::string::npos) << state;
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
  Node idle{NodeOptions{.node_id = 6}, now};
  const Console::Subject subject{.node = idle, .motors = motors, .cycles = {}, .can = events};
  for (const char letter : {'D', 'F', 'U'}) console.hear(letter, subject);
  EXPECT_TRUE(console.system_boot_requested());
}

}  // namespace
}  // namespace kinebus
