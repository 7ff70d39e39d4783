#include "gui/scene/path_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "gateway/gcode/words/rotation.hpp"
#include "gui/scene/path_colours.hpp"

namespace kinebus::gui {
namespace {

ToolPath scan(std::string_view text) {
  PathReader reader;
  reader.add(text);
  return reader.finish();
}

using Point = std::array<float, 3>;

TEST(PathReader, LinesBecomeVerticesWithTheirLineNumbers) {
  const ToolPath path = scan("G90\nG0 X10 Y5 Z0.2\nG1 X20 E1 F600\n; words\nG1 Y15 E2\n");
  ASSERT_EQ(path.size(), 4u);
  EXPECT_EQ(path.points_mm[0], (Point{0, 0, 20}));
  EXPECT_EQ(path.points_mm[3], (Point{20, 15, 0.2F}));
  EXPECT_EQ(path.lines[3], 5u);
  EXPECT_EQ(path.kinds[1], PathKind::kTravel);
  EXPECT_EQ(path.kinds[2], PathKind::kWork);
  EXPECT_EQ(path.feeds_mm_per_min[2], 600);
  EXPECT_EQ(path.line_count, 5u);
  EXPECT_DOUBLE_EQ(path.work_length_mm, 20);
}

TEST(PathReader, CommentsOfSlicersSayWhatLinesAreFor) {
  EXPECT_EQ(feature_named("External perimeter"), PathFeature::kOuterWall);
  EXPECT_EQ(feature_named("Perimeter"), PathFeature::kInnerWall);
  EXPECT_EQ(feature_named("WALL-OUTER"), PathFeature::kOuterWall);
  EXPECT_EQ(feature_named("WALL-INNER"), PathFeature::kInnerWall);
  EXPECT_EQ(feature_named("Internal infill"), PathFeature::kInfill);
  EXPECT_EQ(feature_named("FILL"), PathFeature::kInfill);
  EXPECT_EQ(feature_named("Solid infill"), PathFeature::kSolid);
  EXPECT_EQ(feature_named("Top solid infill"), PathFeature::kSolid);
  EXPECT_EQ(feature_named("SKIN"), PathFeature::kSolid);
  EXPECT_EQ(feature_named("Bridge infill"), PathFeature::kBridge);
  EXPECT_EQ(feature_named("Support material interface"), PathFeature::kSupport);
  EXPECT_EQ(feature_named("Skirt/Brim"), PathFeature::kSkirt);
  EXPECT_EQ(feature_named("Gap fill"), PathFeature::kGap);
  EXPECT_EQ(feature_named("Custom"), PathFeature::kOther);
  const std::string text =
      "G1 X1 E1\n;TYPE:External perimeter\nG1 X2 E2\n; FEATURE: Sparse infill\r\nG1 X3 E3\n"
      "; feature outer perimeter\nG1 X4 E4\n; words of TYPE:Perimeter\n;TYPE:";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    PathReader reader;
    reader.add(std::string_view(text).substr(0, cut));
    reader.add(std::string_view(text).substr(cut));
    const ToolPath path = reader.finish();
    ASSERT_EQ(path.features.size(), 4u) << cut;
    EXPECT_EQ(path.features[0].line, 2u);
    EXPECT_EQ(path.features[0].feature, PathFeature::kOuterWall);
    EXPECT_EQ(path.features[1].line, 4u);
    EXPECT_EQ(path.features[1].feature, PathFeature::kInfill);
    EXPECT_EQ(path.features[2].feature, PathFeature::kOuterWall);
    EXPECT_EQ(path.features[3].feature, PathFeature::kOther);
    // The first vertex is where the tool starts.
    const PathShades shades = shade_path(path, std::nullopt);
    EXPECT_EQ(shades.vertices[2].shade[3], std::lround(255.0 / (kPathFeatures - 1)));
    EXPECT_EQ(shades.vertices[3].shade[3], std::lround(3 * 255.0 / (kPathFeatures - 1)));
  }
}

TEST(PathReader, TextCutAnywhereReadsTheSame) {
  const std::string text = "G1 X1 Y2 Z3 E1 F1200\nG91\nG1 X1 E1\nG90 (back) G1 X0Y0 E5\n";
  const ToolPath whole = scan(text);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    PathReader reader;
    reader.add(std::string_view(text).substr(0, cut));
    reader.add(std::string_view(text).substr(cut));
    const ToolPath parts = reader.finish();
    EXPECT_EQ(parts.points_mm, whole.points_mm) << "cut at " << cut;
    EXPECT_EQ(parts.lines, whole.lines) << "cut at " << cut;
  }
}

TEST(PathReader, RelativeInchAndSetPositionAreUnderstood) {
  const ToolPath path = scan("G20 G91\nG1 X1\nG21 G90\nG92 X0\nG1 X10\n");
  ASSERT_EQ(path.size(), 3u);
  EXPECT_FLOAT_EQ(path.points_mm[1][0], 25.4F);
  EXPECT_FLOAT_EQ(path.points_mm[2][0], 35.4F);
}

TEST(PathReader, ArcsKeepToTheirCircleInBothNotations) {
  for (const char* text : {"G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0\n", "G0 X10 Y0 Z0\nG3 X0 Y10 R10\n"}) {
    const ToolPath path = scan(text);
    ASSERT_GT(path.size(), 10u) << text;
    for (std::size_t i = 2; i < path.size(); ++i)
      EXPECT_NEAR(std::hypot(path.points_mm[i][0], path.points_mm[i][1]), 10, 1e-4) << text;
    EXPECT_FLOAT_EQ(path.points_mm.back()[1], 10);
  }
}

TEST(PathReader, ArcWithoutEndPointIsAWholeTurn) {
  const ToolPath path = scan("G0 X10 Y0 Z0\nG2 I-10\n");
  float least = 1e9F;
  for (const Point& point : path.points_mm) least = std::min(least, point[0]);
  EXPECT_NEAR(least, -10, 0.05);
}

TEST(PathReader, LayersBeginWhereWorkRises) {
  const ToolPath path =
      scan("G0 X0 Y0 Z0.2\nG1 X10 E1\nG0 Z5\nG0 X0 Y5\nG0 Z0.4\nG1 X10 E2\nG1 X20 E3\nG0 Z0.6\nG1 X0 E4\n");
  ASSERT_EQ(path.layers.size(), 3u);
  EXPECT_FLOAT_EQ(path.layers[1].z_mm, 0.4F);
  EXPECT_EQ(path.layers[0].first, 0u);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_EQ(path.layers[i].first, path.layers[i - 1].last);
  EXPECT_EQ(path.layers.back().last, path.size());
  EXPECT_EQ(path.layer_at_vertex(path.size() - 1), 2u);
}

TEST(PathReader, JobWithoutExtrusionIsACut) {
  const ToolPath path = scan("G0 X10 Y0 Z5\nG1 Z-1 F300\nG1 X40\n");
  EXPECT_EQ(path.kinds[1], PathKind::kTravel);
  EXPECT_EQ(path.kinds[3], PathKind::kWork);
}

TEST(PathReader, TiltsAreKeptOnlyForJobsThatTurn) {
  EXPECT_TRUE(scan("G1 X1 E1\n").tilts_rad.empty());
  const ToolPath path = scan("G1 X1 E1\nG1 X2 A30 C90 E2\n");
  ASSERT_EQ(path.tilts_rad.size(), path.size());
  EXPECT_NEAR(path.tilts_rad.back()[0], std::numbers::pi / 6, 1e-6);
}

TEST(PathReader, RefusedLinesAreCountedAndThePathGoesOnBehindThem) {
  const ToolPath path = scan("G1 X1 E1\nG41 X9 Y9 Z9\nM1234\nG1 X Y3\nO1 go\nM1234\nG1 X5 E2\nG1 X[");
  EXPECT_EQ(path.refused_lines, 6u);
  EXPECT_EQ(path.line_count, 8u);
  ASSERT_EQ(path.size(), 3u);
  EXPECT_EQ(path.points_mm[2], (Point{5, 0, 20}));
  EXPECT_EQ(path.lines[2], 7u);
}

TEST(PathReader, LayersOfATiltedPieceLieInItsPlane) {
  std::string text = "M83\nG43.4\nG1 X-10 Y0 Z0.2 F600\nG1 X10 E1\n";
  text += "G69\nG68.2 X0 Y0 Z5 I0 J40 K0\nG53.1 P1\n";
  for (const char* z : {".2", ".4", ".6"})
    text += std::string("G1 Z") + z + "\nG1 X-5 Y-5\nG1 X5 E1\nG1 Y5 E1\nG1 X-5 E1\nG1 Y-5 E1\n";
  const ToolPath path = scan(text + "G69\n");
  EXPECT_EQ(path.refused_lines, 0u);
  ASSERT_EQ(path.layers.size(), 4u);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(path.layers[i].z_mm, 0.2 * static_cast<double>(i), 1e-5);
  EXPECT_EQ(path.layers.back().last, path.size());
}

TEST(PathReader, HomingAndWorkOffsetsOfTheMachineAreThoseOfTheJob) {
  PathReader::Options options;
  options.machine.home = {0, 0, 150, 0, 0, 0};
  options.machine.work_offsets[0] = {1, 2, 3, 0, 0, 0};
  PathReader reader(options);
  reader.add("G28\nG0 X10\nG1 Y5 E1\nG53 G0 Z40\nG28 Z\n");
  const ToolPath path = reader.finish();
  ASSERT_EQ(path.size(), 5u);
  EXPECT_EQ(path.points_mm[0], (Point{0, 0, 150}));
  EXPECT_EQ(path.points_mm[2], (Point{11, 7, 150}));
  EXPECT_EQ(path.points_mm[3], (Point{11, 7, 40}));
  EXPECT_EQ(path.points_mm[4], (Point{11, 7, 150}));
}

// ---- What is drawn is what will move ----

struct Job {
  const char* text;
  std::array<double, 3> end_mm;  ///< of the tool on the part, worked out by hand
};

const std::vector<Job> kJobs = {
    {"G10 L2 P1 X5 Y-2 Z1\nG0 X10\nG1 Y10 Z2 F600", {15, 8, 3}},
    {"G10 L2 P1 X5\nG0 X10\nG10 L20 P1 X0\nG0 X0", {15, 0, 20}},
    {"G10 L2 P2 Y7\nG0 X1 Y1\nG55\nG0 Y1", {1, 8, 20}},
    {"G0 X10\nG92 X0 Y3\nG1 X5 Y4 F600\nG92.1\nG1 Z0", {15, 1, 0}},
    {"G92 X5\nG0 X6\nG92.2\nG0 Y1\nG92.3\nG0 X7", {2, 1, 20}},
    {"G0 X0 Y0 Z0\nG2 X10 Y0 I5 F600", {10, 0, 0}},
    {"G0 X0 Y0 Z0\nG3 X10 Y10 R10 F600", {10, 10, 0}},
    {"G0 X0 Y0 Z0\nG3 X10 Y10 R-10 Z4 F600", {10, 10, 4}},
    {"G0 X10 Y0 Z0\nG2 I-10 P3 Z6 F600", {10, 0, 6}},
    {"G0 X0 Y0 Z0\nG18 G2 X10 Z0 I5 F600", {10, 0, 0}},
    {"G0 X0 Y0 Z0\nG19 G3 Y10 Z10 J10 X1 F600", {1, 10, 10}},
    {"G0 X1 Y1 Z0\nG90.1 G3 X3 Y1 I2 J1 F600", {3, 1, 0}},
    {"G0 X0 Y0 Z0\nG3 X10.004 Y0 I5 F600\nG1 Y1", {10.004, 1, 0}},
    {"G0 X0 Y0 Z0\nG68.2 X10 Y0 Z0 I0 J90 K0\nG1 X1 Y2 Z3 F600", {11, -3, 2}},
    {"G0 X0 Y0 Z0\nG43.4\nG68.2 Z5 J30\nG53.1 P1\nG1 X4 F600\nG69", {4, 0, 0}},
    {"G0 X0 Y0 Z0\nG68.2 J90\nG3 X10 Y0 I5 F600", {10, 0, 0}},
    {"G0 X10 Y0 Z0\nG1 C90 F600", {0, -10, 0}},
    {"G43.4\nG0 X10 Y0 Z0\nG1 A20 C90 F600\nG1 X12", {12, 0, 0}},
    {"G0 X0 Y0 Z10\nG1 A90 F600\nG1 Z11", {0, 11, 0}},
    {"#1=3\n#<up>=[#1*2]\nG0 X[#1 + 1] Y-#<up> Z[10 MOD 4]", {4, -6, 2}},
    {"#5221=12\nG0 X0 Y[ATAN[1]/[1]]", {12, 45, 20}},
    {"G20\nG0 X1 Y.5 Z0\nG91 G1 X1 F10\nG21 X1", {51.8, 12.7, 0}},
    {"G20\nG0 X1 Y0 Z0\nG0 X[#5420 + 1]", {50.8, 0, 0}},
    {"G91\nG0 X1 Y1 Z-20\nX1\nX1 Y2\nG90 X10", {10, 3, 0}},
    {"G10 L2 P1 X5\nG0 X1 Y1 Z1\nG53 G0 X1 Z9", {1, 1, 9}},
    {"G53 G1 X3 F600\nG10 L2 P0 X1\nX3", {4, 0, 20}},
    {"M207 S1 Z2\nG1 X1 Z1 E1 F600\nG10\nG0 X5\nG11\nG1 X6 E1", {6, 0, 1}},
    {"G93\nG1 X10 F2\nG94\nG1 Y1 F600", {10, 1, 20}},
    {"G0 X9\nG28\nG91 G0 X1", {1, 0, 20}},
    {"G0 X1\nG0 X2 Q5\nM1234\nG91 G0 X3", {4, 0, 20}},
    {"G0 X1\nM2\nG0 X50", {1, 0, 20}},
};

/// Where the tool is on the part after each line that moves, by the canonical commands alone.
std::map<std::uint32_t, Pose> canonical_ends(const std::string& text) {
  gcode::Interpreter interpreter(PathReader::any_machine());
  std::map<std::uint32_t, Pose> ends;
  gcode::CommandBuffer out;
  std::uint32_t number = 0;
  for (std::size_t at = 0; at < text.size() && !interpreter.ended();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    static_cast<void>(interpreter.execute(std::string_view(text).substr(at, end - at), ++number, out));
    at = end + 1;
  }
  for (const canonical::Line& line : out) {
    const auto put = [&](const Pose& pose, Frame frame) {
      ends[line.line] = gcode::in_frame(pose, frame, Frame::kPart);
    };
    if (const auto* traverse = std::get_if<canonical::Traverse>(&line.command))
      put(traverse->target, traverse->frame);
    if (const auto* feed = std::get_if<canonical::Feed>(&line.command)) put(feed->target, feed->frame);
    if (const auto* arc = std::get_if<canonical::Arc>(&line.command)) put(arc->target, arc->frame);
    if (const auto* home = std::get_if<canonical::Home>(&line.command)) put(home->afterwards, home->frame);
  }
  return ends;
}

TEST(PathReader, WhatIsDrawnEndsWhereTheMachineWill) {
  for (const Job& job : kJobs) {
    const ToolPath path = scan(job.text);
    const auto ends = canonical_ends(job.text);
    ASSERT_FALSE(ends.empty()) << job.text;
    ASSERT_GT(path.size(), 1u) << job.text;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(path.points_mm.back()[axis], job.end_mm[axis], 1e-4) << job.text << " axis " << axis;
    // The last vertex of every line that moved.
    for (const auto& [line, pose] : ends) {
      const std::size_t after = path.vertex_at_line(line + 1);
      ASSERT_GT(after, 0u);
      if (path.lines[after - 1] != line) continue;  // a retraction alone
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(path.points_mm[after - 1][axis], pose[axis], 1e-4) << job.text << " line " << line;
      const auto tilt = path.tilts_rad.empty() ? std::array<float, 2>{} : path.tilts_rad[after - 1];
      EXPECT_NEAR(tilt[0], pose[3], 1e-6) << job.text;
      EXPECT_NEAR(tilt[1], pose[4], 1e-6) << job.text;
    }
    EXPECT_TRUE(std::is_sorted(path.lines.begin(), path.lines.end())) << job.text;
  }
}

TEST(PathReader, ArcsTurnTheWayTheMachineDoes) {
  // The highest or farthest point tells which half of the circle was drawn.
  const auto has = [](const char* text, const Point& wanted) {
    const ToolPath path = scan(text);
    return std::any_of(path.points_mm.begin(), path.points_mm.end(), [&](const Point& p) {
      return std::hypot(p[0] - wanted[0], p[1] - wanted[1], p[2] - wanted[2]) < 0.5F;
    });
  };
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG2 X10 Y0 I5 F600", {5, 5, 0}));
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG3 X10 Y0 I5 F600", {5, -5, 0}));
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG18 G2 X10 Z0 I5 F600", {5, 0, -5}));
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG18 G3 X10 Z0 I5 F600", {5, 0, 5}));
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG19 G2 Y10 Z0 J5 F600", {0, 5, 5}));
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG19 G3 Y10 Z0 J5 F600", {0, 5, -5}));
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG68.2 J90\nG2 X10 Y0 I5 F600", {5, 0, 5}));
  EXPECT_TRUE(has("G0 X0 Y0 Z0\nG3 X10 Y10 R-10 F600", {10 + 7.07F, -7.07F, 0}));
  // The table turns under a standing tool: on the part a circle.
  EXPECT_TRUE(has("G0 X10 Y0 Z0\nG1 C90 F600", {7.07F, -7.07F, 0}));
}

}  // namespace
}  // namespace kinebus::gui
