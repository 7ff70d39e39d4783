#include "node_firmware/core/homing.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "node_firmware/core/switch_inputs.hpp"

namespace kinebus {
namespace {

/// One carriage and its switch, with debouncing: active from `edge` to the end that the method looks at.
struct Rail {
  HomingConfig config{.fast = 38'400,
                      .slow = 3'840,
                      .acceleration = 1'280'000,
                      .offset = 1000,
                      .travel = 400'000,
                      .back_off = 64'000};
  std::int64_t edge = from_counts(100'000) + kOneCount / 3;
  bool upper = true;
  bool dead = false;   // never active
  bool stuck = false;  // always active
  Trapezoid motion;
  Homing homing;
  SwitchInputs inputs;
  std::int64_t origin = 0;  // motor = position - origin
  ProfileTicks now = 0;

  bool level() const {
    const std::int64_t at = motion.at(now).position - origin;
    return stuck || (!dead && (upper ? at >= edge : at <= edge));
  }
  void run(int method, double seconds = 60) {
    config.method = method;
    inputs.configure(0, {SwitchFunction::kHomeA, false, LocalTime{500'000}});
    inputs.on_level(to_local(now), 0, level(), {});
    now += kTicksPerSecond / 100;
    (void)inputs.next_event(to_local(now));
    homing.start(now, config, inputs.active(SwitchFunction::kHomeA), motion);
    const ProfileTicks end = now + static_cast<ProfileTicks>(seconds * 16e6);
    bool last = level();
    std::int64_t position = motion.at(now).position - origin;
    while (homing.running() && now < end) {
      now += 160;  // 10 us
      const std::int64_t next = motion.at(now).position - origin;
      // Half a millimetre a second more than the fast speed is no room for a step.
      ASSERT_LE(std::abs(next - position), from_counts(40'000) / 100'000 + kOneCount / 64);
      position = next;
      if (level() != last) {
        last = !last;
        inputs.on_level(to_local(now), 0, last, {motion.at(now).position, 0});
      }
      if (const auto event = inputs.next_event(to_local(now)))
        homing.on_switch(now, event->active, event->latched[0], motion);
      homing.on_time(now, motion);
      std::int64_t by = 0;
      if (homing.take_shift(by)) origin += by;
    }
  }
  double home_error_counts() const {
    // Where the edge is in the new coordinates: zero is the edge plus the offset (607Ch).
    return std::abs(static_cast<double>(edge + origin + from_counts(config.offset)) /
                    static_cast<double>(kOneCount));
  }
};

struct Case {
  int method;
  bool upper;
  std::int64_t from_counts;
};
class HomingMethods : public testing::TestWithParam<Case> {};

TEST_P(HomingMethods, FindsTheEdgeFromBothSides) {
  Rail rail;
  rail.upper = GetParam().upper;
  rail.motion.hold(from_counts(GetParam().from_counts));
  rail.run(GetParam().method);
  EXPECT_TRUE(rail.homing.attained());
  EXPECT_EQ(rail.homing.error(), HomingError::kNone);
  // 10 us of the test's own clock at the slow speed: 0.04 counts.
  EXPECT_LT(rail.home_error_counts(), 0.05);
  EXPECT_EQ(rail.motion.at(rail.now).position % kOneCount, 0);
}
INSTANTIATE_TEST_SUITE_P(AllMethods, HomingMethods,
                         testing::Values(Case{17, false, 300'000}, Case{17, false, 90'000}, Case{18, true, 0},
                                         Case{18, true, 110'000}, Case{19, true, 0}, Case{19, true, 110'000},
                                         Case{20, true, 0}, Case{20, true, 110'000}, Case{21, false, 300'000},
                                         Case{21, false, 90'000}, Case{22, false, 300'000},
                                         Case{22, false, 90'000}));

TEST(Homing, CurrentPositionMethodMovesNothing) {
  for (const int method : {35, 37}) {
    Rail rail;
    rail.motion.hold(from_counts(777));
    rail.run(method);
    EXPECT_TRUE(rail.homing.attained());
    EXPECT_EQ(rail.motion.at(rail.now).position, -from_counts(rail.config.offset));
  }
}

TEST(Homing, TheSwitchThatNeverComesIsAnErrorAfterTheTravel) {
  Rail rail;
  rail.dead = true;
  rail.run(19);
  EXPECT_EQ(rail.homing.error(), HomingError::kNoSwitch);
  EXPECT_FALSE(rail.homing.attained());
  EXPECT_EQ(whole_counts(rail.motion.at(rail.now + kTicksPerSecond).position), 400'000);
}

TEST(Homing, TheSwitchThatNeverGoesOffIsAnErrorAfterTheBackOffTravel) {
  Rail rail;
  rail.stuck = true;
  rail.run(20);
  EXPECT_EQ(rail.homing.error(), HomingError::kStuck);
}

TEST(Homing, ACarriageOnItsSwitchStandsUntilItIsItsTurnToLeave) {
  for (const int method : {17, 18, 20, 22}) {
    SCOPED_TRACE(method);
    Rail rail;
    rail.config.method = method;
    rail.homing.set_turn(false);
    rail.homing.start(0, rail.config, true, rail.motion);
    const ProfileTicks later = 10 * kTicksPerSecond;
    rail.homing.on_time(later, rail.motion);
    EXPECT_TRUE(rail.homing.running());
    EXPECT_EQ(rail.motion.at(later).position, 0);
    rail.homing.set_turn(true);
    rail.homing.on_time(later, rail.motion);
    EXPECT_NE(rail.motion.at(later + kTicksPerSecond).position, 0);
  }
}

TEST(Homing, AnUnknownMethodIsRefusedAtRest) {
  Rail rail;
  rail.run(1);
  EXPECT_EQ(rail.homing.error(), HomingError::kMethod);
  EXPECT_EQ(rail.motion.at(rail.now).position, 0);
}

TEST(Homing, AnEdgeWhereNoneMayBeIsAnErrorAndStops) {
  Rail rail;
  rail.config.method = 19;
  rail.homing.start(0, rail.config, false, rail.motion);
  rail.homing.on_switch(16'000'000, true, 0, rail.motion);
  rail.homing.on_switch(16'000'100, false, 0, rail.motion);
  EXPECT_EQ(rail.homing.error(), HomingError::kBounced);
  EXPECT_FALSE(rail.homing.running());
  EXPECT_EQ(rail.motion.at(rail.motion.end()).velocity, 0);
}

/// A stop at `edge`: the load is seen when the axis presses against it at some speed, or where it is said to.
struct RailWithStop : Rail {
  explicit RailWithStop(int method) {
    config.back_off = 20'000;
    config.method = method;
    homing.set_load(Homing::Load::kReady);
  }
  std::int64_t falsely = std::numeric_limits<std::int64_t>::max();  // told once at this place, too
  int meetings = 0;
  void home(double seconds = 60) {
    const int direction = config.method == -3 ? 1 : -1;
    homing.start(now, config, false, motion);
    const ProfileTicks end = now + static_cast<ProfileTicks>(seconds * 16e6);
    bool last = false;
    while (homing.running() && now < end) {
      now += 1600;
      const ProfileState is = motion.at(now);
      const std::int64_t at = is.position - origin;
      const auto beyond = [&](std::int64_t place) { return direction > 0 ? at >= place : at <= place; };
      const bool presses = is.velocity * direction > velocity_from(config.fast / 2);
      const bool once = falsely != std::numeric_limits<std::int64_t>::max() && beyond(falsely);
      const bool told = presses && (dead ? false : beyond(edge) || (once && meetings == 0));
      if (told != last) homing.on_switch(now, told, is.position, motion);
      if (told && !last) ++meetings;
      last = told;
      homing.on_time(now, motion);
      std::int64_t by = 0;
      if (homing.take_shift(by)) origin += by;
    }
  }
};

TEST(HomingByLoad, MeetsItsStopTwiceAndStopsOnTheSpot) {
  for (const int method : {-3, -4}) {
    SCOPED_TRACE(method);
    RailWithStop rail(method);
    rail.motion.hold(from_counts(method == -3 ? 30'000 : 170'000));
    rail.home();
    ASSERT_TRUE(rail.homing.attained());
    EXPECT_EQ(rail.meetings, 2);
    EXPECT_LT(rail.home_error_counts(), 5) << "the test's own clock at the speed";
    const std::int64_t rest = rail.motion.at(rail.now).position - rail.origin;
    EXPECT_LT(std::abs(rest - rail.edge), from_counts(128));
  }
}

TEST(HomingByLoad, BegunAtTheStopItFirstGoesOff) {
  RailWithStop rail(-3);
  rail.motion.hold(rail.edge);
  rail.home();
  EXPECT_TRUE(rail.homing.attained());
}

TEST(HomingByLoad, ALoadThatIsMetOnceIsNoStop) {
  RailWithStop rail(-3);
  rail.falsely = from_counts(60'000);
  rail.home();
  EXPECT_EQ(rail.homing.error(), HomingError::kBounced);
  EXPECT_FALSE(rail.homing.attained());
  EXPECT_EQ(rail.origin, 0) << "no position is taken";
}

TEST(HomingByLoad, ALoadWhereTheAxisWasFreeAMomentAgoIsNoStop) {
  RailWithStop rail(-4);
  rail.edge = from_counts(200'000);  // says so as soon as it is fast enough
  rail.home();
  EXPECT_EQ(rail.homing.error(), HomingError::kBounced);
  EXPECT_EQ(rail.meetings, 1);
}

TEST(HomingByLoad, WithoutALoadItGivesUpAfterTheTravel) {
  RailWithStop rail(-3);
  rail.dead = true;
  rail.home();
  EXPECT_EQ(rail.homing.error(), HomingError::kNoSwitch);
  EXPECT_EQ(whole_counts(rail.motion.at(rail.now + kTicksPerSecond).position), 400'000);
}

TEST(HomingByLoad, NothingMovesWithoutADriverThatTellsOrWithAnInputThatIsActiveAtRest) {
  RailWithStop rail(-3);
  rail.homing.set_load(Homing::Load::kNone);
  rail.homing.start(0, rail.config, false, rail.motion);
  EXPECT_EQ(rail.homing.error(), HomingError::kNoLoad);
  rail.homing.set_load(Homing::Load::kReady);
  rail.homing.start(0, rail.config, true, rail.motion);
  EXPECT_EQ(rail.homing.error(), HomingError::kStuck);
  EXPECT_EQ(rail.motion.at(kTicksPerSecond).position, 0);
}

TEST(HomingByLoad, ItWaitsForTheDriverToHaveItsSettings) {
  RailWithStop rail(-3);
  rail.homing.set_load(Homing::Load::kBusy);
  rail.home(5);
  EXPECT_TRUE(rail.homing.running());
  EXPECT_TRUE(rail.homing.polls());
  EXPECT_EQ(whole_counts(rail.motion.at(rail.now).position), -20'000);
  rail.homing.set_load(Homing::Load::kReady);
  rail.homing.on_time(rail.now, rail.motion);
  EXPECT_FALSE(rail.motion.done(rail.now));
}

TEST(SwitchInputs, AnEdgeCountsFromWhenItHappened) {
  SwitchInputs inputs;
  inputs.configure(2, {SwitchFunction::kEmergencyStop, false, LocalTime{1'000'000}});
  inputs.on_level(LocalTime{5'000'000}, 2, true, {42, 43});
  EXPECT_FALSE(inputs.next_event(LocalTime{5'999'999}));
  EXPECT_EQ(inputs.next_deadline(), LocalTime{6'000'000});
  const auto event = inputs.next_event(LocalTime{6'000'000});
  ASSERT_TRUE(event);
  EXPECT_EQ(event->at, LocalTime{5'000'000});
  EXPECT_EQ(event->latched[1], 43);
  EXPECT_TRUE(event->active);
  EXPECT_EQ(inputs.active_inputs(), 0x04);
}

TEST(SwitchInputs, AShortPulseIsAGlitchAndPolarityTurnsMeaning) {
  SwitchInputs inputs;
  inputs.configure(0, {SwitchFunction::kHomeA, true, LocalTime{1'000'000}});
  EXPECT_TRUE(inputs.active(SwitchFunction::kHomeA));
  inputs.on_level(LocalTime{0}, 0, true, {});
  inputs.on_level(LocalTime{900'000}, 0, false, {});
  EXPECT_FALSE(inputs.next_event(LocalTime{5'000'000}));
  EXPECT_EQ(inputs.glitches(), 1u);
  inputs.on_level(LocalTime{6'000'000}, 0, true, {});
  ASSERT_TRUE(inputs.next_event(LocalTime{7'000'000}));
  EXPECT_FALSE(inputs.active(SwitchFunction::kHomeA));
}

}  // namespace
}  // namespace kinebus
