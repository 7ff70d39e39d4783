// A heat node beside axis pairs: pulsed outputs, and a board's program with both.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "node_firmware/board/board_heat.hpp"
#include "node_firmware/board/node_program.hpp"
#include "node_firmware/board/tests/fake_drivers.hpp"
#include "protocol/bytes.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

TEST(PulsedOutput, KeepsItsMeanWhateverThePasses) {
  for (const std::uint32_t share : {1u, 50u, 150u, 500u, 900u, 999u}) {
    PulsedOutput output(10ms);
    LocalTime now{0}, on_for{0};
    bool on = false;
    std::uint32_t random = 12345;
    while (now < 60s) {
      random = random * 1664525 + 1013904223;
      const LocalTime pass = 64us * (1 + (random >> 24) % 40);
      now += pass;
      if (on) on_for += pass;
      on = output.step(now, share, 1000);
    }
    EXPECT_NEAR(static_cast<double>(on_for.count()) / 60e9, share / 1000.0, 0.001) << share;
  }
}

TEST(PulsedOutput, IsOffAtOnceAndOnAtOnce) {
  PulsedOutput output(10ms);
  LocalTime now{0};
  for (int i = 0; i < 1000; ++i) output.step(now += 1ms, 700, 1000);
  EXPECT_TRUE(output.step(now += 1us, 1000, 1000));
  EXPECT_FALSE(output.step(now += 1us, 0, 1000));
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(output.step(now += 1ms, 0, 1000)) << "nothing is owed";
}

struct FakeHeat {
  static constexpr int kSensors = 2, kHeaters = 2, kFans = 1;
  static constexpr std::array<std::uint8_t, 2> kFilamentInputs{0, 1};
  static constexpr std::uint8_t kProbeInput = 2;
  std::optional<std::uint32_t> take_ratio(int sensor) {
    if (silent) return std::nullopt;
    noise = noise * 1664525 + 1013904223;
    return ratio[static_cast<std::size_t>(sensor)] + (noise >> 28);
  }
  void set_heater(int heater, bool on) { heaters[static_cast<std::size_t>(heater)] = on; }
  void set_fan(int, bool on) { fan = on; }
  void set_contactor(bool closed) { contactor = closed; }
  void set_servo(std::uint16_t us) { servo = us; }
  // 100 kOhm at 25 C on 4.7 kOhm.
  std::array<std::uint32_t, 2> ratio{1'001'500, 1'001'500};
  std::array<bool, 2> heaters{};
  bool fan = false, contactor = false, silent = false;
  std::uint32_t noise = 1;
  std::uint16_t servo = 0;
};

struct HeatBesideAxes : testing::Test {
  static constexpr std::uint32_t kAxes = 5, kHeat = 6;
  HeatBesideAxes() {
    fake::Counter::now = 0;
    program.heat().begin({.node_id = kHeat, .serial = 7, .id_from_board = true}, program.now(), {});
    run(20ms);
    for (const int data : {0x220A, 0x6110}) {
      const std::uint16_t value = data == 0x6110 ? 10'100 : 0xFFCE;
      can.arrive(CanFrame::make(
          0x600 + kHeat, {0x2B, static_cast<std::uint8_t>(data), static_cast<std::uint8_t>(data >> 8), 1,
                          static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8), 0, 0}));
      run(20ms);
    }
    can.arrive(CanFrame::make(0x600 + kHeat, {0x23, 0x43, 0x22, 0, 7, 0, 0, 0}));  // its own serial number
    run(220ms);
    can.arrive(CanFrame::make(0x000, {1, 0}));
    run(20ms);
  }
  void run(LocalTime time) {
    for (LocalTime t{0}; t < time; t += 500us) {
      fake::pass_time(500us);
      program.pass();
    }
  }
  void ask_for(std::uint16_t tenths) {
    can.arrive(CanFrame::make(0x600 + kHeat, {0x2B, 0x02, 0x74, 1, static_cast<std::uint8_t>(tenths),
                                              static_cast<std::uint8_t>(tenths >> 8), 0, 0}));
    run(300ms);
  }
  FakeHeat& driver() { return program.heat().driver(); }
  fake::Can can;
  fake::Switches switches;
  MotionPlanExchange plan;
  NodeProgram<fake::Can, fake::Switches, fake::Counter, 1, BoardHeat<FakeHeat>> program{
      NodeOptions{.node_id = kAxes, .consecutive_ids = 2}, {}, can, switches, plan};
};

/// Sensor 1 as a Pt100 of a MAX31865: 0, or the abort code.
template <typename Driver>
std::uint32_t describe_pt100(BoardHeat<Driver>& board, std::uint8_t id) {
  const auto write = [&](std::uint16_t index, std::uint8_t sub, int size, std::uint32_t value) {
    CanFrame request = CanFrame::make(0x600u + id, {0, 0, 0, 0, 0, 0, 0, 0});
    request.data[0] = static_cast<std::uint8_t>(0x23 | (4 - size) << 2);
    put_u16_le(std::span(request.data).subspan(1), index);
    request.data[3] = sub;
    put_u32_le(std::span(request.data).subspan(4), value);
    board.renew_hearing(1s);
    board.on_frame(1s, request);
    board.serve(1s);
    while (const auto frame = board.next_frame())
      if (frame->id == 0x580u + id)
        return frame->data[0] == 0x60 ? 0u : get_u32_le(std::span(frame->data).subspan(4));
    return 1u;
  };
  EXPECT_EQ(write(0x2201, 1, 4, 430'000), 0u);
  EXPECT_EQ(write(0x220D, 1, 1, 3), 0u);
  EXPECT_EQ(write(0x2200, 1, 1, 1), 0u);
  return write(0x6110, 1, 2, 30);
}

struct FakeMax31865 {
  std::optional<std::uint32_t> take(LocalTime, heat::RtdWiring wiring) {
    last = wiring;
    ++asked;
    return ratio;
  }
  heat::RtdWiring last;
  int asked = 0;
  std::optional<std::uint32_t> ratio = 428'865;  // a Pt100 at 200 C against 430 Ohm
};
struct HeatWithConverter : FakeHeat {
  static constexpr std::uint8_t kMax31865Sensors = 1;
  FakeMax31865* max31865(int) { return fitted ? &chip : nullptr; }
  FakeMax31865 chip;
  bool fitted = true;
};

TEST(BoardHeat, ASensorOfAMax31865IsMeasuredByNothingElse) {
  // 0: valid, 1: not.
  const auto status = [](bool fitted, bool silent) {
    BoardHeat<HeatWithConverter> board;
    auto& driver = board.driver();
    // What its divider has would be a Pt100 of some 200 C, too.
    driver.ratio[0] = *driver.chip.ratio;
    driver.fitted = fitted;
    if (silent) driver.chip.ratio.reset();
    board.begin({.node_id = 6, .serial = 7}, 1s, {});
    EXPECT_EQ(describe_pt100(board, 6), 0u);
    for (LocalTime now = 1s; now < 1300ms; now += 1ms) board.serve(now);
    EXPECT_EQ(driver.chip.asked > 20, fitted);
    if (fitted) {
      EXPECT_EQ(driver.chip.last, (heat::RtdWiring{.three_wires = true}));
    }
    board.on_frame(1300ms, CanFrame::make(0x606, {0x40, 0x50, 0x61, 1, 0, 0, 0, 0}));
    while (const auto frame = board.next_frame())
      if (frame->id == 0x586) return frame->data[4] & 1;
    return -1;
  };
  EXPECT_EQ(status(true, false), 0);
  EXPECT_EQ(status(true, true), 1);
  EXPECT_EQ(status(false, false), 1) << "the board is not its own: nothing is asked";
}

TEST(BoardHeat, ABoardWithoutAMax31865RefusesASensorOfOne) {
  BoardHeat<FakeHeat> board;
  board.begin({.node_id = 6, .serial = 7}, 1s, {});
  EXPECT_NE(describe_pt100(board, 6), 0u);
}

// What another board has stored, or this one's program of before: nothing heats by it.
TEST(BoardHeat, AStoredSensorOfAMax31865MeasuresNothingWithoutOne) {
  BoardHeat<HeatWithConverter> other;
  other.begin({.node_id = 6, .serial = 7}, 1s, {});
  EXPECT_EQ(describe_pt100(other, 6), 0u);
  other.on_frame(1s, CanFrame::make(0x606, {0x23, 0x10, 0x10, 1, 's', 'a', 'v', 'e'}));
  std::vector<std::uint8_t> image;
  struct {
    void allow_flash() {}
    void back_to_normal() {}
  } dog;
  other.store(dog, [&](std::span<const std::uint8_t> bytes) {
    image.assign(bytes.begin(), bytes.end());
    return true;
  });
  ASSERT_FALSE(image.empty());
  BoardHeat<FakeHeat> board;
  board.begin({.node_id = 6, .serial = 7}, 1s, image);
  // What its divider has would be a Pt100 of some 200 C.
  board.driver().ratio[0] = 428'865;
  for (LocalTime now = 1s; now < 2s; now += 1ms) board.serve(now);
  board.renew_hearing(2s);
  board.on_frame(2s, CanFrame::make(0x606, {0x40, 0x50, 0x61, 1, 0, 0, 0, 0}));
  int status = -1;
  while (const auto frame = board.next_frame())
    if (frame->id == 0x586) status = frame->data[4] & 1;
  EXPECT_EQ(status, 1) << "not valid";
}

TEST_F(HeatBesideAxes, AnswersUnderItsOwnIdAndHeats) {
  for (const std::uint32_t id : {0x700 + kAxes, 0x700 + kHeat})
    EXPECT_EQ(std::ranges::count(can.sent, CanFrame::make(id, {0})), 1) << std::hex << id;
  EXPECT_TRUE(can.heard(0x606));
  EXPECT_TRUE(driver().contactor);
  EXPECT_FALSE(driver().heaters[0]);
  ask_for(2000);
  EXPECT_TRUE(driver().heaters[0]);
  EXPECT_FALSE(driver().heaters[1]);
  EXPECT_TRUE(program.heat().heats());
}

TEST_F(HeatBesideAxes, AConverterThatStandsTakesThePower) {
  ask_for(2000);
  ASSERT_TRUE(driver().heaters[0]);
  driver().silent = true;
  run(200ms);
  EXPECT_FALSE(driver().heaters[0]);
  driver().silent = false;
  run(500ms);
  EXPECT_FALSE(driver().heaters[0]) << "the fault stays";
}

// The controller does not hear what it sends: the board's own nodes are told by the board.
TEST_F(HeatBesideAxes, AnEmergencyStopOfTheBoardsAxesReachesIt) {
  can.arrive(CanFrame::make(
      0x600 + kAxes,
      {0x2F, 0x30, 0x21, 1, static_cast<std::uint8_t>(SwitchFunction::kEmergencyStop), 0, 0, 0}));
  ask_for(2000);
  ASSERT_TRUE(driver().heaters[0]);
  switches.in.push_back({fake::Counter::now, 0, true});
  run(110ms);  // a tick of its control
  EXPECT_FALSE(driver().heaters[0]);
  EXPECT_FALSE(program.heat().heats());
}

TEST_F(HeatBesideAxes, IsOffWhenItsIdGoes) {
  ask_for(2000);
  ASSERT_TRUE(driver().heaters[0]);
  program.heat().end();
  EXPECT_FALSE(driver().heaters[0]);
  run(500ms);
  EXPECT_FALSE(driver().heaters[0]);
}

}  // namespace
}  // namespace kinebus
