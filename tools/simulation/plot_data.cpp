// What the picture is made of, thinned while it comes.

#include <algorithm>
#include <cmath>

#include "tools/simulation/plot.hpp"

namespace kinebus {
namespace {

// A point of the path is kept when leaving it out would move the line by more than this, or hide a speed.
constexpr float kPathDetail_mm = 0.1f, kPathStep_mm = 30, kPathSpeedStep = 15;
// Points passed over are remembered so far apart, and looked at again: a curve has no corner of its own.
constexpr float kPassedStep_mm = 0.3f;
// A stretch ends with its layer, if that is not very short or very long.
constexpr std::size_t kShortStretch = 150, kLongStretch = 6'000;
constexpr float kLayer_mm = 0.03f;
// A line of 0.4 x 0.1 mm takes 0.017 mm of filament a millimetre. E keeps to the path within parts of a
// count, which is up to 0.002 in a travel, forth and back.
constexpr double kLeastFilamentPerMm = 0.005, kLeastFilament_mm = 1e-6;

float distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// How far `p` is from the straight way from a to b (by the detour it makes, which is enough here).
float detour_height(const std::array<float, 3>& a, const std::array<float, 3>& p,
                    const std::array<float, 3>& b) {
  const float ap = distance(a, p), pb = distance(p, b), ab = distance(a, b);
  const float s = (ap + pb + ab) / 2;
  const float area2 = s * (s - ap) * (s - pb) * (s - ab);
  // Beyond an end: a way that is gone there and back.
  const float beyond = std::max(ap, pb) - ab;
  return ab > 1e-4f ? std::max(beyond, 2 * std::sqrt(std::max(area2, 0.0f)) / ab) : ap;
}

}  // namespace

bool PlotData::feeds(const Point& before, const Point& now) {
  return now.e_mm - before.e_mm >
         kLeastFilament_mm + kLeastFilamentPerMm * static_cast<double>(distance(before.tool_mm, now.tool_mm));
}

void PlotData::begin_stretch(const PathPoint& point) {
  keeping_ = stretches_++ % keep_ == 0;
  in_stretch_ = 0;
  layer_known_ = false;
  if (keeping_) path_.emplace_back();
  store(point);
}

void PlotData::store(const PathPoint& point) {
  kept_ = point;
  passed_.clear();
  ++in_stretch_;
  if (!keeping_) return;
  path_.back().push_back(point);
  if (++path_points_ < kPathCapacity) return;
  // Every second stretch goes.
  keep_ *= 2;
  for (std::size_t i = 0; i < path_.size() / 2 + path_.size() % 2; ++i) path_[i] = std::move(path_[2 * i]);
  keeping_ = path_.size() % 2 == 1;  // the stretch at hand was one of those that stay
  path_.resize((path_.size() + 1) / 2);
  path_points_ = 0;
  for (const Stretch& stretch : path_) path_points_ += stretch.size();
}

void PlotData::add_to_path(const PathPoint& point) {
  if (stretches_ == 0) {
    begin_stretch(point);
    last_ = point;
    return;
  }
  bool curved = false;
  if (distance(passed_.empty() ? kept_.mm : passed_.back(), last_.mm) > kPassedStep_mm) {
    passed_.push_back(last_.mm);
    for (const auto& mm : passed_) curved = curved || detour_height(kept_.mm, mm, point.mm) > kPathDetail_mm;
  }
  const bool corner = curved || detour_height(kept_.mm, last_.mm, point.mm) > kPathDetail_mm ||
                      distance(kept_.mm, point.mm) > kPathStep_mm ||
                      std::abs(point.speed_mm_per_s - kept_.speed_mm_per_s) > kPathSpeedStep ||
                      point.prints != last_.prints;
  if (corner) {
    const bool next_layer = layer_known_ && point.prints && std::abs(point.mm[2] - layer_mm_) > kLayer_mm;
    if ((in_stretch_ >= kShortStretch && next_layer) || in_stretch_ >= kLongStretch) {
      store(last_);
      begin_stretch(last_);
    } else {
      store(last_);
    }
  }
  if (point.prints && !layer_known_) {
    layer_known_ = true;
    layer_mm_ = point.mm[2];
  }
  last_ = point;
}

void PlotData::add(const Point& point) {
  const bool line = seen_ > 0 && feeds(before_, point);
  prints = prints || line;
  add_to_path({point.tool_mm, point.speed_mm_per_s, line});
  before_ = point;
  for (const float target : point.heat.target_c) heated = heated || target > 0;
  largest_error_ = std::max(largest_error_, point.error_um);
  if (seen_++ % every_ != 0) return;
  points_.push_back(point);
  points_.back().error_um = largest_error_;
  largest_error_ = 0;
  if (points_.size() < kCapacity) return;
  for (std::size_t i = 0; i < kCapacity / 2; ++i) {
    points_[i] = points_[2 * i];
    points_[i].error_um = std::max(points_[2 * i].error_um, points_[2 * i + 1].error_um);
  }
  points_.resize(kCapacity / 2);
  every_ *= 2;
}

}  // namespace kinebus
