// The program of a node between its drivers and its core.

#include "node_firmware/board/node_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "node_firmware/board/tests/fake_drivers.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

struct Program : testing::Test {
  Program() { run(20ms); }
  void run(LocalTime time) {
    for (LocalTime t{0}; t < time; t += 500us) {
      fake::pass_time(500us);
      program.pass();
    }
  }
  fake::Can can;
  fake::Switches switches;
  MotionPlanExchange plan;
  NodeProgram<fake::Can, fake::Switches, fake::Counter> program{
      NodeOptions{.node_id = 5}, {}, can, switches, plan};
};

TEST_F(Program, SaysThatItHasStartedAndAnswers) {
  ASSERT_FALSE(can.sent.empty());
  EXPECT_EQ(can.sent.front(), CanFrame::make(0x705, {0}));
  can.sent.clear();
  can.arrive(CanFrame::make(0x605, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0}));
  program.pass();
  ASSERT_EQ(can.sent.size(), 1u);
  EXPECT_EQ(can.sent[0].id, 0x585u);
}

TEST_F(Program, HearsWhatIsItsOwnAndWhatAllHear) {
  for (const int id : {0x000, 0x080, 0x081, 0x0FF, 0x7E5, 0x605, 0x205, 0x305, 0x405, 0x505})
    EXPECT_TRUE(can.heard(id)) << std::hex << id;
  for (const int id : {0x606, 0x206, 0x181, 0x701, 0x585}) EXPECT_FALSE(can.heard(id)) << std::hex << id;
  // 1016h:1: node 1, 100 ms.
  can.sent.clear();
  can.arrive(CanFrame::make(0x605, {0x23, 0x16, 0x10, 1, 100, 0, 1, 0}));
  program.pass();
  ASSERT_FALSE(can.sent.empty()) << "answered";
  EXPECT_TRUE(can.heard(0x701)) << "a heartbeat that is watched, from the answer on";
  // One that came while a pass had begun already is answered in that pass, too.
  can.sent.clear();
  can.arrive(CanFrame::make(0x605, {0x23, 0x16, 0x10, 2, 100, 0, 2, 0}), fake::Counter::now + 200);
  program.pass();
  ASSERT_FALSE(can.sent.empty()) << "answered";
  EXPECT_TRUE(can.heard(0x702));
}

TEST_F(Program, TakesFramesAndEdgesInTheOrderInWhichTheyHappened) {
  // Input 1 without debouncing; 2133h tells of the edges that came before the question.
  can.arrive(CanFrame::make(0x605, {0x2B, 0x32, 0x21, 1, 0, 0, 0, 0}));
  run(5ms);
  const auto ask = [&](std::uint32_t question_after, std::uint32_t edge_after, bool level) {
    can.sent.clear();
    can.arrive(CanFrame::make(0x605, {0x40, 0x33, 0x21, 0, 0, 0, 0, 0}), fake::Counter::now + question_after);
    switches.in.push_back({fake::Counter::now + edge_after, 0, level});
    fake::pass_time(500us);
    program.pass();
    for (const CanFrame& frame : can.sent)
      if (frame.id == 0x585) return static_cast<int>(frame.data[4]);
    return -1;
  };
  EXPECT_EQ(ask(100, 200, true), 0);
  EXPECT_EQ(ask(100, 200, false), 1);
  EXPECT_EQ(ask(200, 100, true), 1);
  EXPECT_EQ(ask(200, 100, false), 0);
}

TEST_F(Program, TakesEightInputsAPassSoThatWhatIsDueIsServed) {
  can.sent.clear();
  for (int i = 0; i < 12; ++i) can.arrive(CanFrame::make(0x000, {1, 6}));
  program.pass();
  EXPECT_EQ(can.in.size(), 4u);
  program.pass();
  EXPECT_TRUE(can.in.empty());
}

// Half of the bus are EMCYs of others that ask for nothing: no node looks at them. A PDO may have such a
// number.
TEST_F(Program, AnEmcyThatAsksForNothingIsHeardOnlyWhereAPdoHasItsNumber) {
  const CanFrame shut_down = CanFrame::make(0x0C5, {6, 0, 6, 0, 1, 1});
  const auto state = [&] { return program.node().axis(0).state(); };
  can.arrive(CanFrame::make(0x000, {1, 5}));
  can.arrive(shut_down);
  run(5ms);
  EXPECT_EQ(state(), cia402::State::kSwitchOnDisabled);
  can.arrive(CanFrame::make(0x605, {0x23, 0x00, 0x14, 1, 0x05, 0x02, 0, 0x80}));
  can.arrive(CanFrame::make(0x605, {0x23, 0x00, 0x14, 1, 0xC5, 0x00, 0, 0}));
  run(5ms);
  can.arrive(shut_down);
  run(5ms);
  EXPECT_EQ(state(), cia402::State::kReadyToSwitchOn);
}

// Frames that no node hears are no reason to look what is due; what the controller has to tell is.
TEST_F(Program, ReceiveOverrunsAreToldThoughNothingElseHasCome) {
  run(10ms);  // what is heard was looked at just now
  can.sent.clear();
  can.seen.overruns = 1;
  run(1ms);
  EXPECT_TRUE(can.told(0x8110));
}

TEST_F(Program, TellsOfTheBusWhatTheControllerSaw) {
  can.sent.clear();
  can.seen.overruns = 1;
  can.seen.passive = 1;
  program.tell_each([](std::size_t, Node&) { return true; });
  program.pass();
  run(5ms);
  EXPECT_TRUE(can.told(0x8110));
  EXPECT_TRUE(can.told(0x8120));
  can.seen.bus_off = 1;
  can.off = true;
  program.tell_each([](std::size_t, Node&) { return true; });
  program.pass();
  EXPECT_FALSE(can.told(0x8140)) << "nobody would hear it";
  can.off = false;
  program.tell_each([](std::size_t, Node&) { return true; });
  program.pass();
  run(5ms);
  EXPECT_TRUE(can.told(0x8140));
}

// An axis that goes its own way, and a stop that was asked for 1.25 ms before the motors can be told.
TEST_F(Program, AStopBeginsWhereTheMotorsAreNotWhereTheyWereWhenItCame) {
  LocalTime now = program.read_time();
  fake::enable(program.node(), now, 0);
  const auto write = [&](std::uint16_t index, std::uint32_t value) {
    can.arrive(
        CanFrame::make(0x605, {0x23, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8),
                               0, static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
                               static_cast<std::uint8_t>(value >> 16), 0}));
    run(1ms);
  };
  write(0x607F, 400'000);
  write(0x6081, 200'000);
  write(0x6083, 6'400'000);
  write(0x6084, 6'400'000);
  write(0x6085, 6'400'000);
  write(0x607A, 100'000);
  can.arrive(CanFrame::make(0x605, {0x2B, 0x40, 0x60, 0, 0x1F, 0, 0, 0}));
  run(200ms);
  const auto commanded = [&] { return plan.current().at(0, fake::Counter::now); };
  const double counts = 4294967296.0;
  const double speed = static_cast<double>(commanded().velocity);
  ASSERT_NEAR(speed / counts / 512e-6, 200'000, 2'000) << "it moves";
  // EMCY of node 7: stop. The pass comes late.
  const StopRequest stop{.reason = StopReason::kEmergencyStopInput,
                         .start = BusTime{program.now() / 1us * 1us}};
  can.arrive(encode(Emergency{.node = 7, .code = 0xFF01, .error_register = 1, .vendor = encode(stop)}));
  fake::pass_time(1250us);
  const MotionPlan::Point before = commanded();
  program.pass();
  const MotionPlan::Point after = commanded();
  ASSERT_TRUE(program.node().path().stop_latched());
  EXPECT_NEAR(static_cast<double>(after.position - before.position) / counts, 0, 0.05);
  EXPECT_NEAR(static_cast<double>(after.velocity - before.velocity) / speed, 0, 0.01);
  run(100ms);
  EXPECT_EQ(commanded().velocity, 0);
  EXPECT_LT(static_cast<double>(commanded().position - after.position) / counts, 3'300) << "v^2 / 2a = 3125";
}

TEST_F(Program, APowerStageThatDoesNotMeasureGetsNoPower) {
  int refused = 0;
  const auto refuse = [&] {
    program.tell_each([&](std::size_t, Node& node) {
      const bool did = refuse_power(node, program.read_time(), emcy::kOtherBoard);
      refused += did ? 1 : 0;
      return did;
    });
  };
  refuse();
  EXPECT_EQ(refused, 0);
  LocalTime now = program.read_time();
  fake::enable(program.node(), now, 1);
  ASSERT_TRUE(program.node().drive(1).power);
  refuse();
  EXPECT_EQ(refused, 1);
  EXPECT_FALSE(program.node().drive(1).power);
  run(5ms);
  EXPECT_TRUE(can.told(0x5210));
}

}  // namespace
}  // namespace kinebus
