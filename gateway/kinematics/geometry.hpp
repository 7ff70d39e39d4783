#pragma once
// The geometry of each kind of machine: plain structs with the defaults of the machine that is known best.
// A machine file fills them; make_*_kinematics checks them and builds the kinematics.

#include <array>
#include <memory>
#include <numbers>
#include <string>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/result.hpp"

namespace kinebus {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

using Vector3 = std::array<double, 3>;

/// A closed interval; min == max: no limit.
struct Interval {
  double min = 0, max = 0;
  constexpr bool limited() const { return min != max; }
  friend constexpr bool operator==(const Interval&, const Interval&) = default;
};

/// Where the tool may be. X Y Z and radius in table coordinates (they turn with the part); A of the platform,
/// rad.
struct PoseLimits {
  Interval x_mm{}, y_mm{}, z_mm{}, a_rad{}, c_rad{};
  double radius_mm = 0;  ///< sqrt(x^2 + y^2); 0: no limit
  friend bool operator==(const PoseLimits&, const PoseLimits&) = default;
};

/// One leg of M1 (paper M1, eq. 1-5), machine frame, mm.
struct M1Leg {
  Vector3 foot_mm{};           ///< a: start of the rail
  Vector3 rail{0, 0, 1};       ///< d^: direction of positive travel; normalised when used
  Vector3 attachment_mm{};     ///< b: on the platform, platform frame
  double length_mm = 640;      ///< l
  double connector_mm = 0;     ///< c: from carriage to the leg's upper joint along the rail
  bool carriage_above = true;  ///< the branch: carriage ahead of the platform along d^ (+ root), or behind
  Interval travel_mm{530, 1030};
  friend bool operator==(const M1Leg&, const M1Leg&) = default;
};

/// Four-leg parallel mechanism (x, y, z, A) with rotary table C on the platform and a fixed nozzle.
struct M1Geometry {
  std::array<M1Leg, 4> legs{{
      {.foot_mm = {310, 210, 0}, .attachment_mm = {75, 90, 0}, .connector_mm = 25},
      {.foot_mm = {310, -210, 0}, .attachment_mm = {75, -90, 0}, .connector_mm = 0},
      {.foot_mm = {-310, -210, 0}, .attachment_mm = {-75, 45, 0}, .connector_mm = 25},
      {.foot_mm = {-310, 210, 0}, .attachment_mm = {-75, -45, 0}, .connector_mm = 0},
  }};
  Vector3 nozzle_mm{0, 0, 300};  ///< n
  PoseLimits limits{.z_mm = {-5, 250}, .a_rad = {-45 * kRadPerDeg, 45 * kRadPerDeg}, .radius_mm = 150};
  double max_leg_angle_rad = 58 * kRadPerDeg;  ///< between a leg and its rail; pi/2: no limit
  /// Smallest angle between a rail and the arm from platform centre to attachment, either way; 0: no limit.
  double min_rail_clearance_rad = 0;
  /// Smallest angle of a leg above the platform's plane; 0: no limit.
  double min_platform_clearance_rad = 0;
  double max_condition = 10;  ///< of J, with A scaled by rotation_scale_mm
  double rotation_scale_mm = 100;
  double bed_reference_mm =
      20;  ///< height of the nozzle over the table's centre at the bed reference position
  friend bool operator==(const M1Geometry&, const M1Geometry&) = default;
};

/// Optional rotary table of a Cartesian machine: A tilts it about X, C turns it about its own Z.
struct RotaryTable {
  /// Where the A and C axes meet, from the table's centre at A = C = 0, machine frame.
  Vector3 pivot_mm{};
  Interval a_rad{-90 * kRadPerDeg, 90 * kRadPerDeg};
  Interval c_rad{};
  friend bool operator==(const RotaryTable&, const RotaryTable&) = default;
};

/// Cartesian machine. Joints: X, Y, Z, with a rotary table A, C, and E.
struct CartesianGeometry {
  Interval x_mm{-100, 100}, y_mm{-100, 100}, z_mm{0, 200};  ///< joint travel; joint 0 is at pose 0
  bool has_table = false;
  RotaryTable table{};
  double bed_reference_mm = 20;
  friend bool operator==(const CartesianGeometry&, const CartesianGeometry&) = default;
};

/// CoreXY: belt motors a = x + y, b = x - y; then Z and E. Limits are those of X and Y, not of the belts.
struct CoreXyGeometry {
  Interval x_mm{-100, 100}, y_mm{-100, 100}, z_mm{0, 200};
  double bed_reference_mm = 20;
  friend bool operator==(const CoreXyGeometry&, const CoreXyGeometry&) = default;
};

/// Linear delta: three vertical towers, carriage heights above the bed; then E. Nothing turns.
struct LinearDeltaGeometry {
  /// Horizontal distance of an arm's ends with the effector at the centre.
  double radius_mm = 174.75;
  double arm_length_mm = 333;
  std::array<double, 3> tower_angle_rad{210 * kRadPerDeg, 330 * kRadPerDeg, 90 * kRadPerDeg};
  std::array<Interval, 3> travel_mm{{{0, 600}, {0, 600}, {0, 600}}};  ///< height of the upper rod end
  PoseLimits limits{.z_mm = {-5, 290}, .radius_mm = 140};
  double max_arm_angle_rad = 75 * kRadPerDeg;  ///< between an arm and its tower
  double bed_reference_mm = 20;
  friend bool operator==(const LinearDeltaGeometry&, const LinearDeltaGeometry&) = default;
};

/// A geometry no machine can have, or none can be controlled with: the reason, in words.
struct GeometryError {
  std::string what;
};

/// Errors: a leg without length or rail direction, limits that exclude each other, no reachable pose, or a
/// mechanism that is singular at every pose (for instance attachments mirrored about the YZ plane).
Result<std::unique_ptr<Kinematics>, GeometryError> make_m1_kinematics(const M1Geometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_cartesian_kinematics(
    const CartesianGeometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_corexy_kinematics(const CoreXyGeometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_linear_delta_kinematics(
    const LinearDeltaGeometry& geometry);

}  // namespace kinebus
