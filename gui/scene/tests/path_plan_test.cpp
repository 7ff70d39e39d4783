#include "gui/scene/path_plan.hpp"

#include <QSize>

#include <gtest/gtest.h>

#include <string>

#include "gui/scene/camera.hpp"
#include "gui/scene/path_reader.hpp"

namespace kinebus::gui {
namespace {

constexpr int kLayers = 200;
constexpr float kLayer_mm = 0.2F;

PathLevels tower() {
  PathReader reader;
  double e = 0;
  for (int layer = 0; layer < kLayers; ++layer) {
    std::string text = "G0 X40 Y0 Z" + std::to_string(kLayer_mm * static_cast<float>(layer + 1)) + "\n";
    for (int i = 1; i <= 500; ++i) {
      const double angle = 6.283185307 * i / 500;
      text += "G1 X" + std::to_string(40 * std::cos(angle)) + " Y" + std::to_string(40 * std::sin(angle)) +
              " E" + std::to_string(e += 0.01) + "\n";
    }
    reader.add(text);
  }
  return make_path_levels(reader.finish());
}

PathView view_from(float distance_mm) {
  const QSize pixels(900, 560);
  Camera camera;
  camera.target_mm = {0, 0, 20};
  camera.distance_mm = distance_mm;
  PathView view;
  view.clip = camera.projection(pixels) * camera.view();
  view.eye_mm = camera.eye_mm();
  view.mm_per_pixel_at_1mm = camera.mm_per_pixel(pixels) / camera.distance_mm;
  return view;
}

TEST(PathPlan, LayersRiseByTheirMeanHeight) {
  EXPECT_NEAR(tower().layer_mm, kLayer_mm, 1e-4);
}

TEST(PathPlan, WhatIsAllowedIsKeptAndStacksReachFromLayerToLayer) {
  const PathLevels levels = tower();
  PathView view = view_from(250);
  const std::size_t all = plan_drawing(levels, view).lines;
  EXPECT_FALSE(plan_drawing(levels, view).thinned);
  for (std::size_t allowed = all - 1; allowed > 1000; allowed = allowed * 2 / 3) {
    view.max_lines = allowed;
    const DrawPlan plan = plan_drawing(levels, view);
    EXPECT_TRUE(plan.thinned);
    EXPECT_LE(plan.lines, allowed);
    EXPECT_GT(plan.lines, allowed / 3) << "more is left out than has to be";
    // Each layer drawn stands for as many as there are up to the next one that is drawn.
    std::uint32_t next = 0;
    for (const PathChunk& chunk : levels.chunks) {
      const bool top = chunk.layer + 2 >= kLayers;
      for (const DrawRange& range : plan.ranges) {
        const IndexRange lines = chunk.work[range.level];
        if (range.style != PathStyle::kWork || lines.first < range.lines.first ||
            lines.last > range.lines.last)
          continue;
        EXPECT_LE(chunk.layer, next) << "a gap below layer " << chunk.layer << " with " << allowed
                                     << " lines";
        EXPECT_TRUE(!top || range.layers == 1) << "layer " << chunk.layer;
        next = chunk.layer + range.layers;
        break;
      }
    }
    EXPECT_EQ(next, static_cast<std::uint32_t>(kLayers)) << "the topmost layer is always drawn";
  }
}

TEST(PathPlan, NothingIsDrawnFromTheChosenMoveOn) {
  const PathLevels levels = tower();
  PathView view = view_from(250);
  view.show_travel = true;
  for (const bool remaining : {false, true}) {
    view.show_remaining = remaining;
    view.done_vertex = remaining ? levels.chunks[50].first_vertex : UINT32_MAX;
    view.end_vertex = levels.chunks[101].first_vertex + 300;
    std::uint32_t last = 0;
    for (const DrawRange& range : plan_drawing(levels, view).ranges) {
      const auto& list =
          range.style == PathStyle::kTravel ? levels.travel[range.level] : levels.work[range.level];
      for (std::uint32_t i = range.lines.first; i < range.lines.last; ++i)
        last = std::max(last, list[std::size_t{2} * i + 1]);
    }
    EXPECT_LT(last, view.end_vertex);
    EXPECT_GT(last + 20, view.end_vertex);
  }
}

TEST(PathPlan, TheLayerBeingMadeIsWhole) {
  const PathLevels levels = tower();
  PathView view = view_from(250);
  view.max_lines = 1500;
  view.show_remaining = false;
  const PathChunk& chunk = levels.chunks[101];
  view.done_vertex = chunk.first_vertex + 300;
  bool seen = false;
  for (const DrawRange& range : plan_drawing(levels, view).ranges) {
    const std::uint32_t first = chunk.work[range.level].first;
    seen = seen || (range.layers == 1 && range.lines.first <= first && first < range.lines.last);
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace kinebus::gui
