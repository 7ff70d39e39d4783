// Bodies of M1 and M5. Legs are pairs of rods, apart along X, about which alone the platform turns. The
// platform is a star of arms, one to each leg: below the table that it carries, or at the attachments'
// height behind its tool. What it does not carry of table and tool stands in the frame. Rails stand outside
// their legs' joints, carriages reach from one to the other.

#include <algorithm>
#include <cmath>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/kinematics/table_rotation.hpp"
#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus::bodies {
namespace {

constexpr std::size_t kLegs = 4;

Vec vec(const Vector3& v) {
  return {v[0], v[1], v[2]};
}

class LegMachine final : public CollisionModel {
 public:
  LegMachine(const M1Geometry& g, const BodiesDescription& b, bool mill)
      : CollisionModel(b, mill),
        g_(g),
        carries_tool_(g.tool == ToolPlacement::kPlatform),
        half_spacing_(0.5 * b.rod_spacing_mm) {
    Vec middle{};
    for (std::size_t i = 0; i < kLegs; ++i) {
      const M1Leg& leg = g.legs[i];
      const double rail_length = norm(vec(leg.rail));
      legs_[i] = {.foot = vec(leg.foot_mm),
                  .rail = (1 / rail_length) * vec(leg.rail),
                  .attachment = vec(leg.attachment_mm),
                  .length = leg.length_mm,
                  .connector = leg.connector_mm,
                  .branch = leg.carriage_above ? 1.0 : -1.0};
      middle = middle + (1.0 / kLegs) * legs_[i].foot;
    }
    const double offset =
        b.rail_offset_mm > 0 ? b.rail_offset_mm : half_spacing_ + b.rod_radius_mm + b.rail_radius_mm + 15;
    double table_radius = b.table_radius_mm > 0 ? b.table_radius_mm : g.limits.radius_mm;
    if (!(table_radius > 0)) table_radius = 100;
    const Vec tip = vec(g.nozzle_mm), table = vec(g.table_mm), table_foot{0, 0, -b.table_thickness_mm};
    add_table(BodyKind::kTable, Shape::cylinder(table + table_foot, table, table_radius),
              std::hypot(table_radius, b.table_thickness_mm));
    if (b.part_height_mm > 0)
      add_table(BodyKind::kPart,
                Shape::cylinder(table, table + Vec{0, 0, b.part_height_mm}, b.part_radius_mm),
                std::hypot(b.part_radius_mm, b.part_height_mm));
    double floor_z = carries_tool_ ? table.z - b.table_thickness_mm : tip.z;
    for (std::size_t i = 0; i < kLegs; ++i) {
      Leg& leg = legs_[i];
      const auto number = static_cast<std::uint8_t>(i + 1);
      leg.arm_end = leg.attachment;
      if (!carries_tool_) leg.arm_end.z = -b.table_thickness_mm - b.platform_radius_mm;
      leg.arm =
          add({BodyKind::kPlatform, 0}, kPlatformGroup,
              Shape::capsule({0, 0, leg.arm_end.z}, leg.arm_end, b.platform_radius_mm), norm(leg.arm_end));
      // Rods, and the connector from them to the attachment. Placed with the pose.
      const auto rod = [&b](double length) { return Shape::capsule({}, {0, 0, length}, b.rod_radius_mm); };
      leg.body = add({BodyKind::kLeg, number}, static_cast<std::uint8_t>(kFirstLegGroup + i),
                     std::array{rod(leg.length), rod(leg.length), rod(leg.connector)});
      const Vec out_of_middle = leg.foot - middle;
      Vec out = out_of_middle - dot(out_of_middle, leg.rail) * leg.rail;
      if (!(norm(out) > 1)) out = {1, 0, 0};
      out = (1 / norm(out)) * out;
      const Vec half_out = (0.5 * offset) * out, half_along = (0.5 * b.carriage_length_mm) * leg.rail;
      leg.carriage_offset = half_out;
      leg.carriage =
          add({BodyKind::kCarriage, number}, static_cast<std::uint8_t>(kFirstCarriageGroup + i),
              Shape::box({}, half_along, half_out, (0.5 * b.carriage_width_mm) * cross(leg.rail, out)));
      ride(leg.carriage, leg.foot + half_out, leg.rail);
      const Interval travel = g.legs[i].travel_mm;
      const Vec low = leg.foot + offset * out + travel.min * leg.rail - half_along,
                high = leg.foot + offset * out + travel.max * leg.rail + half_along;
      leg.rail_body = add({BodyKind::kRail, number}, kStill, Shape::capsule(low, high, b.rail_radius_mm));
      floor_z = std::min({floor_z, low.z, high.z});
      join(leg.body, leg.carriage);
      join(leg.body, leg.arm);
      join(leg.carriage, leg.rail_body);
    }
    const Vec collet = tip + Vec{0, 0, b.tool_length_mm}, end = collet + Vec{0, 0, b.holder_length_mm};
    add_tool(BodyKind::kTool, Shape::capsule(tip + Vec{0, 0, b.tool_radius_mm}, collet, b.tool_radius_mm),
             std::max(norm(tip), norm(collet)));
    add_tool(BodyKind::kHolder, Shape::cylinder(collet, end, b.holder_radius_mm),
             std::max(norm(collet), norm(end)) + b.holder_radius_mm);
    add_fixed(b);
    add_floor(floor_z - b.floor_mm);
    pair_up();
    for (const Body& body : this->bodies())
      if (body.group == kPlatformGroup) longest_lever_ = std::max(longest_lever_, body.lever_mm);
    for (const Leg& leg : legs_) {
      longest_lever_ = std::max(longest_lever_, norm(leg.attachment));
      parallel_ = parallel_ && norm(cross(leg.rail, legs_[0].rail)) < 1e-12;
    }
  }

  std::optional<Place> place_of(Frame frame, const Pose& pose) const override {
    const double tilt = platform_tilt(g_, pose);
    return Place{vec(platform_at(g_, frame, pose, Turn(tilt))), 2 * longest_lever_ * tilt, longest_lever_};
  }

  /// With p the joint at a leg's end, s of it aside from the rail: the carriage moves by p + p . s / h along
  /// the rail, h^2 = length^2 - s^2. Against the platform that is at most length / h of p; two carriages on
  /// parallel rails move against each other by what s / h differ. A turn moves both of a pair, so it counts
  /// twice.
  double gain(const Place& place, double radius_mm) const override {
    const Turn a(place.turn_mm / (2 * longest_lever_));
    double steepest = 0;
    for (const Leg& leg : legs_) {
      const Vec s = place.point + turned(a, leg.attachment) - leg.foot;
      const double u = dot(s, leg.rail);
      const double aside = std::sqrt(std::max(0.0, dot(s, s) - u * u)) + radius_mm;
      steepest = std::max(steepest, aside / leg.length);
    }
    if (!(steepest < 1)) return std::numeric_limits<double>::infinity();
    const double upright = std::sqrt(1 - steepest * steepest);
    return parallel_ ? std::max(1.0, 2 * steepest) / upright : 2 / upright;
  }

  bool place(Frame frame, const Pose& pose, Scene& scene) const override {
    const double tilt = platform_tilt(g_, pose);
    const Turn a(tilt);
    const Vec p = vec(platform_at(g_, frame, pose, a));
    scene.tilt_rad = tilt;
    for (std::size_t i = 0; i < carried_count_; ++i) {
      const auto& [body, home] = carried_[i];
      Shape& s = scene.shapes[shape_of(body)];
      s.centre = p + turned(a, home.centre);
      s.half[0] = turned(a, home.half[0]);
      s.axis = turned(a, home.axis);
      scene.witness[body] = {p, p};
    }
    for (const Leg& leg : legs_) {
      const Vec joint = p + turned(a, leg.attachment), s = joint - leg.foot;
      const double u = dot(s, leg.rail), radicand = leg.length * leg.length - dot(s, s) + u * u;
      if (!(radicand > 0)) return false;
      const Vec end = joint - leg.connector * leg.rail,
                carriage = leg.foot + (u + leg.branch * std::sqrt(radicand) - leg.connector) * leg.rail;
      Shape* rods = &scene.shapes[shape_of(leg.body)];
      const Vec apart{half_spacing_, 0, 0};
      rods[0].lay(carriage + apart, end + apart);
      rods[1].lay(carriage - apart, end - apart);
      rods[2].lay(end, joint);
      scene.witness[leg.body] = {carriage, joint};
      scene.shapes[shape_of(leg.carriage)].centre = carriage + leg.carriage_offset;
      scene.witness[leg.carriage] = {carriage, carriage};
      const Vec hub = turned(a, {0, 0, leg.arm_end.z});
      scene.shapes[shape_of(leg.arm)].lay(p + hub, p + turned(a, leg.arm_end));
      scene.witness[leg.arm] = {p, p};
    }
    return true;
  }

 private:
  static constexpr std::uint8_t kPlatformGroup = 1, kFirstCarriageGroup = 2, kFirstLegGroup = 6;
  struct Leg {
    Vec foot, rail, attachment;
    double length = 0, connector = 0, branch = 1;
    Vec carriage_offset{}, arm_end{};
    std::size_t body = 0, carriage = 0, rail_body = 0, arm = 0;
  };
  static Vec turned(const Turn& a, const Vec& v) {
    return {v.x, a.c * v.y - a.s * v.z, a.s * v.y + a.c * v.z};
  }
  /// Rides on the platform, where it is at `home` in the platform's frame.
  struct Carried {
    std::size_t body = 0;
    Shape home{};
  };

  /// `place`: in the frame of what holds it. `lever_mm`: about the platform's zero, when that does.
  void add_held(bool carried, BodyKind kind, const Shape& place, double lever_mm) {
    const std::size_t body = add({kind, 0}, carried ? kPlatformGroup : kStill, place, carried ? lever_mm : 0);
    if (carried) carried_[carried_count_++] = {body, place};
  }
  void add_table(BodyKind kind, const Shape& place, double lever_mm) {
    add_held(!carries_tool_, kind, place, lever_mm);
  }
  void add_tool(BodyKind kind, const Shape& place, double lever_mm) {
    add_held(carries_tool_, kind, place, lever_mm);
  }

  M1Geometry g_;
  bool carries_tool_;
  double half_spacing_;
  double longest_lever_ = 1;  ///< of what turns with the platform
  bool parallel_ = true;      ///< rails
  std::array<Leg, kLegs> legs_{};
  std::array<Carried, 2> carried_{};
  std::size_t carried_count_ = 0;
};

}  // namespace

Model make_model(const M1Geometry& geometry, const BodiesDescription& bodies) {
  return std::make_unique<LegMachine>(geometry, bodies, false);
}
Model make_model(const M5Geometry& geometry, const BodiesDescription& bodies) {
  return std::make_unique<LegMachine>(geometry, bodies, true);
}

}  // namespace kinebus::bodies
