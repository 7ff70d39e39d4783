// A switch's edges: debounced, in their order, with what was latched when they happened; and how they are
// shown.
#include "node_firmware/core/switch_inputs.hpp"

#include <gtest/gtest.h>

namespace kinebus::testing_switches {
namespace {

using namespace std::chrono_literals;

constexpr SwitchInputs::Config kHome{SwitchFunction::kHomeA, false, 500us};

LatchedPositions at(std::int64_t position) {
  return {position, -position};
}

TEST(SwitchInputs, AnEdgeCountsFromWhenItHappenedAndOnceItHasLasted) {
  SwitchInputs inputs;
  inputs.configure(1, kHome);
  EXPECT_EQ(inputs.next_deadline(), LocalTime::max());
  EXPECT_TRUE(inputs.configured(SwitchFunction::kHomeA));
  EXPECT_FALSE(inputs.configured(SwitchFunction::kProbe));
  inputs.on_level(10ms, 1, true, at(111), {7, 8});
  inputs.on_level(10ms + 100us, 1, true, at(222), {9, 9});
  EXPECT_EQ(inputs.next_deadline(), 10ms + 500us);
  EXPECT_FALSE(inputs.next_event(10ms + 499us));
  EXPECT_FALSE(inputs.active(SwitchFunction::kHomeA));
  const auto event = inputs.next_event(10ms + 500us);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->input, 1);
  EXPECT_EQ(event->function, SwitchFunction::kHomeA);
  EXPECT_TRUE(event->active);
  EXPECT_EQ(event->at, 10ms);
  EXPECT_EQ(event->latched, at(111));
  EXPECT_EQ(event->scales, (ScaleCounts{7, 8}));
  EXPECT_FALSE(inputs.next_event(20ms));
  EXPECT_TRUE(inputs.active(SwitchFunction::kHomeA));
  EXPECT_FALSE(inputs.active(SwitchFunction::kProbe));
  EXPECT_EQ(inputs.active_inputs(), 0b10);
  inputs.on_level(30ms, 1, false, at(333));
  const auto back = inputs.next_event(31ms);
  ASSERT_TRUE(back);
  EXPECT_FALSE(back->active);
  EXPECT_EQ(inputs.glitches(), 0u);
}

TEST(SwitchInputs, ShorterPulsesAreGlitchesAndLeaveNothing) {
  SwitchInputs inputs;
  inputs.configure(0, kHome);
  inputs.on_level(1ms, 0, false, at(0));
  EXPECT_EQ(inputs.glitches(), 0u) << "a known level again";
  inputs.on_level(2ms, 0, true, at(1));
  inputs.on_level(2ms + 300us, 0, false, at(2));
  EXPECT_EQ(inputs.glitches(), 1u);
  EXPECT_EQ(inputs.next_deadline(), LocalTime::max());
  inputs.on_level(2ms + 400us, 0, true, at(3));
  EXPECT_FALSE(inputs.next_event(2ms + 600us)) << "the time of the pulse does not count";
  const auto event = inputs.next_event(3ms);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->at, 2ms + 400us);
  EXPECT_EQ(event->latched, at(3));
  for (const int none : {-1, kSwitchInputs, 1000}) inputs.on_level(5ms, none, true, at(9));
  EXPECT_FALSE(inputs.next_event(10ms));
}

TEST(SwitchInputs, TheEarlierEdgeComesFirst) {
  for (const int earlier : {0, 2}) {
    SwitchInputs inputs;
    inputs.on_level(1ms, earlier, true, at(0));
    inputs.on_level(2ms, 2 - earlier, true, at(0));
    EXPECT_EQ(inputs.next_event(5ms)->input, earlier);
    EXPECT_EQ(inputs.next_event(5ms)->input, 2 - earlier);
    EXPECT_FALSE(inputs.next_event(5ms));
  }
}

TEST(SwitchInputs, ActiveLowIsTheOtherWayRoundAtOnceAndWithoutAnEvent) {
  SwitchInputs inputs;
  inputs.show(1ms);
  EXPECT_EQ(inputs.shown_inputs(), 0);
  inputs.configure(0, {SwitchFunction::kProbe, true, 500us});
  EXPECT_EQ(inputs.active_inputs(), 1);
  EXPECT_TRUE(inputs.active(SwitchFunction::kProbe));
  EXPECT_FALSE(inputs.next_event(10ms));
  EXPECT_EQ(inputs.next_deadline(), LocalTime{0}) << "it is to be shown";
  inputs.show(10ms);
  EXPECT_EQ(inputs.shown_inputs(), 1);
  EXPECT_EQ(inputs.next_deadline(), LocalTime::max());
}

TEST(SwitchInputs, AChangeIsShownUntilItIsToldOrFor20Ms) {
  for (const bool told : {false, true}) {
    SwitchInputs inputs;
    const auto flip = [&](LocalTime when, bool level) {
      inputs.on_level(when, 0, level, at(0));
      EXPECT_TRUE(inputs.next_event(when + 500us));
    };
    flip(100ms, true);
    inputs.show(101ms);
    EXPECT_EQ(inputs.shown_inputs(), 1);
    // Over before anybody was told.
    flip(102ms, false);
    EXPECT_EQ(inputs.active_inputs(), 0);
    inputs.show(103ms);
    EXPECT_EQ(inputs.shown_inputs(), 1);
    EXPECT_EQ(inputs.next_deadline(), 121ms);
    inputs.show(121ms - 1us);
    EXPECT_EQ(inputs.shown_inputs(), 1);
    if (told) {
      inputs.told();
      EXPECT_LE(inputs.next_deadline(), 121ms - 1us) << "at once";
      inputs.show(121ms - 1us);
    } else {
      inputs.show(121ms);
    }
    EXPECT_EQ(inputs.shown_inputs(), 0);
    EXPECT_EQ(inputs.next_deadline(), LocalTime::max());
    // Another input's change does not wait for it.
    inputs.on_level(130ms, 1, true, at(0));
    EXPECT_TRUE(inputs.next_event(131ms));
    inputs.show(131ms);
    EXPECT_EQ(inputs.shown_inputs(), 0b10);
  }
}

}  // namespace
}  // namespace kinebus::testing_switches
