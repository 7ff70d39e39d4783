#pragma once
// The geometry of each kind of machine: plain structs with the defaults of the machine that is known best.
// A machine file fills them; make_*_kinematics checks them and builds the kinematics.

#include <array>
#include <memory>
#include <numbers>
#include <string>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

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
  Vector3 foot_mm{};        ///< a: start of the rail
  Vector3 rail{0, 0, 1};    ///< d^: direction of positive travel; normalised when used
  Vector3 attachment_mm{};  ///< b: on the platform, platform frame
  double length_mm = 991;   ///< l
  /// c: at the platform's end, from the leg to its attachment along the rail. It stays parallel to the rail
  /// at every tilt, so the leg runs from a + q d^ to p + R b - c d^.
  double connector_mm = 0;
  bool carriage_above = false;  ///< the branch: carriage ahead of the platform along d^ (+ root), or behind
  Interval travel_mm{40, 540};
  friend bool operator==(const M1Leg&, const M1Leg&) = default;
};

/// Who holds the tool of a four-leg machine; the table is where the tool is not (tool_placement.hpp).
enum class ToolPlacement : std::uint8_t { kFrame, kPlatform };

/// Four-leg parallel mechanism (x, y, z, A) with rotary table C on the platform and a fixed nozzle, or with
/// the tool on the platform and the table in the frame.
///
/// The default stands on its legs: carriages below, table, part and nozzle free above. Over a cylinder of 200
/// mm diameter and 200 mm height and |A| <= 45 deg its legs lean 27.4 deg at most, stay 91 mm from each
/// other, 65 mm from other legs' rails and 19 deg under the platform's plane; condition number 7.34 at most,
/// carriages at 53.8 to 525.0 mm. Rails and attachments of one side are no mirror image of the other's: else
/// y and A could not be told apart. With connectors of 15 mm on the side whose legs lean more, a level table
/// has its carriages at one height.
struct M1Geometry {
  std::array<M1Leg, 4> legs{{
      {.foot_mm = {273, 63, 0}, .attachment_mm = {124, 128, -5}, .connector_mm = 0},
      {.foot_mm = {273, -63, 0}, .attachment_mm = {124, -128, -5}, .connector_mm = 0},
      {.foot_mm = {-273, -252, 0}, .attachment_mm = {-124, -69, -5}, .connector_mm = 15},
      {.foot_mm = {-273, 252, 0}, .attachment_mm = {-124, 69, -5}, .connector_mm = 15},
  }};
  ToolPlacement tool = ToolPlacement::kFrame;
  Vector3 nozzle_mm{0, 0, 1340};  ///< the tool's tip in the frame of what holds it: n, or t on the platform
  Vector3 table_mm{};  ///< w: the table's centre in the machine frame, where the tool is on the platform
  PoseLimits limits{.z_mm = {-5, 250}, .a_rad = {-45 * kRadPerDeg, 45 * kRadPerDeg}, .radius_mm = 150};
  double max_leg_angle_rad = 30 * kRadPerDeg;  ///< between a leg and its rail; pi/2: no limit
  /// Smallest angle between a rail and the arm from platform centre to attachment, either way; 0: no limit.
  double min_rail_clearance_rad = 0;
  /// Smallest angle between a leg and the platform's plane, on the side that its carriage is on; 0: no limit.
  double min_platform_clearance_rad = 15 * kRadPerDeg;
  double max_condition = 8;  ///< of J, with A scaled by rotation_scale_mm
  double rotation_scale_mm = 100;
  double bed_reference_mm =
      20;  ///< height of the nozzle over the table's centre at the bed reference position
  friend bool operator==(const M1Geometry&, const M1Geometry&) = default;
};

/// What calibration found of one leg: true less nominal.
struct M1LegCorrection {
  Vector3 foot_mm{};
  Vector3 rail{};  ///< of the direction at length 1
  Vector3 attachment_mm{};
  double length_mm = 0;
  friend bool operator==(const M1LegCorrection&, const M1LegCorrection&) = default;
};
struct M1Correction {
  std::array<M1LegCorrection, 4> legs{};
  friend bool operator==(const M1Correction&, const M1Correction&) = default;
};
/// The machine as it was measured. Rails come out at length 1.
M1Geometry corrected(const M1Geometry& nominal, const M1Correction& correction);

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

/// Five-axis mill: planar 2-RRP + PRP mechanism that carries the spindle (Y, Z and tilt), a table that slides
/// along X and turns about Z. Joints: rail1, rail2, rail3, X, C. No filament: E stays 0.
///
/// The paper's plane is the machine's YZ plane: its x is Y, its y is Z. A is the tilt of the part as the tool
/// sees it, as on every machine here, so the spindle tilts by -A and the triangle stands at phi = spindle -
/// A. The mechanism is singular along a curve that passes through phi = 0 at y = 0 (x and phi then change
/// with all rails at rest): the spindle is mounted at an angle to the triangle that keeps the workspace on
/// one side of it.
struct M4Geometry {
  double rod_mm = 890;                   ///< L1
  double triangle_mm = 173;              ///< L2: side of the tool triangle
  double rails_mm = 840;                 ///< L3: distance of the two rails
  double spindle_rad = 60 * kRadPerDeg;  ///< phi with the tool upright
  double tool_mm = 120;                  ///< from P, the middle of AB, down to the tool's tip
  double table_y_mm = 0;                 ///< the table's centre in the mechanism's plane
  double table_z_mm = -250;
  std::array<Interval, 3> travel_mm{{{300, 1300}, {300, 1300}, {-150, 450}}};  ///< y1, y2, y3
  Interval table_travel_mm{-200, 200};
  PoseLimits limits{.z_mm = {-5, 200}, .a_rad = {-25 * kRadPerDeg, 25 * kRadPerDeg}, .radius_mm = 150};
  double max_leg_angle_rad = 58 * kRadPerDeg;  ///< between a rod and its rail
  double max_condition = 20;                   ///< of d(y1, y2, y3) / d(y, z, phi * rotation_scale_mm)
  double rotation_scale_mm = 100;
  double bed_reference_mm = 50;
  friend bool operator==(const M4Geometry&, const M4Geometry&) = default;
};

/// M1's mechanism as a four-axis mill on ball screws: rails 1..4 and nothing else. C and E stay 0.
struct M5Geometry : M1Geometry {
  friend bool operator==(const M5Geometry&, const M5Geometry&) = default;
};

/// A geometry no machine can have, or none can be controlled with: the reason, in words.
struct GeometryError {
  Sentence what;
};

/// Errors: a leg without length or rail direction, limits that exclude each other, no reachable pose, or a
/// mechanism that is singular at every pose (for instance attachments mirrored about the YZ plane).
Result<std::unique_ptr<Kinematics>, GeometryError> make_m1_kinematics(const M1Geometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_cartesian_kinematics(
    const CartesianGeometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_corexy_kinematics(const CoreXyGeometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_linear_delta_kinematics(
    const LinearDeltaGeometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_m4_kinematics(const M4Geometry& geometry);
Result<std::unique_ptr<Kinematics>, GeometryError> make_m5_kinematics(const M5Geometry& geometry);

}  // namespace kinebus
