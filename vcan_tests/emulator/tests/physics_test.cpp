// The motor and its power stage against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "vcan_tests/emulator/physics/power_stage.hpp"
#include "vcan_tests/emulator/physics/stepper_motor.hpp"
#include "vcan_tests/emulator/tests/fake_lines.hpp"

namespace kinebus::emulator {
namespace {

StepperParameters frictionless() {
  StepperParameters p;
  p.detent_nm = p.viscous_nm_s = p.coulomb_nm = 0;
  return p;
}

TEST(StepperMotor, CurrentRisesWithTheWindingsTimeConstant) {
  StepperMotor motor(frictionless());
  motor.block(true);
  const double tau = motor.parameters().inductance_h / motor.parameters().resistance_ohm;
  for (int i = 0; i < 1000; ++i) motor.step_electrical(tau / 1000, {{2.0, -1.0}, {}}, 25);
  EXPECT_NEAR(motor.current_a(0), 2.0 * (1 - std::exp(-1)), 1e-9);
  EXPECT_NEAR(motor.current_a(1), -1.0 * (1 - std::exp(-1)), 1e-9);
}

TEST(StepperMotor, OneLongStepIsAsExactAsManyShortOnes) {
  StepperMotor one(frictionless()), many(frictionless());
  one.block(true);
  many.block(true);
  one.step_electrical(1e-3, {{24, 0}, {}}, 25);
  for (int i = 0; i < 100; ++i) many.step_electrical(1e-5, {{24, 0}, {}}, 25);
  EXPECT_NEAR(one.current_a(0), many.current_a(0), 1e-9);
}

TEST(StepperMotor, LockedCurrentsHoldTheRotorAtTheirElectricalAngle) {
  StepperParameters p = frictionless();
  p.viscous_nm_s = 2e-2;
  StepperMotor motor(p);
  motor.place(0.005);
  const double goal = 0.7;  // electrical
  for (int i = 0; i < 200'000; ++i) {
    motor.set_current(0, 2 * std::cos(goal));
    motor.set_current(1, 2 * std::sin(goal));
    motor.step_electrical(1e-9, {{2 * std::cos(goal), 2 * std::sin(goal)}, {}}, 25);
    motor.step_electrical(25e-6 - 1e-9, {{2 * std::cos(goal), 2 * std::sin(goal)}, {}}, 25);
    motor.step_mechanical(25e-6);
  }
  EXPECT_NEAR(motor.angle_rad() * p.pole_pairs, goal, 1e-6);
}

TEST(StepperMotor, BackEmfOfATurningRotorDrivesTheKnownCurrentThroughAShort) {
  // Terminals joined, driven at constant speed: i = K w / |R + j w p L|, mean torque by the heat.
  StepperParameters p = frictionless();
  p.inertia_kg_m2 = 1e6;  // turns on at its speed
  StepperMotor motor(p);
  const double w = 2 * std::numbers::pi * 3;
  motor.set_speed(w);
  const double dt = 1e-6;
  double square = 0;
  int count = 0;
  for (int i = 0; i < 400'000; ++i) {
    motor.step_electrical(dt, {{0, 0}, {}}, 25);
    motor.step_mechanical(dt);
    if (i < 200'000) continue;
    square += motor.current_a(0) * motor.current_a(0) + motor.current_a(1) * motor.current_a(1);
    ++count;
  }
  const double expected =
      p.torque_nm_per_a * w / std::hypot(p.resistance_ohm, w * p.pole_pairs * p.inductance_h);
  EXPECT_NEAR(std::sqrt(square / count), expected, 2e-4 * expected);
}

TEST(StepperMotor, DetentTorqueHoldsTheFullSteps) {
  StepperParameters p = frictionless();
  p.detent_nm = 0.02;
  p.viscous_nm_s = 1e-2;
  StepperMotor motor(p);
  const double step = std::numbers::pi / 2 / p.pole_pairs;
  motor.place(3.3 * step);
  for (int i = 0; i < 200'000; ++i) motor.step_mechanical(25e-6);
  EXPECT_NEAR(motor.angle_rad(), 3 * step, 1e-3 * step);
}

TEST(StepperMotor, EnergyIsNeitherMadeNorLost) {
  StepperMotor motor(frictionless());
  for (int i = 0; i < 200'000; ++i) {
    const double angle = 2 * std::numbers::pi * 20 * i * 1e-6;
    motor.step_electrical(1e-6, {{4 * std::cos(angle), 4 * std::sin(angle)}, {}}, 25);
    motor.step_mechanical(1e-6);
  }
  const auto& e = motor.energy();
  const double kinetic =
      0.5 * motor.parameters().inertia_kg_m2 * motor.speed_rad_per_s() * motor.speed_rad_per_s();
  EXPECT_NEAR(e.supplied, e.heat + e.mechanical + motor.magnetic_energy_j(), 1e-3 * e.supplied);
  EXPECT_NEAR(e.mechanical, kinetic, 1e-3 * e.supplied);
  EXPECT_GT(e.supplied, 0.5);
}

TEST(StepperMotor, AnOpenPhaseCarriesNothing) {
  StepperMotor motor(frictionless());
  motor.set_winding(0, StepperMotor::Winding::kOpen);
  motor.step_electrical(1e-3, {{24, 5}, {}}, 25);
  EXPECT_EQ(motor.current_a(0), 0);
  EXPECT_GT(motor.current_a(1), 1);
}

TEST(StepperMotor, DiodesLeadTheCurrentOfASwitchedOffPhaseToZeroAndNoFurther) {
  StepperMotor motor(frictionless());
  motor.block(true);
  motor.set_current(0, 2.5);
  for (int i = 0; i < 1000; ++i) motor.step_electrical(1e-6, {{0, 0}, {true, true}}, 25);
  EXPECT_EQ(motor.current_a(0), 0);
}

struct Stage {
  Stage()
      : timer(lines, {.update_irq = 25, .break_irq = 24}),
        motor(frictionless()),
        stage(timer, motor, parameters()) {
    motor.block(true);
    timer.before_change = [this](Cycle at) { stage.advance(at); };
    stage.on_comparator = [this](bool high, Cycle at) { timer.set_break_level(high, at); };
    timer.write(0x2C, 2100, 0);
    timer.write(0x18, 0x6868, 0);
    timer.write(0x1C, 0x6868, 0);
    timer.write(0x20, 0x1111, 0);
    timer.write(0x0C, 0x80, 0);
    for (std::uint32_t channel = 0; channel < 4; ++channel) timer.write(0x34 + 4 * channel, 1050, 0);
    timer.write(0x14, 1, 0);
    timer.write(0x44, 1u << 15 | 1u << 12, 0);
    timer.write(0x00, 0xA1, 0);
    stage.set_enabled(true, 0);
  }
  static PowerStageParameters parameters() {
    PowerStageParameters p;
    p.switch_ohm = 0;
    return p;
  }
  void run(double seconds) {
    const auto until = now + static_cast<Cycle>(seconds * static_cast<double>(kCoreHz));
    while (timer.next_event() <= until) timer.advance(timer.next_event());
    stage.advance(until);
    now = until;
  }
  Cycle now = 0;
  Lines lines;
  Timer timer;
  StepperMotor motor;
  PowerStage stage;
};

TEST(PowerStage, DutyTimesSupplyOverResistanceIsTheMeanCurrent) {
  Stage s;
  s.timer.write(0x34, 1050 + 105,
                0);  // phase A: +10 % of 2100 between its half-bridges, 2.4 V less the dead time
  s.timer.write(0x38, 1050 - 105, 0);
  s.run(0.03);
  double sum = 0;
  constexpr int kSamples = 1000;
  for (int i = 0; i < kSamples; ++i) {
    s.run(25e-9 * 1000 / 37);
    sum += s.stage.current_a(0);
  }
  // Each half-bridge loses its dead time once a period: 2 x 150 ns of 25 us at 24 V. With ripple around a
  // small current some of it is not lost.
  const double ideal = 2.4 / 1.0, lost = 2 * 150e-9 / 25e-6 * 24;
  EXPECT_LT(sum / kSamples, ideal + 0.02);
  EXPECT_GT(sum / kSamples, ideal - lost - 0.02);
  EXPECT_NEAR(s.stage.current_a(1), 0, 0.02);
}

TEST(PowerStage, AShortedMotorIsCutOffInHardwareWithinAMicrosecondOfTheThreshold) {
  Stage s;
  s.motor.set_winding(0, StepperMotor::Winding::kShorted);
  s.timer.write(0x34, 2000, 0);
  s.timer.write(0x38, 100, 0);
  s.run(0.002);
  EXPECT_LT(s.motor.peak_current_a(), 8.0);
  EXPECT_GT(s.motor.peak_current_a(), 7.0);
  EXPECT_FALSE(s.timer.sweep().main_output);
  EXPECT_TRUE(s.lines[24]);
  EXPECT_EQ(s.stage.current_a(0), 0);
}

TEST(PowerStage, NoCurrentFlowsWithoutTheDriversEnable) {
  Stage s;
  s.stage.set_enabled(false, 0);
  s.timer.write(0x34, 2000, 0);
  s.run(0.002);
  EXPECT_EQ(s.stage.current_a(0), 0);
}

}  // namespace
}  // namespace kinebus::emulator
