#include "node_firmware/motor/current_loop.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "node_firmware/motor/tests/motor_model.hpp"

namespace kinebus::motor {
namespace {

// The loop alone on a blocked motor, with the board's delay of a period and a half.
struct LoopBench {
  TestMotor motor;
  CurrentLoop loop;
  Vector volts;
  double electrical = 0;

  explicit LoopBench(float bandwidth_hz) {
    motor.blocked = true;
    const MotorModel model{static_cast<float>(motor.resistance), static_cast<float>(motor.inductance), 0};
    loop.configure(model, CurrentGains::of(model, bandwidth_hz));
  }
  Vector period(float current, float omega = 0) {
    const Vector measured{static_cast<float>(motor.ia), static_cast<float>(motor.ib)};
    const auto angle = angle_from(static_cast<float>(std::remainder(electrical, 2 * std::numbers::pi)));
    const Vector next = loop.step(measured, {current, angle, omega}, 24);
    motor.run(volts.x, volts.y, 50e-6);
    volts = next;
    electrical += omega * 50e-6;
    return loop.measured();
  }
};

TEST(CurrentLoop, StepOfCurrentRisesAsABandwidthAboveAKilohertzDoes) {
  LoopBench bench(1500);
  int rise = 0;
  float highest = 0;
  for (int i = 0; i < 100; ++i) {
    const float x = bench.period(1.5F).x;
    if (x < 0.9F * 1.5F && rise == i) ++rise;
    highest = std::max(highest, x);
  }
  const double rise_s = rise * 50e-6;
  // First order: 10 to 90 % takes 0.35 / bandwidth; here from the command, the delay of 100 us included.
  EXPECT_LT(rise_s, 0.35e-3 + 100e-6) << "1 kHz would need 0.35 ms";
  EXPECT_LT(highest, 1.5F * 1.15F);
  EXPECT_NEAR(bench.period(1.5F).x, 1.5F, 0.003F);
  RecordProperty("rise_us", static_cast<int>(rise_s * 1e6));
  RecordProperty("overshoot_percent", static_cast<int>((highest / 1.5F - 1) * 100));
}

TEST(CurrentLoop, TurningCurrentHasNoErrorAtAnySpeedThatTheSupplyAllows) {
  for (const float omega : {50.0F, 500.0F, 2000.0F, 4700.0F}) {
    LoopBench bench(1500);
    Vector last;
    for (int i = 0; i < 2000; ++i) last = bench.period(1.0F, omega);
    EXPECT_NEAR(last.x, 1.0F, 0.02F) << omega << " rad/s";
    EXPECT_NEAR(last.y, 0.0F, 0.02F) << omega << " rad/s";
  }
}

TEST(CurrentLoop, VoltageLimitDoesNotWindUp) {
  LoopBench bench(1500);
  for (int i = 0; i < 4000; ++i) bench.period(30.0F);  // 36 V wanted, 23 V there
  EXPECT_TRUE(bench.loop.limited());
  int periods_until_back = 0;
  while (bench.period(1.0F).x > 1.2F && periods_until_back < 200) ++periods_until_back;
  // 2.2 mH from 19 A down with all the voltage: 0.9 ms; then no undershoot that an integral would cause.
  EXPECT_LT(periods_until_back, 40);
  float lowest = 1;
  for (int i = 0; i < 200; ++i) lowest = std::min(lowest, bench.period(1.0F).x);
  EXPECT_GT(lowest, 1 - 0.02F * 18) << "2 % of the way";
}

}  // namespace
}  // namespace kinebus::motor
