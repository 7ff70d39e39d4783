// Filament that is to come heats its hot end ahead: from the planned path to the block's temperature, through
// a hold and an override. The plant's flow is what the extruder's motor really turns.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "gateway/machine/tests/heat_printer.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kTarget = 210;

class HeatAhead : public HeatPrinter {
 protected:
  HeatAhead() {
    for (std::size_t j = 0; j < rig.machine.joints.size(); ++j)
      if (rig.machine.joints[j].name == "E") extruder_ = j;
    rig.on_frame = [this](BusTime, const CanFrame& frame) {
      if (frame.id != cob_id::rpdo(4, kHeatId)) return;
      ++told;
      told_now_w = get_u16_le(frame.data) * 0.01;
    };
  }
  void melt() {
    const BusTime since = rig.now - looked_;
    if (since < 50ms) return;
    const double at = rig.joints()[extruder_], radius = rig.machine.gcode.filament_diameter_mm / 2;
    flow = looked_ == BusTime{0} ? 0 : std::max(0.0, (at - at_) / to_seconds(since));
    flow *= std::numbers::pi * radius * radius;
    rig.nodes.heat_plant(kHeat).hot_end().flow_mm3_per_s = flow;
    most_flow = std::max(most_flow, flow);
    if (watched_) {
      const double off = rig.nodes.heat_plant(kHeat).hot_end().block() - kTarget;
      coldest = std::min(coldest, off);
      hottest = std::max(hottest, off);
    }
    looked_ = rig.now;
    at_ = at;
  }
  bool melt_until(const std::function<bool()>& done, BusTime limit) {
    return rig.run_until(
        [&] {
          melt();
          return done();
        },
        limit);
  }
  void melt_for(BusTime time) {
    melt_until([] { return false; }, time);
  }
  /// Measured, hot and at rest.
  void make_hot() {
    ASSERT_TRUE(rig.make_ready()) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstHotend, kTarget}));
    const auto measured = [&] {
      for (const NamedHeaterStatus& heater : rig.gateway->status().heaters)
        if (heater.tuning.stage == TuningStage::kDone) return true;
      return false;
    };
    ASSERT_TRUE(rig.run_until(measured, 400s)) << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, kTarget}));
    rig.run_for(150s);
    ASSERT_NEAR(rig.nodes.heat_plant(kHeat).hot_end().block(), kTarget, 0.5);
    watched_ = true;
  }
  bool print(std::string job) {
    return rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(std::move(job)), "part"})
        .has_value();
  }

  double flow = 0, most_flow = 0, coldest = 0, hottest = 0, told_now_w = 0;
  int told = 0;

 private:
  std::size_t extruder_ = 0;
  BusTime looked_{0};
  double at_ = 0;
  bool watched_ = false;
};

// 24 mm3/s of 1.75 mm filament is 10 mm/s of it: F600 along X.
const std::string kLongLine = "G1 X-60 F3000\nG1 X60 E120 F600\nG1 X-60 E240\n";

TEST_F(HeatAhead, AStepOf24Mm3PerSecondLeavesTheBlockWithinOneKelvin) {
  make_hot();
  ASSERT_TRUE(print(kLongLine)) << rig.story();
  ASSERT_TRUE(melt_until([&] { return flow > 20; }, 60s)) << rig.story();
  melt_for(1s);
  EXPECT_GT(told_now_w, 9) << "0.0021 J/(mm3 K) * 24 mm3/s * 185 K";
  EXPECT_LT(told_now_w, 11);
  ASSERT_TRUE(melt_until([&] { return rig.gateway->state() == MachineState::kReady; }, 120s)) << rig.story();
  melt_for(20s);
  EXPECT_NEAR(most_flow, 24, 0.7);
  EXPECT_EQ(told_now_w, 0) << "it is over";
  std::printf("block through 24 mm3/s: %.2f to %+.2f K\n", coldest, hottest);
  EXPECT_GT(coldest, -1);
  EXPECT_LT(hottest, 1);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST_F(HeatAhead, HoldAndOverrideMoveItWithPathTime) {
  make_hot();
  ASSERT_TRUE(print(kLongLine)) << rig.story();
  ASSERT_TRUE(melt_until([&] { return flow > 20; }, 60s)) << rig.story();
  melt_for(3s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(melt_until([&] { return rig.gateway->state() == MachineState::kHeld; }, 5s));
  melt_for(500ms);
  EXPECT_EQ(told_now_w, 0);
  melt_for(8s);
  const int silent = told;
  melt_for(2s);
  EXPECT_NEAR(told - silent, 2, 1) << "nothing flows, and that is told once a second";
  EXPECT_EQ(told_now_w, 0);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  melt_for(4s);
  EXPECT_GT(told_now_w, 9);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.5}));
  melt_for(3s);
  EXPECT_NEAR(told_now_w, 4.9, 0.4);
  EXPECT_NEAR(flow, 12, 1);
  ASSERT_TRUE(melt_until([&] { return rig.gateway->state() == MachineState::kReady; }, 120s)) << rig.story();
  std::printf("block through hold and override: %.2f to %+.2f K\n", coldest, hottest);
  EXPECT_GT(coldest, -1);
  EXPECT_LT(hottest, 1);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

}  // namespace
}  // namespace kinebus
