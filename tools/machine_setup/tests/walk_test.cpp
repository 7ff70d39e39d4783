#include "tools/machine_setup/walk.hpp"

#include <gtest/gtest.h>

#include "gateway/description/machine_file.hpp"
#include "tools/machine_setup/tests/setup_rig.hpp"

namespace kinebus {
namespace {

// A CoreXY printer on two cards that have no id yet: belts on card 1, Z and E on card 2.
class TwoCards : public ::testing::Test {
 public:
  TwoCards() {
    rig.add_board(Stm32f405Board::kFacts, 501);
    rig.add_board(Stm32f405Board::kFacts, 502);
    rig.answers = {{"Which machine", {"corexy"}},
                   {"Which boards", {"cards"}},
                   {"heat node", {"0"}},
                   {"Which board is card 1", {"501"}},
                   {"Which board is card 2", {"502"}}};
    rig.wires = {{{0, 0}, {"beltA", false}},
                 {{0, 1}, {"beltB", false}},
                 {{1, 0}, {"Z", false}},
                 {{1, 1}, {"E", false}}};
    rig.presses["Switch of Z"] = {{1, 0, true}};
  }
  MachineDescription machine() {
    auto read = load_machine(rig.file());
    EXPECT_TRUE(read) << to_string(read.error());
    return read ? *read : MachineDescription{};
  }
  const JointDescription& joint(const MachineDescription& d, std::string_view name) {
    for (const JointDescription& j : d.joints)
      if (j.name == name) return j;
    throw std::logic_error("no such joint");
  }
  bool said(std::string_view words) const { return rig.said.find(words) != std::string::npos; }
  SetupRig rig;
};

TEST_F(TwoCards, FromBoardsWithoutIdsToAMachineFile) {
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_EQ(rig.boards[0].node->node_id(), 1);
  EXPECT_EQ(rig.boards[1].node->node_id(), 2);
  const MachineDescription d = machine();
  EXPECT_EQ(d.joints.size(), 4u);
  EXPECT_EQ(d.node(1)->serial, 501u) << "no other board takes its place";
  EXPECT_EQ(d.node(2)->serial, 502u);
  EXPECT_TRUE(d.heaters.empty()) << "nothing that is not there seems to be";
  for (const JointDescription& j : d.joints) EXPECT_FALSE(j.drive.inverted) << j.name;
  EXPECT_TRUE(said("Switch of Z: input 1 of node 2"));
  EXPECT_TRUE(said("in order"));
  EXPECT_TRUE(said("kinebusd --machine"));
  EXPECT_TRUE(rig.dark());
  // Each motor has come back.
  for (const auto& board : rig.boards)
    for (const int axis : {0, 1}) EXPECT_NEAR(static_cast<double>(board.node->position({}, axis)), 0, 1e6);
  // It has the comments that a person needs.
  EXPECT_NE(rig.text().find("# motor B of card 1\n[joint.beltB]"), std::string::npos) << rig.text();
  EXPECT_NE(rig.text().find("# share of the bus"), std::string::npos);
}

TEST_F(TwoCards, AMotorThatTurnsTheOtherWayIsInvertedAndSeenAgain) {
  rig.wires[{1, 0}].mirrored = true;
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  const MachineDescription d = machine();
  EXPECT_TRUE(joint(d, "Z").drive.inverted);
  EXPECT_FALSE(joint(d, "beltA").drive.inverted);
  EXPECT_TRUE(said("joint.Z.inverted = true")) << rig.said;
}

TEST_F(TwoCards, ExchangedPlugsAreExchangedInTheFile) {
  rig.wires = {
      {{0, 0}, {"beltB", true}}, {{0, 1}, {"beltA", false}}, {{1, 0}, {"Z", false}}, {{1, 1}, {"E", false}}};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  const MachineDescription d = machine();
  EXPECT_EQ(joint(d, "beltA").axis, 1);
  EXPECT_EQ(joint(d, "beltB").axis, 0);
  EXPECT_TRUE(joint(d, "beltB").drive.inverted);
}

TEST_F(TwoCards, CardsThatAreExchangedShowInTheTestOfTheirMotors) {
  rig.answers["Which board is card 1"] = {"502"};
  rig.answers["Which board is card 2"] = {"501"};
  rig.presses["Switch of Z"] = {{1, 0, true}};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  const MachineDescription d = machine();
  EXPECT_EQ(joint(d, "Z").node_id, 1) << "card 502 has the first id, and Z's motor";
  EXPECT_EQ(joint(d, "beltA").node_id, 2);
  EXPECT_EQ(joint(d, "E").node_id, 1);
}

TEST_F(TwoCards, ASwitchTellsItsLevelAndAnotherSocketIsFound) {
  rig.presses["Switch of Z"] = {{1, 2, false}};
  rig.boards[1].node->on_switch(LocalTime{std::chrono::seconds{1}}, 2, true);
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  const MachineDescription d = machine();
  EXPECT_EQ(joint(d, "Z").homing->switch_input, 3);
  EXPECT_TRUE(d.node(2)->inputs[2].active_low);
  EXPECT_EQ(d.node(2)->inputs[0].function, InputFunction::kNone);
}

TEST_F(TwoCards, ASwitchOfAnotherNodeIsSentBackToItsOwn) {
  rig.presses["Switch of Z"] = {{0, 4, true}, {1, 0, true}};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("That was input 5 of node 1. A joint homes by an input of its own node, 2")) << rig.said;
}

TEST_F(TwoCards, ASwitchThatWasPressedBeforeItWasAskedForIsAskedForAgain) {
  rig.presses["Switch of Z"] = {{1, 0, true, true}, {1, 0, true}};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("input 1 of node 2 has not come back")) << rig.said;
  EXPECT_FALSE(machine().node(2)->inputs[0].active_low) << "not by the edge of its release";
}

TEST_F(TwoCards, NonsenseIsRefusedWithPlaceAndRule) {
  rig.answers["Which machine"] = {"core-xy"};
  rig.answers["machine: found"] = {"9", "\x1b[A", "", "3"};
  rig.answers["heat node"] = {"-1", "twenty", "127", "0"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(
      said("machine: found 'core-xy'; expected 1 .. 4 or one of m1, delta, corexy, cartesian (did you mean "
           "corexy?)"))
      << rig.said;
  EXPECT_TRUE(said("machine: found '9'"));
  EXPECT_TRUE(said("heat_node: found '127'; expected a whole number in 0 .. 126"));
}

TEST_F(TwoCards, WhatWasInterruptedGoesOnWhereItWas) {
  // At every question once: in the end it is the same file.
  int rounds = 0;
  for (rig.most_questions = 1; rig.walk() != 0 && rounds < 100; ++rounds) {
    EXPECT_TRUE(rig.dark()) << "round " << rounds;
    rig.questions = 0;
    rig.most_questions = 2 + rounds / 4;
    rig.answers["Which board is card 1"] = {"501"};
  }
  EXPECT_GT(rounds, 3);
  EXPECT_LT(rounds, 100) << rig.said;
  EXPECT_TRUE(said("interrupted: motors and heaters are off"));
  EXPECT_EQ(machine().joints.size(), 4u);
}

TEST_F(TwoCards, ControlCWhileAMotorMovesStopsItAndSwitchesAllOff) {
  rig.interrupted = [&] { return std::abs(rig.boards[1].first_move[0]) > 0; };
  EXPECT_EQ(rig.walk(), 130) << rig.said;
  EXPECT_TRUE(rig.dark());
  EXPECT_TRUE(said("interrupted"));
  rig.interrupted = {};
  EXPECT_EQ(rig.walk(), 0) << rig.said;
}

TEST_F(TwoCards, AFileOfSomebodyElseIsLeftAlone) {
  std::ofstream(rig.file()) << "mine\n";
  EXPECT_EQ(rig.walk(), 1);
  EXPECT_EQ(rig.text(), "mine\n");
  EXPECT_TRUE(said("is there already and was not written by this set-up"));
}

TEST_F(TwoCards, TwoBoardsWithOneIdAreNamed) {
  rig.boards.clear();
  rig.add_board(Stm32f405Board::kFacts, 501, 1);
  rig.add_board(Stm32f405Board::kFacts, 502, 1);
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said(
      "card 1: node 1 is Kinebus two-axis node (serial number 502, node 1). Is that one to be node 119?"))
      << rig.said;
  EXPECT_EQ(rig.boards[0].node->node_id(), 1);
  EXPECT_EQ(rig.boards[1].node->node_id(), 2);
}

TEST_F(TwoCards, ABoardThatIsMissingIsAskedForAndNothingIsWritten) {
  rig.boards.pop_back();
  rig.wires.clear();
  rig.answers["Look again?"] = {"y", "n"};
  EXPECT_EQ(rig.walk(), 1);
  EXPECT_TRUE(said("card 2: no board with STM32F405 answers")) << rig.said;
  EXPECT_FALSE(std::filesystem::exists(rig.file()));
}

TEST_F(TwoCards, ProgramsAreWrittenToAllCardsWhenAskedFor) {
  rig.add_program("next.bin", make_image(4004, 1));
  rig.programs.clear();
  rig.answers["to write over CAN"] = {rig.file("next.bin").string()};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  ASSERT_EQ(rig.flashed.size(), 1u);
  EXPECT_EQ(rig.flashed[0].second, (std::vector<std::uint8_t>{1, 2}));
}

TEST_F(TwoCards, AFileThatIsNoProgramForThemIsNotWritten) {
  rig.add_program("ebb.bin", FlashBoard::image(1, false));
  auto damaged = make_image(4004, 1);
  damaged[3000] ^= 1;
  rig.add_program("damaged.bin", damaged);
  rig.programs.clear();
  rig.answers["to write over CAN"] = {"nowhere.bin", rig.file("ebb.bin").string(),
                                      rig.file("damaged.bin").string(), ""};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(rig.flashed.empty());
  EXPECT_TRUE(said("cannot read nowhere.bin")) << rig.said;
  EXPECT_TRUE(
      said("ebb.bin: found the program of Kinebus extruder axis on an EBB; expected that of Kinebus two-axis "
           "node, kinebus-node.bin"))
      << rig.said;
  EXPECT_TRUE(said("damaged.bin: the image's CRC is wrong: the file is damaged")) << rig.said;
}

}  // namespace
}  // namespace kinebus
