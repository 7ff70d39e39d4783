#include "gateway/description/machine_homing.hpp"

#include <algorithm>
#include <utility>

#include "gateway/description/bodies_rules.hpp"

namespace kinebus {
namespace {

/// The mechanism alone: no workspace, and joints that may stand as far behind their switches as they overrun
/// them, and at their other end as far as they first go off a stop.
MachineDescription mechanism_of(const MachineDescription& d) {
  MachineDescription free = d;
  std::vector<Interval> travel;
  for (const JointDescription& j : d.joints) travel.push_back(j.travel);
  for (const homing::Joint& j : homing_joints(d)) {
    Interval& t = travel[j.joint];
    if (!t.limited()) continue;
    const double end = j.switch_position + j.direction() * 2 * j.overrun();
    const double other = (j.positive ? t.min : t.max) - j.direction() * j.back_off;
    t = {std::min({t.min, end, other}), std::max({t.max, end, other})};
  }
  const auto widen = [](PoseLimits& limits) {
    limits.x_mm = limits.y_mm = limits.z_mm = {};
    limits.radius_mm = 0;
  };
  struct Free {
    const std::vector<Interval>& travel;
    decltype(widen)& widen_limits;
    void operator()(M1Geometry& g) const {
      for (std::size_t i = 0; i < g.legs.size(); ++i) g.legs[i].travel_mm = travel[i];
      widen_limits(g.limits);
    }
    void operator()(M4Geometry& g) const {
      for (std::size_t i = 0; i < g.travel_mm.size(); ++i) g.travel_mm[i] = travel[i];
      g.table_travel_mm = travel[g.travel_mm.size()];
      widen_limits(g.limits);
      // The tilt's limits are those of work. Its rods stand well up to this much farther.
      constexpr double kTilt_rad = 20 * kRadPerDeg;
      g.limits.a_rad.min -= kTilt_rad;
      g.limits.a_rad.max += kTilt_rad;
    }
    void operator()(LinearDeltaGeometry& g) const {
      for (std::size_t i = 0; i < g.travel_mm.size(); ++i) g.travel_mm[i] = travel[i];
      widen_limits(g.limits);
    }
    void operator()(CartesianGeometry& g) const {
      g.x_mm = travel[0];
      g.y_mm = travel[1];
      g.z_mm = travel[2];
    }
    void operator()(CoreXyGeometry& g) const { g.z_mm = travel[2]; }
  };
  std::visit(Free{travel, widen}, free.kinematics);
  return free;
}

}  // namespace

std::vector<homing::Joint> homing_joints(const MachineDescription& description) {
  std::vector<homing::Joint> joints;
  for (std::size_t i = 0; i < description.joints.size() && i < kMaxJoints; ++i) {
    const JointDescription& joint = description.joints[i];
    if (!joint.homing) continue;
    const HomingDescription& h = *joint.homing;
    joints.push_back({.joint = i,
                      .node = joint.node_id,
                      .moves = h.method != 37,
                      .positive = h.towards_positive(),
                      .entering = h.method == 20 || h.method == 22 || h.by_load(),
                      .fast_per_s = h.fast_per_s,
                      .slow_per_s = h.slow_per_s,
                      .accel_per_s2 = h.accel_per_s2,
                      .switch_position = h.switch_position,
                      .order = h.order,
                      .back_off = h.by_load() ? h.back_off : 0});
  }
  return joints;
}

homing::Plan homing_plan(const MachineDescription& description, const Kinematics& kinematics) {
  return homing::make_plan(kinematics, homing_joints(description));
}

HomingStudy::HomingStudy(const MachineDescription& description) {
  auto kinematics = make_kinematics(description);
  auto mechanism = make_kinematics(mechanism_of(description));
  if (kinematics) kinematics_ = std::move(*kinematics);
  // What the wider travel makes impossible is judged within the travel.
  mechanism_ = mechanism ? std::move(*mechanism) : std::move(*make_kinematics(description));
  machine_.kinematics = kinematics_.get();
  machine_.mechanism = mechanism_.get();
  machine_.joints = homing_joints(description);
  for (std::size_t i = 0; i < description.joints.size() && i < kMaxJoints; ++i)
    machine_.travel[i] = description.joints[i].travel;
  if (const PoseLimits* limits = pose_limits(description.kinematics)) machine_.limits = *limits;
  plan_ = homing::make_plan(*kinematics_, machine_.joints);
  if (!description.bodies) return;
  const BodiesDescription& b = *description.bodies;
  const double widest = b.table_radius_mm > 0           ? b.table_radius_mm
                        : machine_.limits.radius_mm > 0 ? machine_.limits.radius_mm
                                                        : 100;
  const double highest = machine_.limits.z_mm.limited() ? machine_.limits.z_mm.max : 100;
  machine_.part_radius_mm = b.part_radius_mm > 0 ? b.part_radius_mm : widest;
  machine_.part_height_mm = b.part_height_mm > 0 ? b.part_height_mm : highest;
  bare_.kinematics = description.kinematics;
  bare_.geometry_calibration = description.geometry_calibration;
  bare_.bodies = description.bodies;
  machine_.bodies = [this](double radius, double height, bool carrier) {
    MachineDescription with_part = bare_;
    with_part.bodies->part_radius_mm = height > 0 ? radius : 0;
    with_part.bodies->part_height_mm = height > 0 ? height : 0;
    // Where the tool is fixed to the frame, which hangs it from above.
    constexpr double kCarrier_mm = 1000;
    const M1Geometry* legs = std::get_if<M1Geometry>(&bare_.kinematics);
    if (const auto* m5 = std::get_if<M5Geometry>(&bare_.kinematics)) legs = m5;
    const bool hangs = legs != nullptr && legs->tool == ToolPlacement::kFrame;
    if (carrier && hangs) with_part.bodies->holder_length_mm += kCarrier_mm;
    return make_collision_model(with_part);
  };
}

void HomingStudy::set_part(double radius_mm, double height_mm) {
  machine_.part_radius_mm = radius_mm;
  machine_.part_height_mm = height_mm;
}

void judge_homing(const MachineDescription& description, std::vector<BrokenRule>& broken) {
  bool moves = false, stated = false, derived = false;
  std::vector<std::string> orders, keys;
  for (const JointDescription& joint : description.joints) {
    if (!joint.homing) continue;
    const std::string key = "joint." + joint.name + ".homing";
    (joint.homing->order != 0 ? stated : derived) = true;
    orders.push_back(key + ".order");
    keys.push_back(key + ".method");
    moves = moves || joint.homing->method != 37;
  }
  if (stated && derived) {
    broken.push_back({std::move(orders), say("an order of some joints"),
                      say("an order for every joint that homes, or for none: then it follows from the "
                          "kinematics")});
    return;
  }
  if (!moves) return;
  judge_load_homing(description, broken);
  if (!description.bodies || !broken.empty()) return;
  HomingStudy study(description);
  const double stated_mm = description.bodies->part_height_mm;
  const double spared_mm = description.homing.spared_part_mm;
  const auto look = [&](double height_mm, std::size_t corners) {
    constexpr int kStarts = 8, kAttempts = 12;
    study.set_part(study.machine().part_radius_mm, height_mm);
    constexpr homing::Walker::Density kCoarse{.least_mm = 2, .most_mm = 25, .most_poses = 100};
    return homing::survey(study.machine(), study.plan(), 1, kStarts, kCoarse, kAttempts,
                          height_mm > 0 ? corners : 0);  // it is a part that corners are about
  };
  // Fewer corners for what is only stated: this is done whenever a file is read.
  homing::Survey found = stated_mm > 0 ? look(stated_mm, 32) : look(spared_mm, 8);
  bool about_spared = found.failure && !(stated_mm > 0) && spared_mm > 0;
  if (about_spared)
    if (homing::Survey without = look(0, 0); without.failure) {
      found = std::move(without);
      about_spared = false;
    }
  if (!found.failure) return;
  const auto& [start, way] = *found.failure;
  if (about_spared) keys = {"homing.spared_part_mm"};
  keys.insert(keys.end(), {"bodies", "kinematics"});
  Sentence words = way.end == homing::Way::End::kTouches
                       ? say("homing that is not safe: begun at %1, at %2 %3", pose_text(start.pose),
                             pose_text(way.at), start.model->words(way.nearest))
                       : say("homing that is not safe: begun at %1, from %2 on the mechanism cannot follow",
                             pose_text(start.pose), pose_text(way.at));
  broken.push_back({std::move(keys), std::move(words),
                    about_spared
                        ? say("a lower part than %1 mm: see kinebus plan --home", printed("%.6g", spared_mm))
                        : say("switches that can be reached from everywhere: see kinebus plan --home")});
}

}  // namespace kinebus
