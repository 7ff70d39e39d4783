#include "tools/compose/support.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kinebus::compose {
namespace {

constexpr double kCellMm = 0.5;
constexpr double kLayerMm = 2;
/// Where the body stands on the plane: less than any sliver that a cut leaves under a corner.
constexpr double kTouchMm = 0.004;

}  // namespace

double LayeredBody::cell_mm2() {
  return kCellMm * kCellMm;
}

LayeredBody::LayeredBody(const TriangleMesh& mesh, const Vector& up, double from_mm, double limit_rad)
    : mesh_(mesh), up_(up), from_(from_mm), reach_mm_(kLayerMm * std::tan(limit_rad) + 1.2 * kCellMm) {
  across_ = (std::abs(up[0]) < 0.9 ? Vector::UnitX() : Vector::UnitY()).cross(up).normalized();
  along_ = up.cross(across_);
  for (Vector& p : mesh_.points) p = Vector(across_.dot(p), along_.dot(p), up_.dot(p));
  const Box box = bounds(mesh_);
  top_ = box.high[2], left_ = box.low[0], front_ = box.low[1];
  columns_ = static_cast<int>((box.high[0] - box.low[0]) / kCellMm) + 1;
  rows_ = static_cast<int>((box.high[1] - box.low[1]) / kCellMm) + 1;
}

LayeredBody::Bitmap LayeredBody::slice(double height_mm) const {
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(rows_));
  for (const auto& face : mesh_.faces) {
    std::array<Vector, 2> ends{Vector::Zero(), Vector::Zero()};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
      const Vector &a = mesh_.points[face[i]], &b = mesh_.points[face[(i + 1) % 3]];
      if ((a[2] > height_mm) == (b[2] > height_mm)) continue;
      ends[count++] = a + (b - a) * ((height_mm - a[2]) / (b[2] - a[2]));
    }
    if (count < 2) continue;
    const double low = std::min(ends[0][1], ends[1][1]), high = std::max(ends[0][1], ends[1][1]);
    const int first = std::max(0, static_cast<int>(std::ceil((low - front_) / kCellMm - 0.5)));
    for (int row = first; row < rows_; ++row) {
      const double y = front_ + (row + 0.5) * kCellMm;
      if (y >= high) break;
      if (y < low) continue;
      const double share = (y - ends[0][1]) / (ends[1][1] - ends[0][1]);
      crossings[static_cast<std::size_t>(row)].push_back(ends[0][0] + share * (ends[1][0] - ends[0][0]));
    }
  }
  Bitmap out(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int row = 0; row < rows_; ++row) {
    auto& line = crossings[static_cast<std::size_t>(row)];
    std::sort(line.begin(), line.end());
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      const int from = std::max(0, static_cast<int>(std::ceil((line[i] - left_) / kCellMm - 0.5)));
      const int to = std::min(columns_, static_cast<int>(std::ceil((line[i + 1] - left_) / kCellMm - 0.5)));
      for (int column = from; column < to; ++column)
        out[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
            static_cast<std::size_t>(column)] = true;
    }
  }
  return out;
}

bool LayeredBody::held(const Bitmap& below, int x, int y) const {
  const int reach = static_cast<int>(std::floor(reach_mm_ / kCellMm));
  const double reach2 = reach_mm_ * reach_mm_ / (kCellMm * kCellMm);
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      if (x + dx < 0 || x + dx >= columns_ || y + dy < 0 || y + dy >= rows_ || dx * dx + dy * dy > reach2)
        continue;
      if (below[static_cast<std::size_t>(y + dy) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(x + dx)])
        return true;
    }
  return false;
}

std::vector<LayeredBody::Place> LayeredBody::unheld() const {
  std::vector<Place> out;
  Bitmap below = slice(from_ + kTouchMm);
  for (int layer = 0; layer < layers(); ++layer) {
    const double height = layer_height(layer);
    Bitmap here = slice(height);
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x) {
        const auto cell =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
        if (!here[cell] || below[cell] || held(below, x, y)) continue;
        const Vector place(left_ + (x + 0.5) * kCellMm, front_ + (y + 0.5) * kCellMm, height);
        out.push_back({height, place[0] * across_ + place[1] * along_ + place[2] * up_});
      }
    below = std::move(here);
  }
  return out;
}

int LayeredBody::layers() const {
  return std::max(0, static_cast<int>(std::ceil((top_ - from_) / kLayerMm - 0.5)));
}

double LayeredBody::layer_height(int layer) const {
  return from_ + (layer + 0.5) * kLayerMm;
}

double LayeredBody::section_mm2(double height_mm) const {
  if (sections_mm2_.empty())
    for (int layer = 0; layer < layers(); ++layer) {
      const Bitmap cells = slice(layer_height(layer));
      sections_mm2_.push_back(cell_mm2() * static_cast<double>(std::count(cells.begin(), cells.end(), true)));
    }
  if (sections_mm2_.empty()) return 0;
  const auto layer = static_cast<std::int64_t>(std::floor((height_mm - from_) / kLayerMm));
  return sections_mm2_[static_cast<std::size_t>(
      std::clamp<std::int64_t>(layer, 0, static_cast<std::int64_t>(sections_mm2_.size()) - 1))];
}

double unheld_mm2(const Solid& solid, double limit_rad) {
  const LayeredBody body(solid.mesh, solid.base.normal, solid.base.height, limit_rad);
  return static_cast<double>(body.unheld().size()) * LayeredBody::cell_mm2();
}

}  // namespace kinebus::compose
