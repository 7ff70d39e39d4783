#include <gtest/gtest.h>

#include <fstream>

#include "tools/compose/job_description.hpp"
#include "tools/compose/joiner.hpp"
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

TEST(SlicedGcode, WhatCannotBeTiltedIsRefusedWithItsLine) {
  for (const char* bad : {"G20", "G91", "T1", "G54", "G92 X0", "G1 X", "G1 Q4", "hello", "G1 X1..2"}) {
    try {
      read_sliced(std::string("G90\n") + bad + "\n", "piece.gcode");
      ADD_FAILURE() << bad << " was taken";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("piece.gcode:2: ", 0), 0u) << error.what();
    }
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

}  // namespace
}  // namespace kinebus::compose
