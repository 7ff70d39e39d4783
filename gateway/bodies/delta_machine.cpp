// Bodies of a linear delta. Its kinematics reduce it to the arms' lower ends, all in the tip: here they are
// where they really are, on the effector above the tip, and the towers as far outwards. Arms are pairs of
// rods.

#include <algorithm>
#include <cmath>
#include <limits>

#include "gateway/bodies/collision_model.hpp"

namespace kinebus::bodies {
namespace {

constexpr std::size_t kArms = 3;

class DeltaMachine final : public CollisionModel {
 public:
  DeltaMachine(const LinearDeltaGeometry& g, const BodiesDescription& b)
      : CollisionModel(b, false),
        effector_mm_(b.holder_radius_mm + b.rod_radius_mm + 5),
        height_mm_(b.tool_length_mm),
        arm_length_(g.arm_length_mm) {
    double table_radius = b.table_radius_mm > 0 ? b.table_radius_mm : g.limits.radius_mm;
    if (!(table_radius > 0)) table_radius = 100;
    add({BodyKind::kTable, 0}, kStill, Shape::cylinder({0, 0, -b.table_thickness_mm}, {}, table_radius));
    if (b.part_height_mm > 0)
      add({BodyKind::kPart, 0}, kStill, Shape::cylinder({}, {0, 0, b.part_height_mm}, b.part_radius_mm));
    const double offset = b.rail_offset_mm > 0 ? b.rail_offset_mm : b.rod_radius_mm + b.rail_radius_mm + 15;
    double lowest = -b.table_thickness_mm;
    for (std::size_t i = 0; i < kArms; ++i) {
      Arm& arm = arms_[i];
      const auto number = static_cast<std::uint8_t>(i + 1);
      arm.out = {std::cos(g.tower_angle_rad[i]), std::sin(g.tower_angle_rad[i]), 0};
      arm.tower = g.radius_mm * arm.out;
      arm.apart = (0.5 * b.rod_spacing_mm) * Vec{-arm.out.y, arm.out.x, 0};
      const Shape rod = Shape::capsule({}, {}, b.rod_radius_mm);
      arm.body =
          add({BodyKind::kLeg, number}, static_cast<std::uint8_t>(kFirstArmGroup + i), std::array{rod, rod});
      arm.carriage = add({BodyKind::kCarriage, number}, static_cast<std::uint8_t>(kFirstCarriageGroup + i),
                         Shape::box({}, {0, 0, 0.5 * b.carriage_length_mm}, (0.5 * offset) * arm.out,
                                    (b.carriage_width_mm / b.rod_spacing_mm) * arm.apart));
      arm.carriage_offset = (0.5 * offset) * arm.out;
      ride(arm.carriage, arm.tower + effector_mm_ * arm.out + arm.carriage_offset, {0, 0, 1});
      const Vec foot = arm.tower + (effector_mm_ + offset) * arm.out;
      const double low = g.travel_mm[i].min + height_mm_ - 0.5 * b.carriage_length_mm;
      const std::size_t rail =
          add({BodyKind::kRail, number}, kStill,
              Shape::capsule({foot.x, foot.y, std::min(low, 0.0)},
                             {foot.x, foot.y, g.travel_mm[i].max + height_mm_ + 0.5 * b.carriage_length_mm},
                             b.rail_radius_mm));
      lowest = std::min(lowest, low);
      join(arm.body, arm.carriage);
      join(arm.carriage, rail);
    }
    // The effector turns with nothing: three arms and what they hold move as one.
    effector_ = add({BodyKind::kPlatform, 0}, kEffectorGroup,
                    Shape::cylinder({0, 0, -b.platform_radius_mm}, {0, 0, b.platform_radius_mm},
                                    effector_mm_ - b.rod_radius_mm));
    for (const Arm& arm : arms_) join(arm.body, effector_);
    tool_ = add({BodyKind::kTool, 0}, kEffectorGroup,
                Shape::capsule({0, 0, b.tool_radius_mm}, {0, 0, height_mm_}, b.tool_radius_mm));
    tool_centre_ = at_rest().shapes[shape_of(tool_)].centre;
    holder_ = add({BodyKind::kHolder, 0}, kEffectorGroup,
                  Shape::cylinder({0, 0, 0}, {0, 0, b.holder_length_mm}, b.holder_radius_mm));
    holder_centre_ = Vec{0, 0, height_mm_ + 0.5 * b.holder_length_mm};
    // While the tip is inside its tower an arm leans outwards: nothing of it is nearer to the tip than its
    // lower end, seen along `out`. The holder is within its radius.
    if (g.limits.radius_mm > 0 && g.limits.radius_mm <= g.radius_mm)
      for (const Arm& arm : arms_)
        part_at_work(arm.body, holder_, effector_mm_ - b.rod_radius_mm - b.holder_radius_mm);
    add_fixed(b);
    add_floor(lowest - b.floor_mm);
    pair_up();
  }

  std::optional<Place> place_of(Frame, const Pose& pose) const override {
    return Place{{pose[kX], pose[kY], pose[kZ]}, 0, 0};
  }

  /// An arm that is h aside from its tower: its carriage moves by p - p . h / sqrt(length^2 - h^2) when the
  /// tip moves by p. Against what the tip carries and against what stands that is at most length / sqrt(...)
  /// of p; two carriages move against each other by what both fractions differ.
  double gain(const Place& place, double radius_mm) const override {
    double steepest = 0;
    for (const Arm& arm : arms_) {
      const Vec h = place.point - arm.tower;
      steepest = std::max(steepest, (std::hypot(h.x, h.y) + radius_mm) / arm_length_);
    }
    if (!(steepest < 1)) return std::numeric_limits<double>::infinity();
    return std::max(1.0, 2 * steepest) / std::sqrt(1 - steepest * steepest);
  }

  bool place(Frame, const Pose& pose, Scene& scene) const override {
    const Vec tip{pose[kX], pose[kY], pose[kZ]};
    const auto move = [&](std::size_t body, const Vec& from_tip) {
      scene.shapes[shape_of(body)].centre = tip + from_tip;
      scene.witness[body] = {tip, tip};
    };
    move(effector_, {0, 0, height_mm_});
    move(tool_, tool_centre_);
    move(holder_, holder_centre_);
    for (const Arm& arm : arms_) {
      const double hx = tip.x - arm.tower.x, hy = tip.y - arm.tower.y;
      const double radicand = arm_length_ * arm_length_ - hx * hx - hy * hy;
      if (!(radicand > 0)) return false;
      const Vec low = tip + effector_mm_ * arm.out + Vec{0, 0, height_mm_};
      const Vec high =
          arm.tower + effector_mm_ * arm.out + Vec{0, 0, tip.z + std::sqrt(radicand) + height_mm_};
      Shape* rods = &scene.shapes[shape_of(arm.body)];
      rods[0].span(low + arm.apart, high + arm.apart);
      rods[1].span(low - arm.apart, high - arm.apart);
      scene.witness[arm.body] = {low, high};
      scene.shapes[shape_of(arm.carriage)].centre = high + arm.carriage_offset;
      scene.witness[arm.carriage] = {high, high};
    }
    return true;
  }

 private:
  static constexpr std::uint8_t kEffectorGroup = 1, kFirstCarriageGroup = 2, kFirstArmGroup = 5;
  struct Arm {
    Vec out, tower, apart, carriage_offset;
    std::size_t body = 0, carriage = 0;
  };
  double effector_mm_;  ///< from the tool's axis to the arms' lower ends
  double height_mm_;    ///< of the effector above the tip
  double arm_length_;
  std::array<Arm, kArms> arms_{};
  std::size_t effector_ = 0, tool_ = 0, holder_ = 0;
  Vec tool_centre_{}, holder_centre_{};
};

}  // namespace

Model make_model(const LinearDeltaGeometry& geometry, const BodiesDescription& bodies) {
  return std::make_unique<DeltaMachine>(geometry, bodies);
}

}  // namespace kinebus::bodies
