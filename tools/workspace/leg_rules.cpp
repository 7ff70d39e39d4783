#include "tools/workspace/leg_rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus::workspace {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
/// What bodies may spare counts as a share of this, mm.
constexpr double kRoom_mm = 20;

/// So far inside a rule that rounding to whole millimetres and the poses between those that are looked at
/// leave it kept; in shares, as Finding::spare().
constexpr double inside(LegRule rule) {
  switch (rule) {
    case LegRule::kLegsApart:
      return 0.04;
    case LegRule::kBodies:
      return 0.03;
    case LegRule::kUnderPlatform:
      return 0.02;
    default:
      return 0.01;
  }
}

bodies::Vec vec(const Vector3& v) {
  return {v[0], v[1], v[2]};
}
bodies::Vec tilted(double angle_rad, const Vector3& v) {
  return vec(turn_x(Turn(angle_rad), v));
}

/// Nothing of travel and workspace limits it, so that every pose has its numbers.
M1Geometry unlimited(M1Geometry g) {
  g.limits = {};
  for (M1Leg& leg : g.legs) leg.travel_mm = {};
  g.max_leg_angle_rad = std::numbers::pi / 2;
  g.min_rail_clearance_rad = g.min_platform_clearance_rad = 0;
  g.max_condition = 1e5;
  return g;
}

bool upright(const M1Geometry& g) {
  return std::all_of(g.legs.begin(), g.legs.end(), [](const M1Leg& leg) {
    return leg.rail[0] == 0 && leg.rail[1] == 0 && leg.rail[2] > 0;
  });
}

class Judge {
 public:
  Judge(const M1Geometry& g, const Wish& wish) : g_(g), kinematics_(make_m1_kinematics(unlimited(g))) {
    judged_.findings = {
        {.rule = LegRule::kReach, .worst = kFar},
        {.rule = LegRule::kLegAngle, .worst = 0, .limit = g.max_leg_angle_rad},
        {.rule = LegRule::kCondition, .worst = 0, .limit = g.max_condition},
        {.rule = LegRule::kUnderPlatform, .worst = kFar, .limit = g.min_platform_clearance_rad},
        {.rule = LegRule::kLegsApart, .worst = kFar, .limit = wish.legs_apart_mm},
        {.rule = LegRule::kBodies, .worst = kFar},
    };
    for (const M1Leg& leg : g.legs) {
      judged_.footprint_mm = std::max(judged_.footprint_mm, std::hypot(leg.foot_mm[0], leg.foot_mm[1]));
      judged_.leg_mm = std::max(judged_.leg_mm, leg.length_mm);
    }
    judged_.travel_mm = {kFar, -kFar};
  }

  /// Legs alone. False: out of reach.
  bool look_at_legs(const Pose& pose) {
    const PlatformPose at = platform_at(g_, Frame::kPart, pose);
    bool reached = true;
    for (const M1Leg& leg : g_.legs) {
      const double rail_length = bodies::norm(vec(leg.rail));
      const bodies::Vec d = (1 / rail_length) * vec(leg.rail);
      const bodies::Vec s = vec(at.p_mm) + tilted(at.a_rad, leg.attachment_mm) - vec(leg.foot_mm);
      const double u = dot(s, d), ll = leg.length_mm * leg.length_mm;
      const double left = 1 - (dot(s, s) - u * u) / ll;
      note(LegRule::kReach, left, pose);
      if (!(left > 0)) {
        reached = false;
        continue;
      }
      const double along = (leg.carriage_above ? 1 : -1) * leg.length_mm * std::sqrt(left);
      const double q = u + along - leg.connector_mm;
      judged_.travel_mm.min = std::min(judged_.travel_mm.min, q);
      judged_.travel_mm.max = std::max(judged_.travel_mm.max, q);
      note(LegRule::kLegAngle, std::acos(std::min(1.0, std::sqrt(left))), pose);
      // From the platform along the leg, on the platform's normal.
      const bodies::Vec down = (1 / leg.length_mm) * ((u + along) * d - s);
      const double side = (leg.carriage_above ? 1 : -1) * (d.z < 0 ? -1 : 1);
      const double rise = side * dot(down, tilted(at.a_rad, {0, 0, 1}));
      note(LegRule::kUnderPlatform, std::asin(std::clamp(rise, -1.0, 1.0)), pose);
    }
    if (reached && kinematics_)
      note(LegRule::kCondition, std::min(1e5, (*kinematics_)->condition(Frame::kPart, pose)), pose);
    return reached;
  }

  void look_at_bodies(const BodiesDescription& description, const Room& room,
                      const std::vector<Pose>& poses) {
    const bodies::Model model = bodies::make_model(fitted(g_, judged_, room), description);
    finding(LegRule::kBodies).limit = model->wanted_mm();
    bodies::Scene scene = model->at_rest();
    // The nozzle's height is that of the machine fitted, by which a pose's bodies are placed.
    for (const Pose& pose : poses) {
      if (!model->place(Frame::kPart, pose, scene)) continue;
      double legs = kFar, others = kFar;
      Finding &apart = finding(LegRule::kLegsApart), &any = finding(LegRule::kBodies);
      for (const auto& pair : model->pairs()) {
        if (pair.homing_only) continue;
        const auto &a = model->bodies()[pair.first].id, &b = model->bodies()[pair.second].id;
        const bool both_legs = a.kind == bodies::BodyKind::kLeg && b.kind == bodies::BodyKind::kLeg;
        Finding& found = both_legs ? apart : any;
        double& least = both_legs ? legs : others;
        // What breaks no rule and is not the worst of all poses need not be known.
        const double matters = std::min(least, std::max(found.worst, found.limit + 0.1 * kRoom_mm));
        if (farther_than(*model, scene, pair, matters)) continue;
        const double mm = model->distance(scene, pair);
        if (mm >= least) continue;
        least = mm;
        if (mm < found.worst) {
          found.first = a;
          found.second = b;
        }
      }
      if (legs < kFar) note(LegRule::kLegsApart, legs, pose);
      if (others < kFar) note(LegRule::kBodies, others, pose);
    }
  }

  Judgement finish() {
    judged_.worst_condition = finding(LegRule::kCondition).worst;
    return std::move(judged_);
  }

 private:
  /// Along one of the machine's axes: cheap, and true of most pairs.
  static bool farther_than(const bodies::CollisionModel& model, const bodies::Scene& scene,
                           const bodies::CollisionModel::Pair& pair, double mm) {
    if (!std::isfinite(mm)) return false;
    for (const bodies::Vec& axis : {bodies::Vec{1, 0, 0}, bodies::Vec{0, 1, 0}, bodies::Vec{0, 0, 1}})
      if (model.gap_along(scene, pair, axis) >= mm || model.gap_along(scene, pair, -axis) >= mm) return true;
    return model.least_distance(scene, pair) >= mm;
  }

  Finding& finding(LegRule rule) { return judged_.findings[static_cast<std::size_t>(rule)]; }

  void note(LegRule rule, double value, const Pose& pose) {
    Finding& f = finding(rule);
    if (f.at_most() ? value >= f.worst : value <= f.worst) {
      f.worst = value;
      f.pose = pose;
    }
    Finding here = f;
    here.worst = value;
    const double missing = inside(rule) - here.spare();
    if (missing > 0) judged_.beyond += std::min(10.0, missing);
  }

  const M1Geometry& g_;
  Result<std::unique_ptr<Kinematics>, GeometryError> kinematics_;
  Judgement judged_;
};

}  // namespace

double Finding::spare() const {
  switch (rule) {
    case LegRule::kReach:
      return worst;
    case LegRule::kLegAngle:
    case LegRule::kCondition:
      return 1 - worst / limit;
    case LegRule::kUnderPlatform:
    case LegRule::kLegsApart:
      return limit > 0 ? worst / limit - 1 : kFar;
    case LegRule::kBodies:
      return (worst - limit) / kRoom_mm;
  }
  return 0;
}

bool Judgement::holds() const {
  return std::all_of(findings.begin(), findings.end(), [](const Finding& f) { return f.keeps(); });
}

double Judgement::price(const M1Geometry& geometry) const {
  return worst_condition / geometry.max_condition + 1e-3 * (leg_mm + footprint_mm);
}

std::vector<Pose> poses_of(const Room& room, const Density& density) {
  std::vector<Pose> poses;
  for (int h = 0; h <= density.heights; ++h)
    for (int ring = 0; ring <= density.rings; ++ring)
      for (int ray = 0; ray < (ring == 0 ? 1 : density.rays); ++ray)
        for (int tilt = 0; tilt <= density.tilts; ++tilt) {
          const double r = room.radius_mm * ring / density.rings;
          const double angle = 2 * std::numbers::pi * ray / density.rays;
          poses.push_back({r * std::cos(angle), r * std::sin(angle),
                           room.z_min_mm + (room.z_max_mm - room.z_min_mm) * h / density.heights,
                           room.tilt_min_rad + (room.tilt_max_rad - room.tilt_min_rad) * tilt / density.tilts,
                           0, 0});
        }
  return poses;
}

Judgement judge(const M1Geometry& geometry, const std::optional<BodiesDescription>& bodies, const Wish& wish,
                const std::vector<Pose>& poses) {
  Judge judge(geometry, wish);
  bool reached = true;
  for (const Pose& pose : poses) reached = judge.look_at_legs(pose) && reached;
  // Bodies need to be somewhere.
  if (bodies && reached) judge.look_at_bodies(*bodies, wish.room, poses);
  return judge.finish();
}

M1Geometry fitted(const M1Geometry& geometry, const Judgement& judged, const Room& room) {
  // Homing goes down: with so much more room below, the tool is above a tall part beside it before the first
  // carriage has come to its switch and the platform turns level.
  constexpr double kSpare_mm = 10, kLowest_mm = 40, kHomingRoom_mm = 30;
  M1Geometry g = geometry;
  Interval used = judged.travel_mm;
  if (upright(g) && g.tool == ToolPlacement::kFrame) {
    const double lift =
        std::ceil((kLowest_mm + kSpare_mm - used.min + g.nozzle_mm[2]) / 10) * 10 - g.nozzle_mm[2];
    g.nozzle_mm[2] += lift;
    used = {used.min + lift, used.max + lift};
  }
  const Interval travel{std::floor((used.min - kSpare_mm) / 10) * 10 - kHomingRoom_mm,
                        std::ceil((used.max + kSpare_mm) / 10) * 10};
  for (M1Leg& leg : g.legs) leg.travel_mm = travel;
  g.limits = {.z_mm = {room.z_min_mm, room.z_max_mm},
              .a_rad = {room.tilt_min_rad, room.tilt_max_rad},
              .radius_mm = room.radius_mm};
  return g;
}

}  // namespace kinebus::workspace
