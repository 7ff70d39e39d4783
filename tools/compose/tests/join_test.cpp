#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "gateway/description/machine_file.hpp"
#include "tools/compose/job_description.hpp"
#include "tools/compose/joiner.hpp"
#include "tools/compose/slicer.hpp"
#include "tools/compose/verify.hpp"

namespace kinebus::compose {
namespace {

/// A square of 8 mm in two layers, as slicers write: absolute E, retraction first and last.
const char* const kSliced =
    "M104 S210\nG28\nG21\nG90\nM82\nG92 E0\nM107\nG1 Z.2 F7800\nG1 E-.8 F2100\nG92 E0\nG1 X4 Y4 F7800\nG1 "
    "E.8 F2100\n"
    "G1 F1800\nG1 X12 Y4 E1.1\nG1 X12 Y12 E1.4\nG1 X4 Y12 E1.7\nG1 X4 Y4 E2.0\nG1 Z.4 F7800\nM106 S128\n"
    "G1 X12 Y4 E2.3 F1800\nG1 X12 Y12 E2.6\nG1 X4 Y12 E2.9\nG1 X4 Y4 E3.2\nG1 E2.4 F2100\nM84\n";

JoinPiece piece(const PieceFrame& frame) {
  JoinPiece out{"square", frame, read_sliced(kSliced, "square.gcode"), {}};
  const Vector low = frame.to_part({4, 4, 0}), high = frame.to_part({12, 12, 0.4});
  out.box = {low.cwiseMin(high), low.cwiseMax(high)};
  return out;
}

TEST(SlicedGcode, IsReadIntoMovesWithTheFilamentOfEach) {
  const SlicedGcode read = read_sliced(kSliced, "square.gcode");
  EXPECT_EQ(read.hotend_celsius, 210);
  EXPECT_EQ(read.layers, 2);
  EXPECT_NEAR(read.filament_mm, -0.8 + 0.8 + 2.4 - 0.8, 1e-9);
  EXPECT_EQ(read.left_out.at("G28"), 1);
  EXPECT_EQ(read.left_out.at("M84"), 1);
}

TEST(Slicer, SettingsHaveTheFilamentOfTheMachine) {
  const std::string folder = testing::TempDir();
  const Slicer slicer({.config = "", .filament_diameter_mm = 2.85}, folder);
  std::ifstream file(folder + "/settings.ini");
  const std::string settings{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(settings.find("filament_diameter = 2.85\n"), std::string::npos) << settings;
}

TEST(SlicedGcode, WhatCannotBeTiltedIsRefusedWithItsLine) {
  for (const char* bad :
       {"T1", "G43.4", "G68.2 J10", "G1 A5", "G1 X1 E1", "G2 X1 I1", "G1 X", "G1 Q4", "hello", "G1 X1..2"}) {
    try {
      read_sliced(std::string("M83\n") + bad + "\n", "piece.gcode");
      ADD_FAILURE() << bad << " was taken";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("piece.gcode:2: ", 0), 0u) << error.what();
    }
  }
}

TEST(SlicedGcode, WhateverTheDialectTheMovesAreTheSame) {
  const auto moves = [](const std::string& text) {
    std::vector<std::string> lines;
    for (const SlicedItem& item : read_sliced(text, "piece.gcode").items) {
      const auto& move = std::get<SlicedMove>(item);
      std::string line = "G" + std::to_string(move.code);
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (move.to_mm[axis]) line += " " + std::string(1, "XYZ"[axis]) + std::to_string(*move.to_mm[axis]);
      lines.push_back(line + " E" + std::to_string(move.e_mm) +
                      (move.feed_mm_per_min ? " F" + std::to_string(*move.feed_mm_per_min) : ""));
    }
    return lines;
  };
  const auto expected = moves("M83\nG1 X25.4 Y50.8 Z12.7 F2540\nG1 X50.8 Y50.8 E2.54\nG1 Z25.4\n");
  ASSERT_EQ(expected.size(), 3u);
  for (const char* text :
       {"G20\nM83\nG1 X1 Y2 Z.5 F100\nG1 X2 E.1\nG1 Z1\n", "G20 M82\nG1 X1 Y2 Z.5 F100\nG92 E5\nX2 E5.1\nZ1",
        "M83\nG1 X25.4 Y50.8 Z12.7 F2540\nG91\nG1 X25.4 E2.54\nG1 Z12.7\n",
        "M83\nG1 X25.4 Y50.8 Z12.7 F2540\nG92 X0 Y0 Z100\nG1 X25.4 E2.54\nG1 Z112.7\n",
        "M83\nG10 L2 P2 X5.4\nG55\nG1 X20 Y50.8 Z12.7 F2540\nG1 X[40 + 5.4] E[1.27 * 2]\n#1=25.4\nG1 Z#1\n"})
    EXPECT_EQ(moves(text), expected) << text;
}

TEST(SlicedGcode, ArcsComeBackInEveryPlane) {
  const char* const kArcs =
      "M83\nG1 X10 Y10 Z5 F1200\nG2 X20 Y10 I5 E1\nG3 X10 Y10 R5 E1\nG18 G2 X20 Z5 I5 E1\nG19 G3 Y20 Z6 J5 "
      "K.5 E1\n"
      "G17 G3 I3 P2 Z8 E1\n";
  const SlicedGcode read = read_sliced(kArcs, "piece.gcode");
  ASSERT_EQ(read.items.size(), 6u);
  EXPECT_EQ(std::get<SlicedMove>(read.items[3]).plane, 18);
  EXPECT_EQ(std::get<SlicedMove>(read.items[4]).plane, 19);
  JoinPiece piece{"arcs", frame_from_angles({0, 0, 0}, 0, 0, 0), read, {}};
  const JoinedJob job = join({piece}, JoinOptions{});
  // Read again, the piece within the job is what it was.
  const SlicedGcode again =
      read_sliced("M83\nG1 X10 Y10 Z5 F1200\n" +
                      job.text.substr(job.text.find("G2 "), job.text.find("G69") - job.text.find("G2 ")),
                  "again.gcode");
  ASSERT_GE(again.items.size(), 6u);
  for (std::size_t i = 1; i < 6; ++i) {
    const auto &was = std::get<SlicedMove>(read.items[i]), &is = std::get<SlicedMove>(again.items[i]);
    EXPECT_EQ(was.code, is.code) << i;
    EXPECT_EQ(was.plane, is.plane) << i;
    EXPECT_EQ(was.arc, is.arc) << i;
    EXPECT_NEAR(was.e_mm, is.e_mm, 1e-4) << i;
  }
}

TEST(Join, TheJobFeedsWhatThePiecesFeedAndPrintsSquareToTheirNormals) {
  const std::vector<JoinPiece> pieces{piece(frame_from_angles({0, 0, 0}, 0, 0, 0)),
                                      piece(frame_from_angles({-8, 10, 20}, 30, 40, -30))};
  const JoinedJob job = join(pieces, JoinOptions{});
  const Verification result = verify(job, pieces, {}, default_m1(), SweepOptions{});
  EXPECT_EQ(result.problems.errors(), 0u) << result.problems.all().front().words;
  EXPECT_LT(result.worst_layer_tilt_deg, 1e-3);
  EXPECT_LE(result.worst_overlap_mm, 0) << "line " << result.worst_overlap_line;
  double fed = 0;
  for (const SlicedItem& item : pieces[0].gcode.items)
    if (const auto* move = std::get_if<SlicedMove>(&item)) fed += move->to_mm[0] ? move->e_mm : 0;
  EXPECT_NEAR(fed, 2.4, 1e-9);
  EXPECT_NEAR(result.filament_mm, 2 * 2.4, 1e-4);
}

TEST(Join, ATableInTheWayIsFound) {
  // 45 degrees of tilt 1 mm over the table's middle: the table rises beside the nozzle.
  const std::vector<JoinPiece> pieces{piece(frame_from_angles({0, 0, 1}, 0, 45, 0))};
  const Verification result = verify(join(pieces, JoinOptions{}), pieces, {}, default_m1(), SweepOptions{});
  EXPECT_GT(result.worst_overlap_mm, 0);
}

TEST(JobDescription, TellsFileLineAndKey) {
  const std::string folder = testing::TempDir(), path = folder + "/compose-job.toml";
  std::ofstream(folder + "/a.gcode") << kSliced;
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    return read_job_description(path);
  };
  const auto good = read("[[piece]]\ngcode = \"a.gcode\"\norigin_mm = [1, 2, 3]\nnormal = [0, -1, 1]\n");
  ASSERT_EQ(good.size(), 1u);
  EXPECT_NEAR(good[0].frame.j_deg, 45, 1e-9);
  EXPECT_EQ(good[0].frame.origin, Vector(1, 2, 3));
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {"[[piece]]\ngcode = \"none.gcode\"\n", ":2: gcode: there is no file"},
           {"[[piece]]\ngcode = \"a.gcode\"\ntilt = 4\n", ":3: tilt: unknown key"},
           {"[[piece]]\ngcode = \"a.gcode\"\norigin_mm = [1, 2]\n", ":3: origin_mm: expected three numbers"},
           {"[[piece]]\norigin_mm = [1, 2, 3]\n", "gcode: missing"},
           {"piece = 4\n", "expected [[piece]]"},
           {"[[piece\n", ":1: "}}) {
    try {
      read(text);
      ADD_FAILURE() << text << " was taken";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  }
}

TEST(JobDescription, AMachineFileIsReadBesideIt) {
  const std::string path = testing::TempDir() + "/compose-machine.toml";
  std::ofstream(path) << write_machine(default_m1());
  EXPECT_TRUE(load_machine(path));
}

}  // namespace
}  // namespace kinebus::compose
