#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "tools/calibrate/hidden.hpp"
#include "tools/calibrate/machine_edit.hpp"
#include "tools/calibrate/readings.hpp"
#include "tools/calibrate/rehearsal.hpp"

namespace kinebus {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Csv, UnitsOfTheHeaderAreTaken) {
  const auto csv = Csv::parse("# note\njoint,measured_um,a_deg,raw\ntower1, 1500 ,180,7\n");
  ASSERT_TRUE(csv);
  EXPECT_DOUBLE_EQ(*csv->quantity(0, "measured"), 1.5);
  EXPECT_DOUBLE_EQ(*csv->quantity(0, "a"), M_PI);
  EXPECT_EQ(csv->word(0, "joint"), "tower1");
  EXPECT_NE(csv->quantity(0, "raw").error().what.find("does not say its unit"), std::string::npos);
  EXPECT_NE(csv->quantity(0, "absent").error().what.find("no column absent_mm"), std::string::npos);
}

TEST(Csv, WhatIsWrongIsSaidWithItsLine) {
  EXPECT_EQ(to_string(Csv::parse("a_mm,b_mm\n1,2\n3\n").error(), "f.csv"),
            "f.csv:3: 1 values; the header has 2 columns");
  EXPECT_NE(Csv::parse("").error().what.find("no header"), std::string::npos);
  EXPECT_NE(Csv::parse("a_mm\n").error().what.find("no measurements"), std::string::npos);
  const auto csv = Csv::parse("a_mm\n1x\n");
  EXPECT_EQ(csv->quantity(0, "a").error().line, 2);
  const auto rails = rail_samples(*Csv::parse("joint,commanded_mm,measured_mm\nnone,1,1\n"), default_m1());
  EXPECT_NE(rails.error().what.find("none of the machine's"), std::string::npos);
  const auto points = geometry_readings(*Csv::parse("x_mm,y_mm,z_mm\n1,1,1\n"));
  EXPECT_NE(points.error().what.find("nothing measured"), std::string::npos);
}

/// The whole loop on files' texts: rails first, then the tool.
MachineDescription calibrate(const MachineDescription& nominal, const MachineDescription& truth, double pitch,
                             std::uint64_t seed) {
  const auto machine = calibrated(nominal, truth, {.pitch_mm = pitch, .seed = seed});
  EXPECT_TRUE(machine) << machine.error();
  return *machine;
}

TEST(CalibrationLoop, FromAMillimetreTo25Micrometres) {
  const MachineDescription nominal = default_m1();
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const MachineDescription truth = with_hidden_errors(nominal, {}, seed);
    const Accuracy before = accuracy(nominal, truth, 500, seed + 100);
    const MachineDescription machine = calibrate(nominal, truth, 0, seed);
    const Accuracy after = accuracy(machine, truth, 500, seed + 200);
    EXPECT_GT(before.rms_mm, 0.4) << "seed " << seed;
    EXPECT_LE(after.rms_mm, 0.025) << "seed " << seed;
  }
}

TEST(CalibrationLoop, AScrewsPeriodicErrorGoesToo) {
  const auto nominal = load_machine(machines_folder() / "m5.toml");
  ASSERT_TRUE(nominal) << to_string(nominal.error());
  HiddenErrors errors;
  errors.periodic_mm = 0.02;
  const MachineDescription truth = with_hidden_errors(*nominal, errors, 4);
  const MachineDescription machine = calibrate(*nominal, truth, 10, 4);
  EXPECT_LE(accuracy(machine, truth, 500, 5).rms_mm, 0.025);
}

TEST(CalibrationLoop, FindsAMachineWhosePlatformCarriesTheToolAndItsTwinThatCarriesTheTable) {
  auto mill = load_machine(machines_folder() / "m5.toml");
  ASSERT_TRUE(mill) << to_string(mill.error());
  ASSERT_EQ(std::get<M5Geometry>(mill->kinematics).tool, ToolPlacement::kPlatform);
  MachineDescription twin = *mill;
  auto& g = std::get<M5Geometry>(twin.kinematics);
  static_cast<M1Geometry&>(g) = M1Geometry{};
  for (std::size_t i = 0; i < 4; ++i) {
    twin.joints[i].homing->method = 22;
    twin.joints[i].homing->switch_position = 40;
  }
  for (const MachineDescription& nominal : {*mill, twin})
    for (const std::uint64_t seed : {21u, 22u}) {
      const MachineDescription truth = with_hidden_errors(nominal, {}, seed);
      EXPECT_GT(accuracy(nominal, truth, 500, seed + 100).rms_mm, 0.4) << "seed " << seed;
      const MachineDescription machine = calibrate(nominal, truth, 10, seed);
      EXPECT_LE(accuracy(machine, truth, 500, seed + 200).rms_mm, 0.025) << "seed " << seed;
    }
}

TEST(CalibrationLoop, ASecondRoundFindsNothingMore) {
  const MachineDescription nominal = default_m1();
  const MachineDescription truth = with_hidden_errors(nominal, {}, 7);
  const MachineDescription once = calibrate(nominal, truth, 0, 7), twice = calibrate(once, truth, 0, 8);
  EXPECT_LE(accuracy(twice, truth, 500, 9).rms_mm, 0.025);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(once.joints[i].calibration.scale, twice.joints[i].calibration.scale, 2e-5);
}

TEST(MachineEdit, TheFileKeepsItsWordsAndTakesTheCalibration) {
  const auto folder = std::filesystem::temp_directory_path() / "kinebus-machine-edit-test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  const auto file = folder / "m1.toml";
  std::filesystem::copy_file(machines_folder() / "m1.toml", file);
  MachineDescription machine = with_hidden_errors(*load_machine(file), {}, 5);
  machine.joints[1].calibration.table_step = 50;
  machine.joints[1].calibration.table = {0.01, -0.02, 0.03};
  // Numbers as a file can hold them.
  machine = *parse_machine(write_machine(machine), "rounded");
  for (int round = 0; round < 2; ++round) {
    const auto text = with_calibration(text_of(file), machine);
    ASSERT_TRUE(text) << text.error();
    const auto kept = replace_machine_file(file, *text);
    EXPECT_EQ(kept.filename().string(), "m1.toml.before-" + std::to_string(round + 1));
    const auto read = load_machine(file);
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_TRUE(*read == machine);
    EXPECT_NE(text->find("# the fixed nozzle in the machine frame"), std::string::npos);
    EXPECT_EQ(text->find("kinebus-calibrate"), text->rfind("kinebus-calibrate"));
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace kinebus
