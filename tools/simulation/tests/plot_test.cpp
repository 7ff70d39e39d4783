#include <cmath>

#include "tools/simulation/plot.hpp"
#include "tools/simulation/ringing_plot.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

PlotData spiral(int points) {
  PlotData data;
  data.joint_count = 4;
  for (int i = 0; i < points; ++i) {
    const auto t = static_cast<float>(i) * 1e-3f;
    data.add({.time_s = t,
              .speed_mm_per_s = 100,
              .error_um = i == points / 2 ? 1.25f : 0.5f,
              .tool_mm = {30 * std::cos(t), 30 * std::sin(t), t / 50},
              .e_mm = t,
              .joints = {800 + t, 810, 820, 830}});
  }
  return data;
}

TEST(RingingPlot, ShowsTheCornerThatSwungMostAndSaysWhatIsMissing) {
  RingingTrace unshaped, shaped;
  for (int i = 0; i < 2000; ++i) {
    const auto x = static_cast<float>(0.02 * i), off = i > 900 && i < 950 ? 80.0f : 1.0f;
    const auto line = static_cast<std::uint32_t>(1 + i / 500);
    unshaped.points.push_back({x, 0, 5, off, 0, 0, line});
    shaped.points.push_back({x, 0, 5, 0.5f, 0, 0, line});
  }
  EXPECT_NE(draw_ringing(unshaped, shaped, "t").find("line 2 "), std::string::npos);
  EXPECT_EQ(draw_ringing(unshaped, shaped, "t").find("shapes nothing"), std::string::npos);
  EXPECT_NE(draw_ringing(unshaped, {}, "t").find("shapes nothing"), std::string::npos);
  EXPECT_NE(draw_ringing({}, {}, "t").find("nothing moved"), std::string::npos);
}

TEST(Plot, KeepsItsSizeWhateverTheJobsLength) {
  const PlotData data = spiral(1'000'000);
  EXPECT_LE(data.points().size(), PlotData::kCapacity);
  const std::string svg = draw_plot(data, default_m1(), "spiral", "");
  EXPECT_LT(svg.size(), 2'000'000u);
}

TEST(Plot, ThinningKeepsPeaks) {
  const PlotData data = spiral(1'000'000);
  float peak = 0;
  for (const auto& point : data.points()) peak = std::max(peak, point.error_um);
  EXPECT_EQ(peak, 1.25f);
}

TEST(Plot, CurvesStayRoundAndLinesStayShort) {
  const PlotData round = spiral(7000);
  float nearest = 30;
  for (const PlotData::Stretch& stretch : round.path())
    for (std::size_t i = 1; i < stretch.size(); ++i)
      nearest = std::min(nearest, std::hypot((stretch[i - 1].mm[0] + stretch[i].mm[0]) / 2,
                                             (stretch[i - 1].mm[1] + stretch[i].mm[1]) / 2));
  EXPECT_GT(nearest, 29.85f);
  PlotData straight;
  for (int i = 0; i < 1000; ++i) {
    const auto x = static_cast<float>(i) * 0.025f;
    straight.add({.speed_mm_per_s = 25, .tool_mm = {x, 0, 0}, .e_mm = x});
  }
  ASSERT_EQ(straight.path().size(), 1u);
  EXPECT_LE(straight.path().front().size(), 2u);
}

TEST(Plot, AWayThereAndBackIsDrawn) {
  PlotData tap;
  for (int i = 0; i <= 800; ++i) {
    const float z = 40 - static_cast<float>(i <= 400 ? i : 800 - i) * 0.05f;
    tap.add({.speed_mm_per_s = 10, .tool_mm = {10, 10, z}});
  }
  float deepest = 40;
  for (const PlotData::Stretch& stretch : tap.path())
    for (const auto& point : stretch) deepest = std::min(deepest, point.mm[2]);
  EXPECT_LT(deepest, 20.5f);  // what is drawn is 0.4 mm exact
}

TEST(Plot, ATravelIsNoLineThoughEWavers) {
  PlotData data;
  PlotData::Point point{.speed_mm_per_s = 30, .e_mm = 5000};
  const auto go = [&](std::size_t axis, int steps, double filament_mm) {
    for (int i = 0; i < steps; ++i) {
      point.tool_mm[axis] += 0.03f;
      point.e_mm += filament_mm + (i % 2 == 0 ? 5e-5 : -5e-5);  // parts of a count, forth and back
      data.add(point);
    }
  };
  data.add(point);
  go(0, 1000, 8e-4);
  go(2, 1000, 0);
  int lines = 0, travels = 0;
  for (const PlotData::Stretch& stretch : data.path())
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      if (stretch[i].mm == stretch[i - 1].mm) continue;
      EXPECT_EQ(stretch[i].prints, stretch[i].mm[2] == 0) << i;
      ++(stretch[i].prints ? lines : travels);
    }
  EXPECT_GT(lines, 0);
  EXPECT_GT(travels, 0);
}

TEST(Plot, WhatIsFullEndsAtAHundredPercent) {
  PlotData data;
  for (int i = 0; i < 100; ++i) {
    const auto t = static_cast<float>(i);
    PlotData::Point point{.time_s = t, .speed_mm_per_s = 1, .tool_mm = {t / 100, 0, 0}};
    point.heat.target_c[0] = 200;
    point.heat.power[0] = 1;
    data.add(point);
  }
  MachineDescription machine = default_m1();
  machine.heaters.push_back({.name = "hotend"});
  const std::string svg = draw_plot(data, machine, "x", "");
  const std::string full = svg.substr(svg.find("% of full"));
  EXPECT_NE(full.find(">100<"), std::string::npos);
  EXPECT_EQ(full.find(">150<"), std::string::npos);
}

TEST(Plot, NamesWhatItShowsAndEscapesTheTitle) {
  const std::string svg = draw_plot(spiral(5000), default_m1(), "a<b&c.gcode", "12 lines");
  for (const char* words : {"a&lt;b&amp;c.gcode", "12 lines", "X mm", "Y mm", "Z mm", "tower1", "tower4",
                            "Tool speed", "Tool error", "Bus load", "</svg>"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
}

TEST(Plot, WithoutMotionSaysSo) {
  EXPECT_NE(draw_plot({}, default_m1(), "x", "").find("No motion"), std::string::npos);
}

}  // namespace
}  // namespace kinebus
