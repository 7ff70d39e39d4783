// Two motors behind step and direction pins: power, direction, and what becomes of frames that were missed.

#include "node_firmware/board/step_motors.hpp"

#include <gtest/gtest.h>

#include "node_firmware/board/tests/fake_drivers.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

struct FakeStepStage {
  using Frames = step::StepFrames<1>;
  static constexpr std::array<StepPins, 2> kPins{{{0, 0, 1, 2}, {0, 0, 4, 8}}};
  static constexpr int kStepBits = 4;
  static constexpr bool kQuickDivision = true;
  static constexpr PlanSize kPlan{};
  static inline const Frames* frames = nullptr;
  static inline std::array<bool, 2> enabled{};

  PlanCounts start(const Frames& given) {
    frames = &given;
    return fake::Counter::now;
  }
  static PlanCounts counts() { return fake::Counter::now; }
  static void acknowledge_control() {}
  void enable(int axis, bool on) { enabled[static_cast<std::size_t>(axis)] = on; }
};

struct Steps : testing::Test {
  Steps() {
    FakeStepStage::enabled = {};
    motors.start();
  }
  /// A frame is put out; its last word calls the control interrupt.
  void frame() {
    for (const std::uint32_t word : std::span(FakeStepStage::frames->words(0)).subspan(half * 64, 64)) {
      pins = (pins | (word & 0xFFFF)) & ~(word >> 16 & ~word);
      for (const int axis : {0, 1})
        if ((word >> (2 * axis) & 1) != 0)
          made[static_cast<std::size_t>(axis)] += (pins >> (2 * axis + 1) & 1) != 0 ? 1 : -1;
    }
    half = 1 - half;
    fake::pass_time(64us);
    now += 64us;
    motors.on_control();
  }
  void run(LocalTime time) {
    for (const LocalTime end = now + time; now < end;) {
      node.on_time(now);
      plans[0].renew(node, now, fake::Counter::now);
      frame();
      motors.serve(0, node, now);
    }
  }
  void enable(int axis) { fake::enable(node, now, axis); }
  void write(int axis, int index, std::uint8_t sub, std::int64_t value) {
    CanFrame request = CanFrame::make(0x605, {0x23, 0, 0, sub, 0, 0, 0, 0});
    put_u16_le(std::span(request.data).subspan(1), static_cast<std::uint16_t>(index + 0x800 * axis));
    put_u32_le(std::span(request.data).subspan(4), static_cast<std::uint32_t>(value));
    if (index == 0x6040) request.data[0] = 0x2B;
    if (index == 0x2140) request.data[0] = 0x2F;
    node.on_frame(now, request);
    while (const auto reply = node.next_frame()) EXPECT_NE(reply->data[0], 0x80);
  }
  void move(int axis, std::int64_t counts) {
    write(axis, 0x6081, 0, 200'000);
    write(axis, 0x607A, 0, counts);
    write(axis, 0x6040, 0, 0x1F);
    write(axis, 0x6040, 0, 0x0F);
  }
  bool told(std::uint16_t code) {
    bool found = false;
    while (const auto frame_out = node.next_frame())
      found = found || (frame_out->id == 0x085 && get_u16_le(frame_out->data) == code);
    return found;
  }

  StepMotors<FakeStepStage>::Plans plans;
  StepMotors<FakeStepStage> motors{plans};
  LocalTime now{0};
  LoneNode node{NodeOptions{.node_id = 5}, now};
  std::size_t half = 0;
  std::uint32_t pins = 0;
  std::array<int, 2> made{};
};

TEST_F(Steps, DriversAreEnabledWithTheDriveAndTheirMotorsArriveToTheStep) {
  run(5ms);
  EXPECT_TRUE(motors.dark());
  enable(0);
  run(10ms);
  EXPECT_TRUE(FakeStepStage::enabled[0]);
  EXPECT_FALSE(FakeStepStage::enabled[1]);
  EXPECT_FALSE(motors.dark());
  enable(1);
  run(10ms);
  move(0, 16'000);
  move(1, -1'600);
  run(500ms);
  EXPECT_EQ(made[0], 1'000);
  EXPECT_EQ(made[1], -100);
  EXPECT_EQ(motors.steps(0), 1'000);
  EXPECT_FALSE(told(emcy::kSoftware));
  write(0, 0x6040, 0, 0);
  run(10ms);
  EXPECT_FALSE(FakeStepStage::enabled[0]);
}

TEST_F(Steps, AnAxisThatIsInvertedAtRestSetsItsDirectionAnew) {
  enable(0);
  run(10ms);
  move(0, 16'000);
  run(500ms);
  EXPECT_EQ(made[0], 1'000);
  write(0, 0x2140, 4, 1);
  run(10ms);
  move(0, 24'000);
  run(500ms);
  EXPECT_EQ(made[0], 500) << "as the driver counts: the motor turns the other way";
  EXPECT_EQ(motors.steps(0), 1'500);
}

TEST_F(Steps, FramesMissedAtRestAreHarmlessAndInMotionAFault) {
  enable(0);
  run(10ms);
  fake::pass_time(1ms);
  now += 1ms;
  run(10ms);
  EXPECT_FALSE(told(emcy::kSoftware));
  move(0, 160'000);
  run(100ms);
  EXPECT_GT(made[0], 100);
  fake::pass_time(256us);
  now += 256us;
  run(10ms);
  EXPECT_TRUE(told(emcy::kSoftware));
  EXPECT_FALSE(FakeStepStage::enabled[0]);
  EXPECT_TRUE(motors.dark());
  // A reset of the fault works when it has rested.
  run(200ms);
  write(0, 0x6040, 0, 0x80);
  enable(0);
  run(10ms);
  EXPECT_TRUE(FakeStepStage::enabled[0]);
}

}  // namespace
}  // namespace kinebus
