#include "gateway/description/bodies_rules.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gateway/bodies/collision_model.hpp"

namespace kinebus {
namespace {

std::string short_text(double value) {
  return printed("%.6g", value);
}

/// Rules of the numbers alone.
void judge_numbers(const BodiesDescription& b, std::vector<BrokenRule>& broken) {
  const auto require = [&](bool holds, std::vector<std::string> keys, Sentence found, Sentence expected) {
    if (!holds) broken.push_back({std::move(keys), std::move(found), std::move(expected)});
  };
  require(b.tool_length_mm > b.tool_radius_mm, {"bodies.tool_length_mm", "bodies.tool_radius_mm"},
          Sentence::verbatim(short_text(b.tool_length_mm)),
          say("above tool_radius_mm, %1: the tool's end is round", short_text(b.tool_radius_mm)));
  require((b.part_radius_mm > 0) == (b.part_height_mm > 0),
          {"bodies.part_radius_mm", "bodies.part_height_mm"},
          Sentence::verbatim(short_text(b.part_radius_mm)),
          say("part_radius_mm and part_height_mm both above 0, or neither of them"));
  require(b.fixed.size() <= bodies::kMostFixed, {"bodies.fixed"}, say("%1 tables", b.fixed.size()),
          say("at most %1", bodies::kMostFixed));
  for (const FixedBody& body : b.fixed) {
    const std::string key = "bodies.fixed." + body.name;
    if (body.radius_mm > 0) {
      require(body.from_mm != body.to_mm, {key + ".to_mm", key + ".from_mm"}, say("a rod without length"),
              say("another point than from_mm"));
      continue;
    }
    bool grows = true;
    for (std::size_t k = 0; k < 3; ++k) grows = grows && body.from_mm[k] < body.to_mm[k];
    require(grows, {key + ".to_mm", key + ".from_mm"}, say("a box turned inside out"),
            say("each of its three numbers above that of from_mm"));
  }
}

/// Poses all over the workspace, those among them that the kinematics allow.
template <typename Visit>
void visit_workspace(const MachineDescription& d, const Kinematics& kinematics, Visit&& visit) {
  const PoseLimits* limits = pose_limits(d.kinematics);
  const double radius = limits != nullptr && limits->radius_mm > 0 ? limits->radius_mm : 100;
  const Interval z = limits != nullptr && limits->z_mm.limited() ? limits->z_mm : Interval{0, 100};
  const Interval a = limits != nullptr ? limits->a_rad : Interval{};
  constexpr int kHeights = 3, kTilts = 2, kRings = 2, kRays = 6;
  for (int h = 0; h <= kHeights; ++h)
    for (int t = 0; t <= kTilts; ++t)
      for (int ring = 0; ring <= kRings; ++ring)
        for (int ray = 0; ray < (ring == 0 ? 1 : kRays); ++ray) {
          const double r = radius * ring / kRings, angle = 2 * std::numbers::pi * ray / kRays;
          const Pose pose{r * std::cos(angle),
                          r * std::sin(angle),
                          std::max(z.min, 0.0) + (z.max - std::max(z.min, 0.0)) * h / kHeights,
                          a.min + (a.max - a.min) * t / kTilts,
                          0,
                          0};
          if (kinematics.check(Frame::kPart, pose)) visit(pose);
        }
}

/// What says where the machine can be, `first` before all.
std::vector<std::string> keys_of_place(const MachineDescription& d, std::string first) {
  std::vector<std::string> keys{std::move(first), "kinematics"};
  for (const JointDescription& joint : d.joints)
    keys.push_back("joint." + joint.name + ".travel_" + (joint.rotary ? "deg" : "mm"));
  return keys;
}

}  // namespace

void judge_reach(const MachineDescription& d, const Kinematics& kinematics, std::vector<BrokenRule>& broken) {
  const Pose reference = kinematics.bed_reference();
  const auto reached = kinematics.check(Frame::kMachine, reference);
  if (reached) return;
  bool stands = false;
  visit_workspace(d, kinematics, [&stands](const Pose&) { stands = true; });
  if (stands) return;
  broken.push_back({keys_of_place(d, "kinematics.workspace"),
                    say("a machine that can stand nowhere in its workspace: at its bed reference, %1: %2",
                        pose_text(reference), to_string(reached.error(), kinematics)),
                    say("geometry, travel and workspace that fit each other")});
}

std::string pose_text(const Pose& pose) {
  return printed("X %.4g Y %.4g Z %.4g A %.4g", pose[kX], pose[kY], pose[kZ], pose[kA] / kRadPerDeg);
}

void judge_bodies(const MachineDescription& d, const Kinematics& kinematics,
                  std::vector<BrokenRule>& broken) {
  if (!d.bodies) return;
  const std::size_t before = broken.size();
  judge_numbers(*d.bodies, broken);
  if (broken.size() > before) return;
  const bodies::Model model = make_collision_model(d);
  const std::vector<std::string> keys = keys_of_place(d, "bodies");
  const auto refuse = [&](const bodies::Clearance& c, const Pose& pose, Sentence expected) {
    broken.push_back(
        {keys, say("bodies that touch: at %1, %2", pose_text(pose), model->words(c)), std::move(expected)});
  };
  bodies::Clearance widest{.mm = -HUGE_VAL};
  Pose widest_pose{};
  visit_workspace(d, kinematics, [&](const Pose& pose) {
    if (widest.mm >= model->wanted_mm()) return;  // one such pose is enough
    const auto c = model->clearance(Frame::kPart, pose);
    if (!c || c->mm <= widest.mm) return;
    widest = *c;
    widest_pose = pose;
  });
  if (std::isfinite(widest.mm) && widest.mm < model->wanted_mm())
    return refuse(widest, widest_pose, say("a machine that has room somewhere: this is its best pose"));
  const Pose reference = kinematics.bed_reference();
  if (const auto c = model->clearance(Frame::kMachine, reference); c && c->mm < model->wanted_mm())
    refuse(*c, reference, say("room at the bed reference, where the machine waits before a job"));
}

}  // namespace kinebus
