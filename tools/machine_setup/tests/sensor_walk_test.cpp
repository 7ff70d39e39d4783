// The set-up's questions about a Pt100 or Pt1000 on an EBB's amplifier, and what the node says to the
// answers.

#include <gtest/gtest.h>

#include "gateway/description/machine_file.hpp"
#include "tools/card/node_sdo.hpp"
#include "tools/machine_setup/tests/octopus_ebb_heat.hpp"

namespace kinebus {
namespace {

constexpr heat::SensorPart kPt100{.ohm_0 = 100, .reference_ohm = 430, .max31865 = true};

class HotendOnAnAmplifier : public OctopusAndEbbHeat {
 public:
  HotendOnAnAmplifier() {
    rig.answers["amplifier for a Pt100 or Pt1000"] = {"pt100"};
    rig.plant.plug(0, kPt100);
  }
  bool said(std::string_view words) const { return rig.said.find(words) != std::string::npos; }
  HeaterDescription hotend() {
    const auto machine = load_machine(rig.file());
    EXPECT_TRUE(machine) << to_string(machine.error());
    if (!machine) return {};
    mains_hz = machine->thermal.mains_hz;
    for (const HeaterDescription& heater : machine->heaters)
      if (heater.kind == HeaterKind::kHotend) return heater;
    return {};
  }
  void command(std::string_view text) { EXPECT_EQ(rig.plant.command(text), ""); }
  std::int64_t told(ObjectAddress address) { return NodeSdo(rig.host().bus, 6, kHeatTable).read(address); }
  int mains_hz = 0;
};

TEST_F(HotendOnAnAmplifier, IsAskedForWrittenToldToTheNodeAndSeen) {
  rig.add_heat(6);
  rig.answers["How many wires"] = {"3"};
  rig.answers["What does the mains swing with"] = {"60"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  const SensorWiring sensor = hotend().wiring.sensor;
  EXPECT_EQ(sensor.element, SensorElement::kPt100);
  EXPECT_TRUE(sensor.max31865);
  EXPECT_EQ(sensor.reference_ohm, 430);
  EXPECT_EQ(sensor.wires, 3);
  EXPECT_EQ(mains_hz, 60);
  EXPECT_EQ(told(heat_object::kSensorPath), 1);
  EXPECT_EQ(told(heat_object::kSensorWires), 3);
  EXPECT_EQ(told(heat_object::kMains), 60);
  EXPECT_TRUE(said("The hot end's sensor says 22.")) << rig.said;
  EXPECT_TRUE(said("Heater hotend: heater and MAX31865 of the EBB")) << "and it is warmed by it";
  EXPECT_TRUE(said("Its sensor has risen by")) << rig.said;
  EXPECT_NE(rig.text().find("\nsensor_wires = 3"), std::string::npos) << rig.text();
  EXPECT_TRUE(rig.dark());
}

TEST_F(HotendOnAnAmplifier, NonsenseIsRefusedWithPlaceAndRule) {
  rig.add_heat(6);
  rig.answers["amplifier for a Pt100 or Pt1000"] = {"pt10"};
  rig.answers["hotend_amplifier: found"] = {"pt100"};
  rig.answers["How many wires"] = {"1"};
  rig.answers["hotend_wires: found"] = {"two", "5", "4"};
  rig.answers["What does the mains swing with"] = {"55"};
  rig.answers["mains_hz: found"] = {"50"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  for (const char* words :
       {"hotend_amplifier: found 'pt10'; expected 1 .. 3 or one of no, pt100, pt1000 (did you mean pt100?)",
        "hotend_wires: found '1'; expected a whole number in 2 .. 4", "hotend_wires: found 'two'",
        "mains_hz: found '55'; expected 1 .. 2 or one of 50, 60"})
    EXPECT_TRUE(said(words)) << words << "\n" << rig.said;
  EXPECT_EQ(hotend().wiring.sensor.wires, 4);
  EXPECT_EQ(mains_hz, 50);
}

TEST_F(HotendOnAnAmplifier, AnAnswerThatIsNotTrueIsSeenAndGivenAnew) {
  rig.add_heat(6);
  rig.plant.plug(0, {});  // a thermistor at TH0
  command("sensor 1 silent");
  rig.answers["amplifier for a Pt100 or Pt1000"] = {"pt1000", "no"};
  rig.answers["What now?"] = {"another"};
  bool mended = false;
  rig.on_question = [&](std::string_view question) {
    if (mended || question.find("What does the hot end measure with?") == std::string_view::npos) return;
    mended = true;
    command("sensor 1 ok");
  };
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(
      said("Pt1000 with 2 wires at the amplifier: its amplifier does not answer: has this board one, a "
           "chip MAX31865?"))
      << rig.said;
  EXPECT_TRUE(said("set for Pt1000 (4300 ohm) and 2 wires")) << rig.said;
  EXPECT_EQ(hotend().wiring.sensor, SensorWiring{}) << "a thermistor, and nothing left of the other";
  EXPECT_TRUE(said("Its sensor has risen by")) << rig.said;
}

TEST_F(HotendOnAnAmplifier, BrokenAndTouchingWiresAreToldApart) {
  rig.add_heat(6);
  command("sensor 1 open");
  rig.answers["What now?"] = {"again", "skip"};
  rig.on_question = [&](std::string_view question) {
    if (question.find("a wire is broken") == std::string_view::npos) return;
    command("sensor 1 ok");
    command("sensor 1 short");
  };
  rig.answers["Heater hotend"] = {"skip"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  const auto open = rig.said.find("a wire is broken"), shorted = rig.said.find("its wires touch each other");
  EXPECT_NE(open, std::string::npos) << rig.said;
  EXPECT_NE(shorted, std::string::npos) << rig.said;
  EXPECT_LT(open, shorted);
  // Passed over, it is asked for again.
  command("sensor 1 ok");
  rig.on_question = {};
  rig.said.clear();
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("The hot end's sensor says 22.")) << rig.said;
}

TEST_F(HotendOnAnAmplifier, ATemperatureThatIsNotTrueIsNoPass) {
  rig.add_heat(6);
  rig.plant.plug(0, {.ohm_0 = 100, .reference_ohm = 300, .max31865 = true});
  rig.answers["Is it as warm as that"] = {"n"};
  rig.answers["What now?"] = {"skip"};
  rig.answers["Heater hotend"] = {"skip"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("another element than was said, or the switches beside the amplifier")) << rig.said;
  EXPECT_FALSE(said("sensor_hotend: says"));
}

TEST_F(HotendOnAnAmplifier, ABoardThatTakesNoneSaysSo) {
  rig.add_heat(6, false);
  rig.answers["What now?"] = {"skip"};
  rig.answers["Fan part"] = {"skip"};
  rig.answers["Fan hotend_fan"] = {"skip"};
  rig.answers["Heater hotend"] = {"skip"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("A board without the amplifier, or an older program, refuses such a sensor")) << rig.said;
}

TEST_F(HotendOnAnAmplifier, WhatWasInterruptedAtEachQuestionGoesOnToTheSameFile) {
  rig.add_heat(6);
  rig.answers["How many wires"] = {"4"};
  int rounds = 0;
  for (rig.most_questions = 1; rig.walk() != 0 && rounds < 60; ++rounds) {
    rig.questions = 0;
    rig.most_questions = 1 + rounds / 3;
  }
  EXPECT_GT(rounds, 3);
  EXPECT_LT(rounds, 60) << rig.said;
  EXPECT_EQ(hotend().wiring.sensor.wires, 4);
  EXPECT_EQ(hotend().wiring.sensor.element, SensorElement::kPt100);
  EXPECT_NE(rig.text().find("# heater and MAX31865 of the EBB"), std::string::npos) << rig.text();
}

}  // namespace
}  // namespace kinebus
