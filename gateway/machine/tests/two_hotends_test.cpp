// A printer with two hot ends, each on a heat node of its own: what must be hot is the one in use at that
// place of the job. Looked at from outside: the extruder's motor, both sensors as they really are, the
// frames.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/machine/tests/heat_printer.hpp"
#include "gateway/machine/tests/resume_rig.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

constexpr HeaterId kSecondHotend{HeaterKind::kHotend, 1};
constexpr std::uint8_t kSecondId = 21;
constexpr int kSecond = 4;  // its node's place among the nodes
constexpr std::size_t kFeeder = 5;

HeaterDescription& second_hotend(MachineDescription& machine) {
  HeaterDescription heater = *machine.heater(kFirstHotend);
  heater.name = "hotend_1";
  heater.index = 1;
  return machine.heaters.emplace_back(heater);
}

MachineDescription two_hotends() {
  MachineDescription machine = printer_on_the_bus();
  NodeDescription node = machine.nodes.back();
  node.id = kSecondId;
  node.functions.heaters = 1;
  machine.nodes.push_back(node);
  second_hotend(machine).place = {DevicePlace::Where::kNode, kSecondId, 1};
  return machine;
}

/// Each 4 mm long, 0.2 mm fed: some 0.4 s.
std::string fed_lines(int count, double from_mm) {
  std::string job;
  for (int i = 1; i <= count; ++i)
    job += "G1 X" + std::to_string(i % 2 * 4) + " E" + std::to_string(from_mm + 0.2 * i) + " F600\n";
  return job;
}

class TwoHotends : public HeatPrinter {
 protected:
  explicit TwoHotends(MachineDescription machine = two_hotends()) : HeatPrinter(std::move(machine)) {}
  heat::ThermalPlant& first() { return rig.nodes.heat_plant(kHeat).hot_end(); }
  virtual heat::ThermalPlant& second() { return rig.nodes.heat_plant(kSecond).hot_end(); }
  double fed_mm() { return rig.joints()[kFeeder]; }
  double target(HeaterId id) { return rig.gateway->status().heater(id).target_celsius; }
  bool tells(std::string_view words) const { return rig.story().find(words) != std::string::npos; }
  bool feeds_until(double mm, BusTime limit = 200s) {
    return rig.run_until([&] { return fed_mm() > mm; }, limit);
  }
  std::string refusal(std::string_view line, std::uint32_t number) {
    const auto done = rig.gateway->take_line(line, number);
    return done ? "" : done.error().words.english();
  }
};

TEST_F(TwoHotends, AJobWhoseSecondToolIsColdIsRefusedInItsName) {
  first().begin_at(200);
  ASSERT_TRUE(begin("M109 S200\nG1 X5 E1 F600\nT1\nG1 X10 E2\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_TRUE(tells("filament is fed with the hotend T1 at 0 C; at least 170 C is needed")) << rig.story();
  EXPECT_LT(fed_mm(), 0.02);
}

TEST_F(TwoHotends, WithTheSecondInUseTheFirstMayBeCold) {
  ASSERT_TRUE(begin("T1\nM109 S200\nG1 X20 E4 F600\nG1 E3.2 F1200\nG1 E4\nM104 T0 S60\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return target(kSecondHotend) == 200; }, 60s)) << rig.story();
  EXPECT_EQ(target(kFirstHotend), 0) << "M109 without T is of the tool in use";
  ASSERT_TRUE(feeds_until(0.02)) << rig.story();
  EXPECT_GT(second().sensor(), 195) << rig.story();
  EXPECT_LT(first().sensor(), 40);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(fed_mm(), 4, 0.01);
  EXPECT_EQ(target(kFirstHotend), 60) << "M104 T0 is of the other";
  EXPECT_EQ(target(kSecondHotend), 200);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
  EXPECT_EQ(rig.gateway->status().tool, kSecondHotend);
}

TEST_F(TwoHotends, ATextThatDoesNotWaitForItsSecondToolIsMadeToBeforeItFeeds) {
  first().begin_at(200);
  ASSERT_TRUE(begin("M104 T1 S200\nM109 S200\nG1 X5 E1 F600\nT1\nG1 X20 F1200\nG1 X40 E3\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return rig.gateway->status().pose[kX] > 19.9; }, 60s)) << rig.story();
  EXPECT_NEAR(fed_mm(), 1, 0.01);
  EXPECT_LT(second().sensor(), 165) << "what feeds nothing moves meanwhile";
  rig.run_for(1s);
  EXPECT_NE(rig.gateway->status().doing.english().find("hotend T1"), std::string::npos)
      << rig.gateway->status().doing.english();
  ASSERT_TRUE(feeds_until(1.02)) << rig.story();
  EXPECT_GT(second().sensor(), 169) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(fed_mm(), 3, 0.01);
}

TEST_F(TwoHotends, TheSecondTurnedDownInMidJobIsHeldForAndTheFirstIsNot) {
  first().begin_at(200);
  second().begin_at(200);
  ASSERT_TRUE(begin("M104 T1 S200\nM109 S200\n" + fed_lines(10, 0) + "T1\nM109 S200\n" + fed_lines(500, 2)))
      << rig.story();
  ASSERT_TRUE(feeds_until(3)) << rig.story();
  // The job goes on while the first one cools.
  EXPECT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 100})) << "it feeds nothing now";
  const auto low = rig.gateway->carry_out(command::SetTemperature{kSecondHotend, 100});
  ASSERT_FALSE(low);
  EXPECT_NE(low.error().words.find("at least 170 C"), std::string::npos) << low.error().words;
  ASSERT_TRUE(rig.run_until([this] { return first().sensor() < 165; }, 100s)) << rig.story();
  EXPECT_EQ(rig.gateway->state(), MachineState::kRunning) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kSecondHotend, 0}));
  double farthest_mm = fed_mm(), coldest = 1000;
  ASSERT_TRUE(rig.run_until(
      [&] {
        if (fed_mm() > farthest_mm + 0.001) {
          farthest_mm = fed_mm();
          coldest = std::min(coldest, second().sensor());
        }
        return rig.gateway->state() == MachineState::kHeld;
      },
      120s))
      << rig.story();
  EXPECT_GE(coldest, rig.machine.thermal.min_extrude_c);
  EXPECT_TRUE(tells("heater.hotend_1: it is set to 0 C and filament is to be fed")) << rig.story();
  const auto cold = rig.gateway->carry_out(command::Resume{});
  ASSERT_FALSE(cold);
  EXPECT_NE(cold.error().words.find("the hotend T1 is set to 0 C: set it to at least 170 C"),
            std::string::npos)
      << cold.error().words;
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kSecondHotend, 200}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 400s)) << rig.story();
  EXPECT_NEAR(fed_mm(), 102, 0.01) << rig.story();
}

TEST_F(TwoHotends, WhatTheFirstDrewBackIsNotPressedIntoAColdSecond) {
  first().begin_at(200);
  ASSERT_TRUE(begin("M104 T1 S150\nM109 S200\nG1 X5 E3 F600\nG1 E1 F1200\nT1\nG1 E3\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_TRUE(tells("filament is fed with the hotend T1 at 150 C")) << rig.story();
}

TEST_F(TwoHotends, LinesAndJogsGoByTheToolInUse) {
  first().begin_at(200);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(rig.run_until([this] { return hotend() > 195; }, 60s));
  command::Jog jog;
  jog.delta[kE] = 1;
  ASSERT_EQ(refusal("T1", 1), "");
  const auto cold = rig.gateway->carry_out(jog);
  ASSERT_FALSE(cold);
  EXPECT_NE(cold.error().words.find("the hotend T1 is too cold"), std::string::npos) << cold.error().words;
  ASSERT_EQ(refusal("T0", 2), "");
  EXPECT_TRUE(rig.gateway->carry_out(jog));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  ASSERT_TRUE(rig.gateway->carry_out(command::OpenLines{"host"})) << rig.story();
  for (const char* line : {"G91", "M83", "G1 E1 F100", "T1"}) EXPECT_EQ(refusal(line, 3), "") << line;
  EXPECT_NE(refusal("G1 E1", 7).find("the hotend T1 at 0 C"), std::string::npos) << refusal("G1 E1", 7);
  for (const char* line : {"T0", "G1 E1"}) EXPECT_EQ(refusal(line, 8), "") << line;
}

TEST_F(TwoHotends, TheNodeOfTheToolInUseIsToldWhatFlows) {
  first().begin_at(200);
  second().begin_at(200);
  double first_w = 0, second_w = 0;
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    if (frame.id == cob_id::rpdo(4, kHeatId)) first_w = get_u16_le(frame.data) * 0.01;
    if (frame.id == cob_id::rpdo(4, kSecondId)) second_w = get_u16_le(frame.data) * 0.01;
  };
  ASSERT_TRUE(begin("M104 T1 S200\nM109 S200\n" + fed_lines(20, 0) + "T1\nM109 S200\n" + fed_lines(40, 4)));
  ASSERT_TRUE(feeds_until(2)) << rig.story();
  EXPECT_GT(first_w, 0.3);
  EXPECT_EQ(second_w, 0);
  ASSERT_TRUE(feeds_until(6)) << rig.story();
  EXPECT_EQ(first_w, 0);
  EXPECT_GT(second_w, 0.3);
}

/// The second one is the other channel of the same node, where beds usually are.
MachineDescription two_on_one_node() {
  MachineDescription machine = printer_on_the_bus();
  std::erase_if(machine.heaters, [](const HeaterDescription& h) { return h.kind == HeaterKind::kBed; });
  HeaterDescription& second = second_hotend(machine);
  second.place = {DevicePlace::Where::kNode, kHeatId, 2};
  second.wiring.fan_channel = 0;
  return machine;
}

class TwoOnOneNode : public TwoHotends {
 protected:
  TwoOnOneNode() : TwoHotends(two_on_one_node()) {}
  heat::ThermalPlant& second() override { return rig.nodes.heat_plant(kHeat).bed(); }
};

TEST_F(TwoOnOneNode, ItIsToldWhichOneTheFlowIsOf) {
  second().p = first().p;
  first().begin_at(200);
  second().begin_at(200);
  int named = 0;
  double told_w = 0, most_w[3] = {};
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    const auto data = frame.bytes();
    if (frame.id == cob_id::kSdoRequest + kHeatId && data.size() == 8 &&
        get_u16_le(data.subspan(1)) == 0x2228 && (data[0] & 0xE0) == 0x20)
      named = data[4];
    if (frame.id != cob_id::rpdo(4, kHeatId)) return;
    told_w = get_u16_le(frame.data) * 0.01;
    if (named < 3) most_w[named] = std::max(most_w[named], told_w);
  };
  ASSERT_TRUE(begin("M104 T1 S200\nM109 S200\n" + fed_lines(20, 0) + "T1\n" + fed_lines(40, 4)))
      << rig.story();
  ASSERT_TRUE(feeds_until(2)) << rig.story();
  EXPECT_EQ(named, 1);
  EXPECT_GT(most_w[1], 0.3);
  ASSERT_TRUE(feeds_until(6)) << rig.story();
  EXPECT_EQ(named, 2);
  EXPECT_GT(most_w[2], 0.3);
  EXPECT_EQ(most_w[0], 0);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST(TwoHotendsResumed, AnotherGatewayHeatsBothInOrderAndGoesOnWithTheToolInUse) {
  MachineDescription machine = default_m1();
  second_hotend(machine);
  ResumeRig rig(std::move(machine));
  rig.job_text =
      "G21 G90 M83\nM104 T0 S60\nG1 Z10 F6000\nT1\nM109 S50\nG1 X20 E1 F1200\nG1 X-20 E1\nG1 X20 E1\n";
  ASSERT_TRUE(rig.begin(0.1)) << rig.story();
  ASSERT_TRUE(rig.run_until(
      [&] {
        rig.watch();
        return rig.gateway->status().line >= 6;
      },
      200s))
      << rig.story();
  rig.run(500ms);
  ASSERT_EQ(rig.gateway->status().tool, kSecondHotend);
  ASSERT_NO_FATAL_FAILURE(rig.replace_gateway());
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
  ASSERT_TRUE(
      rig.run_until([&] { return rig.gateway->status().heater(kSecondHotend).target_celsius == 50; }, 200s))
      << rig.story();
  EXPECT_GE(rig.gateway->status().heater(kFirstHotend).actual_celsius, 57) << "one after the other";
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 60);
  EXPECT_EQ(rig.gateway->status().tool, kSecondHotend);
  ASSERT_TRUE(rig.finish(200s)) << rig.story();
  EXPECT_NEAR(rig.filament_mm, 3, 0.01) << rig.story();
}

// R waits while it cools, too; S does not.
TEST_F(TwoHotends, AWaitWithRIsOverWhenTheBedHasCooled) {
  rig.nodes.heat_plant(kHeat).bed().begin_at(70);
  ASSERT_TRUE(begin("M190 S60\nG1 X5 F600\nM190 R60\nG1 X10\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return rig.gateway->status().pose[kX] > 4.9; }, 30s)) << rig.story();
  EXPECT_GT(rig.nodes.heat_plant(kHeat).bed().sensor(), 65) << "S is reached where it is hotter";
  ASSERT_TRUE(rig.run_until([this] { return rig.gateway->status().pose[kX] > 5.1; }, 2000s)) << rig.story();
  EXPECT_LT(rig.nodes.heat_plant(kHeat).bed().sensor(), 62.5);
  EXPECT_GT(rig.nodes.heat_plant(kHeat).bed().sensor(), 57.5);
}

TEST_F(TwoHotends, AWaitWithRIsOverWhenTheHotEndHasCooled) {
  first().begin_at(220);
  ASSERT_TRUE(begin("M109 S220\nG1 X5 F600\nM109 R180\nG1 X10\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return rig.gateway->status().pose[kX] > 5.1; }, 400s)) << rig.story();
  EXPECT_LT(first().sensor(), 182.5);
  EXPECT_GT(first().sensor(), 177.5);
}

}  // namespace
}  // namespace kinebus
