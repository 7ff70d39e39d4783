#include "gui/scene/path_plan.hpp"

#include <QVector3D>
#include <QVector4D>

#include <algorithm>
#include <cmath>

namespace kinebus::gui {
namespace {

QVector3D to_qt(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// Outside one of the clip planes with all corners.
bool out_of_sight(const Box& box, const QMatrix4x4& clip) {
  std::array<int, 5> outside{};
  for (int corner = 0; corner < 8; ++corner) {
    const QVector4D p = clip * QVector4D((corner & 1) != 0 ? box.high_mm[0] : box.low_mm[0],
                                         (corner & 2) != 0 ? box.high_mm[1] : box.low_mm[1],
                                         (corner & 4) != 0 ? box.high_mm[2] : box.low_mm[2], 1);
    outside[0] += p.x() < -p.w();
    outside[1] += p.x() > p.w();
    outside[2] += p.y() < -p.w();
    outside[3] += p.y() > p.w();
    outside[4] += p.z() < -p.w();
  }
  return std::find(outside.begin(), outside.end(), 8) != outside.end();
}

float distance_mm(const Box& box, const QVector3D& eye) {
  const QVector3D low = to_qt(box.low_mm), high = to_qt(box.high_mm);
  const QVector3D nearest(std::clamp(eye.x(), low.x(), high.x()), std::clamp(eye.y(), low.y(), high.y()),
                          std::clamp(eye.z(), low.z(), high.z()));
  return (eye - nearest).length();
}

class Planner {
 public:
  Planner(const PathLevels& levels, const PathView& view) : levels_(levels), view_(view) {}

  DrawPlan plan() {
    select();
    Detail detail;
    while (cost(detail) > view_.max_lines && reduce(detail)) {
    }
    // A job of one layer has only its chunks to leave out.
    std::size_t stride = 1;
    const std::size_t total = cost(detail);
    if (total > view_.max_lines && view_.max_lines > 0) stride = total / view_.max_lines + 1;
    DrawPlan plan;
    plan.thinned = detail.coarser > 0 || detail.layers > 1 || stride > 1;
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      if (whole(i) || (drawn(i, detail) && i % stride == 0)) add(plan, i, detail);
    for (const DrawRange& range : plan.ranges) plan.lines += range.lines.count();
    return plan;
  }

 private:
  static constexpr std::size_t kTopChunks = 2;
  static constexpr float kNever_mm = 1e30F;
  static constexpr std::uint32_t kMostLayers = UINT16_MAX;
  struct Chosen {
    const PathChunk* chunk;
    std::uint8_t level;
  };
  struct Detail {
    std::uint8_t coarser = 0;  ///< levels above what a pixel asks for
    std::uint32_t layers = 1;  ///< one layer is drawn for so many
  };

  /// One step less of what is seen less: bends of the lines, or layers. False: there is nothing less.
  bool reduce(Detail& detail) const {
    const std::size_t level = std::size_t{finest_} + detail.coarser + 1;
    const float bends_mm = level < kPathLevels ? kLevelTolerance_mm[level] : kNever_mm;
    const std::uint32_t more = std::max(detail.layers + 1, detail.layers * 3 / 2);
    const float layers_mm = more <= last_layer_ - first_layer_ && more < kMostLayers && levels_.layer_mm > 0
                                ? static_cast<float>(more) * levels_.layer_mm
                                : kNever_mm;
    if (bends_mm >= kNever_mm && layers_mm >= kNever_mm) return false;
    if (bends_mm <= layers_mm)
      ++detail.coarser;
    else
      detail.layers = more;
    return true;
  }

  void select() {
    for (const PathChunk& chunk : levels_.chunks) {
      if (chunk.layer < view_.first_layer || chunk.layer > view_.last_layer) continue;
      if (!view_.show_remaining && chunk.first_vertex >= view_.done_vertex) break;
      if (chunk.first_vertex >= view_.end_vertex) break;
      if (chunk.bounds_mm.empty() || out_of_sight(chunk.bounds_mm, view_.clip)) continue;
      const float pixel_mm = distance_mm(chunk.bounds_mm, view_.eye_mm) * view_.mm_per_pixel_at_1mm;
      std::uint8_t level = 0;
      while (level + 1u < kPathLevels && kLevelTolerance_mm[level + 1u] <= pixel_mm * 0.8F) ++level;
      if (chosen_.empty()) first_layer_ = chunk.layer;
      last_layer_ = chunk.layer;
      finest_ = std::min(finest_, level);
      chosen_.push_back({&chunk, level});
    }
  }

  /// Shown with all its layers whatever it costs: it is what is looked at.
  bool whole(std::size_t i) const {
    const PathChunk& chunk = *chosen_[i].chunk;
    return i + kTopChunks >= chosen_.size() ||
           (chunk.first_vertex <= view_.done_vertex && view_.done_vertex < chunk.last_vertex);
  }
  bool drawn(std::size_t i, const Detail& detail) const {
    return whole(i) || chosen_[i].chunk->layer % detail.layers == 0;
  }

  static std::uint8_t raised(std::uint8_t level, std::uint8_t coarser) {
    return static_cast<std::uint8_t>(std::min<std::size_t>(kPathLevels - 1, std::size_t{level} + coarser));
  }
  std::size_t cost(const Detail& detail) const {
    std::size_t lines = 0;
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      if (!drawn(i, detail)) continue;
      const Chosen& c = chosen_[i];
      lines += c.chunk->work[raised(c.level, detail.coarser)].count();
      if (view_.show_travel) lines += c.chunk->travel[c.level + detail.coarser > 1 ? 1 : 0].count();
    }
    return lines;
  }

  /// First line of a range that ends at this vertex or behind it.
  static std::uint32_t cut(const std::vector<std::uint32_t>& indices, IndexRange range,
                           std::uint32_t vertex) {
    std::uint32_t low = range.first, high = range.last;
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      if (indices[std::size_t{2} * middle + 1] < vertex)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }

  static void append(DrawPlan& plan, DrawRange range) {
    if (range.lines.count() == 0) return;
    // The last range of the same list, if this one goes on where it ended.
    for (auto last = plan.ranges.rbegin(); last != plan.ranges.rend() && last - plan.ranges.rbegin() < 3;
         ++last)
      if (last->style == range.style && last->level == range.level && last->layers == range.layers &&
          last->lines.last == range.lines.first) {
        last->lines.last = range.lines.last;
        return;
      }
    plan.ranges.push_back(range);
  }

  void add(DrawPlan& plan, std::size_t i, const Detail& detail) const {
    const Chosen& chosen = chosen_[i];
    const std::uint8_t level = raised(chosen.level, detail.coarser);
    const auto layers = static_cast<std::uint16_t>(whole(i) ? 1 : detail.layers);
    const IndexRange work = chosen.chunk->work[level];
    const std::uint32_t end = cut(levels_.work[level], work, view_.end_vertex);
    const std::uint32_t done = std::min(end, cut(levels_.work[level], work, view_.done_vertex));
    append(plan, {PathStyle::kWork, level, layers, {work.first, done}});
    if (view_.show_remaining) append(plan, {PathStyle::kRemaining, level, layers, {done, end}});
    if (!view_.show_travel) return;
    const auto travel_level = static_cast<std::uint8_t>(chosen.level + detail.coarser > 1 ? 1 : 0);
    const IndexRange travel = chosen.chunk->travel[travel_level];
    const std::uint32_t last =
        view_.show_remaining ? view_.end_vertex : std::min(view_.end_vertex, view_.done_vertex);
    append(plan, {PathStyle::kTravel,
                  travel_level,
                  1,
                  {travel.first, cut(levels_.travel[travel_level], travel, last)}});
  }

  const PathLevels& levels_;
  const PathView& view_;
  std::vector<Chosen> chosen_;
  std::uint8_t finest_ = kPathLevels - 1;           ///< level of any chosen chunk
  std::uint32_t first_layer_ = 0, last_layer_ = 0;  ///< of the chosen chunks
};

}  // namespace

DrawPlan plan_drawing(const PathLevels& levels, const PathView& view) {
  return Planner(levels, view).plan();
}

}  // namespace kinebus::gui
