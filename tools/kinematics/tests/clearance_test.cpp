// How near bodies come, against distances that can be told by hand.

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>

#include "tools/kinematics/tests/tool_call.hpp"

namespace kinebus::kinematics_tool {
namespace {

/// A shipped machine with what `[bodies]` is to say, as a file.
class MachineWithBodies {
 public:
  MachineWithBodies(std::string_view name, const std::string& bodies)
      : path_(::testing::TempDir() + "kinematics_tool_" + std::string(name) + "_bodies.toml") {
    std::string text;
    for (const ShippedMachine& shipped : shipped_machines())
      if (shipped.name == name) text = shipped.text;
    // Tables [bodies...] of its own go: each ends where the next table begins.
    for (std::size_t at = 0; (at = text.find("\n[bodies", at)) != std::string::npos;)
      text.erase(at, text.find("\n[", at + 1) - at);
    std::ofstream(path_) << text << "\n[bodies]\n" << bodies;
  }
  ~MachineWithBodies() { std::remove(path_.c_str()); }
  MachineWithBodies(const MachineWithBodies&) = delete;
  MachineWithBodies& operator=(const MachineWithBodies&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A post beside the tool of a machine whose tool moves along X, Y, Z.
constexpr const char* kPost =
    "clearance_mm = 3\nholder_radius_mm = 20\nholder_length_mm = 50\ntool_length_mm = 30\n"
    "tool_radius_mm = 4\n"
    "[bodies.fixed.post]\nfrom_mm = [60, -10, 0]\nto_mm = [80, 10, 150]\n";

/// Distances of curved bodies are found to this, on the safe side.
constexpr double kBelow_mm = 2e-3;
void expect_distance(double found_mm, double true_mm) {
  EXPECT_LE(found_mm, true_mm + 1e-6);
  EXPECT_GE(found_mm, true_mm - kBelow_mm);
}

TEST(Clearance, IsTheDistanceOfTheHolderFromAPostAndNamesBoth) {
  const MachineWithBodies machine("corexy", kPost);
  const Said said = call({"clearance", "--machine", machine.path()}, "0 0 50\n25 0 50\n25 40 50\n39 0 50\n");
  ASSERT_EQ(said.code, 0) << said.err;
  const Lines lines = lines_of(said.out);
  ASSERT_EQ(lines.numbers.size(), 4u) << said.out;
  const double expected[] = {60 - 20, 60 - 25 - 20, std::hypot(60 - 25, 40 - 10) - 20, 60 - 39 - 20};
  for (std::size_t k = 0; k < 4; ++k) {
    ASSERT_EQ(lines.numbers[k].size(), 4u) << said.out;
    expect_distance(lines.numbers[k].back(), expected[k]);
    const std::string& remark = lines.remarks[k];
    EXPECT_NE(remark.find("nozzle holder"), std::string::npos) << remark;
    EXPECT_NE(remark.find("post"), std::string::npos) << remark;
    // 1 mm is less than the file's 3 mm.
    EXPECT_EQ(remark.find("keep 3 mm") != std::string::npos, k == 3) << remark;
  }
}

TEST(Clearance, AsJsonItSaysWhetherThePoseIsAllowed) {
  const MachineWithBodies machine("corexy", kPost);
  const auto row = [&](const char* x) {
    return call({"clearance", "--json", "--machine", machine.path(), x, "0", "50"}).json()["rows"][0];
  };
  const Json far = row("0"), near = row("39"), touching = row("45");
  expect_distance(far["clearance_mm"].get<double>(), 40);
  EXPECT_EQ(far["kept_mm"], 3);
  EXPECT_EQ(far["allowed"], true);
  EXPECT_EQ(far["pose"]["x_mm"], 0);
  EXPECT_EQ(near["allowed"], false);
  const auto between = near["between"].get<std::vector<std::string>>();
  EXPECT_EQ(std::set<std::string>(between.begin(), between.end()),
            (std::set<std::string>{"nozzle holder", "post"}));
  EXPECT_EQ(touching["allowed"], false);
  EXPECT_LE(touching["clearance_mm"].get<double>(), 0);
  EXPECT_NE(touching["breaks"].get<std::string>().find("would touch"), std::string::npos);
}

TEST(Clearance, MachinesOfEveryKindAnswerATable) {
  for (const char* name : {"m4", "delta", "cartesian", "corexy"}) {
    const MachineWithBodies machine(name, "");
    const Subject s = subject(machine.path());
    const auto poses = allowed_poses(s, 10, 7);
    const Said said = call({"clearance", "--machine", machine.path()}, table_of(poses));
    ASSERT_EQ(said.code, 0) << name << said.err;
    const Lines lines = lines_of(said.out);
    ASSERT_EQ(lines.numbers.size(), poses.size()) << said.out;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      ASSERT_EQ(lines.numbers[k].size(), poses[k].size() + 1);
      for (std::size_t i = 0; i < poses[k].size(); ++i) EXPECT_NEAR(lines.numbers[k][i], poses[k][i], 1e-5);
      EXPECT_NE(lines.remarks[k].find(" and "), std::string::npos);
    }
  }
}

TEST(Clearance, AFileWithoutBodiesIsToldWhatToAdd) {
  const std::string path = ::testing::TempDir() + "kinematics_tool_no_bodies.toml";
  {
    const MachineWithBodies machine("cartesian", "");
    std::ifstream in(machine.path());
    std::string text((std::istreambuf_iterator<char>(in)), {});
    std::ofstream(path) << text.substr(0, text.find("\n[bodies]"));
  }
  const Said said = call({"clearance", "--machine", path, "0", "0", "50"});
  EXPECT_EQ(said.code, 1);
  EXPECT_TRUE(said.out.empty()) << said.out;
  EXPECT_NE(said.err.find("expected a table [bodies] in the machine file"), std::string::npos) << said.err;
  std::remove(path.c_str());
}

TEST(Clearance, APoseOutOfReachHasNone) {
  const MachineWithBodies machine("m4", "");
  const Said said = call({"clearance", "--json", "--machine", machine.path()}, "0 0 50 0 0\n0 5000 50 0 0\n");
  EXPECT_EQ(said.code, 1);
  const Json rows = said.json()["rows"];
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_TRUE(rows[0].contains("clearance_mm"));
  EXPECT_EQ(rows[1]["error"]["kind"], "out_of_reach");
  EXPECT_FALSE(rows[1].contains("clearance_mm"));
}

}  // namespace
}  // namespace kinebus::kinematics_tool
