#include "gateway/homing/way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinebus::homing {
namespace {

/// What distances are known to, mm (bodies/shape.hpp), with room.
constexpr double kRounding_mm = 5e-3;
/// Bodies as near as this touch: what lies between two poses is looked at no more closely.
constexpr double kTouch_mm = 0.2;
/// From the first switch of a lift until all have been told to halt: a statusword and two controlwords, and
/// what bus_nodes/homing.cpp lets pass before it believes the first statusword.
constexpr double kReaction_s = 0.1;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

Walker::Walker(const Kinematics& kinematics, const Plan& plan, const bodies::CollisionModel* model,
               Density density)
    : kinematics_(kinematics), plan_(plan), model_(model), density_(density) {
  if (model_ == nullptr) return;
  scene_ = model_->at_rest();
  for (const auto& pair : model_->pairs())
    if (pair.homing_only) partings_.push_back({.pair = pair});
}

Walker::Room Walker::room(const Pose& pose) const {
  if (model_ == nullptr) return {kInfinite, kInfinite, kInfinite};
  bodies::Scene scene = model_->at_rest();
  if (!model_->place(Frame::kMachine, pose, scene)) return {};
  Room room{model_->clearance(scene).mm, kInfinite, kInfinite};
  for (const Parting& p : partings_) {
    const auto is_holder = [&](std::size_t body) {
      return model_->bodies()[body].id.kind == bodies::BodyKind::kHolder;
    };
    double& nearest = is_holder(p.pair.first) || is_holder(p.pair.second) ? room.holder_mm : room.tool_mm;
    nearest = std::min(nearest, model_->distance(scene, p.pair));
  }
  return room;
}

Way Walker::walk(JointVector joints, Pose pose) {
  Way way{.nearest = {.mm = kInfinite}, .at = pose};
  pose_ = pose;
  if (model_ != nullptr && model_->place(Frame::kMachine, pose, scene_))
    for (Parting& p : partings_) {
      p.start_mm = model_->distance(scene_, p.pair);
      p.apart = p.start_mm >= model_->wanted_mm();
    }
  if (!look(joints, way)) return way;
  for (const Stage& stage : plan_.stages) {
    if (!go_free(stage, joints, way)) return way;
    note_spread(stage, joints, way);
    if (!lift(stage, joints, way) || !seek(stage, joints, way) || !leave(stage, joints, way)) return way;
  }
  return way;
}

/// The pose of these joints, near the last one; false: the way ends here.
bool Walker::look(const JointVector& joints, Way& way) {
  Pose pose = pose_;
  if (!kinematics_.forward(Frame::kMachine, joints, pose)) {
    way.end = Way::End::kNotClosed;
    way.at = pose_;
    return false;
  }
  pose_ = pose;
  way.worst_condition = std::max(way.worst_condition, kinematics_.condition(Frame::kMachine, pose));
  if (model_ == nullptr) return true;
  if (!model_->place(Frame::kMachine, pose, scene_)) {
    way.end = Way::End::kNotClosed;
    way.at = pose;
    return false;
  }
  return judge(way);
}

bool Walker::passes(const JointVector& from, Pose pose, const JointVector& to, double step) {
  double longest = 0;
  for (std::size_t j = 0; j < from.size(); ++j) longest = std::max(longest, std::abs(to[j] - from[j]));
  const int steps = std::max(1, static_cast<int>(std::ceil(longest / step)));
  for (int n = 0; n <= steps; ++n) {
    JointVector q = from;
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += (to[j] - from[j]) * n / steps;
    if (!kinematics_.forward(Frame::kMachine, q, pose)) return false;
    if (model_ == nullptr) continue;
    if (!model_->place(Frame::kMachine, pose, scene_)) return false;
    if (model_->clearance(scene_, bodies::Occasion::kMotion, &before_).mm < model_->wanted_mm()) return false;
  }
  return true;
}

bool Walker::judge(Way& way) {
  bodies::Clearance least = model_->clearance(scene_, bodies::Occasion::kMotion, &before_);
  bool nearer = false;  // tool and part come nearer before they have had room
  for (Parting& p : partings_) {
    if (p.apart && model_->least_distance(scene_, p.pair) >= least.mm) continue;
    const double mm = model_->distance(scene_, p.pair);
    const bool worse = !p.apart && mm < p.start_mm - kRounding_mm;
    nearer = nearer || (worse && mm <= kTouch_mm);
    p.apart = p.apart || mm >= model_->wanted_mm();
    if ((p.apart || worse) && mm < least.mm)
      least = {mm, model_->bodies()[p.pair.first].id, model_->bodies()[p.pair.second].id};
  }
  near_mm_ = least.mm;
  if (least.mm < way.nearest.mm) {
    way.nearest = least;
    way.at = pose_;
  }
  if (!nearer && least.mm > kTouch_mm) return true;
  way.end = Way::End::kTouches;
  return false;
}

/// To rest behind the edge.
double Walker::travel(const Joint& joint, const JointVector& joints) {
  const double to_edge = (joint.switch_position - joints[joint.joint]) * joint.direction();
  return to_edge > 0 ? to_edge + joint.overrun() : 0;
}

void Walker::note_spread(const Stage& stage, const JointVector& joints, Way& way) const {
  double shortest = kInfinite, longest = 0;
  for (const Joint& j : stage.joints) {
    if (!j.moves || kinematics_.joint_info(static_cast<int>(j.joint)).rotary) continue;
    shortest = std::min(shortest, travel(j, joints));
    longest = std::max(longest, travel(j, joints));
  }
  if (longest > shortest) way.spread_mm = std::max(way.spread_mm, longest - shortest);
}

/// Where a stop is found by load: off it first, wherever that is.
bool Walker::go_free(const Stage& stage, JointVector& joints, Way& way) {
  for (const Joint& j : stage.joints) {
    if (!(j.back_off > 0)) continue;
    joints[j.joint] -= j.direction() * j.back_off;
    if (!look(joints, way)) return false;
  }
  return true;
}

/// Straight away at the lift's rates, until the first has come to its switch and all are told to halt.
bool Walker::lift(const Stage& stage, JointVector& joints, Way& way) {
  double seconds = kInfinite;
  for (std::size_t i = 0; i < stage.lift_per_s.size(); ++i) {
    const Joint& j = stage.joints[i];
    if (!(stage.lift_per_s[i] > 0)) continue;
    const double to_edge = (j.switch_position - joints[j.joint]) * j.direction();
    seconds = std::min(seconds, std::max(to_edge, 0.0) / stage.lift_per_s[i]);
  }
  if (!std::isfinite(seconds)) return true;
  std::vector<Goal> goals;
  for (std::size_t i = 0; i < stage.lift_per_s.size(); ++i) {
    const Joint& j = stage.joints[i];
    const double speed = stage.lift_per_s[i];
    if (!(speed > 0)) continue;
    const double ramp = 0.5 * speed * speed / j.accel_per_s2;
    const double to_edge = (j.switch_position - joints[j.joint]) * j.direction();
    if (to_edge <= 0) continue;  // stands on its switch
    const double by = speed * (seconds + kReaction_s) + ramp;
    goals.push_back({&j, std::min(by, to_edge + ramp), speed});
  }
  return go(goals, joints, way);
}

/// All go at once; each stops behind the edge of its own switch.
bool Walker::seek(const Stage& stage, JointVector& joints, Way& way) {
  std::vector<Goal> goals;
  for (const Joint& j : stage.joints)
    if (j.moves) goals.push_back({&j, travel(j, joints), j.fast_per_s});
  return go(goals, joints, way);
}

/// Ramps are left out: they are the same for all that go as fast, and the way is looked at in any case.
bool Walker::go(std::vector<Goal>& goals, JointVector& joints, Way& way) {
  double farthest = 0;
  for (const Goal& g : goals) farthest = std::max(farthest, g.left);
  for (;;) {
    double fastest = 0, arrival_s = kInfinite;
    for (const Goal& g : goals) {
      if (!(g.left > 0)) continue;
      fastest = std::max(fastest, g.per_s);
      arrival_s = std::min(arrival_s, g.left / g.per_s);
    }
    if (!(fastest > 0)) return true;
    // A carriage's motion is passed on to the bodies up to some 4 times.
    const double step = std::max(std::clamp(near_mm_ / 8, density_.least_mm, density_.most_mm),
                                 farthest / density_.most_poses);
    const double seconds = std::min(arrival_s, step / fastest);
    for (Goal& g : goals) {
      if (!(g.left > 0)) continue;
      const double by = std::min(g.left, g.per_s * seconds);
      // What rounding would leave of the last step is no step.
      g.left = g.left - by > 1e-9 ? g.left - by : 0;
      joints[g.joint->joint] += g.joint->direction() * by;
    }
    if (!look(joints, way)) return false;
  }
}

/// One after the other, node after node: off the switch, and where the edge is taken on the way in, back.
bool Walker::leave(const Stage& stage, JointVector& joints, Way& way) {
  std::vector<const Joint*> waiting;
  for (const Joint& j : stage.joints)
    if (j.moves) waiting.push_back(&j);
  while (!waiting.empty()) {
    const std::uint8_t node = waiting.front()->node;
    for (auto& next : waiting) {
      if (next->node != node) continue;
      const Joint& j = *next;
      const double off = j.back_off > 0 ? j.back_off : j.entering ? j.overrun() : j.slow_overrun();
      joints[j.joint] = j.switch_position - j.direction() * off;
      if (!look(joints, way)) return false;
      if (j.entering) {
        joints[j.joint] = j.switch_position + j.direction() * j.slow_overrun();
        if (!look(joints, way)) return false;
      }
    }
    std::erase_if(waiting, [node](const Joint* j) { return j->node == node; });
  }
  return true;
}

}  // namespace kinebus::homing
