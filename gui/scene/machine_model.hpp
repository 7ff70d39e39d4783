#pragma once
// What a picture of the machine needs to know of it: dimensions and reach. Comes from the gateway
// (MachineInfo).

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/bodies/collision_model.hpp"
#include "gui/scene/vec.hpp"

namespace kinebus::gui {

struct Range {
  double min = 0, max = 0;
  friend bool operator==(const Range&, const Range&) = default;
};

/// Tool relative to the part: X Y Z in table coordinates (mm), A and C (rad).
struct PartPose {
  Vec3 q_mm{};
  double a_rad = 0, c_rad = 0;
};

struct MachineModel {
  enum class Kind { kM1, kCartesian, kCoreXy, kLinearDelta, kM4 };
  struct Leg {
    Vec3 foot_mm{}, rail{0, 0, 1}, attachment_mm{};
    double length_mm = 991, connector_mm = 0;
    bool carriage_above = false;
    Range travel_mm{40, 540};
    double speed_mm_per_s = 450;
  };
  Kind kind = Kind::kM1;
  std::string name;
  /// M1: the platform carries the tool, and the table stands in the frame.
  bool tool_on_platform = false;
  Vec3 nozzle_mm{};       ///< M1: the tip in the frame of what holds it: machine, or platform
  Vec3 table_mm{};        ///< M1 with the tool on the platform: the table's centre, machine frame
  std::vector<Leg> legs;  ///< M1: four; linear delta: three towers with their arms
  double max_leg_angle_rad = 1.2;
  Range x_mm{-100, 100}, y_mm{-100, 100}, z_mm{0, 200};  ///< where the tool may be, table coordinates
  double radius_mm = 0;                                  ///< 0: the workspace is the box alone
  bool turns = false;                                    ///< has A or C
  std::shared_ptr<const bodies::CollisionModel> solid;   ///< what is drawn
  bool watched = false;                                  ///< the gateway keeps these bodies apart, too
  double table_radius_mm = 0;                            ///< 0: the bed is the box of X and Y

  bool round() const { return radius_mm > 0; }
  /// Carriage travels for a pose, by the closure of each leg; nullopt: out of reach. Only machines with legs.
  std::optional<std::array<double, 4>> carriages_mm(const PartPose& pose) const;
  /// Where M1's platform is in the machine frame, and its tilt about X.
  struct Platform {
    Vec3 p_mm{};
    double a_rad = 0;
  };
  /// p = n - R_X(A) R_Z(C) q, tilted by A; p = w + R_Z(C) q - R_X(-A) t, tilted by -A.
  Platform platform(const PartPose& pose) const;
  /// How far a pose is from the nearest limit of reach, 0 (at it or beyond) .. 1 (as free as can be): travel
  /// of the carriages, angle of the legs, workspace.
  double margin(const PartPose& pose) const;
  /// With the carriages' travels, which it needs anyway.
  double margin(const PartPose& pose, std::optional<std::array<double, 4>>& travel_mm) const;
};

}  // namespace kinebus::gui
