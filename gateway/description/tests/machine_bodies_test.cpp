// [bodies] of a machine file.

#include <gtest/gtest.h>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/tests/machine_text.hpp"

namespace kinebus {
namespace {

/// A machine that has room for its bodies, and `lines` in its [bodies].
std::string with_bodies(std::string_view lines) {
  return write_machine(legs_below()).substr(0, write_machine(legs_below()).find("\n[bodies]")) +
         "\n[bodies]\n" + std::string(lines);
}

TEST(MachineFile, BodiesReadBackAsTheyWereWritten) {
  MachineDescription d = legs_below();
  d.bodies->clearance_mm = 3.5;
  d.bodies->rail_offset_mm = 61;
  d.bodies->part_radius_mm = 40;
  d.bodies->part_height_mm = 90;
  d.bodies->fixed = {{"camera", {300, -20, 1400}, {340, 20, 1440}},
                     {"lamp", {-340, -20, 1400}, {-300, 20, 1440}},
                     {"post", {-420, 0, 0}, {-420, 0, 1500}, 20}};
  const auto machine = parse_machine(write_machine(d), "written");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_TRUE(*machine == d);
  const auto defaults = parse_machine(with_bodies(""), "written");
  ASSERT_TRUE(defaults) << to_string(defaults.error());
  EXPECT_TRUE(defaults->bodies == BodiesDescription{});
  EXPECT_NE(make_collision_model(*defaults), nullptr);
  d.bodies.reset();
  EXPECT_EQ(make_collision_model(d), nullptr) << "no table, no bodies";
}

TEST(MachineFile, WrongBodiesAreRefusedWithTheirKeyAndRule) {
  const std::pair<const char*, const char*> table[] = {
      {"clearance_mm = -1", "bodies.clearance_mm: found -1; expected a number in 0.1 .. 100"},
      {"clearance_mm = 0", "bodies.clearance_mm: found 0; expected a number in 0.1 .. 100"},
      {"rod_radius_mm = 0", "bodies.rod_radius_mm: found 0; expected a number in 0.1 .. 10000"},
      {"rod_radiu_mm = 5",
       "bodies.rod_radiu_mm: found a key that does not exist; expected perhaps rod_radius_mm"},
      {"tool_length_mm = 3",
       "bodies.tool_length_mm: found 3; expected above tool_radius_mm, 4: the tool's end is round"},
      {"part_radius_mm = 30",
       "bodies.part_radius_mm: found 30; expected part_radius_mm and part_height_mm both above 0, or neither "
       "of "
       "them"},
      {"[bodies.fixed.lamp]\nfrom_mm = [1, 2, 3]",
       "bodies.fixed.lamp.to_mm: missing; expected three numbers, each in -10000 .. 10000"},
      {"[bodies.fixed.lamp]\nfrom_mm = [1, 2, 3]\nto_mm = [4, 5, 3]",
       "bodies.fixed.lamp.to_mm: found a box turned inside out; expected each of its three numbers above "
       "that of "
       "from_mm"},
      {"[bodies.fixed.post]\nfrom_mm = [1, 2, 3]\nto_mm = [1, 2, 3]\nradius_mm = 5",
       "bodies.fixed.post.to_mm: found a rod without length; expected another point than from_mm"},
      {"[bodies.fixed.post]\nfrom_mm = [1, 2, 3]\nto_mm = [4, 5, 6]\nradius_mm = -1",
       "bodies.fixed.post.radius_mm: found -1; expected a number in 0 .. 10000"},
      // A beam through the nozzle's axis that the table comes up against, at the bed reference as well.
      {"[bodies.fixed.beam]\nfrom_mm = [-10, -10, 1260]\nto_mm = [10, 10, 1290]",
       "bodies: found bodies that touch: at X 0 Y 0 Z 20 A 0, platform and beam would touch; expected room "
       "at "
       "the bed "
       "reference, where the machine waits before a job"},
      {"rod_radius_mm = 100", "expected a machine that has room somewhere: this is its best pose"},
  };
  for (const auto& [lines, message] : table) {
    const auto machine = parse_machine(with_bodies(lines), "m");
    ASSERT_FALSE(machine) << lines;
    EXPECT_NE(to_string(machine.error()).find(message), std::string::npos) << to_string(machine.error());
    EXPECT_EQ(machine.error().size(), 1u) << to_string(machine.error());
  }
}

/// A shipped file, and `lines` in its [bodies] instead of its own.
std::string with_lines(const char* file, std::string_view lines) {
  const std::string text = file_text(file);
  return text.substr(0, text.find("\n[bodies]")) + "\n[bodies]\n" + std::string(lines);
}

// The lamp is under the workspace: only homing takes the platform down there.
TEST(MachineFile, HomingThatRunsIntoSomethingIsRefusedWithThePairAndThePose) {
  const std::string table = with_lines("m1.toml", "table_radius_mm = 100\n");
  EXPECT_TRUE(parse_machine(table, "m1"));
  const auto machine =
      parse_machine(table + "[bodies.fixed.lamp]\nfrom_mm = [-20, -20, 950]\nto_mm = [20, 20, 1000]\n", "m1");
  ASSERT_FALSE(machine);
  const std::string words = to_string(machine.error());
  EXPECT_EQ(machine.error().size(), 1u) << words;
  EXPECT_NE(words.find("joint.tower1.homing.method: found homing that is not safe: begun at X "),
            std::string::npos)
      << words;
  EXPECT_NE(words.find("platform and lamp would"), std::string::npos) << words;
}

/// M1 with its switches where its work ends: no room for tall parts.
std::string near_switches(std::string text) {
  for (const auto& [from, to] : {std::pair{"travel_mm = [10, 540]", "travel_mm = [40, 540]"},
                                 std::pair{"switch_position_mm = 10", "switch_position_mm = 40"}})
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
      text.replace(at, std::string_view(from).size(), to);
  return text;
}

TEST(MachineFile, APartIsStatedToBeSparedOnlyWhereHomingSparesIt) {
  const std::string text = near_switches(with_lines("m1.toml", "table_radius_mm = 100\n"));
  const auto machine = parse_machine(text, "m1");
  ASSERT_FALSE(machine);
  const std::string words = to_string(machine.error());
  EXPECT_NE(words.find("homing.spared_part_mm: found homing that is not safe: begun at X "),
            std::string::npos)
      << words;
  EXPECT_NE(words.find("part on the table and nozzle"), std::string::npos) << words;
  EXPECT_NE(words.find("a lower part than 250 mm"), std::string::npos) << words;
  std::string lower = text;
  lower.replace(lower.find("spared_part_mm = 250"), 20, "spared_part_mm = 200");
  EXPECT_TRUE(parse_machine(lower, "m1"));
}

TEST(MachineFile, APartThatHomingCannotSpareIsRefusedWithThePairAndThePose) {
  const auto with_part = [](int height) {
    return parse_machine(
        near_switches(with_lines("m1.toml", "table_radius_mm = 100\npart_radius_mm = 100\npart_height_mm = " +
                                                std::to_string(height) + "\n")),
        "m1");
  };
  EXPECT_TRUE(with_part(200));
  const auto machine = with_part(250);
  ASSERT_FALSE(machine);
  const std::string words = to_string(machine.error());
  EXPECT_NE(words.find("homing that is not safe: begun at X "), std::string::npos) << words;
  EXPECT_NE(words.find("part on the table and nozzle"), std::string::npos) << words;
}

TEST(MachineFile, AnOrderOfHomingIsStatedForAllJointsOrNone) {
  std::string text = file_text("cartesian.toml");
  const auto state = [&](const std::string& joint, int order) {
    const std::string table = "[joint." + joint + ".homing]\n";
    const std::size_t at = text.find(table);
    ASSERT_NE(at, std::string::npos);
    text.insert(at + table.size(), "order = " + std::to_string(order) + "\n");
  };
  state("X", 2);
  const auto some = parse_machine(text, "cartesian");
  ASSERT_FALSE(some);
  EXPECT_NE(to_string(some.error()).find("found an order of some joints; expected an order for every joint"),
            std::string::npos)
      << to_string(some.error());
  state("Y", 3);
  state("Z", 1);
  const auto all = parse_machine(text, "cartesian");
  ASSERT_TRUE(all) << to_string(all.error());
  EXPECT_EQ(all->joints[1].homing->order, 3);
}

TEST(MachineFile, EachKindHasTheKeysOfItsBodies) {
  for (const char* file : {"cartesian.toml", "corexy.toml"}) {
    EXPECT_TRUE(parse_machine(with_lines(file, "holder_radius_mm = 30\n"), file));
    const auto machine = parse_machine(with_lines(file, "rod_radius_mm = 5\n"), file);
    ASSERT_FALSE(machine) << file;
    EXPECT_NE(to_string(machine.error()).find("bodies.rod_radius_mm: found a key that does not exist"),
              std::string::npos);
  }
  EXPECT_TRUE(parse_machine(with_lines("delta.toml", "rod_spacing_mm = 40\n"), "delta"));
  EXPECT_TRUE(parse_machine(with_lines("m4.toml", "rod_radius_mm = 12\n"), "m4"));
  EXPECT_FALSE(parse_machine(with_lines("m4.toml", "rod_spacing_mm = 40\n"), "m4"))
      << "M4's legs are single rods";
}

TEST(MachineFile, EveryShippedMachineHasBodies) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kMachines)) {
    const auto machine = load_machine(entry.path());
    ASSERT_TRUE(machine) << to_string(machine.error());
    EXPECT_NE(make_collision_model(*machine), nullptr) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 8);
}

TEST(MachineFile, LegsThatCrossAreRefusedWithThePairAndAPose) {
  // Rails of one side to the other's attachments.
  MachineDescription d = default_m1();
  auto& legs = std::get<M1Geometry>(d.kinematics).legs;
  std::swap(legs[2].attachment_mm, legs[3].attachment_mm);
  const auto machine = parse_machine(write_machine(d), "m");
  ASSERT_FALSE(machine);
  const std::string words = to_string(machine.error());
  EXPECT_NE(
      words.find(
          "bodies: found bodies that touch: at X 0 Y 0 Z 20 A 0, leg 3 and leg 4 would touch; expected room"),
      std::string::npos)
      << words;
}

TEST(MachineFile, AMachineThatCanStandNowhereIsRefusedWithWhatHindersIt) {
  // Carriages above a platform whose rails and legs are made for carriages below it.
  MachineDescription d = default_m1();
  for (M1Leg& leg : std::get<M1Geometry>(d.kinematics).legs) leg.carriage_above = true;
  const auto machine = parse_machine(write_machine(d), "m");
  ASSERT_FALSE(machine);
  const std::string words = to_string(machine.error());
  EXPECT_NE(
      words.find("kinematics.workspace: found a machine that can stand nowhere in its workspace: at its "
                 "bed reference, X 0 Y 0 Z 20 A 0: tower1: would be "),
      std::string::npos)
      << words;
}

}  // namespace
}  // namespace kinebus
