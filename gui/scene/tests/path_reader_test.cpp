#include "gui/scene/gcode_scanner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinebus::gui {
namespace {

ToolPath scan(std::string_view text) {
  GcodeScanner scanner;
  scanner.add(text);
  return scanner.finish();
}

using Point = std::array<float, 3>;

TEST(GcodeScanner, LinesBecomeVerticesWithTheirLineNumbers) {
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

TEST(GcodeScanner, TextCutAnywhereReadsTheSame) {
  const std::string text = "G1 X1 Y2 Z3 E1 F1200\nG91\nG1 X1 E1\nG90 (back) G1 X0Y0 E5\n";
  const ToolPath whole = scan(text);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    GcodeScanner scanner;
    scanner.add(std::string_view(text).substr(0, cut));
    scanner.add(std::string_view(text).substr(cut));
    const ToolPath parts = scanner.finish();
    EXPECT_EQ(parts.points_mm, whole.points_mm) << "cut at " << cut;
    EXPECT_EQ(parts.lines, whole.lines) << "cut at " << cut;
  }
}

TEST(GcodeScanner, RelativeInchAndSetPositionAreUnderstood) {
  const ToolPath path = scan("G20 G91\nG1 X1\nG21 G90\nG92 X0\nG1 X10\n");
  ASSERT_EQ(path.size(), 3u);
  EXPECT_FLOAT_EQ(path.points_mm[1][0], 25.4F);
  EXPECT_FLOAT_EQ(path.points_mm[2][0], 35.4F);
}

TEST(GcodeScanner, ArcsKeepToTheirCircleInBothNotations) {
  for (const char* text : {"G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0\n", "G0 X10 Y0 Z0\nG3 X0 Y10 R10\n"}) {
    const ToolPath path = scan(text);
    ASSERT_GT(path.size(), 10u) << text;
    for (std::size_t i = 2; i < path.size(); ++i)
      EXPECT_NEAR(std::hypot(path.points_mm[i][0], path.points_mm[i][1]), 10, 1e-4) << text;
    EXPECT_FLOAT_EQ(path.points_mm.back()[1], 10);
  }
}

TEST(GcodeScanner, ArcWithoutEndPointIsAWholeTurn) {
  const ToolPath path = scan("G0 X10 Y0 Z0\nG2 I-10\n");
  float least = 1e9F;
  for (const Point& point : path.points_mm) least = std::min(least, point[0]);
  EXPECT_NEAR(least, -10, 0.05);
}

TEST(GcodeScanner, LayersBeginWhereWorkRises) {
  const ToolPath path =
      scan("G0 X0 Y0 Z0.2\nG1 X10 E1\nG0 Z5\nG0 X0 Y5\nG0 Z0.4\nG1 X10 E2\nG1 X20 E3\nG0 Z0.6\nG1 X0 E4\n");
  ASSERT_EQ(path.layers.size(), 3u);
  EXPECT_FLOAT_EQ(path.layers[1].z_mm, 0.4F);
  EXPECT_EQ(path.layers[0].first, 0u);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_EQ(path.layers[i].first, path.layers[i - 1].last);
  EXPECT_EQ(path.layers.back().last, path.size());
  EXPECT_EQ(path.layer_at_vertex(path.size() - 1), 2u);
}

TEST(GcodeScanner, JobWithoutExtrusionIsACut) {
  const ToolPath path = scan("G0 X10 Y0 Z5\nG1 Z-1 F300\nG1 X40\n");
  EXPECT_EQ(path.kinds[1], PathKind::kTravel);
  EXPECT_EQ(path.kinds[3], PathKind::kWork);
}

TEST(GcodeScanner, TiltsAreKeptOnlyForJobsThatTurn) {
  EXPECT_TRUE(scan("G1 X1 E1\n").tilts_rad.empty());
  const ToolPath path = scan("G1 X1 E1\nG1 X2 A30 C90 E2\n");
  ASSERT_EQ(path.tilts_rad.size(), path.size());
  EXPECT_NEAR(path.tilts_rad.back()[0], std::numbers::pi / 6, 1e-6);
}

TEST(GcodeScanner, ExpressionsAreCountedNotGuessed) {
  const ToolPath path = scan("#1 = 5\nG1 X[#1 + 2] Y3\nG1 X5\n");
  EXPECT_EQ(path.unread_lines, 2u);
  EXPECT_FLOAT_EQ(path.points_mm[1][0], 0);
  EXPECT_FLOAT_EQ(path.points_mm[1][1], 3);
}

}  // namespace
}  // namespace kinebus::gui
