// Bodies of Cartesian and CoreXY machines: tool and holder over a bed, or over a table that tilts and turns.

#include <algorithm>
#include <cmath>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus::bodies {
namespace {

class CartesianMachine final : public CollisionModel {
 public:
  CartesianMachine(const CartesianGeometry& g, const BodiesDescription& b)
      : CollisionModel(b, false), turns_(g.has_table), pivot_{g.table.pivot_mm} {
    const auto middle = [](const Interval& i) { return 0.5 * (i.min + i.max); };
    const auto half = [](const Interval& i) { return std::max(0.5 * (i.max - i.min), 1.0); };
    const std::uint8_t group = turns_ ? kTableGroup : kStill;
    const double radius = b.table_radius_mm > 0 ? b.table_radius_mm : std::min(half(g.x_mm), half(g.y_mm));
    const double reach = norm({pivot_[0], pivot_[1], pivot_[2]});
    const Shape bed =
        turns_ || b.table_radius_mm > 0
            ? Shape::cylinder({0, 0, -b.table_thickness_mm}, {}, radius)
            : Shape::box({middle(g.x_mm), middle(g.y_mm), -0.5 * b.table_thickness_mm}, {half(g.x_mm), 0, 0},
                         {0, half(g.y_mm), 0}, {0, 0, 0.5 * b.table_thickness_mm});
    table_ = add({BodyKind::kTable, 0}, group, bed, reach + std::hypot(radius, b.table_thickness_mm));
    if (b.part_height_mm > 0)
      part_ =
          add({BodyKind::kPart, 0}, group, Shape::cylinder({}, {0, 0, b.part_height_mm}, b.part_radius_mm),
              reach + std::hypot(b.part_radius_mm, b.part_height_mm));
    const Vec collet{0, 0, b.tool_length_mm};
    tool_ = add({BodyKind::kTool, 0}, kToolGroup,
                Shape::capsule({0, 0, b.tool_radius_mm}, collet, b.tool_radius_mm));
    holder_ = add({BodyKind::kHolder, 0}, kToolGroup,
                  Shape::cylinder(collet, collet + Vec{0, 0, b.holder_length_mm}, b.holder_radius_mm));
    add_fixed(b);
    // A table that tilts swings below its own plane.
    const double swing = turns_ ? radius + std::abs(pivot_[2]) : 0;
    add_floor(-b.table_thickness_mm - swing - b.floor_mm);
    pair_up();
    for (const Body& body : bodies()) longest_lever_ = std::max(longest_lever_, body.lever_mm);
  }

  /// No bound where C takes the table's disc around with it.
  std::optional<Place> place_of(Frame frame, const Pose& pose) const override {
    const Vec tip = tip_of(frame, pose);
    if (!turns_) return Place{tip, 0, 0};
    if (pivot_[0] != 0 || pivot_[1] != 0) return std::nullopt;
    return Place{tip, 2 * longest_lever_ * pose[kA], longest_lever_};
  }
  double gain(const Place&, double) const override { return 1; }

  bool place(Frame frame, const Pose& pose, Scene& scene) const override {
    const Vec tip = tip_of(frame, pose);
    for (const std::size_t body : {tool_, holder_}) {
      scene.shapes[shape_of(body)].centre = tip + at_rest().shapes[shape_of(body)].centre;
      scene.witness[body] = {tip, tip};
    }
    if (!turns_) return true;
    scene.tilt_rad = pose[kA];
    const TableTurn turn(pose);
    const auto set_disc = [&](std::size_t body) {
      const Shape& home = at_rest().shapes[shape_of(body)];
      Shape& s = scene.shapes[shape_of(body)];
      s.centre = carried(turn, home.centre);
      s.half[0] = turn(home.half[0]);
      s.axis = turn(home.axis);
      scene.witness[body] = {s.centre, s.centre};
    };
    set_disc(table_);
    if (part_) set_disc(*part_);
    return true;
  }

 private:
  static constexpr std::uint8_t kTableGroup = 1, kToolGroup = 2;
  struct TableTurn {
    explicit TableTurn(const Pose& pose) : a(pose[kA]), c(pose[kC]) {}
    Vec operator()(const Vec& v) const {
      const Vector3 t = turn_x(a, turn_z(c, {v.x, v.y, v.z}));
      return {t[0], t[1], t[2]};
    }
    Turn a, c;
  };
  Vec carried(const TableTurn& turn, const Vec& v) const {
    const Vec pivot{pivot_[0], pivot_[1], pivot_[2]};
    return pivot + turn(v - pivot);
  }
  Vec tip_of(Frame frame, const Pose& pose) const {
    const Vec tip{pose[kX], pose[kY], pose[kZ]};
    return frame == Frame::kPart && turns_ ? carried(TableTurn(pose), tip) : tip;
  }

  bool turns_;
  Vector3 pivot_;
  double longest_lever_ = 1;  ///< of what turns with the table
  std::size_t table_ = 0, tool_ = 0, holder_ = 0;
  std::optional<std::size_t> part_;
};

}  // namespace

Model make_model(const CartesianGeometry& geometry, const BodiesDescription& bodies) {
  return std::make_unique<CartesianMachine>(geometry, bodies);
}
Model make_model(const CoreXyGeometry& geometry, const BodiesDescription& bodies) {
  CartesianGeometry same;
  same.x_mm = geometry.x_mm;
  same.y_mm = geometry.y_mm;
  same.z_mm = geometry.z_mm;
  return std::make_unique<CartesianMachine>(same, bodies);
}

}  // namespace kinebus::bodies
