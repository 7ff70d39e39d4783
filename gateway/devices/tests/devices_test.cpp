#include <gtest/gtest.h>

#include "gateway/devices/devices.hpp"
#include "gateway/devices/node_probe.hpp"
#include "gateway/devices/registry.hpp"
#include "gateway/devices/simulated.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

double after(SimulatedHeater& heater, BusTime begin, BusTime duration, BusTime step) {
  for (BusTime t = begin; t <= begin + duration; t += step) heater.on_time(t);
  return heater.status().actual_celsius;
}

TEST(SimulatedHeater, SettlesOnTheTarget) {
  SimulatedHeater heater({});
  heater.on_time(BusTime{0});
  heater.set_target(210);
  EXPECT_NEAR(after(heater, BusTime{0}, 600s, 100ms), 210, 0.1);
}

TEST(SimulatedHeater, CoolsTowardsTheRoomAndNotBelow) {
  SimulatedHeater heater({});
  heater.set_target(210);
  after(heater, BusTime{0}, 600s, 1s);
  heater.set_target(0);
  EXPECT_LT(after(heater, 600s, 100s, 1s), 120);
  EXPECT_NEAR(after(heater, 700s, 3600s, 1s), 22, 0.01);
}

TEST(SimulatedHeater, LongStepsGiveTheSameAsShortOnes) {
  SimulatedHeater coarse({}), fine({});
  for (SimulatedHeater* heater : {&coarse, &fine}) {
    heater->on_time(BusTime{0});
    heater->set_target(200);
  }
  EXPECT_NEAR(after(coarse, 10s, 90s, 10s), after(fine, 100ms, 99900ms, 100ms), 0.5);
}

TEST(SimulatedInput, ChangesAsOftenAsItsFileSays) {
  SimulatedInput steady(true, 0), changing(false, 2);
  for (BusTime t{0}; t <= 10s; t += 100ms) {
    steady.on_time(t);
    changing.on_time(t);
  }
  EXPECT_EQ(steady.level(), InputLevel::kOn);
  EXPECT_EQ(steady.changes().rises + steady.changes().falls, 0U);
  EXPECT_EQ(changing.changes().rises, 3U);
  EXPECT_EQ(changing.changes().falls, 2U);
  EXPECT_EQ(changing.level(), InputLevel::kOn);
}

TEST(SimulatedFilament, RunsOutAtItsEndAndIsThereAgainWhenTheRestIsDrawnOut) {
  SimulatedFilament spool(100);
  spool.follow(0);
  for (double mm = 1; mm < 100; ++mm) spool.follow(mm);
  EXPECT_EQ(spool.condition(), FilamentCondition::kInOrder);
  spool.follow(100);
  EXPECT_EQ(spool.condition(), FilamentCondition::kOut);
  spool.follow(95);
  EXPECT_EQ(spool.condition(), FilamentCondition::kOut) << "a retraction is no change of spools";
  spool.follow(89);
  EXPECT_EQ(spool.condition(), FilamentCondition::kInOrder);
  for (double mm = 90; mm < 188; ++mm) spool.follow(mm);
  EXPECT_EQ(spool.condition(), FilamentCondition::kInOrder);
  spool.follow(5000);  // another number for where it is
  EXPECT_EQ(spool.condition(), FilamentCondition::kInOrder);
  spool.follow(5003);
  EXPECT_EQ(spool.condition(), FilamentCondition::kOut);
  SimulatedFilament endless(0);
  for (double mm = 0; mm < 1e4; mm += 100) endless.follow(mm);
  EXPECT_EQ(endless.condition(), FilamentCondition::kInOrder);
}

MachineDescription printer_of_two_tools() {
  MachineDescription machine = default_m1();
  machine.heaters.push_back({.name = "left", .index = 1});
  machine.heaters.push_back({.name = "oven", .kind = HeaterKind::kChamber, .max_c = 80});
  machine.fans.push_back({.name = "side", .index = 2});
  machine.outputs = {{.name = "lamp"}};
  machine.sensors = {{.name = "room", .sim_c = 24.5}};
  return machine;
}

TEST(Devices, EachIsFoundByKindAndIndexAndHeatsForItself) {
  auto made = make_devices(printer_of_two_tools());
  ASSERT_TRUE(made) << made.error();
  Devices& devices = *made;
  devices.on_time(BusTime{0});
  devices.heat({HeaterKind::kHotend, 1}, 150);
  devices.heat({HeaterKind::kChamber, 0}, 50);
  for (BusTime t{0}; t < 3600s; t += 1s) devices.on_time(t);
  EXPECT_NEAR(devices.heater({HeaterKind::kHotend, 1}).actual_celsius, 150, 0.1);
  EXPECT_NEAR(devices.heater({HeaterKind::kChamber, 0}).actual_celsius, 50, 0.1);
  EXPECT_NEAR(devices.heater(kFirstHotend).actual_celsius, 23, 0.01);
  EXPECT_NEAR(devices.heater(kFirstBed).actual_celsius, 23, 0.01);
  ASSERT_EQ(devices.heaters().size(), 4u);
  EXPECT_EQ(devices.heaters()[2].name, "left");
  EXPECT_EQ(devices.heaters()[2].target_celsius, 150);
  devices.heaters_off();
  for (const NamedHeaterStatus& heater : devices.heaters())
    EXPECT_EQ(heater.target_celsius, 0) << heater.name;
}

TEST(Devices, FansAndOutputsTurnByTheirOwnIndex) {
  auto made = make_devices(printer_of_two_tools());
  ASSERT_TRUE(made) << made.error();
  Devices& devices = *made;
  devices.blow(2, 0.5);
  devices.blow(7, 1);  // none there
  devices.put_out(0, 1);
  EXPECT_EQ(devices.fan(0), 0);
  EXPECT_EQ(devices.fan(2), 0.5);
  ASSERT_EQ(devices.fans().size(), 2u);
  EXPECT_EQ(devices.fans()[1].name, "side");
  ASSERT_EQ(devices.outputs().size(), 1u);
  EXPECT_EQ(devices.outputs()[0].ratio, 1);
  ASSERT_EQ(devices.sensors().size(), 1u);
  EXPECT_EQ(devices.sensors()[0].celsius, 24.5);
}

TEST(Devices, AMachineWithoutAnyIsColdAndAtRest) {
  Devices devices;
  devices.heat(kFirstHotend, 200);
  devices.turn_spindle(1000);
  devices.on_time(1s);
  EXPECT_EQ(devices.heater(kFirstHotend).target_celsius, 0);
  EXPECT_EQ(devices.spindle().target_rpm, 0);
  EXPECT_FALSE(devices.fault());
  EXPECT_FALSE(devices.next_frame(1s));
  EXPECT_EQ(devices.next_deadline(), BusTime::max());
}

TEST(Devices, WhereNoImplementationLivesIsSaid) {
  MachineDescription machine = default_m1();
  machine.heaters[0].place = {DevicePlace::Where::kNode, 3, 1};
  const auto made = make_devices(machine);
  ASSERT_FALSE(made);
  EXPECT_EQ(
      made.error().english(),
      "heater.bed is to live on node 3, where this gateway knows no such device: use where = \"simulated\"");
}

/// A device on the bus as a test needs it: one frame out, one frame in, a deadline, a fault.
class WiredOutput : public Output {
 public:
  void set(double ratio) override {
    ratio_ = ratio;
    due_ = true;
  }
  double ratio() const override { return ratio_; }
  bool on_frame(BusTime, const CanFrame& frame) override {
    broken_ = broken_ || frame.id == 0x281;
    return frame.id == 0x281;
  }
  std::optional<CanFrame> next_frame(BusTime) override {
    if (!std::exchange(due_, false)) return std::nullopt;
    return CanFrame{.id = 0x201, .length = 1};
  }
  BusTime next_deadline() const override { return 7s; }
  std::optional<Sentence> fault() const override {
    return broken_ ? std::optional(Sentence::verbatim("broken wire")) : std::nullopt;
  }

 private:
  double ratio_ = 0;
  bool due_ = false, broken_ = false;
};

TEST(Devices, FramesTimeAndFaultsOfOneOnTheBusPassThrough) {
  Devices devices;
  devices.add_output({"lamp", 3}, 5, std::make_unique<WiredOutput>());
  EXPECT_FALSE(devices.next_frame(0s));
  devices.put_out(3, 1);
  const auto frame = devices.next_frame(0s);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x201u);
  EXPECT_FALSE(devices.next_frame(0s));
  EXPECT_EQ(devices.next_deadline(), 7s);
  EXPECT_FALSE(devices.on_frame(0s, CanFrame{.id = 0x181, .length = 1}));
  EXPECT_FALSE(devices.fault());
  EXPECT_TRUE(devices.on_frame(0s, CanFrame{.id = 0x281, .length = 1}));
  const auto fault = devices.fault();
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->device, "output.lamp");
  EXPECT_EQ(fault->node, 5);
  EXPECT_EQ(fault->words.english(), "broken wire");
}

TEST(NodeProbe, TouchesAsTheInputOfItsNodeSays) {
  MachineDescription machine = default_m1();
  machine.nodes[2].inputs[4] = {InputFunction::kProbe, 0};
  machine.probe = {.present = true, .place = {DevicePlace::Where::kNode, 3, 5}};
  auto made = make_devices(machine);
  ASSERT_TRUE(made) << made.error();
  CanFrame frame{.id = 0x183, .length = 7};
  frame.data[6] = 0x10;
  made->on_frame(0s, frame);
  EXPECT_TRUE(made->probe_touches());
  frame.id = 0x182;
  frame.data[6] = 0;
  made->on_frame(0s, frame);
  EXPECT_TRUE(made->probe_touches()) << "another node's inputs";
  frame.id = 0x183;
  made->on_frame(0s, frame);
  EXPECT_FALSE(made->probe_touches());
}

}  // namespace
}  // namespace kinebus
