// Objects that show a node's own state: motor, driver, inputs, home, counters.

#include "node_firmware/core/tests/lone_bench.hpp"

namespace kinebus::testing_bench {
namespace {

std::uint16_t of_axis(int index, int axis) {
  return static_cast<std::uint16_t>(index + axis * 0x800);
}

TEST(NodeObjects, AMotorWithoutSensorsHasTheCurrentThatItIsToldToHave) {
  for (const int axis : {0, 1}) {
    Lone lone;
    ASSERT_EQ(lone.write(of_axis(0x2140, axis), 2, 2, 1'400), 0u);
    ASSERT_EQ(lone.write(of_axis(0x2140, axis), 3, 2, 900), 0u);
    const auto current = [&](int of) { return lone.read(of_axis(0x2150, of), 9); };
    EXPECT_EQ(current(axis), 0);
    lone.power(axis);
    EXPECT_EQ(current(axis), 900) << "it holds";
    EXPECT_EQ(current(1 - axis), 0);
    lone.unpower(axis);
    lone.start_move(axis);
    EXPECT_EQ(current(axis), 1'400) << "it runs";
    lone.wait(5s);
    EXPECT_EQ(current(axis), 900);
    lone.unpower(axis);
    EXPECT_EQ(current(axis), 0);
  }
}

TEST(NodeObjects, WhatAPortMeasuresIsShownOfItsAxis) {
  Lone lone;
  lone.node.set_feedback(0, {.following_error = 3,
                             .supply_mv = 24'100,
                             .temperature_dc = 412,
                             .current_ma = 1'234,
                             .tune_state = 2});
  lone.node.set_feedback(1, {.following_error = -5,
                             .supply_mv = 23'900,
                             .temperature_dc = -73,
                             .current_ma = -87,
                             .tune_state = 3});
  struct Shown {
    int index;
    std::uint8_t sub;
    std::int64_t first, second;
  };
  for (const Shown& s : {Shown{0x2150, 8, 2, 3}, Shown{0x2150, 9, 1'234, -87}, Shown{0x2150, 10, 412, -73},
                         Shown{0x6079, 0, 24'100, 23'900}, Shown{0x60F4, 0, 3, -5}, Shown{0x6064, 0, -3, 5},
                         Shown{0x6062, 0, 0, 0}}) {
    EXPECT_EQ(lone.read(of_axis(s.index, 0), s.sub), s.first) << std::hex << s.index << ":" << int{s.sub};
    EXPECT_EQ(lone.read(of_axis(s.index, 1), s.sub), s.second) << std::hex << s.index << ":" << int{s.sub};
  }
}

TEST(NodeObjects, WhoFollowsBadlySaysSoInTheModesThatHaveABitForIt) {
  for (const int axis : {0, 1})
    for (const int mode : {1, 3, 6, 8}) {
      Lone lone;
      EXPECT_EQ(lone.write(of_axis(0x6060, axis), 0, 1, mode), 0u);
      lone.power(axis);
      lone.control(0x0F, axis);
      const auto bit = [&](std::int32_t error, std::int64_t window) {
        EXPECT_EQ(lone.write(of_axis(0x6065, axis), 0, 4, window), 0u);
        lone.node.set_feedback(axis, {.following_error = error});
        return (lone.read(of_axis(0x6041, axis), 0) & 0x2000) != 0;
      };
      const bool quiet = bit(0, 100), has = mode == 1 || mode == 8;
      if (has) {
        EXPECT_FALSE(quiet) << mode;
      }
      EXPECT_EQ(bit(101, 100), has || quiet) << mode;
      EXPECT_EQ(bit(-101, 100), has || quiet) << mode;
      EXPECT_EQ(bit(100, 100), quiet) << mode;
      EXPECT_EQ(bit(-100, 100), quiet) << mode;
      EXPECT_EQ(bit(-5'000'000, 0xFFFF'FFFF), quiet) << "nobody watches";
    }
}

TEST(NodeObjects, WhatADriverSaysIsShownOfItsAxis) {
  Lone lone;
  lone.node.set_driver(0, {.state = 2, .status = 0x8010'0203, .stall_guard = 511, .found = 5160});
  lone.node.set_driver(1, {.state = 4, .status = 7, .stall_guard = 1, .found = 2209});
  const std::int64_t first[] = {2, 0x8010'0203, 511, 5160}, second[] = {4, 7, 1, 2209};
  const std::uint8_t subs[] = {5, 6, 7, 9};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(lone.read(0x2170, subs[i]), first[i]) << int{subs[i]};
    EXPECT_EQ(lone.read(0x2970, subs[i]), second[i]) << int{subs[i]};
  }
}

TEST(NodeObjects, InputsAreShownByWhatTheyAreForAndByTheirNumbers) {
  struct Case {
    SwitchFunction function;
    std::int64_t first, second;
  };
  for (const Case& c :
       {Case{SwitchFunction::kNegativeLimitA, 1, 0}, Case{SwitchFunction::kNegativeLimitB, 0, 1},
        Case{SwitchFunction::kPositiveLimitA, 2, 0}, Case{SwitchFunction::kPositiveLimitB, 0, 2},
        Case{SwitchFunction::kHomeA, 4, 0}, Case{SwitchFunction::kHomeB, 0, 4},
        Case{SwitchFunction::kProbe, 0, 0}, Case{SwitchFunction::kNone, 0, 0}}) {
    Lone lone;
    ASSERT_EQ(lone.write(0x2130, 5, 1, static_cast<std::int64_t>(c.function)), 0u);
    const auto expect_shown = [&](bool active) {
      const std::int64_t number = active ? 1 << (16 + 4) : 0;
      EXPECT_EQ(lone.read(0x60FD, 0), (active ? c.first : 0) | number) << static_cast<int>(c.function);
      EXPECT_EQ(lone.read(0x68FD, 0), (active ? c.second : 0) | number) << static_cast<int>(c.function);
    };
    expect_shown(false);
    lone.node.on_switch(lone.now, 4, true);
    expect_shown(true);  // past its 500 us
    EXPECT_EQ(lone.read(0x2133, 0), 1 << 4);
    lone.node.on_switch(lone.now, 4, false);
    expect_shown(false);
    ASSERT_EQ(lone.write(0x2131, 5, 1, 1), 0u);
    expect_shown(true);  // the other way round
  }
}

TEST(NodeObjects, AnInputThatABoardDoesNotHaveIsNone) {
  Lone lone;
  for (const int input : {-1, 7, 8, 1'000}) lone.node.on_switch(lone.now, input, true);
  lone.wait(5ms);
  EXPECT_EQ(lone.read(0x60FD, 0), 0);
  lone.node.on_switch(lone.now, 0, true);
  lone.node.on_switch(lone.now, 6, true);
  lone.wait(5ms);
  EXPECT_EQ(lone.read(0x60FD, 0) >> 16, 0x41);
}

TEST(NodeObjects, EdgesOfTwoInputsAreServedInTheOrderInWhichTheyCame) {
  Lone lone;
  ASSERT_EQ(lone.write(0x2130, 1, 1, static_cast<std::int64_t>(SwitchFunction::kProbe)), 0u);
  ASSERT_EQ(lone.write(0x2130, 3, 1, static_cast<std::int64_t>(SwitchFunction::kProbe)), 0u);
  ASSERT_EQ(lone.write(0x60B8, 0, 2, touch_probe::kOn | touch_probe::kPositiveEdge), 0u);
  lone.start_move();
  // The later edge is that of the lower input; both are heard of together.
  const std::int64_t first = lone.node.user_position(lone.now, 0);
  lone.node.on_switch(lone.now, 2, true);
  lone.node.on_switch(lone.now + 400us, 0, true);
  lone.now += 5ms;
  lone.node.on_time(lone.now);
  EXPECT_NEAR(static_cast<double>(lone.read(0x60BA, 0)), std::ldexp(static_cast<double>(first), -32), 1.0);
}

TEST(NodeObjects, WhereHomeIsAndWhetherItIsKnownAreShownOfEachAxis) {
  for (const int axis : {0, 1}) {
    Lone lone;
    lone.start_move(axis);
    lone.wait(5s);
    for (const int each : {0, 1}) {
      EXPECT_EQ(lone.read(of_axis(0x2140, each), 6), 0);
      EXPECT_EQ(lone.read(of_axis(0x2140, each), 7), each == axis ? from_counts(50'000) : 0);
    }
    ASSERT_EQ(lone.write(of_axis(0x607C, axis), 0, 4, 700), 0u);
    ASSERT_EQ(lone.write(of_axis(0x6098, axis), 0, 1, 37), 0u);
    ASSERT_EQ(lone.write(of_axis(0x6060, axis), 0, 1, 6), 0u);
    lone.control(0x0F, axis);
    lone.control(0x1F, axis);
    lone.wait(50ms);
    for (const int each : {0, 1}) {
      const bool homed = each == axis;
      EXPECT_EQ(lone.read(of_axis(0x2140, each), 6), homed ? 1 : 0);
      EXPECT_EQ(lone.read(of_axis(0x2140, each), 7), homed ? from_counts(-700) : 0);
      EXPECT_EQ(lone.read(of_axis(0x2140, each), 8), homed ? from_counts(50'000) : 0) << "home latch";
    }
    lone.control(0x00, axis);
    EXPECT_EQ(lone.read(of_axis(0x2140, axis), 6), 0) << "without power it may be turned by hand";
  }
}

TEST(NodeObjects, EveryCounterTellsOfItsOwnTrouble) {
  Lone lone;
  for (std::uint8_t sub = 1; sub <= static_cast<std::uint8_t>(NodeCounter::kLast); ++sub)
    EXPECT_EQ(lone.read(0x2120, sub), 0) << int{sub};
  lone.node.count(NodeCounter::kTxFull, 3);
  lone.node.count(NodeCounter::kBusOff);
  lone.node.on_receive_overrun(lone.now, 4);
  lone.node.on_drive_fault(lone.now, 1, emcy::kOverCurrent);
  lone.send("201#0600");                               // RPDO1 with two of its bytes, before the start
  EXPECT_EQ(lone.read_code(0x2000, 0), 0x0602'0000u);  // an abort
  lone.send("000#0101");
  lone.send("201#0600");  // too short
  EXPECT_EQ(lone.counter(NodeCounter::kTxFull), 3);
  EXPECT_EQ(lone.counter(NodeCounter::kBusOff), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kRxOverrun), 4);
  EXPECT_EQ(lone.counter(NodeCounter::kDriveFaults), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kSdoAborts), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kPdoLengthErrors), 1);
  EXPECT_GE(lone.counter(NodeCounter::kEmergencies), 2);
  EXPECT_EQ(lone.counter(NodeCounter::kWatchdogResets), 0);
  EXPECT_EQ(lone.counter(NodeCounter::kCoordinatedStops), 1) << "of the fault";
}

TEST(NodeObjects, AResetByTheWatchdogIsCounted) {
  Lone lone({.node_id = 1, .reset = {.cause = ResetCause::kWatchdog}});
  EXPECT_EQ(lone.counter(NodeCounter::kWatchdogResets), 1);
  Lone other({.node_id = 1, .reset = {.cause = ResetCause::kBrownOut}});
  EXPECT_EQ(other.counter(NodeCounter::kWatchdogResets), 0);
  EXPECT_EQ(Lone({.node_id = 1,
                  .reset = {.cause = ResetCause::kSoftware, .reason = fault_reason::kUnmeasuredCrystal}})
                .told(emcy::kCrystal),
            1)
      << "nothing has failed";
}

TEST(NodeObjects, AnEdgeThatIsTooShortIsAGlitch) {
  Lone lone;
  lone.node.on_switch(lone.now, 0, true);
  lone.node.on_switch(lone.now + 100us, 0, false);
  lone.wait(5ms);
  EXPECT_EQ(lone.read(0x60FD, 0), 0);
  EXPECT_EQ(lone.counter(NodeCounter::kSwitchGlitches), 1);
  // A level that is told again is none.
  lone.node.on_switch(lone.now, 0, false);
  EXPECT_EQ(lone.counter(NodeCounter::kSwitchGlitches), 1);
}

TEST(NodeObjects, AResetEndsPowerAndWhatWasWritten) {
  Lone lone;
  lone.start_move();
  lone.send("000#8101");
  EXPECT_FALSE(lone.node.drive(0).power);
  EXPECT_FALSE(lone.node.moving(lone.now));
  EXPECT_EQ(lone.read(0x6041, 0) & 0x6F, 0x40) << "switch on disabled";
  EXPECT_EQ(lone.read(0x6061, 0), 0);
  EXPECT_TRUE(lone.node.take_reset_request());
  EXPECT_FALSE(lone.node.take_reset_request());
}

}  // namespace
}  // namespace kinebus::testing_bench
