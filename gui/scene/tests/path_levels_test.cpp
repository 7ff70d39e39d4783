#include "gui/scene/path_levels.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gui/scene/path_reader.hpp"

namespace kinebus::gui {
namespace {

/// Circles of short lines, a layer each.
ToolPath rings(int layers, int lines) {
  PathReader reader;
  std::string text;
  double e = 0;
  for (int layer = 0; layer < layers; ++layer) {
    text = "G0 X40 Y0 Z" + std::to_string(0.2 * (layer + 1)) + "\n";
    for (int i = 1; i <= lines; ++i) {
      const double angle = 6.283185307 * i / lines, r = 40 + 0.05 * std::sin(40 * angle);
      text += "G1 X" + std::to_string(r * std::cos(angle)) + " Y" + std::to_string(r * std::sin(angle)) +
              " E" + std::to_string(e += 0.01) + "\n";
    }
    reader.add(text);
  }
  return reader.finish();
}

float distance(const std::array<float, 3>& p, const std::array<float, 3>& a, const std::array<float, 3>& b) {
  float ab = 0, dot = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    ab += (b[i] - a[i]) * (b[i] - a[i]);
    dot += (b[i] - a[i]) * (p[i] - a[i]);
  }
  const float share = ab > 0 ? std::min(1.0F, std::max(0.0F, dot / ab)) : 0;
  float sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const float off = a[i] + share * (b[i] - a[i]) - p[i];
    sum += off * off;
  }
  return std::sqrt(sum);
}

TEST(PathLevels, EveryVertexStaysWithinTheLevelsTolerance) {
  const ToolPath path = rings(3, 2000);
  const PathLevels levels = make_path_levels(path);
  for (std::size_t k = 0; k < kPathLevels; ++k) {
    const auto& indices = levels.work[k];
    for (std::size_t i = 0; i + 1 < indices.size(); i += 2)
      for (std::uint32_t v = indices[i]; v <= indices[i + 1]; ++v)
        ASSERT_LE(distance(path.points_mm[v], path.points_mm[indices[i]], path.points_mm[indices[i + 1]]),
                  kLevelTolerance_mm[k] + 1e-3F)
            << "level " << k << " vertex " << v;
  }
}

TEST(PathLevels, LevelsShrinkAndLevelZeroIsWhole) {
  const ToolPath path = rings(5, 4000);
  const PathLevels levels = make_path_levels(path);
  EXPECT_EQ(levels.work[0].size() + levels.travel[0].size(), 2 * (path.size() - 1));
  for (std::size_t k = 1; k < kPathLevels; ++k) EXPECT_LE(levels.work[k].size(), levels.work[k - 1].size());
  EXPECT_LT(levels.work[2].size() * 8, levels.work[0].size());
}

TEST(PathLevels, ChunksFollowThePathAndHoldTheirIndices) {
  const ToolPath path = rings(4, 5000);
  const PathLevels levels = make_path_levels(path);
  std::uint32_t next = 0;
  for (const PathChunk& chunk : levels.chunks) {
    EXPECT_EQ(chunk.first_vertex, next);
    next = chunk.last_vertex;
    for (std::size_t k = 0; k < kPathLevels; ++k)
      for (std::uint32_t i = chunk.work[k].first; i < chunk.work[k].last; ++i) {
        EXPECT_GE(levels.work[k][2 * i] + 1, chunk.first_vertex);
        EXPECT_LT(levels.work[k][2 * i + 1], chunk.last_vertex);
      }
  }
  EXPECT_EQ(next, path.size());
}

}  // namespace
}  // namespace kinebus::gui
