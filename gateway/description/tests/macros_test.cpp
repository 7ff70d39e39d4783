#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "gateway/description/machine_file.hpp"

namespace kinebus {
namespace {

/// The default machine file, and `tables` behind it.
Result<MachineDescription, MachineFileErrors> with(const std::string& tables) {
  return parse_machine(write_machine(default_m1()) + tables, "macros.toml");
}

TEST(Macros, AreReadAndWritten) {
  const auto machine = with(
      "[macro.START_PRINT]\ngcode = '''\nG28\no1 if [exists[#<bed>]]\nM190 S#<bed>\no1 endif\n'''\n"
      "[macro.park]\ngcode = \"G0 Z50\"\n");
  ASSERT_TRUE(machine) << to_string(machine.error());
  ASSERT_EQ(machine->macros.size(), 2u);
  EXPECT_EQ(machine->macros[0].name, "START_PRINT");
  EXPECT_EQ(machine->macros[1].gcode, "G0 Z50");
  const auto again = parse_machine(write_machine(*machine), "again.toml");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);
}

/// The one mistake of these tables.
MachineFileError mistake(const std::string& tables) {
  const auto machine = with(tables);
  if (machine || machine.error().size() != 1) {
    ADD_FAILURE() << (machine ? "no mistake is found" : to_string(machine.error()));
    return {};
  }
  return machine.error().front();
}

TEST(Macros, AMistakeNamesTheMacroItsLineAndTheRule) {
  const MachineFileError open = mistake("[macro.park]\ngcode = \"G28\\no1 if [1]\\nG0 X0\"\n");
  EXPECT_EQ(open.key, "macro.park.gcode");
  EXPECT_EQ(open.expected, "G-code, a line each; line 2: o1 if has no end");
  EXPECT_EQ(mistake("[macro.park]\ngcode = \"o<a> spin\"\n").key, "macro.park.gcode");
  EXPECT_EQ(mistake("[macro.park]\ngcode = 5\n").expected, "a text");
  EXPECT_EQ(mistake("[macro.park]\n").key, "macro.park.gcode");
  EXPECT_EQ(mistake("[macro.\"to park\"]\ngcode = \"\"\n").key, "macro.to park");
}

TEST(Macros, NamesDifferByMoreThanTheirCase) {
  const MachineFileError twice = mistake("[macro.Park]\ngcode = \"\"\n[macro.park]\ngcode = \"\"\n");
  EXPECT_EQ(twice.key, "macro.park");
  EXPECT_EQ(twice.expected, "another name than Park: upper and lower case are the same");
}

TEST(Macros, FilesBesideTheMachineFileAreMacros) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / ("macro_files_" + std::to_string(::getpid()));
  fs::create_directories(folder / "macros");
  const auto write = [&](const fs::path& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  write("machine.toml", write_machine(default_m1()) + "[macro.park]\ngcode = \"G0 Z50\"\n");
  write("macros/wipe.g", "G1 X#<s>\n");
  write("macros/hole.ngc", "o<hole> sub\nG1 Z#1\no<hole> endsub\n");
  write("macros/notes.txt", "not G-code");
  const auto machine = load_machine(folder / "machine.toml");
  ASSERT_TRUE(machine) << to_string(machine.error());
  ASSERT_EQ(machine->macros.size(), 3u);
  EXPECT_EQ(machine->macros[1].name, "hole");
  EXPECT_EQ(machine->macros[2].gcode, "G1 X#<s>\n");

  write("macros/Park.g", "G28\n");
  write("macros/two words.g", "G28\n");
  write("macros/open.g", "G28\no1 if [1]\n");
  const auto wrong = load_machine(folder / "machine.toml");
  ASSERT_FALSE(wrong);
  ASSERT_EQ(wrong.error().size(), 3u);
  EXPECT_EQ(wrong.error()[0].expected, "another name than park: upper and lower case are the same");
  EXPECT_EQ(wrong.error()[1].line, 2u);
  EXPECT_EQ(wrong.error()[1].found, "o1 if has no end");
  EXPECT_EQ(wrong.error()[2].found, "two words");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace kinebus
