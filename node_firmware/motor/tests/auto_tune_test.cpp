// The measurement of a winding alone: an ideal current source, and an ideal winding for its wave.

#include "node_firmware/motor/auto_tune.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinebus::motor {
namespace {

struct Winding {
  double resistance = 1.2, inductance = 2.2e-3;  // ohm, H
  double lost_v = 0;                             // to dead time, by the sign of the current
  double share = 1;                              // of what it is asked for, that the source delivers
  double settle_s = 0;                           // time constant of the source
};

AutoTune measure(const Winding& winding, float current_a, float supply_v, int* periods = nullptr) {
  AutoTune tune;
  tune.start(current_a);
  double amperes = 0, volts = 0, waiting = 0;
  int count = 0;
  while (tune.state() == AutoTune::State::kRuns && count < 100'000) {
    const AutoTune::Wish wish = tune.step(static_cast<float>(volts), static_cast<float>(amperes), supply_v);
    ++count;
    if (wish.open) {
      // What is wished for acts from the next sample to the one after it.
      const double decay = std::exp(-kControlPeriodS * winding.resistance / winding.inductance);
      const double goal = (waiting - winding.lost_v) / winding.resistance;
      amperes = goal + (amperes - goal) * decay;
      waiting = wish.added_v;
    } else {
      const double goal = winding.share * wish.current_a;
      amperes = winding.settle_s > 0 ? amperes + (goal - amperes) * kControlPeriodS / winding.settle_s : goal;
      volts = winding.resistance * amperes + winding.lost_v;
      waiting = volts;
    }
  }
  if (periods != nullptr) *periods = count;
  return tune;
}

TEST(AutoTune, FindsWhatAWindingHas) {
  for (const double ohm : {0.1, 0.5, 4.0, 20.0})
    for (const double henry : {0.2e-3, 1e-3, 8e-3, 40e-3})
      for (const float supply : {12.0F, 24.0F}) {
        const AutoTune tune = measure({.resistance = ohm, .inductance = henry}, 1.0F, supply);
        if (henry / ohm < 1e-3) continue;  // the wave's current no longer rises evenly
        ASSERT_EQ(tune.state(), AutoTune::State::kDone)
            << ohm << " ohm, " << henry << " H, " << supply << " V";
        EXPECT_NEAR(tune.result().resistance_ohm, ohm, 0.01 * ohm);
        EXPECT_NEAR(tune.result().inductance_h, henry, 0.06 * henry) << ohm << " ohm, " << supply << " V";
      }
}

TEST(AutoTune, WhatTheBridgesLoseCancels) {
  const AutoTune tune = measure({.lost_v = 0.4}, 1.0F, 24);
  ASSERT_EQ(tune.state(), AutoTune::State::kDone);
  EXPECT_NEAR(tune.result().resistance_ohm, 1.2, 0.012);
}

TEST(AutoTune, ASlowCurrentIsWaitedFor) {
  const AutoTune tune = measure({.settle_s = 0.03}, 1.0F, 24);
  ASSERT_EQ(tune.state(), AutoTune::State::kDone);
  EXPECT_NEAR(tune.result().resistance_ohm, 1.2, 0.004);
}

TEST(AutoTune, NoCurrentIsNoMeasurement) {
  for (const double share : {0.0, 0.1, 0.25}) {
    const AutoTune tune = measure({.share = share}, 1.0F, 24);
    EXPECT_EQ(tune.state(), AutoTune::State::kFailed) << share;
    EXPECT_EQ(tune.result().resistance_ohm, 0);
  }
  EXPECT_EQ(measure({.share = 0.5}, 1.0F, 24).state(), AutoTune::State::kDone);
  // A part of a small current is within the noise of the amplifiers.
  EXPECT_EQ(measure({}, 0.07F, 24).state(), AutoTune::State::kFailed);
  EXPECT_EQ(measure({}, 0.1F, 24).state(), AutoTune::State::kDone);
}

TEST(AutoTune, WhatIsNoWindingIsNoMeasurement) {
  const auto state = [](double ohm, double henry) {
    return measure({.resistance = ohm, .inductance = henry}, 0.2F, 24).state();
  };
  EXPECT_EQ(state(0.019, 1e-3), AutoTune::State::kFailed);
  EXPECT_EQ(state(0.021, 1e-3), AutoTune::State::kDone);
  EXPECT_EQ(state(61, 55e-3), AutoTune::State::kFailed);
  EXPECT_EQ(state(59, 55e-3), AutoTune::State::kDone);
  EXPECT_EQ(state(0.05, 45e-6), AutoTune::State::kFailed);
  EXPECT_EQ(state(0.05, 55e-6), AutoTune::State::kDone);
  EXPECT_EQ(state(20, 70e-3), AutoTune::State::kFailed);
}

TEST(AutoTune, ItEndsByItselfAndStartsAnew) {
  int periods = 0;
  AutoTune tune = measure({}, 1.0F, 24, &periods);
  EXPECT_NEAR(static_cast<float>(periods) * kControlPeriodS, 2 * 0.25 + 0.08, 0.001);
  EXPECT_EQ(tune.step(1, 1, 24).current_a, 0) << "it wishes for nothing any more";
  EXPECT_EQ(tune.state(), AutoTune::State::kDone);
  tune.start(1);
  EXPECT_EQ(tune.state(), AutoTune::State::kRuns);
  tune.stop();
  EXPECT_EQ(tune.step(1, 1, 24).current_a, 0);
  EXPECT_EQ(tune.state(), AutoTune::State::kIdle);
}

}  // namespace
}  // namespace kinebus::motor
