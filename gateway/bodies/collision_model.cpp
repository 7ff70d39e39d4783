#include "gateway/bodies/collision_model.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace kinebus::bodies {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// What rounding may add to a body's motion from one pose to the next, with room.
constexpr double kMoved_mm = 1e-9;

/// Pairs whose bodies may touch at work.
bool at_work(BodyKind a, BodyKind b) {
  if (a > b) std::swap(a, b);
  return (a == BodyKind::kTable || a == BodyKind::kPart) && b == BodyKind::kTool;
}

}  // namespace

std::size_t CollisionModel::add(BodyId id, std::uint8_t group, std::span<const Shape> shapes,
                                double lever_mm) {
  assert(bodies_.size() < kMostBodies && shapes_ + shapes.size() <= kMostShapes);
  bodies_.push_back({id,
                     static_cast<std::uint8_t>(shapes_),
                     static_cast<std::uint8_t>(shapes.size()),
                     group,
                     lever_mm,
                     {}});
  for (const Shape& shape : shapes) rest_.shapes[shapes_++] = shape;
  return bodies_.size() - 1;
}

void CollisionModel::add_fixed(const BodiesDescription& bodies) {
  assert(bodies.fixed.size() <= kMostFixed);
  for (const FixedBody& body : bodies.fixed) {
    const Vec from{body.from_mm[0], body.from_mm[1], body.from_mm[2]},
        to{body.to_mm[0], body.to_mm[1], body.to_mm[2]}, half = 0.5 * (to - from);
    fixed_names_.push_back(body.name);
    add({BodyKind::kFixed, static_cast<std::uint8_t>(fixed_names_.size())}, kStill,
        body.radius_mm > 0 ? Shape::capsule(from, to, body.radius_mm)
                           : Shape::box(from + half, {half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z}));
  }
}

void CollisionModel::add_floor(double z_mm) {
  constexpr double kHalfWidth_mm = 3000, kHalfThickness_mm = 50;
  add({BodyKind::kFloor, 0}, kStill,
      Shape::box({0, 0, z_mm - kHalfThickness_mm}, {kHalfWidth_mm, 0, 0}, {0, kHalfWidth_mm, 0},
                 {0, 0, kHalfThickness_mm}));
}

void CollisionModel::ride(std::size_t body, const Vec& centre, const Vec& line) {
  assert(bodies_[body].shapes == 1 && rest_.shapes[shape_of(body)].core == Shape::Core::kBox);
  rest_.shapes[shape_of(body)].centre = centre;
  bodies_[body].line = line;
}

bool CollisionModel::always_parted(const Pair& pair) const {
  const Body &a = bodies_[pair.first], &b = bodies_[pair.second];
  const auto rides = [](const Body& body) { return dot(body.line, body.line) > 0; };
  const Body &rider = rides(a) ? a : b, &other = rides(a) ? b : a;
  constexpr double kParallel = 1e-9;
  if (!rides(rider) || (other.moves() && !(rides(other) && norm(cross(rider.line, other.line)) < kParallel)))
    return false;
  // Against the other it moves along its line: the box is made as long as any machine is high.
  constexpr double kLong_mm = 1e5;
  Shape way = rest_.shapes[rider.first_shape];
  for (Vec& half : way.half)
    if (norm(cross(half, rider.line)) < kParallel * norm(half)) half = kLong_mm * rider.line;
  way.core_reach_mm += kLong_mm;
  const auto shapes = std::span(rest_.shapes).subspan(other.first_shape, other.shapes);
  return std::all_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
    return bodies::part(way, shape).mm >= wanted_mm_ + kRounding_mm;
  });
}

bool CollisionModel::among(const std::vector<Two>& list, std::size_t a, std::size_t b) {
  return std::any_of(list.begin(), list.end(), [&](const Two& two) {
    return (two[0] == a && two[1] == b) || (two[0] == b && two[1] == a);
  });
}

bool CollisionModel::parted_at_work(const Pair& pair) const {
  return among(parted_at_work_, pair.first, pair.second);
}

void CollisionModel::pair_up() {
  for (std::size_t a = 0; a < bodies_.size(); ++a)
    for (std::size_t b = a + 1; b < bodies_.size(); ++b) {
      if (bodies_[a].group == bodies_[b].group) continue;
      if (among(joined_, a, b)) continue;
      const BodyKind kinds[] = {bodies_[a].id.kind, bodies_[b].id.kind};
      const auto is = [&](BodyKind k) { return kinds[0] == k || kinds[1] == k; };
      const bool homing_only = at_work(kinds[0], kinds[1]) || (is(BodyKind::kPart) && is(BodyKind::kHolder));
      pairs_.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), homing_only});
    }
}

Parting CollisionModel::part(const Scene& scene, const Pair& pair, double enough_mm) const {
  const Body &a = bodies_[pair.first], &b = bodies_[pair.second];
  Parting least{.mm = kInfinite};
  for (std::size_t i = a.first_shape; i < std::size_t{a.first_shape} + a.shapes; ++i)
    for (std::size_t j = b.first_shape; j < std::size_t{b.first_shape} + b.shapes; ++j)
      if (const Parting found = bodies::part(scene.shapes[i], scene.shapes[j], std::min(enough_mm, least.mm));
          found.mm < least.mm)
        least = found;
  return least;
}

double CollisionModel::gap_along(const Scene& scene, const Pair& pair, const Vec& axis) const {
  const auto reach = [&](const Body& body, const Vec& direction) {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = body.first_shape; i < std::size_t{body.first_shape} + body.shapes; ++i)
      most = std::max(most, reach_along(scene.shapes[i], direction));
    return most;
  };
  return -reach(bodies_[pair.first], -axis) - reach(bodies_[pair.second], axis);
}

double CollisionModel::least_distance(const Scene& scene, const Pair& pair) const {
  const Body &a = bodies_[pair.first], &b = bodies_[pair.second];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = a.first_shape; i < std::size_t{a.first_shape} + a.shapes; ++i)
    for (std::size_t j = b.first_shape; j < std::size_t{b.first_shape} + b.shapes; ++j)
      least = std::min(least, least_distance_mm(scene.shapes[i], scene.shapes[j]));
  return least;
}

std::optional<Clearance> CollisionModel::clearance(Frame frame, const Pose& pose, Occasion occasion) const {
  Scene scene = rest_;
  if (!place(frame, pose, scene)) return std::nullopt;
  return clearance(scene, occasion);
}

void CollisionModel::carry_on(Memory& memory, const Scene& scene) const {
  if (memory.apart_mm.size() != pairs_.size()) {
    memory.planes.assign(pairs_.size(), {});
    memory.apart_mm.assign(pairs_.size(), -kInfinite);
    memory.witness.resize(bodies_.size());
  }
  std::array<double, kMostBodies> moved_mm{};
  const double turned = std::abs(scene.tilt_rad - memory.tilt_rad);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].moves()) continue;
    auto& last = memory.witness[i];
    const Vec p = scene.witness[i][0] - last[0], q = scene.witness[i][1] - last[1];
    moved_mm[i] = std::sqrt(std::max(dot(p, p), dot(q, q))) + turned * bodies_[i].lever_mm + kMoved_mm;
    last = scene.witness[i];
  }
  memory.tilt_rad = scene.tilt_rad;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    memory.apart_mm[k] -= moved_mm[pairs_[k].first] + moved_mm[pairs_[k].second];
}

Clearance CollisionModel::clearance(const Scene& scene, Occasion occasion, Memory* before) const {
  constexpr double kAbove_mm = 1e-6;
  if (before != nullptr) carry_on(*before, scene);
  Clearance best{.mm = kInfinite};
  std::size_t nearest = pairs_.size();
  const auto look = [&](std::size_t k) {
    const Pair& pair = pairs_[k];
    if (pair.homing_only && occasion != Occasion::kHoming) return;
    // Of pairs as near as each other the first counts, in whatever order they are looked at.
    const auto farther = [&](double mm) { return mm > best.mm || (mm == best.mm && k >= nearest); };
    if (before != nullptr && before->apart_mm[k] > best.mm + kAbove_mm) return;
    const double least = least_distance(scene, pair);
    if (before != nullptr) before->apart_mm[k] = std::max(before->apart_mm[k], least);
    if (farther(least)) return;
    if (before != nullptr) {
      const double gap = gap_along(scene, pair, before->planes[k]);
      before->apart_mm[k] = std::max(before->apart_mm[k], gap);
      if (gap > best.mm + kAbove_mm) return;
    }
    const Parting parting = part(scene, pair, best.mm);
    if (before != nullptr) {
      before->planes[k] = parting.axis;
      before->apart_mm[k] = std::max(before->apart_mm[k], parting.mm);
    }
    double mm = parting.mm;
    if (mm == best.mm) mm = distance(scene, pair);
    if (farther(mm)) return;
    best = {mm, bodies_[pair.first].id, bodies_[pair.second].id};
    nearest = k;
  };
  const std::size_t first = before != nullptr ? before->likely : pairs_.size();
  if (first < pairs_.size()) look(first);
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (k != first) look(k);
  if (before != nullptr) before->likely = nearest;
  return best;
}

Sentence CollisionModel::name(BodyId body) const {
  switch (body.kind) {
    case BodyKind::kLeg:
      return say("leg %1", int{body.number});
    case BodyKind::kCarriage:
      return say("carriage %1", int{body.number});
    case BodyKind::kRail:
      return say("rail %1", int{body.number});
    case BodyKind::kPlatform:
      return say("platform");
    case BodyKind::kBeam:
      return say("beam");
    case BodyKind::kTable:
      return say("table");
    case BodyKind::kPart:
      return say("part on the table");
    case BodyKind::kTool:
      return mill_ ? say("tool") : say("nozzle");
    case BodyKind::kHolder:
      return mill_ ? say("spindle") : say("nozzle holder");
    case BodyKind::kFloor:
      return say("floor");
    case BodyKind::kFixed:
      break;
  }
  return Sentence::verbatim(fixed_names_[body.number - 1u]);
}

Sentence CollisionModel::words(const Clearance& c) const {
  if (c.mm <= 0) return say("%1 and %2 would touch", name(c.first), name(c.second));
  return say("%1 and %2 would come as near as %3 mm; bodies keep %4 mm apart", name(c.first), name(c.second),
             printed("%.2f", c.mm), printed("%.6g", wanted_mm_));
}

}  // namespace kinebus::bodies
