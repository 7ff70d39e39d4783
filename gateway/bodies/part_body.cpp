#include "gateway/bodies/part_body.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus::bodies {
namespace {

// A body this much farther from the part than it must be is not measured exactly: spheres around both say so.
constexpr double kFar_mm = 30;
// So much more than it must keep is enough: less, and cells are looked at.
constexpr double kEnough_mm = 1;
// The distance that a refusal names, to a part in so many halvings of the clearance.
constexpr int kHalvings = 5;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::span<const Shape> shapes_of(const Scene& scene, const CollisionModel::Body& body) {
  return std::span(scene.shapes).subspan(body.first_shape, body.shapes);
}

}  // namespace

PartBody::PartBody(const CollisionModel& model, const PrintedPart& part)
    : model_(model),
      part_(part),
      near_mm_(std::max(PrintedPart::kSkin_mm, model.wanted_mm() - PrintedPart::kCorner_mm)) {
  const auto& all = model_.bodies();
  const auto table =
      std::find_if(all.begin(), all.end(), [](const auto& b) { return b.id.kind == BodyKind::kTable; });
  assert(table != all.end());
  table_ = static_cast<std::size_t>(table - all.begin());
}

bool PartBody::meets(std::size_t body) const {
  const CollisionModel::Body &b = model_.bodies()[body], &table = model_.bodies()[table_];
  return b.group != table.group && b.id.kind != BodyKind::kTool && b.id.kind != BodyKind::kHolder;
}

double PartBody::grow() {
  if (extents_ == part_.extents()) return 0;
  extents_ = part_.extents();
  const auto before = extent_;
  extent_.reset();
  if (part_.empty()) return 0;
  extent_ = part_.extent();
  const CollisionModel::Body& table = model_.bodies()[table_];
  const Scene& rest = model_.at_rest();
  if (table.moves()) {
    // No part of the table is farther from its witnesses than its lever.
    lever_mm_ = table.lever_mm + std::hypot(extent_->radius_mm, std::max(extent_->high.z, -extent_->low.z));
    assert(rest.shapes[table.first_shape].core == Shape::Core::kCylinder);
  }
  if (!before) return kInfinite;
  const auto beyond = [](double now, double then) { return std::max(0.0, now - then); };
  const double z = std::max(beyond(extent_->high.z, before->high.z), beyond(before->low.z, extent_->low.z));
  const double x = std::max(beyond(extent_->high.x, before->high.x), beyond(before->low.x, extent_->low.x));
  const double y = std::max(beyond(extent_->high.y, before->high.y), beyond(before->low.y, extent_->low.y));
  const double radius = beyond(extent_->radius_mm, before->radius_mm);
  return std::max(norm({x, y, z}), std::hypot(radius, z));
}

PartBody::Ground PartBody::ground(const Scene& scene, const Pose& pose) const {
  const Shape& table = scene.shapes[model_.bodies()[table_].first_shape];
  if (table.core != Shape::Core::kCylinder) return {};
  return {.zero = table.centre + table.half[0],
          .y = cross(table.axis, {1, 0, 0}),
          .z = table.axis,
          .c_rad = pose[kC]};
}

Shape PartBody::around(const Scene& scene) const {
  const PrintedPart::Extent& e = *extent_;
  const Shape& table = scene.shapes[model_.bodies()[table_].first_shape];
  if (table.core != Shape::Core::kCylinder) {
    const Vec half = 0.5 * (e.high - e.low);
    return Shape::box(e.low + half, {half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z});
  }
  const Vec zero = table.centre + table.half[0];
  return Shape::cylinder(zero + e.low.z * table.axis, zero + e.high.z * table.axis, e.radius_mm);
}

bool PartBody::cells_near(const Scene& scene, const Ground& g, std::size_t body, double near_mm) const {
  const Turn c(g.c_rad);
  const auto turned = [&](const Vec& v) {
    const Vector3 t = turn_back_z(c, {v.x, dot(v, g.y), dot(v, g.z)});
    return Vec{t[0], t[1], t[2]};
  };
  const auto shapes = shapes_of(scene, model_.bodies()[body]);
  return std::any_of(shapes.begin(), shapes.end(), [&](Shape on_table) {
    on_table.centre = turned(on_table.centre - g.zero);
    for (Vec& half : on_table.half) half = turned(half);
    on_table.axis = turned(on_table.axis);
    return part_.comes_near(on_table, near_mm);
  });
}

double PartBody::distance(const Scene& scene, const Pose& pose, std::size_t body, Parting& last) const {
  if (!extent_) return kInfinite;
  const Shape around = this->around(scene);
  const auto shapes = shapes_of(scene, model_.bodies()[body]);
  double far = kInfinite;
  for (const Shape& s : shapes) far = std::min(far, least_distance_mm(around, s));
  if (far >= near_mm_ + kFar_mm) return far + coarse_mm();
  // The plane that parted both when they were measured parts them still, as a rule.
  if (last.mm > 0) {
    double reach = -kInfinite;
    for (const Shape& s : shapes) reach = std::max(reach, reach_along(s, last.axis));
    if (const double gap = -reach_along(around, -last.axis) - reach;
        gap >= near_mm_ + kEnough_mm && gap >= std::min(last.mm - kEnough_mm, near_mm_ + kFar_mm))
      return gap + coarse_mm();
  }
  last = {.mm = kInfinite};
  for (const Shape& s : shapes)
    if (const Parting found = part(around, s); found.mm < last.mm) last = found;
  if (last.mm >= near_mm_ + kEnough_mm) return last.mm + coarse_mm();
  const Ground ground = this->ground(scene, pose);
  // No more than that: the next cell may be laid nearer.
  if (!cells_near(scene, ground, body, near_mm_)) return model_.wanted_mm();
  if (cells_near(scene, ground, body, PrintedPart::kSkin_mm)) return 0;
  double low = PrintedPart::kSkin_mm, high = near_mm_;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (cells_near(scene, ground, body, middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace kinebus::bodies
