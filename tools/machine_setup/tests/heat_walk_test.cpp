// The set-up's part that warms and blows, and a whole one on an Octopus.

#include <gtest/gtest.h>

#include "gateway/description/machine_file.hpp"
#include "tools/machine_setup/heat_bench.hpp"
#include "tools/machine_setup/tests/octopus_ebb_heat.hpp"
#include "tools/machine_setup/tests/setup_rig.hpp"

namespace kinebus {
namespace {

/// Two cards and a heat node with a hot end, a bed and two fans (HeatPlant).
class CardsWithHeat : public ::testing::Test {
 public:
  CardsWithHeat() {
    rig.add_board(Stm32f405Board::kFacts, 501, 1);
    rig.add_board(Stm32f405Board::kFacts, 502, 2);
    rig.add_heat(20);
    rig.answers = {{"Which machine", {"cartesian"}},          {"Which boards", {"cards"}},
                   {"What does the", {"generic_3950"}},       {"it moves now", {"skip"}},
                   {"it is pressed within", {"skip"}},        {"Did it run?", {"yes"}},
                   {"Which one got warm?", {"bed", "hotend"}}};
  }
  bool said(std::string_view words) const { return rig.said.find(words) != std::string::npos; }
  double peak(int sensor) const { return rig.heat->temperature(sensor) / 1000.0; }
  SetupRig rig;
};

TEST_F(CardsWithHeat, EachHeaterIsWarmedABitAndNamedByAPerson) {
  double hottest = 0;
  rig.interrupted = [&] {
    for (const int sensor : {0, 1}) hottest = std::max(hottest, peak(sensor));
    return false;
  };
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("Heater hotend: heater 1 and sensor 1 of the heat node"));
  EXPECT_TRUE(said("Its sensor has risen by"));
  EXPECT_TRUE(said("in order"));
  EXPECT_TRUE(rig.dark());
  EXPECT_GT(hottest, 25) << "it did heat";
  EXPECT_LT(hottest, 45) << "and only a bit";
}

TEST_F(CardsWithHeat, AnOpenSensorIsSaidAndNothingHeats) {
  ASSERT_EQ(rig.plant.command("sensor 1 open"), "");
  rig.answers["it is warmed by 5 K now"] = {"warm", "warm", "skip"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("hotend: its sensor does not measure: is it plugged in, and whole?")) << rig.said;
}

TEST_F(CardsWithHeat, ASensorThatWasPluggedInMeanwhileIsGoneOnWith) {
  ASSERT_EQ(rig.plant.command("sensor 1 open"), "");
  rig.on_question = [&](std::string_view question) {
    if (question.find("its sensor does not measure") != std::string_view::npos)
      static_cast<void>(rig.plant.command("sensor 1 ok"));
  };
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("hotend: its sensor does not measure")) << rig.said;
  EXPECT_TRUE(said("Its sensor has risen by")) << rig.said;
  EXPECT_TRUE(rig.dark());
}

TEST_F(CardsWithHeat, AHeaterThatIsNotConnectedIsFoundOut) {
  ASSERT_EQ(rig.plant.command("heater 1 open"), "");
  rig.answers["it is warmed by 5 K now"] = {"warm", "warm", "skip"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("hotend: ")) << rig.said;
  EXPECT_FALSE(said("heater_hotend: warms"));
  EXPECT_TRUE(rig.dark());
}

TEST_F(CardsWithHeat, AnotherOneThatGotWarmIsNoPass) {
  rig.answers["Which one got warm?"] = {"hotend", "bed", "hotend"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("exchange both plugs")) << rig.said;
}

TEST_F(CardsWithHeat, InterruptedWhileItHeatsItIsOff) {
  rig.interrupted = [&] { return peak(1) > 25; };
  EXPECT_EQ(rig.walk(), 130) << rig.said;
  EXPECT_TRUE(rig.dark());
}

TEST_F(CardsWithHeat, WithoutTheHeatNodeTheRestIsStillDone) {
  rig.heat.reset();
  rig.answers["it runs for 3 s now"] = {"skip"};
  rig.answers["it is warmed by 5 K now"] = {"skip"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("heat: no heat node 20 (heat node) answers")) << rig.said;
}

TEST_F(OctopusAndEbbHeat, AllMotorsAreTheOctopusAndTheHotEndIsTheEbbs) {
  rig.add_heat(6);
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  for (const char* words : {"EBB: node 6", "Heater hotend: heater and TH0 of the EBB",
                            "Fan part: FAN2 of the EBB", "Fan hotend_fan: FAN1 of the EBB",
                            "E: MOTOR3 of the Octopus", "heat: no heat node 5 (Octopus) answers"})
    EXPECT_NE(rig.said.find(words), std::string::npos) << words << "\n" << rig.said;
  const auto machine = load_machine(rig.file());
  ASSERT_TRUE(machine) << to_string(machine.error());
  for (const HeaterDescription& heater : machine->heaters)
    EXPECT_EQ(heater.place.node_id, heater.kind == HeaterKind::kHotend ? 6 : 5);
  EXPECT_EQ(machine->joints.back().node_id, 2);
  EXPECT_EQ(machine->node(6)->serial, 77u);
  EXPECT_TRUE(rig.dark());
  EXPECT_EQ(rig.heat->nmt_state(), NmtState::kPreOperational) << "as the gateway expects it, before its SYNC";
}

TEST(AnOctopus, IsOneBoardWithItsNodesIdsInARow) {
  SetupRig rig;
  rig.is_octopus = true;
  // As the board is: its first node has the id, the others follow.
  for (std::uint8_t i = 0; i < 4; ++i)
    rig.add_board(Stm32f446OctopusBoard::kFacts, 900U + i, static_cast<std::uint8_t>(1 + i));
  rig.wires = {{{0, 0}, {"tower1", false}},
               {{0, 1}, {"tower2", true}},
               {{1, 0}, {"tower3", false}},
               {{1, 1}, {"E", false}}};
  rig.answers = {{"Which machine", {"delta"}},      {"Which boards", {"octopus"}},
                 {"What does the", {"pt1000"}},     {"touches the bed", {"yes"}},
                 {"it runs for 3 s now", {"skip"}}, {"it is warmed by 5 K now", {"skip"}}};
  rig.presses = {{"Switch of tower1", {{0, 0, true}}},
                 {"Switch of tower2", {{0, 1, true}}},
                 {"Switch of tower3", {{1, 0, true}}},
                 {"Probe", {{0, 6, true}}}};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  const auto machine = load_machine(rig.file());
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_TRUE(machine->joints[1].drive.inverted);
  EXPECT_EQ(machine->node(2)->serial, 901u);
  EXPECT_EQ(machine->probe.place.channel, 7);
  EXPECT_EQ(machine->heaters[0].wiring.sensor.element, SensorElement::kPt1000);
  EXPECT_NE(rig.said.find("Switch of tower3: STOP2 (input 1 of node 2)"), std::string::npos) << rig.said;
  EXPECT_NE(rig.said.find("tower2: MOTOR1 of the Octopus (node 1, axis B): first its carriage up"),
            std::string::npos)
      << rig.said;
}

}  // namespace
}  // namespace kinebus
