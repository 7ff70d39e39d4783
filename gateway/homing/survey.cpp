#include "gateway/homing/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kinebus::homing {
namespace {

/// Tool and part at a start: as after a layer.
constexpr double kLayer_mm = 0.2;
/// How densely the way to a start is looked at, mm of a joint.
constexpr double kStep_mm = 10;
const Plan kNoPlan;

}  // namespace

double Starts::in(double low, double high) {
  return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

double Starts::in_or_end(const Interval& range) {
  const double place = in(-0.25, 1.25);
  return range.min + (range.max - range.min) * std::clamp(place, 0.0, 1.0);
}

std::optional<Start> Starts::next() {
  for (int attempt = 0; attempt < attempts_; ++attempt) {
    Start start;
    if (draw(start) && put_part(start)) return start;
  }
  return std::nullopt;
}

bool Starts::draw(Start& start) {
  const std::uint64_t kind = random_() % 3;
  if (!draw_in_workspace(start)) return false;
  return kind == 0 || draw_towards_switches(start, kind == 2);
}

bool Starts::draw_in_workspace(Start& start) {
  const Kinematics& k = *machine_.kinematics;
  const PoseLimits& limits = machine_.limits;
  Pose pose = k.bed_reference();
  if (limits.z_mm.limited()) {
    const double radius = limits.radius_mm > 0 ? limits.radius_mm : limits.x_mm.limited() ? HUGE_VAL : 100;
    if (std::isfinite(radius)) {
      const double r = radius * std::sqrt(std::min(in(0, 1.2), 1.0)), angle = in(0, 2 * std::numbers::pi);
      pose[kX] = r * std::cos(angle);
      pose[kY] = r * std::sin(angle);
    } else {
      pose[kX] = in_or_end(limits.x_mm);
      pose[kY] = in_or_end(limits.y_mm);
    }
    pose[kZ] = std::max(in_or_end(limits.z_mm), kLayer_mm);
    pose[kA] = limits.a_rad.limited() ? in_or_end(limits.a_rad) : 0;
    if (!k.check(Frame::kPart, pose) || !k.inverse(Frame::kPart, pose, start.joints)) return false;
  } else {
    if (!k.inverse(Frame::kPart, pose, start.joints)) return false;
    for (std::size_t j = 0; j < static_cast<std::size_t>(k.joint_count()); ++j)
      if (machine_.travel[j].limited()) start.joints[j] = in_or_end(machine_.travel[j]);
  }
  start.pose = k.bed_reference();
  return k.forward(Frame::kMachine, start.joints, start.pose) &&
         static_cast<bool>(k.check(Frame::kMachine, start.pose));
}

/// From a pose of the workspace on towards the switches, as an interrupted homing leaves a machine, or a
/// hand.
bool Starts::draw_towards_switches(Start& start, bool one_on_switch) {
  std::vector<const Joint*> movers;
  for (const Joint& j : machine_.joints)
    if (j.moves) movers.push_back(&j);
  if (movers.empty()) return false;
  const std::size_t chosen = random_() % movers.size();
  const double share = in(0, 1);  // of the way that is left
  const JointVector from = start.joints;
  const Pose before = start.pose;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const Joint& j = *movers[i];
    double& q = start.joints[j.joint];
    q = j.switch_position + (q - j.switch_position) * share;
    if (one_on_switch && i == chosen) {
      q = j.switch_position + j.direction() * in(0, j.overrun());
      start.on_switch = j.joint;
    }
  }
  if (!machine_.mechanism->forward(Frame::kMachine, start.joints, start.pose) ||
      !machine_.mechanism->check(Frame::kMachine, start.pose))
    return false;
  // The mechanism may tilt farther on its way.
  if (const Interval& a = machine_.limits.a_rad;
      a.limited() && !(start.pose[kA] >= a.min && start.pose[kA] <= a.max))
    return false;
  const bodies::Model bare = machine_.bodies ? machine_.bodies(0, 0, false) : nullptr;
  return Walker(*machine_.mechanism, kNoPlan, bare.get(), {}).passes(from, before, start.joints, kStep_mm);
}

/// With such a part the machine can stand there.
bool Starts::fits(Start& start, double radius_mm, double height_mm) const {
  start.part_radius_mm = radius_mm;
  start.part_height_mm = height_mm;
  start.model = machine_.bodies(radius_mm, height_mm, true);
  const auto room = Walker(*machine_.mechanism, kNoPlan, start.model.get(), {}).room(start.pose);
  return room.machine_mm >= start.model->wanted_mm() && room.holder_mm >= start.model->wanted_mm() &&
         room.tool_mm >= 0.5 * kLayer_mm;
}

/// A part that the bodies leave room for, in many starts right under the tool.
bool Starts::put_part(Start& start) {
  if (!machine_.bodies) return true;
  const auto real_bodies = [&] {
    start.model = machine_.bodies(start.part_radius_mm, start.part_height_mm, false);
    return true;
  };
  if (!fits(start, 0, 0)) return false;
  if (!(machine_.part_height_mm > 0)) return real_bodies();
  const double radius = in(std::min(2.0, machine_.part_radius_mm), machine_.part_radius_mm);
  double height = random_() % 2 == 0 ? machine_.part_height_mm : in(0, machine_.part_height_mm);
  if (fits(start, radius, height)) return real_bodies();
  // Lower, until it has room. Under a level tool that is a layer below its tip.
  Pose tip = start.pose;
  if (tip[kA] == 0 && tip[kZ] - kLayer_mm < height) height = tip[kZ] - kLayer_mm;
  while (height > 0.5) {
    if (fits(start, radius, height)) return real_bodies();
    height -= std::max(0.5, 0.02 * height);
  }
  fits(start, 0, 0);
  return real_bodies();
}

namespace {

// Around, tilts, heights, and what of a corner: the tool on the rim, or against the part.
constexpr std::size_t kRays = 8, kTilts = 2, kPlaces = 2;
// A part swings farthest at this height of the tool, as a share: there what is not safe shows first.
constexpr std::array<double, 3> kHeights{2.0 / 3, 0, 1.0 / 3};

}  // namespace

std::size_t Starts::corner_count() {
  return kRays * kTilts * kHeights.size() * kPlaces;
}

std::optional<Start> Starts::corner(std::size_t number) {
  const PoseLimits& limits = machine_.limits;
  if (!limits.z_mm.limited()) return std::nullopt;
  const std::size_t ray = number % kRays, tilt = number / kRays % kTilts,
                    height = number / (kRays * kTilts) % kHeights.size(),
                    place = number / (kRays * kTilts * kHeights.size());
  const Kinematics& k = *machine_.kinematics;
  const double rim = limits.radius_mm > 0 ? limits.radius_mm : 100;
  // Against the part where it leaves room for that.
  const double beside = std::min(rim, machine_.part_radius_mm + 6);
  const double r = place == 0 ? rim : beside, angle = 2 * std::numbers::pi * static_cast<double>(ray) / kRays;
  Start start;
  Pose pose = k.bed_reference();
  pose[kX] = r * std::cos(angle);
  pose[kY] = r * std::sin(angle);
  const double low = std::max(limits.z_mm.min, kLayer_mm);
  pose[kZ] = low + (limits.z_mm.max - low) * kHeights[height];
  pose[kA] = tilt == 0 ? limits.a_rad.min : limits.a_rad.max;
  if (!k.check(Frame::kPart, pose) || !k.inverse(Frame::kPart, pose, start.joints)) return std::nullopt;
  start.pose = k.bed_reference();
  if (!k.forward(Frame::kMachine, start.joints, start.pose)) return std::nullopt;
  if (!machine_.bodies) return start;
  if (!fits(start, 0, 0)) return std::nullopt;
  if (machine_.part_height_mm > 0 && !fits(start, machine_.part_radius_mm, machine_.part_height_mm)) {
    // The highest that the tool and what it hangs from leave room for.
    double fitting = 0, too_high = machine_.part_height_mm;
    while (too_high - fitting > 1) {
      const double middle = 0.5 * (fitting + too_high);
      (fits(start, machine_.part_radius_mm, middle) ? fitting : too_high) = middle;
    }
    start.part_height_mm = fitting;
  }
  start.model = machine_.bodies(start.part_radius_mm, start.part_height_mm, false);
  return start;
}

Survey survey(const Machine& machine, const Plan& plan, std::uint64_t seed, int starts,
              Walker::Density density, int attempts, std::size_t corners) {
  Survey found;
  found.nearest.mm = std::numeric_limits<double>::infinity();
  Starts source(machine, seed, attempts);
  const auto home_from = [&](Start& start) {
    Walker walker(*machine.mechanism, plan, start.model.get(), density);
    const Way way = walker.walk(start.joints, start.pose);
    ++found.starts;
    found.on_switch += start.on_switch ? 1 : 0;
    found.under_tool += start.part_height_mm > 0 && walker.room(start.pose).tool_mm < 2 ? 1 : 0;
    found.spread_mm = std::max(found.spread_mm, way.spread_mm);
    found.worst_condition = std::max(found.worst_condition, way.worst_condition);
    if (way.nearest.mm < found.nearest.mm) {
      found.nearest = way.nearest;
      found.nearest_at = way.at;
    }
    if (way.end == Way::End::kHome) return;
    ++(way.end == Way::End::kTouches ? found.touching : found.not_closed);
    if (!found.failure) found.failure = Failure{std::move(start), way};
  };
  for (std::size_t n = 0; n < std::min(corners, Starts::corner_count()); ++n)
    if (std::optional<Start> start = source.corner(n)) {
      ++found.corners;
      home_from(*start);
    }
  for (int n = 0; n < starts; ++n) {
    std::optional<Start> start = source.next();
    if (!start) break;
    home_from(*start);
  }
  return found;
}

}  // namespace kinebus::homing
