// A heater that its node measures, from the command to the model that is kept: gateway core, heat node,
// plant.

#include <gtest/gtest.h>

#include <algorithm>

#include "gateway/machine/tests/heat_printer.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/heat_units.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class HeatTuningOnTheBus : public HeatPrinter {
 protected:
  HeatTuningOnTheBus() {
    rig.on_frame = [this](BusTime, const CanFrame& frame) {
      // The gateway asks the node, too.
      if (frame.id == cob_id::kSdoReply + kHeatId && (frame.data[0] & 0xE0) == 0x40 &&
          get_u16_le(std::span(frame.data).subspan(1)) == asked.index && frame.data[3] == asked.subindex)
        answer = get_u32_le(std::span(frame.data).subspan(4));
    };
  }
  HeaterTuning tuning(HeaterId id = kFirstHotend) {
    for (const NamedHeaterStatus& heater : rig.gateway->status().heaters)
      if (heater.id == id) return heater.tuning;
    return {};
  }
  bool over(BusTime within) {
    return rig.run_until([&] { return !tuning().runs() && !tuning(kFirstBed).runs(); }, within);
  }
  std::string refusal(Command command) {
    const auto done = rig.gateway->carry_out(std::move(command));
    return done ? "" : done.error().words.english();
  }
  /// As another master reads it.
  std::uint32_t object(ObjectAddress address) {
    CanFrame request{.id = cob_id::kSdoRequest + kHeatId, .length = 8};
    request.data[0] = 0x40;
    put_u16_le(std::span(request.data).subspan(1), address.index);
    request.data[3] = address.subindex;
    asked = address;
    rig.stranger_sends(request);
    rig.run_for(50ms);
    return answer;
  }

  ObjectAddress asked{};
  std::uint32_t answer = 0;
};

TEST_F(HeatTuningOnTheBus, AHotEndIsMeasuredKeptAndReachedWithoutOvershoot) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstHotend, 210}));
  rig.run_for(5s);
  EXPECT_EQ(tuning().stage, TuningStage::kHeats);
  EXPECT_EQ(power(0), 1);
  EXPECT_NE(refusal(command::SetTemperature{kFirstBed, 60}).find("heater.hotend is being measured"),
            std::string::npos);
  EXPECT_NE(refusal(command::TuneHeater{kFirstBed, 90}).find("heater.hotend is measured"), std::string::npos);
  EXPECT_NE(refusal(command::GoToReference{}).find("while heater.hotend is measured"), std::string::npos);
  ASSERT_TRUE(over(400s)) << rig.story();
  ASSERT_EQ(tuning().stage, TuningStage::kDone) << rig.story();
  rig.run_for(100ms);
  EXPECT_TRUE(tuning().failure.empty()) << "it is stored";
  // The plant: 44 W, 14.6 J/K in two lumps, 1.6 s dead, the sensor 1.3 s behind.
  const HeaterModel model = tuning().model;
  EXPECT_EQ(model.power_w, 44);
  EXPECT_NEAR(model.capacity_j_per_k, 14.6, 1.0);
  EXPECT_NEAR(model.dead_s + model.lag_s, 2.9 + 0.5, 0.8) << "and the cartridge";
  EXPECT_NEAR(model.loss_w_per_k, 0.075, 0.02);
  for (const char* words : {"heater.hotend is measured, to be good at 210 C", "the power is off", "44.0 W"})
    EXPECT_NE(rig.story().find(words), std::string::npos) << words << "\n" << rig.story();

  // Without power and back: the node knows its heater.
  const std::uint32_t rate = object(heat_object::kModelRate);
  EXPECT_NEAR(rate, 44e3 / model.capacity_j_per_k, 2);
  rig.nodes.set_power(kHeat, rig.now, false);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  rig.nodes.set_power(kHeat, rig.now, true);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  EXPECT_EQ(object(heat_object::kModelRate), rate);
  rig.nodes.heat_plant(kHeat).hot_end().forget_hottest();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 210}));
  rig.run_for(120s);
  EXPECT_NEAR(rig.nodes.heat_plant(kHeat).hot_end().block(), 210, 1);
  EXPECT_LE(rig.nodes.heat_plant(kHeat).hot_end().hottest(), 212);
}

TEST_F(HeatTuningOnTheBus, AHeaterThatWasNeverMeasuredIsToldWhenItIsToHeat) {
  const auto times = [&] {
    int count = 0;
    const std::string story = rig.story(), words = "heater.hotend was never measured";
    for (std::size_t at = story.find(words); at != std::string::npos; at = story.find(words, at + 1)) ++count;
    return count;
  };
  const auto measured = [&] { return rig.gateway->status().heater(kFirstHotend).measured; };
  EXPECT_EQ(measured(), Measured::kNotTold);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.run_for(1s);
  EXPECT_EQ(measured(), Measured::kNotYet);
  EXPECT_EQ(times(), 0) << "nothing heats yet";
  for (int i = 1; i <= 2; ++i) {
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 60}));
    rig.run_for(3s);
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 70}));
    rig.run_for(3s);
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 0}));
    rig.run_for(1s);
    EXPECT_EQ(times(), i) << rig.story();
  }
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstHotend, 210}));
  ASSERT_TRUE(over(400s)) << rig.story();
  ASSERT_EQ(tuning().stage, TuningStage::kDone) << rig.story();
  EXPECT_EQ(measured(), Measured::kYes);
  // Another gateway reads it from the node.
  rig.gateway = std::make_unique<Gateway>(rig.machine);
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 60}));
  rig.run_for(3s);
  EXPECT_EQ(measured(), Measured::kYes);
  EXPECT_EQ(times(), 2) << rig.story();
}

TEST_F(HeatTuningOnTheBus, TheBedIsMeasuredByMarlinsWords) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->text_line("M303 E-1 S90 C8 U1")) << rig.story();
  ASSERT_TRUE(over(1500s)) << rig.story();
  ASSERT_EQ(tuning(kFirstBed).stage, TuningStage::kDone) << rig.story();
  EXPECT_EQ(tuning(kFirstBed).celsius, 90);
  // 250 W, 1060 J/K.
  EXPECT_NEAR(tuning(kFirstBed).model.capacity_j_per_k, 1060, 60);
  ASSERT_TRUE(rig.gateway->text_line("M303 H1 P1 S180"));
  EXPECT_EQ(tuning().celsius, 180);
  EXPECT_TRUE(tuning().runs());
  for (const char* line : {"M303 E0.5", "M303 E7", "M303 E-2", "M303 E-3"})
    EXPECT_FALSE(rig.gateway->text_line(line)) << line;
}

TEST_F(HeatTuningOnTheBus, ATargetOfZeroAndAStopEndIt) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstHotend, 210}));
  rig.run_for(5s);
  ASSERT_GT(power(0), 0);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 0}));
  rig.run_for(1s);
  EXPECT_EQ(power(0), 0);
  EXPECT_EQ(tuning().stage, TuningStage::kFailed);
  EXPECT_NE(rig.story().find("heater.hotend was not measured: it was ended"), std::string::npos)
      << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstHotend, 0}));
  rig.run_for(5s);
  ASSERT_GT(power(0), 0) << "the usual temperature";
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  rig.run_for(1s);
  EXPECT_EQ(power(0), 0);
  EXPECT_EQ(tuning().stage, TuningStage::kFailed);
}

TEST_F(HeatTuningOnTheBus, WhatCannotBeMeasuredIsRefusedWithWhy) {
  EXPECT_NE(refusal(command::TuneHeater{kFirstHotend, 210}).find("bring it up first"), std::string::npos);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  EXPECT_NE(refusal(command::TuneHeater{{HeaterKind::kChamber, 0}, 50}).find("no such heater"),
            std::string::npos);
  EXPECT_NE(refusal(command::TuneHeater{kFirstHotend, 1000}).find("0 to "), std::string::npos);
  EXPECT_NE(refusal(command::TuneHeater{kFirstHotend, 50}).find("less than the 40 K"), std::string::npos);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60}));
  EXPECT_NE(refusal(command::TuneHeater{kFirstHotend, 210}).find("switch them off first"), std::string::npos);
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 0}));
  ASSERT_TRUE(
      rig.gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X40 F600\nG1 X-40\n"), "part"}));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 30s)) << rig.story();
  EXPECT_NE(refusal(command::TuneHeater{kFirstHotend, 210}).find("cannot measure a heater while"),
            std::string::npos);

  MachineRig simulated(default_m1());
  ASSERT_TRUE(simulated.make_ready()) << simulated.story();
  const auto refused = simulated.gateway->carry_out(command::TuneHeater{kFirstHotend, 210});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().words.english().find("only a heater on a heat node can be measured"),
            std::string::npos);
}

TEST_F(HeatTuningOnTheBus, NoJobMeasures) {
  ASSERT_TRUE(begin("G1 X40 F600\nM303 E0 S200\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() == MachineState::kReady; }, 30s));
  EXPECT_NE(rig.story().find("M303 measures a heater, which no job does"), std::string::npos) << rig.story();
}

TEST_F(HeatTuningOnTheBus, AHeaterThatIsNotPluggedInIsToldAndLeftCold) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_EQ(breaks("heater 1 open"), "");
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstHotend, 210}));
  ASSERT_TRUE(over(100s)) << rig.story();
  EXPECT_EQ(tuning().stage, TuningStage::kFailed);
  EXPECT_EQ(power(0), 0);
  EXPECT_NE(rig.story().find("heater.hotend was not measured"), std::string::npos) << rig.story();
  EXPECT_TRUE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST_F(HeatTuningOnTheBus, ANodeThatIsGoneEndsIt) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneHeater{kFirstHotend, 210}));
  rig.run_for(5s);
  rig.nodes.set_power(kHeat, rig.now, false);
  ASSERT_TRUE(over(15s)) << rig.story();
  EXPECT_EQ(tuning().stage, TuningStage::kFailed);
}

}  // namespace
}  // namespace kinebus
