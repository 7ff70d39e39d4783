// A hot end that cools while filament is fed, turned down by hand or too weak: the path stops before it is
// fed cold, and goes on when it is hot again. Looked at from outside: the extruder's motor, and the hot end's
// sensor as it really is.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kFeederJoint = 5;
/// Each 4 mm long and fed: some 80 s.
std::string printed_lines() {
  std::string job = "M109 S200\n";
  for (int i = 1; i <= 200; ++i)
    job += "G1 X" + std::to_string(i % 2 * 4) + " Y" + std::to_string(0.1 * i) + " E" +
           std::to_string(0.2 * i) + " F600\n";
  return job;
}
constexpr double kAll_mm = 40;
/// The heat node's report, the lead of a hold and its ramp: so long a hold takes to end on the path.
constexpr BusTime kHoldTakes = 600ms;

class CooledFeed : public HeatPrinter {
 protected:
  explicit CooledFeed(MachineDescription machine = printer_on_the_bus()) : HeatPrinter(std::move(machine)) {}
  double sensor() { return rig.nodes.heat_plant(kHeat).hot_end().sensor(); }
  double least() const { return rig.machine.thermal.min_extrude_c; }
  bool begin_to_feed(const std::string& job) {
    rig.nodes.heat_plant(kHeat).hot_end().begin_at(200);
    return begin(job) && watch_until([this] { return rig.joints()[kFeederJoint] > 2; }, 200s);
  }
  /// Notes how cold the hot end was whenever the extruder went on.
  bool watch_until(const std::function<bool()>& done, BusTime limit) {
    return rig.run_until(
        [&] {
          const double e_mm = rig.joints()[kFeederJoint];
          if (e_mm > farthest_mm_ + 0.001) {
            farthest_mm_ = e_mm;
            coldest_fed_ = std::min(coldest_fed_, sensor());
            if (sensor() < least()) fed_cold_ = rig.now - melted_at_;
          }
          if (sensor() >= least()) melted_at_ = rig.now;
          return done();
        },
        limit);
  }
  bool watch_reach(MachineState state, BusTime limit) {
    return watch_until([&] { return rig.gateway->state() == state; }, limit);
  }
  bool tells(std::string_view words) const { return rig.story().find(words) != std::string::npos; }

  double farthest_mm_ = 0, coldest_fed_ = 1000;
  BusTime melted_at_{0}, fed_cold_{0};  ///< last; for how long it was fed since
};

TEST_F(CooledFeed, SwitchedOffByHandAJobIsHeldOnItsPathAndGoesOnWhenItIsHotAgain) {
  ASSERT_TRUE(begin_to_feed(printed_lines())) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 0})) << rig.story();
  ASSERT_TRUE(watch_reach(MachineState::kHeld, 120s)) << rig.story();
  EXPECT_GE(coldest_fed_, least()) << rig.story();
  EXPECT_TRUE(tells("it is set to 0 C and filament is to be fed: at least 170 C is needed")) << rig.story();
  watch_until([] { return false; }, 20s);
  const auto cold = rig.gateway->carry_out(command::Resume{});
  ASSERT_FALSE(cold);
  EXPECT_NE(cold.error().words.find("set it to at least 170 C, then resume"), std::string::npos)
      << cold.error().words;
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
  ASSERT_TRUE(watch_reach(MachineState::kReady, 400s)) << rig.story();
  EXPECT_NEAR(rig.joints()[kFeederJoint], kAll_mm, 0.01) << rig.story();
  EXPECT_GE(coldest_fed_, least()) << rig.story();
}

MachineDescription stuff_that_melts_late() {
  MachineDescription machine = printer_on_the_bus();
  machine.thermal.min_extrude_c = 195;
  return machine;
}

class MeltsLate : public CooledFeed {
 protected:
  MeltsLate() : CooledFeed(stuff_that_melts_late()) {}
};

TEST_F(MeltsLate, AHeaterThatIsTooWeakIsHeldForToo) {
  ASSERT_TRUE(begin_to_feed(printed_lines())) << rig.story();
  heat::ThermalPlant& hot_end = rig.nodes.heat_plant(kHeat).hot_end();
  // Full power holds some 191 C then: no watch takes that for a fault.
  hot_end.p.loss_w_per_k += 0.2;
  ASSERT_TRUE(watch_reach(MachineState::kHeld, 200s)) << sensor() << "\n" << rig.story();
  EXPECT_TRUE(tells("it has only 195 C and filament is to be fed: at least 195 C is needed")) << rig.story();
  EXPECT_LE(fed_cold_, kHoldTakes) << rig.story();
  hot_end.p.loss_w_per_k -= 0.2;
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
  ASSERT_TRUE(watch_reach(MachineState::kReady, 400s)) << rig.story();
  EXPECT_NEAR(rig.joints()[kFeederJoint], kAll_mm, 0.01) << rig.story();
  EXPECT_LE(fed_cold_, kHoldTakes) << rig.story();
}

TEST_F(CooledFeed, ATargetThatMeltsNothingIsRefusedWhileAJobFeeds) {
  ASSERT_TRUE(begin_to_feed(printed_lines())) << rig.story();
  const auto low = rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 150});
  ASSERT_FALSE(low);
  EXPECT_NE(low.error().words.find("at least 170 C"), std::string::npos) << low.error().words;
  EXPECT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 190}));
  EXPECT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 40}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(watch_reach(MachineState::kHeld, 5s));
  EXPECT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 150}));
}

TEST_F(CooledFeed, WhatIsTurnedDownInAHoldIsHeldForBeforeItFeeds) {
  ASSERT_TRUE(begin_to_feed(printed_lines())) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(watch_reach(MachineState::kHeld, 5s));
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 0}));
  ASSERT_TRUE(watch_until([this] { return sensor() < 120; }, 200s));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
  const double before_mm = rig.joints()[kFeederJoint];
  ASSERT_TRUE(watch_until([this] { return tells("filament is to be fed"); }, 5s)) << rig.story();
  ASSERT_TRUE(watch_reach(MachineState::kHeld, 20s)) << rig.story();
  EXPECT_NEAR(rig.joints()[kFeederJoint], before_mm, 0.01) << rig.story();
}

// Ends of jobs switch off and press what was drawn back: that is no cold feed.
TEST_F(CooledFeed, AJobsOwnEndIsNotHeldFor) {
  ASSERT_TRUE(begin("M109 S200\nG1 X10 E4 F600\nG1 E2 F1200\nM104 S0\nG4 S40\nG1 X0 E4 F600\n"));
  ASSERT_TRUE(watch_reach(MachineState::kReady, 400s)) << rig.story();
  EXPECT_FALSE(tells("filament is to be fed")) << rig.story();
  EXPECT_NEAR(rig.joints()[kFeederJoint], 4, 0.01);
}

TEST_F(CooledFeed, AMoveByHandEndsBeforeItFeedsCold) {
  rig.nodes.heat_plant(kHeat).hot_end().begin_at(200);
  ASSERT_TRUE(rig.make_ready());
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(rig.run_until([this] { return hotend() > 195; }, 60s)) << rig.story();
  command::Jog jog;
  jog.delta[kE] = 200;
  jog.speed_per_s = 2;
  ASSERT_TRUE(rig.gateway->carry_out(jog)) << rig.story();
  ASSERT_TRUE(watch_until([this] { return rig.joints()[kFeederJoint] > 2; }, 10s));
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 0}));
  ASSERT_TRUE(watch_reach(MachineState::kReady, 120s)) << rig.story();
  EXPECT_GE(coldest_fed_, least()) << rig.story();
  EXPECT_LT(rig.joints()[kFeederJoint], 190);
}

TEST_F(CooledFeed, AWaitForAHeaterThatIsSwitchedOffIsOver) {
  ASSERT_TRUE(begin("M190 S60\nG1 X5 F600\n")) << rig.story();
  ASSERT_TRUE(
      rig.run_until([this] { return rig.gateway->status().heater(kFirstBed).target_celsius == 60; }, 60s));
  rig.run_for(5s);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 0}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  EXPECT_TRUE(tells("was switched off: nothing waits for it")) << rig.story();
}

TEST_F(CooledFeed, AWaitGoesWithATargetThatIsChangedByHand) {
  ASSERT_TRUE(begin("M190 S90\nG1 X5 F600\n")) << rig.story();
  ASSERT_TRUE(
      rig.run_until([this] { return rig.gateway->status().heater(kFirstBed).target_celsius == 90; }, 60s));
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 40}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 300s)) << rig.story();
  EXPECT_LT(bed(), 60);
}

MachineDescription soon_idle() {
  MachineDescription machine = printer_on_the_bus();
  machine.thermal.idle_off = 60s;
  return machine;
}

class SoonIdle : public HeatPrinter {
 protected:
  SoonIdle() : HeatPrinter(soon_idle()) {}
  bool tells(std::string_view words) const { return rig.story().find(words) != std::string::npos; }
};

// A bed takes longer to be measured than heat may be on while nothing moves.
TEST_F(SoonIdle, AMeasurementIsNotIdle) {
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstBed, 70}));
  rig.run_for(200s);
  EXPECT_FALSE(tells("nothing has moved")) << rig.story();
}

}  // namespace
}  // namespace kinebus
