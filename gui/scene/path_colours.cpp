#include "gui/scene/path_colours.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kinebus::gui {
namespace {

std::uint8_t byte(double share) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255));
}

using Ramp = std::array<std::array<float, 3>, 9>;

// Perceptually even, readable by the colour-blind on light and dark ground.
constexpr Ramp kFeedRamp{{{0.24F, 0.20F, 0.62F},
                          {0.20F, 0.38F, 0.80F},
                          {0.13F, 0.55F, 0.84F},
                          {0.09F, 0.69F, 0.74F},
                          {0.27F, 0.78F, 0.56F},
                          {0.58F, 0.83F, 0.36F},
                          {0.89F, 0.80F, 0.22F},
                          {0.97F, 0.60F, 0.16F},
                          {0.91F, 0.34F, 0.17F}}};
constexpr Ramp kLayerRamp{{{0.10F, 0.44F, 0.62F},
                           {0.07F, 0.56F, 0.66F},
                           {0.12F, 0.66F, 0.62F},
                           {0.30F, 0.74F, 0.55F},
                           {0.53F, 0.78F, 0.50F},
                           {0.73F, 0.77F, 0.46F},
                           {0.87F, 0.71F, 0.42F},
                           {0.93F, 0.60F, 0.39F},
                           {0.92F, 0.47F, 0.40F}}};
constexpr Ramp kMarginRamp{{{0.80F, 0.13F, 0.15F},
                            {0.90F, 0.33F, 0.16F},
                            {0.95F, 0.54F, 0.17F},
                            {0.95F, 0.73F, 0.24F},
                            {0.80F, 0.78F, 0.33F},
                            {0.55F, 0.75F, 0.42F},
                            {0.32F, 0.69F, 0.48F},
                            {0.19F, 0.63F, 0.52F},
                            {0.14F, 0.57F, 0.56F}}};

// Walls light and warm, what fills them dark, what is broken off green.
constexpr Ramp kFeatureColours{{{0.52F, 0.55F, 0.58F},
                                {0.90F, 0.45F, 0.15F},
                                {0.94F, 0.72F, 0.27F},
                                {0.72F, 0.25F, 0.27F},
                                {0.56F, 0.36F, 0.72F},
                                {0.24F, 0.50F, 0.82F},
                                {0.30F, 0.67F, 0.38F},
                                {0.16F, 0.55F, 0.55F},
                                {0.85F, 0.52F, 0.68F}}};
static_assert(kPathFeatures == std::tuple_size_v<Ramp>);

constexpr std::array<float, 3> kPartColour{0.30F, 0.58F, 0.78F};
constexpr Ramp kPartRamp{kPartColour, kPartColour, kPartColour, kPartColour, kPartColour,
                         kPartColour, kPartColour, kPartColour, kPartColour};

/// Carriage speed at the programmed feed as a share of what the carriage may do; 1 or more: the gateway slows
/// down.
double speed_share(const MachineModel& model, const std::optional<std::array<double, 4>>& from,
                   const std::optional<std::array<double, 4>>& to, double time_s) {
  if (!from || !to || !(time_s > 0)) return 0;
  double most = 0;
  for (std::size_t i = 0; i < model.legs.size() && i < 4; ++i)
    most = std::max(most, std::abs((*to)[i] - (*from)[i]) / time_s / model.legs[i].speed_mm_per_s);
  return most;
}

PartPose pose_at(const ToolPath& path, std::size_t i) {
  const auto& p = path.points_mm[i];
  PartPose pose{{p[0], p[1], p[2]}, 0, 0};
  if (!path.tilts_rad.empty()) {
    pose.a_rad = path.tilts_rad[i][0];
    pose.c_rad = path.tilts_rad[i][1];
  }
  return pose;
}

}  // namespace

PathShades shade_path(const ToolPath& path, const std::optional<MachineModel>& model,
                      const std::function<bool()>& cancelled) {
  PathShades shades;
  shades.vertices.resize(path.size());
  std::uint16_t low = UINT16_MAX, high = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path.kinds[i] != PathKind::kWork) continue;
    low = std::min(low, path.feeds_mm_per_min[i]);
    high = std::max(high, path.feeds_mm_per_min[i]);
  }
  shades.feed_min_mm_per_min = std::min(low, high);
  shades.feed_max_mm_per_min = high;
  const double feed_span = std::max(1, high - std::min(low, high));
  const double layer_span = static_cast<double>(std::max<std::size_t>(1, path.layers.size() - 1));
  std::size_t layer = 0;
  auto feature = PathFeature::kOther;
  auto change = path.features.begin();
  std::optional<std::array<double, 4>> before, now;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i % 16384 == 0 && cancelled && cancelled()) return {};
    while (layer + 1 < path.layers.size() && i >= path.layers[layer].last) ++layer;
    for (; change != path.features.end() && change->line <= path.lines[i]; ++change)
      feature = change->feature;
    PathVertex& v = shades.vertices[i];
    v.point_mm = path.points_mm[i];
    double margin = 1;
    if (model) {
      const PartPose pose = pose_at(path, i);
      margin = model->margin(pose, now);
      if (i > 0 && path.feeds_mm_per_min[i] > 0) {
        const auto &a = path.points_mm[i - 1], &b = path.points_mm[i];
        const double length_mm = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        margin =
            std::min(margin, 1 - speed_share(*model, before, now, length_mm / path.feeds_mm_per_min[i] * 60));
      }
      before = now;
      if (path.kinds[i] == PathKind::kWork && margin < shades.least_margin) {
        shades.least_margin = std::max(0.0, margin);
        shades.least_margin_line = path.lines[i];
      }
    }
    v.shade = {byte((path.feeds_mm_per_min[i] - shades.feed_min_mm_per_min) / feed_span),
               byte(static_cast<double>(layer) / layer_span), byte(margin),
               byte(static_cast<double>(feature) / (kPathFeatures - 1))};
  }
  return shades;
}

const std::array<std::array<float, 3>, 9>& colour_ramp(PathColouring colouring) {
  switch (colouring) {
    case PathColouring::kLayer:
      return kLayerRamp;
    case PathColouring::kMargin:
      return kMarginRamp;
    case PathColouring::kPart:
      return kPartRamp;
    case PathColouring::kFeature:
      return kFeatureColours;
    case PathColouring::kFeed:
      break;
  }
  return kFeedRamp;
}

}  // namespace kinebus::gui
