// Two motors on half-bridges: zero of the amplifiers, power, faults and troubles between control and node.

#include "node_firmware/board/bridge_motors.hpp"

#include <gtest/gtest.h>

#include "node_firmware/board/tests/fake_drivers.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

struct Motors : testing::Test {
  Motors() {
    fake::Stage::forget();
    running = &motors;
    fake::Stage::control = [] { period(); };
  }
  ~Motors() override { running = nullptr; }
  static void period() {
    fake::pass_time(50us);
    running->on_control();
  }
  void run(LocalTime time) {
    for (LocalTime t{0}; t < time; t += 50us) {
      period();
      now += 50us;
      motors.serve(node, now);
    }
  }
  bool told(std::uint16_t code) {
    bool found = false;
    while (const auto frame = node.next_frame())
      found = found || (frame->id == 0x085 && (frame->data[0] | frame->data[1] << 8) == code);
    return found;
  }
  static inline BridgeMotors<fake::Stage>* running = nullptr;
  MotionPlanExchange plan;
  BridgeMotors<fake::Stage> motors{plan};
  LocalTime now{0};
  LoneNode node{NodeOptions{.node_id = 5}, now};
};

TEST_F(Motors, TheAmplifiersZeroIsTakenAtStart) {
  fake::Stage::steps = {{{2050, 2040}, {2100, 1990}}};
  EXPECT_TRUE(motors.start());
  EXPECT_EQ(fake::Stage::zero[0].x, 2050);
  EXPECT_EQ(fake::Stage::zero[1].y, 1990);
  EXPECT_GE(motors.ticks(), 64u);
}

TEST_F(Motors, AnAmplifierThatIsFarOffOrNoConversionsAreNoStart) {
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (std::size_t phase = 0; phase < 2; ++phase) {
      fake::Stage::steps = {{{2048, 2048}, {2048, 2048}}};
      fake::Stage::steps[axis][phase] = 2200;
      EXPECT_FALSE(motors.start()) << axis << " " << phase;
    }
  fake::Stage::control = nullptr;
  EXPECT_FALSE(motors.start());
}

TEST_F(Motors, PowerComesWithTheDriveAndGoesWithABreak) {
  ASSERT_TRUE(motors.start());
  run(10ms);
  EXPECT_FALSE(fake::Stage::applied[0].power);
  fake::enable(node, now, 0);
  run(10ms);
  EXPECT_TRUE(fake::Stage::applied[0].power);
  EXPECT_FALSE(fake::Stage::applied[1].power) << "the other axis was not asked for";
  motors.on_break(0);
  EXPECT_EQ(fake::Stage::breaks, 1);
  period();
  EXPECT_FALSE(fake::Stage::applied[0].power) << "in the next period";
  run(1ms);
  EXPECT_FALSE(node.drive(0).power);
  EXPECT_TRUE(told(0x2320));
}

TEST_F(Motors, ATroubleIsToldOnceAndPowerIsKept) {
  ASSERT_TRUE(motors.start());
  fake::enable(node, now, 0);
  // Before the current is so high that one of a motor which is not there is missed.
  run(2ms);
  fake::Stage::measured.supply_v = 8;
  run(5ms);
  EXPECT_TRUE(told(0x3220));
  EXPECT_TRUE(node.drive(0).power);
  run(3ms);
  EXPECT_FALSE(told(0x3220));
}

TEST_F(Motors, WithoutPowerALowSupplyIsNobodysTrouble) {
  ASSERT_TRUE(motors.start());
  fake::Stage::measured.supply_v = 0;
  run(50ms);
  EXPECT_FALSE(told(0x3220));
}

}  // namespace
}  // namespace kinebus
