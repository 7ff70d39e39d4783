// Tables, machine files, and input that is wrong.

#include <cstdio>
#include <fstream>

#include "tools/kinematics/tests/tool_call.hpp"

namespace kinebus::kinematics_tool {
namespace {

TEST(KinematicsTool, ATableAnswersEveryRowAndNamesTheFirstThatItCannot) {
  const std::string table = "# poses\nz_mm y_mm x_mm\n50 0 0\n\n50 5000 0  # beyond the rods\n60 10 0\n";
  const Said said = call({"inverse", "--machine", "m4", "--json"}, table);
  EXPECT_EQ(said.code, 1);
  const Json rows = said.json()["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["line"], 3);
  EXPECT_EQ(rows[0]["allowed"], true);
  EXPECT_EQ(rows[1]["line"], 5);
  EXPECT_EQ(rows[1]["error"]["kind"], "out_of_reach");
  EXPECT_EQ(rows[1]["error"]["joint"].get<std::string>().substr(0, 4), "rail");
  EXPECT_GT(rows[1]["error"]["short_by_mm"].get<double>(), 3000);
  EXPECT_EQ(rows[2]["pose"]["y_mm"], 10);
  EXPECT_NE(said.err.find("line 5: rail"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("out of reach"), std::string::npos);
  EXPECT_NE(said.err.find("1 of 3"), std::string::npos);
  // As text the row is a remark, and the others can still be read.
  const Said text = call({"inverse", "--machine", "m4"}, table);
  EXPECT_NE(text.out.find("# line 5: rail"), std::string::npos) << text.out;
}

TEST(KinematicsTool, BadInputIsNamedWithItsPlaceAndWhatIsExpected) {
  struct Case {
    std::vector<std::string> arguments;
    std::string input;
    const char* words;
  };
  const Case cases[] = {
      {{"inverse", "--machine", "m9"}, "", "unknown machine \"m9\"; expected a machine file, or one of"},
      {{"inverse", "--machine", "/nowhere/m1.toml"}, "", "unknown machine"},
      {{"inverse", "--machine", "m4", "1", "2"},
       "",
       "2 values; expected 3 to 5: x_mm y_mm z_mm [a_deg] [c_deg]"},
      {{"inverse", "--machine", "m5", "1", "2", "3", "4", "5"}, "", "5 values; expected 3 to 4"},
      {{"inverse", "1", "two", "3"}, "", "value 2 (y_mm): found \"two\"; expected a number"},
      {{"inverse", "1", "nan", "3"}, "", "found \"nan\"; expected a number"},
      {{"inverse", "1", "1e9", "3"}, "", "expected a number in -1e7 .. 1e7"},
      {{"forward", "--machine", "m4", "932.6"}, "", "1 value; expected 3 to 5: rail1_mm rail2_mm rail3_mm"},
      {{"forward", "--machine", "m4", "5000", "0", "0"}, "", "closes in no pose"},
      {{"forward", "--machine", "m1", "--mirrored", "1", "2", "3", "4"},
       "",
       "no part that could be mounted mirrored"},
      {{"inverse", "--machine", "m4"}, "", "standard input: no values"},
      {{"inverse", "--machine", "m4"}, "1 2 3\n1 2\n", "standard input:2: 2 values; expected 3 to 5"},
      {{"inverse", "--machine", "m4"}, "1 2 3\n1 x 3\n", "standard input:2: value 2 (y_mm): found \"x\""},
      {{"inverse", "--machine", "m4"}, "x_mm y_mm a_deg\n1 2 3\n", "standard input:1: no column z_mm"},
      {{"inverse", "--machine", "m4"},
       "x_mm y_mm z_mm q_mm\n",
       "standard input:1: a column that is not known"},
      {{"inverse", "--machine", "m4"}, "x_mm y_mm z_mm y_mm\n", "standard input:1: column y_mm stands twice"},
      {{"inverse", "--in", "/nowhere/table"}, "", "/nowhere/table: cannot be read"},
      {{"inverse", "1", "2", "3", "--in", "-"}, "", "expected one of them"},
  };
  for (const Case& bad : cases) {
    const Said said = call(bad.arguments, bad.input);
    EXPECT_EQ(said.code, 1) << bad.words;
    EXPECT_TRUE(said.out.empty() || said.out.find('\n') != std::string::npos);
    EXPECT_NE(said.err.find(bad.words), std::string::npos)
        << "expected: " << bad.words << "\nsaid: " << said.err;
  }
  EXPECT_NE(call({"clearence"}).code, 0);
  EXPECT_NE(call({}).code, 0);
  // Negative numbers are values, however they are written.
  EXPECT_EQ(call({"inverse", "--machine", "m4", "-1", "-.5", "50"}).code, 0);
}

TEST(KinematicsTool, AMachineFileIsReadAndAWrongOneRefusedWithItsPlace) {
  const std::string path = ::testing::TempDir() + "kinematics_tool_machine.toml";
  const auto write = [&](const std::string& text) { std::ofstream(path) << text; };
  std::string text;
  for (const ShippedMachine& shipped : shipped_machines())
    if (shipped.name == "m4") text = shipped.text;
  write(text);
  EXPECT_EQ(call({"inverse", "--machine", path, "0", "0", "50"}).out,
            call({"inverse", "--machine", "M4", "0", "0", "50"}).out);
  text.replace(text.find("rod_mm = 890"), 12, "rod_mm = -890");
  write(text);
  const Said said = call({"inverse", "--machine", path, "0", "0", "50"});
  EXPECT_EQ(said.code, 1);
  EXPECT_NE(said.err.find("kinematics.rod_mm"), std::string::npos) << said.err;
  std::remove(path.c_str());
}

}  // namespace
}  // namespace kinebus::kinematics_tool
