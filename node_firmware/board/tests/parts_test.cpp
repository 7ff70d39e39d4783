// Clock, watchdog, handover, thermistor, bit timing, serial number.

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include <cmath>

#include "node_firmware/board/boot_program.hpp"
#include "node_firmware/board/can_timing.hpp"
#include "node_firmware/board/fault_record.hpp"
#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/status_led.hpp"
#include "node_firmware/board/tests/fake_drivers.hpp"
#include "node_firmware/board/thermistor.hpp"
#include "node_firmware/board/upkeep.hpp"
#include "node_firmware/boot/tests/boot_bench.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

TEST(LocalClock, GoesOnWhenTheCounterGoesRound) {
  fake::Counter::now = 0xFFFF'FF00;
  LocalClock<fake::Counter> clock;
  const LocalTime before = clock.now();
  const PlanCounts noted = fake::Counter::now + 0x80;
  fake::Counter::now += 0x200;
  EXPECT_EQ(clock.now() - before, 0x200 * kPlanCount);
  EXPECT_EQ(clock.at(noted) - before, 0x80 * kPlanCount) << "of an interrupt before the last look";
}

TEST(FaultRecord, IsToldOnceAndOnlyWhenItIsWhole) {
  FaultRecord record{.reason = 3, .lr = 5, .pc = 0x0802'0000, .cfsr = 1, .hfsr = 2, .address = 4};
  EXPECT_EQ(FaultRecord(record).take().reason, fault_reason::kNone) << "not sealed";
  record.seal();
  FaultRecord damaged = record;
  damaged.psr ^= 1u << 31;
  EXPECT_EQ(damaged.take().reason, fault_reason::kNone);
  const ResetReport report = record.take();
  EXPECT_EQ(report.reason, 3);
  EXPECT_EQ(report.pc, 0x0802'0000u);
  EXPECT_EQ(report.address, 4u);
  EXPECT_EQ(record.take().reason, fault_reason::kNone) << "once";
}

TEST(StatusLed, EachStateHasItsOwnPattern) {
  const std::array<LedState, 6> states{LedState{.on_bus = false},
                                       {.fault = true, .node_id = 1},
                                       {.node_id = 0},
                                       {.node_id = 1, .nmt = NmtState::kOperational},
                                       {.node_id = 1, .nmt = NmtState::kStopped},
                                       {.node_id = 1, .nmt = NmtState::kPreOperational}};
  std::set<std::vector<bool>> patterns;
  for (const LedState& state : states) {
    std::vector<bool> pattern;
    for (std::uint32_t step = 0; step < 16; ++step) {
      pattern.push_back(led_on(state, step));
      EXPECT_EQ(led_on(state, step), led_on(state, step + 16));
    }
    patterns.insert(pattern);
  }
  EXPECT_EQ(patterns.size(), states.size());
}

TEST(WatchdogKeeper, FeedsOnlyWhileTheControlGoesOnAndTheNodeIsServed) {
  LocalTime now{0};
  LoneNode node{NodeOptions{.node_id = 5}, now};
  fake::Watchdog dog;
  WatchdogKeeper keeper;
  std::uint32_t ticks = 0;
  const auto pass = [&](LocalTime time, bool served, bool control) {
    for (LocalTime t{0}; t < time; t += 1ms) {
      now += 1ms;
      if (served) {
        node.on_time(now);
        while (node.next_frame()) {
        }
      }
      if (control) ticks += 20;
      keeper.serve(dog, now, node, ticks);
    }
    return std::exchange(dog.feeds, 0);
  };
  EXPECT_NEAR(pass(200ms, true, true), 20, 1);
  EXPECT_LE(pass(200ms, true, false), 1);
  EXPECT_NEAR(pass(200ms, true, true), 20, 1);
  EXPECT_LE(pass(2000ms, false, true), 60) << "a heartbeat was due after half a second at most";
}

TEST(Handover, TheBootLoadersNodeIdIsTakenOnce) {
  Handover handover{.node_id = 7};
  EXPECT_EQ(take_inherited_node_id(handover), 7);
  EXPECT_EQ(take_inherited_node_id(handover), 0);
  Handover noise{.magic = 0xA5A5'A5A5, .node_id = 9};
  EXPECT_EQ(take_inherited_node_id(noise), 0) << "after power-up";
  Handover strange{.node_id = 500};
  EXPECT_EQ(take_inherited_node_id(strange), 0);
}

TEST(Thermistor, IsNearTheFormula) {
  static constexpr Thermistor kNtc{3435};
  for (double celsius = 0; celsius <= 110; celsius += 0.7) {
    const double ratio = std::exp(3435 * (1 / (celsius + 273.15) - 1 / 298.15));
    const auto steps = static_cast<std::uint32_t>(std::lround(4096 * ratio / (1 + ratio)));
    EXPECT_NEAR(static_cast<double>(kNtc.celsius(steps)), celsius, 0.5) << steps;
  }
  EXPECT_LT(kNtc.celsius(4095), -50) << "open";
  EXPECT_GT(kNtc.celsius(0), 180) << "shorted";
}

TEST(CanTiming, IsExactAndSamplesWhereCiaSays) {
  for (const std::uint32_t clock : {36'000'000u, 42'000'000u, 45'000'000u, 64'000'000u}) {
    const CanTiming timing = can_timing(clock, 1'000'000, 800);
    EXPECT_EQ(timing.prescaler * timing.quanta() * 1'000'000, clock);
    EXPECT_GE(timing.sample_permille(), 750u) << clock;
    EXPECT_LE(timing.sample_permille(), 875u) << clock;
  }
  EXPECT_EQ(can_timing(7'000'000, 1'000'000, 800).quanta(), 1u) << "none exists";
}

TEST(Identity, EveryBitOfTheChipsNumberCounts) {
  const std::array<std::uint32_t, 3> one{1, 2, 3}, other{1, 2, 0x8000'0003};
  EXPECT_NE(serial_number(one), serial_number(other));
}

TEST(BootProgram, HearsItsIdAndStartsAProgramWhenItsAnswerIsOnTheBus) {
  ParameterImage stored;
  EXPECT_EQ(boot_node_id(Handover{.node_id = 9}, stored, {}), 9);
  EXPECT_EQ(boot_node_id(Handover{.node_id = 0}, stored, {}), 0);
  ParameterImage kept;
  kept.clear(12);
  EXPECT_EQ(boot_node_id(Handover{.node_id = 0}, stored, kept.bytes()), 12);

  ModelFlash flash{8192, 1};
  flash.erase();
  fake::Can can;
  const auto image = make_image(3000, 5);
  for (std::size_t at = 0; at < image.size(); at += 4)
    flash.program(static_cast<std::uint32_t>(at), get_u32_le(std::span(image).subspan(at)));
  BootProgram<fake::Can, fake::Counter> boot(kBootBoard, kBootIdentity, 9, flash, can);
  EXPECT_FALSE(boot.pass());
  EXPECT_TRUE(can.heard(0x609));
  EXPECT_FALSE(can.heard(0x60A));
  EXPECT_EQ(can.sent.front(), CanFrame::make(0x709, {0}));
  can.arrive(CanFrame::make(0x609, {0x2F, 0x51, 0x1F, 1, program_control::kStart, 0, 0, 0}));
  EXPECT_TRUE(boot.pass());
  EXPECT_EQ(can.sent.back(), CanFrame::make(0x589, {0x60, 0x51, 0x1F, 1, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace kinebus
