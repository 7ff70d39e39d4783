// The set-up writes programs: to an EBB without one, with that of its other use, and with an older one.

#include <gtest/gtest.h>

#include "gateway/description/machine_file.hpp"
#include "tools/machine_setup/tests/octopus_ebb_heat.hpp"

namespace kinebus {
namespace {

constexpr bool kHeat = true, kAxis = false;
constexpr const char* kHeatImage = "kinebus-ebb-g0b1-heat.bin";

// Heaters and fans are passed over: the rig's plant hangs on another node.
class EbbPrograms : public OctopusAndEbbHeat {
 public:
  EbbPrograms() : ebb(rig.add_ebb(950)) {
    rig.answers["Fan part"] = rig.answers["Fan hotend_fan"] = rig.answers["Heater"] = {"skip"};
    rig.answers["What now?"] = {"skip"};
    rig.answers["Which version is printed"] = {"v1.2"};
    rig.answers["Look again?"] = {"n"};
    rig.add_program(kHeatImage, FlashBoard::image(2, kHeat));
    rig.add_program("kinebus-ebb-g0b1-heat-v1.1.bin", FlashBoard::image(11, kHeat));
  }
  bool said(std::string_view words) const { return rig.said.find(words) != std::string::npos; }
  std::string file_of_heat() const { return rig.file(kHeatImage).string(); }
  void expect_heat_node_for_good() {
    ASSERT_TRUE(ebb.heat) << rig.said;
    EXPECT_EQ(ebb.node_id(), 6);
    ebb.power_cycle(rig.now());
    ASSERT_TRUE(ebb.heat);
    EXPECT_EQ(ebb.node_id(), 6) << "it has stored its id";
    const auto machine = load_machine(rig.file());
    ASSERT_TRUE(machine) << to_string(machine.error());
    EXPECT_EQ(machine->node(6)->serial, 950u);
  }
  FlashBoard& ebb;
};

TEST_F(EbbPrograms, OneThatWaitsWithoutAProgramAndWithoutAnIdGetsBoth) {
  ASSERT_TRUE(ebb.boot);
  ASSERT_EQ(ebb.node_id(), 0);
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(
      said("waits in its boot loader without a program; it could be the EBB. Write " + file_of_heat()))
      << rig.said;
  EXPECT_TRUE(said("updated")) << rig.said;
  EXPECT_TRUE(said("EBB: node 6")) << rig.said;
  EXPECT_TRUE(said("EBB: it has the program that is at hand")) << rig.said;
  ASSERT_EQ(rig.flashed.size(), 1u);
  expect_heat_node_for_good();
}

TEST_F(EbbPrograms, OneThatWaitsUnderTheIdOfItsRoleKeepsIt) {
  ebb.write(std::vector<std::uint8_t>(4004, 7), 6, rig.now());  // no image
  ASSERT_TRUE(ebb.boot);
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("Kinebus extruder axis on an EBB (serial number 950, node 6) waits in its boot loader"))
      << rig.said;
  expect_heat_node_for_good();
}

TEST_F(EbbPrograms, OneWithTheProgramOfAnAxisBecomesAHeatNode) {
  ebb.write(FlashBoard::image(1, kAxis), 40, rig.now());
  ASSERT_TRUE(ebb.axis);
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(
      said("Kinebus extruder axis on an EBB (serial number 950, node 40) answers. If that is the EBB, it "
           "wants the program "
           "for this use. Write " +
           file_of_heat()))
      << rig.said;
  expect_heat_node_for_good();
}

TEST_F(EbbPrograms, OneWithTheProgramOfAnAxisAndTheRolesIdKeepsItAsAHeatNode) {
  ebb.write(FlashBoard::image(1, kAxis), 6, rig.now());
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  expect_heat_node_for_good();
}

// What it is with its program, its product code says; that it has none, only its boot loader.
TEST_F(EbbPrograms, OneForAnAxisThatWaitsWithoutAProgramAndWithoutAnIdGetsBoth) {
  rig.answers["Which boards"] = {"octopus+ebb"};
  rig.answers["E: the extruder"] = {"skip"};
  rig.add_program("kinebus-ebb-g0b1.bin", FlashBoard::image(3, kAxis));
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("waits in its boot loader without a program; it could be the EBB. Write ")) << rig.said;
  ASSERT_TRUE(ebb.axis);
  ebb.power_cycle(rig.now());
  EXPECT_EQ(ebb.node_id(), 6);
}

TEST_F(EbbPrograms, AnOlderProgramIsSeenAndReplacedWhenThePersonWantsIt) {
  ebb.write(FlashBoard::image(1, kHeat), 6, rig.now());
  rig.answers["its program is another one than that at hand"] = {"n"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(rig.flashed.empty());
  rig.answers["its program is another one than that at hand"] = {"y"};
  ASSERT_EQ(rig.walk("again.toml"), 0) << rig.said;
  ASSERT_EQ(rig.flashed.size(), 1u) << rig.said;
  ASSERT_TRUE(ebb.heat);
  const auto newer = FlashBoard::image(2, kHeat);
  EXPECT_TRUE(std::equal(newer.begin(), newer.end(), ebb.flash.bytes().begin()));
  // It runs what is at hand now: nothing is asked.
  rig.said.clear();
  ASSERT_EQ(rig.walk("third.toml"), 0) << rig.said;
  EXPECT_TRUE(said("EBB: it has the program that is at hand")) << rig.said;
  EXPECT_EQ(rig.flashed.size(), 1u);
}

TEST_F(EbbPrograms, TheBoardsVersionChoosesTheImage) {
  rig.answers["Which version is printed"] = {"v1"};
  rig.answers["ebb_version: found"] = {"v1.1"};
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said("ebb_version: found 'v1'; expected 1 .. 2 or one of v1.2, v1.1")) << rig.said;
  const auto older = FlashBoard::image(11, kHeat);
  EXPECT_TRUE(std::equal(older.begin(), older.end(), ebb.flash.bytes().begin())) << rig.said;
}

TEST_F(EbbPrograms, AWriteThatFailsIsSaidAndTriedAgain) {
  ebb.flash.erases = false;
  int offers = 0;
  rig.answers["Look again?"] = {"y"};
  rig.on_question = [&](std::string_view question) {
    if (question.find("waits in its boot loader without") != std::string_view::npos && ++offers == 2)
      ebb.flash.erases = true;
  };
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_EQ(offers, 2);
  EXPECT_EQ(rig.flashed.size(), 2u);
  expect_heat_node_for_good();
}

TEST_F(EbbPrograms, WithoutTheFilesTheFolderIsAskedForAndADamagedOneIsSaid) {
  const auto folder = rig.programs;
  auto damaged = FlashBoard::image(2, kHeat);
  damaged[2000] ^= 1;
  rig.add_program(kHeatImage, damaged);
  std::filesystem::remove(folder / "kinebus-ebb-g0b1-heat-v1.1.bin");
  std::filesystem::create_directories(folder / "good");
  rig.answers["to write over CAN"] = {"nowhere", (folder / "good").string()};
  rig.answers["Program for Octopus"] = {""};
  rig.add_program("good/" + std::string(kHeatImage), FlashBoard::image(2, kHeat));
  ASSERT_EQ(rig.walk(), 0) << rig.said;
  EXPECT_TRUE(said(file_of_heat() + ": the image's CRC is wrong: the file is damaged")) << rig.said;
  EXPECT_TRUE(said("cannot read nowhere")) << rig.said;
  ASSERT_TRUE(ebb.heat) << rig.said;
}

TEST_F(EbbPrograms, WhoDoesNotWantItIsToldThatTheBoardIsMissing) {
  rig.answers["waits in its boot loader without"] = {"n"};
  EXPECT_EQ(rig.walk(), 1);
  EXPECT_TRUE(said("EBB: no board with heat answers")) << rig.said;
  EXPECT_TRUE(ebb.boot) << "untouched";
  EXPECT_TRUE(rig.flashed.empty());
}

}  // namespace
}  // namespace kinebus
