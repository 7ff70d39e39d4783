#pragma once
// The rules that a four-leg machine (M1) keeps all over a wanted cylinder, its bodies among them: how near it
// comes to each, and where.

#include <optional>
#include <string>
#include <vector>

#include "gateway/bodies/bodies_description.hpp"
#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {

enum class LegRule : std::uint8_t {
  kReach,          ///< share of a leg's length, squared, that is left along its rail: more than 0
  kLegAngle,       ///< rad between leg and rail, at most
  kCondition,      ///< at most
  kUnderPlatform,  ///< rad between leg and the platform's plane, on its carriage's side, at least
  kLegsApart,      ///< mm between two legs, rods and joints counted, at least
  kBodies,         ///< mm between any two bodies, at least
};
inline constexpr std::size_t kLegRules = 6;

/// What is asked of a machine, beyond what its geometry and bodies state themselves.
struct Wish {
  Room room{100, 0, 200, -45 * kRadPerDeg, 45 * kRadPerDeg};
  double legs_apart_mm = 40;
};

/// How near the machine comes to a rule.
struct Finding {
  LegRule rule{};
  double worst = 0, limit = 0;
  Pose pose{};                       ///< of the worst, Frame::kPart
  bodies::BodyId first{}, second{};  ///< of kLegsApart and kBodies
  bool at_most() const { return rule == LegRule::kLegAngle || rule == LegRule::kCondition; }
  bool keeps() const {
    return at_most() ? worst <= limit : rule == LegRule::kReach ? worst > limit : worst >= limit;
  }
  /// What is left to the limit, as a share of it (kReach: of the leg's length, squared; kBodies: of 20 mm).
  double spare() const;
};

struct Judgement {
  std::vector<Finding> findings;  ///< one of each rule
  double beyond = 0;              ///< how far poses are beyond the rules: 0 when all keep a little inside
  Interval travel_mm{};           ///< that the carriages use, all legs together
  double footprint_mm = 0;        ///< radius of the circle around the rails
  double leg_mm = 0;              ///< the longest
  double worst_condition = 0;
  bool holds() const;
  const Finding& of(LegRule rule) const { return findings[static_cast<std::size_t>(rule)]; }
  /// What makes a machine dear that keeps all rules, without a unit: worst condition number over its limit,
  /// and length of a leg and radius around the rails, in metres.
  double price(const M1Geometry& geometry) const;
};

/// How densely a room is looked at: steps from the axis outwards, around, upwards, and over the tilts.
struct Density {
  int heights = 1, tilts = 4, rings = 2, rays = 12;
  static constexpr Density fine() { return {3, 12, 4, 36}; }
};
std::vector<Pose> poses_of(const Room& room, const Density& density);

/// The geometry's joint travel and pose limits are not asked for: they follow from the room.
/// Where `bodies` is empty, kLegsApart and kBodies are not looked at, and hold.
Judgement judge(const M1Geometry& geometry, const std::optional<BodiesDescription>& bodies, const Wish& wish,
                const std::vector<Pose>& poses);

/// The same machine with nozzle (rails upright), travel and limits as the room needs them: 10 mm to spare at
/// both ends, whole tens.
M1Geometry fitted(const M1Geometry& geometry, const Judgement& judged, const Room& room);

}  // namespace kinebus::workspace
