#include "gui/scene/printed_body.hpp"

#include <QVector3D>
#include <QVector4D>
#include <algorithm>
#include <cmath>

namespace kinebus::gui {
namespace {

using bodies::BodyKind;
using bodies::Shape;
using bodies::Vec;

constexpr float kBlock_mm = 8;
/// From point to point along a line: a block that a line crosses has some of it.
constexpr float kStep_mm = 4;
/// Half of a bead around its middle line.
constexpr double kBead_mm = 0.25;
/// A job may be anywhere; what is farther is on no table.
constexpr float kFarthest_mm = 4000;

/// A box of table coordinates as a solid of the machine frame.
Shape solid_of(const Box& box, const QMatrix4x4& frame) {
  const auto vec = [](const QVector3D& v) { return Vec{v.x(), v.y(), v.z()}; };
  const QVector3D low(box.low_mm[0], box.low_mm[1], box.low_mm[2]);
  const QVector3D high(box.high_mm[0], box.high_mm[1], box.high_mm[2]);
  const auto half = [&](int axis) {
    const double mm = static_cast<double>(high[axis] - low[axis]) / 2 + kBead_mm;
    return mm * vec(frame.column(axis).toVector3D());
  };
  return Shape::box(vec(frame.map((low + high) / 2)), half(0), half(1), half(2));
}

}  // namespace

void PrintedBody::clear() {
  path_.reset();
  taken_ = 0;
  blocks_.clear();
  bounds_mm_ = {};
}

bool PrintedBody::follow(const std::shared_ptr<const ToolPath>& path, std::uint32_t done,
                         std::uint32_t most_vertices) {
  if (path == nullptr || !path->extrudes) {
    clear();
    return true;
  }
  const auto end = static_cast<std::uint32_t>(std::min<std::size_t>(done, path->size()));
  if (path != path_ || end < taken_) {
    clear();
    path_ = path;
  }
  const std::uint32_t to = std::min(end, taken_ + most_vertices);
  for (std::uint32_t i = std::max(taken_, 1u); i < to; ++i)
    if (path->kinds[i] == PathKind::kWork) add_line(path->points_mm[i - 1], path->points_mm[i]);
  taken_ = std::max(taken_, to);
  return taken_ == end;
}

void PrintedBody::add_line(const std::array<float, 3>& from, const std::array<float, 3>& to) {
  const float length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  if (!(length < kFarthest_mm)) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(length / kStep_mm)));
  for (int k = 0; k <= steps; ++k) {
    const float share = static_cast<float>(k) / static_cast<float>(steps);
    add({from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]),
         from[2] + share * (to[2] - from[2])});
  }
}

void PrintedBody::add(const std::array<float, 3>& point) {
  std::uint64_t key = 0;
  for (const float coordinate : point) {
    if (!(std::abs(coordinate) < kFarthest_mm)) return;
    key = key << 16u | static_cast<std::uint16_t>(std::floor((coordinate + kFarthest_mm) / kBlock_mm));
  }
  blocks_[key].add(point);
  bounds_mm_.add(point);
}

std::optional<PrintedBody::Near> PrintedBody::comes_close(const bodies::CollisionModel& solid,
                                                          const bodies::Scene& placed,
                                                          const QMatrix4x4& part_frame,
                                                          double close_mm) const {
  if (empty()) return std::nullopt;
  const auto table = std::find_if(solid.bodies().begin(), solid.bodies().end(),
                                  [](const auto& body) { return body.id.kind == BodyKind::kTable; });
  const std::uint8_t carried = table != solid.bodies().end() ? table->group : bodies::CollisionModel::kStill;
  const Shape all = solid_of(bounds_mm_, part_frame);
  std::optional<Near> nearest;
  double least = close_mm;
  for (const auto& body : solid.bodies()) {
    const BodyKind kind = body.id.kind;
    if (kind == BodyKind::kTable || kind == BodyKind::kPart || kind == BodyKind::kTool ||
        kind == BodyKind::kFloor || (body.moves() && body.group == carried))
      continue;
    // As the gateway has it: the holder may come up to the part, the rest keeps what two bodies keep.
    const double keeps_mm = kind == BodyKind::kHolder ? 0 : solid.wanted_mm();
    for (std::size_t k = 0; k < body.shapes; ++k) {
      const Shape& shape = placed.shapes[body.first_shape + k];
      if (distance_mm(all, shape) - keeps_mm >= least) continue;
      for (const auto& [key, box] : blocks_) {
        const Shape block = solid_of(box, part_frame);
        if (least_distance_mm(block, shape) - keeps_mm >= least) continue;
        const double left_mm = distance_mm(block, shape) - keeps_mm;
        if (left_mm >= least) continue;
        least = left_mm;
        nearest = Near{body.id, left_mm + keeps_mm};
      }
    }
  }
  return nearest;
}

}  // namespace kinebus::gui
