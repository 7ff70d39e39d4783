// Bodies of M4, all around its YZ plane. In the plane: rails, blocks, rods, the triangle, and the spindle
// through it. The third input's beam runs along Y behind the plane, where rods and triangle pass it.

#include <algorithm>
#include <cmath>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus::bodies {
namespace {

class M4Machine final : public CollisionModel {
 public:
  M4Machine(const M4Geometry& g, const BodiesDescription& b) : CollisionModel(b, true), g_(g) {
    const double half = g.triangle_mm / 2, c = std::cos(g.spindle_rad), s = std::sin(g.spindle_rad);
    const double height = std::numbers::sqrt3 * half;
    corner_ = {{{0, -half * c, g.tool_mm - half * s},
                {0, half * c, g.tool_mm + half * s},
                {0, -height * s, g.tool_mm + height * c}}};
    offset_ = b.rail_offset_mm > 0 ? b.rail_offset_mm : b.rod_radius_mm + b.rail_radius_mm + 15;
    double table_radius = b.table_radius_mm > 0 ? b.table_radius_mm : g.limits.radius_mm;
    if (!(table_radius > 0)) table_radius = 100;
    table_ = add({BodyKind::kTable, 0}, kTableGroup,
                 Shape::cylinder({0, 0, -b.table_thickness_mm}, {}, table_radius));
    table_centre_ = at_rest().shapes[shape_of(table_)].centre;
    if (b.part_height_mm > 0) {
      part_ = add({BodyKind::kPart, 0}, kTableGroup,
                  Shape::cylinder({}, {0, 0, b.part_height_mm}, b.part_radius_mm));
      part_centre_ = at_rest().shapes[shape_of(*part_)].centre;
    }
    double lowest = g.table_z_mm - b.table_thickness_mm;
    const Shape rod = Shape::capsule({}, {}, b.rod_radius_mm);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto number = static_cast<std::uint8_t>(i + 1);
      const double side = i == 0 ? -1 : 1, y = side * g.rails_mm / 2;
      Side& at = sides_[i];
      at.y = y;
      at.rod = add({BodyKind::kLeg, number}, static_cast<std::uint8_t>(kFirstRodGroup + i), rod);
      at.block_offset = {0, 0.5 * side * offset_, 0};
      at.block = add({BodyKind::kCarriage, number}, static_cast<std::uint8_t>(kFirstBlockGroup + i),
                     Shape::box({}, {0.5 * b.carriage_width_mm, 0, 0}, at.block_offset,
                                {0, 0, 0.5 * b.carriage_length_mm}));
      ride(at.block, Vec{0, y, 0} + at.block_offset, {0, 0, 1});
      const double low = g.travel_mm[i].min - 0.5 * b.carriage_length_mm;
      const std::size_t rail =
          add({BodyKind::kRail, number}, kStill,
              Shape::capsule({0, y + side * offset_, std::min(low, lowest)},
                             {0, y + side * offset_, g.travel_mm[i].max + 0.5 * b.carriage_length_mm},
                             b.rail_radius_mm));
      lowest = std::min(lowest, low);
      join(at.rod, at.block);
      join(at.block, rail);
    }
    // Behind the spindle: what rides on it leads forward to corner C.
    beam_x_ = -(b.holder_radius_mm + b.rail_radius_mm + 15);
    beam_ =
        add({BodyKind::kBeam, 0}, kBeamGroup,
            Shape::capsule({beam_x_, -g.rails_mm / 2, 0}, {beam_x_, g.rails_mm / 2, 0}, b.rail_radius_mm));
    const double lever = norm(corner_[2]) + g.triangle_mm;
    for (std::size_t k = 0; k < 3; ++k)
      edges_[k] =
          add({BodyKind::kPlatform, 0}, kSpindleGroup, Shape::capsule({}, {}, b.platform_radius_mm), lever);
    for (std::size_t i = 0; i < 2; ++i)
      for (const std::size_t edge : edges_) join(sides_[i].rod, edge);
    for (const std::size_t edge : edges_) join(beam_, edge);
    tool_mm_ = b.tool_length_mm;
    tool_radius_ = b.tool_radius_mm;
    holder_mm_ = b.holder_length_mm;
    tool_ = add({BodyKind::kTool, 0}, kSpindleGroup,
                Shape::capsule({0, 0, tool_radius_}, {0, 0, tool_mm_}, tool_radius_), tool_mm_);
    holder_ = add({BodyKind::kHolder, 0}, kSpindleGroup,
                  Shape::cylinder({0, 0, tool_mm_}, {0, 0, tool_mm_ + holder_mm_}, b.holder_radius_mm),
                  tool_mm_ + holder_mm_ + b.holder_radius_mm);
    // The spindle is held between A and B: rods end at it.
    for (const Side& side : sides_) join(side.rod, holder_);
    add_fixed(b);
    add_floor(lowest - b.floor_mm);
    pair_up();
  }

  bool place(Frame frame, const Pose& pose, Scene& scene) const override {
    Vector3 v{pose[kX], pose[kY], pose[kZ]};
    v = frame == Frame::kPart ? turn_z(Turn(pose[kC]), v) : turn_x(Turn(-pose[kA]), v);
    const Turn tilt(-pose[kA]);
    const auto turned = [&tilt](const Vec& r) {
      return Vec{r.x, tilt.c * r.y - tilt.s * r.z, tilt.s * r.y + tilt.c * r.z};
    };
    scene.tilt_rad = pose[kA];
    const Vec tip{0, g_.table_y_mm + v[1], g_.table_z_mm + v[2]};
    const Vec table{-v[0], g_.table_y_mm, g_.table_z_mm};
    const auto put = [&](std::size_t body, const Vec& centre) {
      scene.shapes[shape_of(body)].centre = centre;
      scene.witness[body] = {centre, centre};
    };
    put(table_, table + table_centre_);
    if (part_) put(*part_, table + part_centre_);
    std::array<Vec, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = tip + turned(corner_[k]);
    for (std::size_t i = 0; i < 2; ++i) {
      const Side& side = sides_[i];
      const double h = corner[i].y - side.y, radicand = g_.rod_mm * g_.rod_mm - h * h;
      if (!(radicand > 0)) return false;
      const Vec block{0, side.y, corner[i].z + std::sqrt(radicand)};
      scene.shapes[shape_of(side.rod)].span(block, corner[i]);
      scene.witness[side.rod] = {block, corner[i]};
      scene.shapes[shape_of(side.block)].centre = block + side.block_offset;
      scene.witness[side.block] = {block, block};
    }
    put(beam_, {beam_x_, 0, corner[2].z});
    for (std::size_t k = 0; k < 3; ++k)
      scene.shapes[shape_of(edges_[k])].span(corner[k], corner[(k + 1) % 3]);
    scene.shapes[shape_of(tool_)].span(tip + turned({0, 0, tool_radius_}), tip + turned({0, 0, tool_mm_}));
    Shape& holder = scene.shapes[shape_of(holder_)];
    holder.centre = tip + turned({0, 0, tool_mm_ + 0.5 * holder_mm_});
    holder.half[0] = turned({0, 0, 0.5 * holder_mm_});
    holder.axis = turned({0, 0, 1});
    for (const std::size_t body : {edges_[0], edges_[1], edges_[2], tool_, holder_})
      scene.witness[body] = {tip, tip};
    return true;
  }

 private:
  static constexpr std::uint8_t kTableGroup = 1, kSpindleGroup = 2, kBeamGroup = 3, kFirstRodGroup = 4,
                                kFirstBlockGroup = 6;
  struct Side {
    double y = 0;
    Vec block_offset{};
    std::size_t rod = 0, block = 0;
  };
  M4Geometry g_;
  std::array<Vec, 3> corner_{};  ///< A, B, C from the tip, tool upright
  double offset_ = 0, beam_x_ = 0, tool_mm_ = 0, tool_radius_ = 0, holder_mm_ = 0;
  std::array<Side, 2> sides_{};
  std::size_t table_ = 0, beam_ = 0, tool_ = 0, holder_ = 0;
  std::array<std::size_t, 3> edges_{};
  std::optional<std::size_t> part_;
  Vec table_centre_{}, part_centre_{};
};

}  // namespace

Model make_model(const M4Geometry& geometry, const BodiesDescription& bodies) {
  return std::make_unique<M4Machine>(geometry, bodies);
}

}  // namespace kinebus::bodies
