// A joint that is led by its linear scale (`correction_mm`), on a machine one of whose screws is not what its
// file says; and which way `scale` of the calibration counts, which knows such a screw beforehand. Measured
// on the true carriages.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "tools/simulation/simulation.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kTooLong = 0.0014;  // as far off as paper M5's third rail, which goes too short
constexpr std::size_t kLongRail = 2;
// A count of the scale where it is read, and one where home was latched; microsteps of 0.2 um.
constexpr double kTwoPulses_mm = 0.021;

MachineDescription m5() {
  auto machine = load_machine(machines_folder() / "m5.toml");
  EXPECT_TRUE(machine) << to_string(machine.error());
  return *std::move(machine);
}

MachineDescription led(double correction_mm) {
  MachineDescription machine = m5();
  for (std::size_t rail = 0; rail < 4; ++rail)
    machine.joints[rail].scale =
        ScaleDescription{.pulses_per_mm = 100, .inverted = rail == 1, .correction_mm = correction_mm};
  return machine;
}

/// `machine` at work with a screw that carries its carriage `too_long` farther than it should.
class Led {
 public:
  explicit Led(const MachineDescription& machine, double too_long = kTooLong)
      : machine_(machine), truth_(machine) {
    truth_.joints[kLongRail].calibration.scale = too_long;
    auto kinematics = make_kinematics(machine_);
    EXPECT_TRUE(kinematics);
    kinematics_ = *std::move(kinematics);
    SimulationOptions options;
    options.plant = &truth_;
    simulation_ = std::make_unique<Simulation>(machine_, *kinematics_, options);
    simulation_->on_event = [this](const MachineEvent& event) { told += event.words.english() + "\n"; };
    EXPECT_TRUE(gateway().carry_out(command::BringUp{}) && reach(MachineState::kUnhomed));
    EXPECT_TRUE(gateway().carry_out(command::Home{}) && reach(MachineState::kReady));
    EXPECT_TRUE(gateway().carry_out(command::GoToReference{}));
    reach(MachineState::kReady);
  }
  /// Along Z; where it ends.
  MachineState jog(double mm) {
    Pose delta{};
    delta[kZ] = mm;
    EXPECT_TRUE(gateway().carry_out(command::Jog{.delta = delta, .speed_per_s = 50})) << told;
    wait(200ms);
    reach(MachineState::kReady);
    return gateway().state();
  }
  void wait(BusTime time) { simulation_->run_until(simulation_->now() + time); }
  /// Of the true carriage from where it was told to be.
  double off_mm(std::size_t rail) {
    return simulation_->sample().joints[rail] - gateway().status().joints[rail];
  }
  double worst_off_mm() {
    double worst = 0;
    for (std::size_t rail = 0; rail < 4; ++rail) worst = std::max(worst, std::abs(off_mm(rail)));
    return worst;
  }
  double from_home_mm() {
    return gateway().status().joints[kLongRail] - machine_.joints[kLongRail].homing->switch_position;
  }
  /// The fastest that a carriage is moved while the machine rests.
  double fastest_mm_per_s(BusTime time) {
    double fastest = 0, before = simulation_->sample().joints[kLongRail];
    for (BusTime end = simulation_->now() + time; simulation_->now() < end;) {
      wait(100ms);
      const double now = simulation_->sample().joints[kLongRail];
      fastest = std::max(fastest, std::abs(now - before) / 0.1);
      before = now;
    }
    return fastest;
  }
  Gateway& gateway() { return simulation_->gateway(); }
  std::string told;

 private:
  bool reach(MachineState state) {
    return simulation_->run_until_state(
        [state](MachineState s) {
          return s == state || s == MachineState::kStopped || s == MachineState::kAlarm;
        },
        200s);
  }
  MachineDescription machine_, truth_;
  std::unique_ptr<Kinematics> kinematics_;
  std::unique_ptr<Simulation> simulation_;
};

TEST(LedByScale, TheTrueCarriageComesToWhereItWasToldToBe) {
  Led open(led(0)), closed(led(0.5));
  for (const double step : {40.0, 40.0, -60.0}) {
    open.jog(step), closed.jog(step);
    open.wait(15s), closed.wait(15s);
    const double error = kTooLong * open.from_home_mm();
    EXPECT_GT(std::abs(error), 5 * kTwoPulses_mm);
    EXPECT_NEAR(open.off_mm(kLongRail), error, 1e-3) << "it only measures";
    EXPECT_LE(closed.worst_off_mm(), kTwoPulses_mm);
    EXPECT_NEAR(closed.from_home_mm(), open.from_home_mm(), 1e-6) << "the command is the same";
  }
  EXPECT_EQ(closed.gateway().state(), MachineState::kReady) << closed.told;
}

TEST(LedByScale, SlowlyAtTheRateOfTheFileAndThenItRests) {
  MachineDescription machine = led(0.5);
  for (std::size_t rail = 0; rail < 4; ++rail) machine.joints[rail].scale->correction_mm_per_s = 0.02;
  Led slow(machine);
  slow.wait(30s);
  slow.jog(80);
  const double fastest = slow.fastest_mm_per_s(20s);
  EXPECT_GT(fastest, 0.01);
  EXPECT_LT(fastest, 0.022);
  EXPECT_LE(slow.worst_off_mm(), kTwoPulses_mm);
  EXPECT_LT(slow.fastest_mm_per_s(5s), 1e-4);
}

TEST(LedByScale, FartherAwayThanItMayBeLedStopsTheMachineOnThePathInWords) {
  Led strained(led(0.05));
  MachineState state = strained.gateway().state();
  for (int i = 0; i < 4 && state == MachineState::kReady; ++i) state = strained.jog(40);
  EXPECT_TRUE(state == MachineState::kStopped || state == MachineState::kAlarm);
  EXPECT_NE(strained.told.find("following error"), std::string::npos) << strained.told;
}

TEST(LedByScale, WhatTheCalibrationKnowsOfTheScrewIsNotCorrectedTwice) {
  MachineDescription machine = led(0.5);
  machine.joints[kLongRail].calibration.scale = kTooLong;
  Led known(machine);
  known.jog(60);
  EXPECT_LT(known.fastest_mm_per_s(5s), 1e-4) << "nothing is left to be led";
  EXPECT_LE(known.worst_off_mm(), kTwoPulses_mm);
}

TEST(SignOfScale, AScrewThatGoesTooFarHasAPositiveOneAndTheCorrectionOfThePaperIsItsNegative) {
  const auto off_mm = [](double scale) {
    MachineDescription machine = m5();
    machine.joints[kLongRail].calibration.scale = scale;
    Led rail(machine);
    rail.jog(60);
    return std::pair(rail.off_mm(kLongRail), kTooLong * rail.from_home_mm());
  };
  const auto [unknown, error] = off_mm(0);
  EXPECT_NEAR(unknown, error, 1e-3);
  EXPECT_NEAR(off_mm(kTooLong).first, 0, 1e-3) << "measured travel over commanded, less 1";
  EXPECT_NEAR(off_mm(-kTooLong).first, 2 * error, 2e-3)
      << "a correction, as the paper prints it, taken for the error";
}

}  // namespace
}  // namespace kinebus
