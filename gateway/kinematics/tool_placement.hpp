#pragma once
// A four-leg machine carries the part on its platform or the tool; the other one stands in the machine frame.
// Only here is known which: everything else has a pose, or the platform.
//
// A pose says where the tool is relative to the part, whoever of both moves: X+ is the tool towards the
// part's X+, and A is the part's tilt as the tool sees it, so that one program runs on both. With
// m = R_X(A) R_Z(C) q along the tool's axes (gateway/pose.hpp) the platform stands at
//   tool in the frame:     p = n - m,              tilted by  A   (n: the tip in the machine frame)
//   tool on the platform:  p = w + R_X(-A) (m - t), tilted by -A  (t: the tip in the platform's frame, w: the
//                                                                  table's centre in the machine frame)
// where C turns the table, on the platform or in the frame.

#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus {

/// Of the platform's frame, in the machine frame.
struct PlatformPose {
  Vector3 p_mm{};
  double a_rad = 0;  ///< tilt about X
};

/// Tilt of the platform about X.
inline double platform_tilt(const M1Geometry& geometry, const Pose& pose) {
  return geometry.tool == ToolPlacement::kPlatform ? -pose[kA] : pose[kA];
}
/// Its zero; `tilt`: of platform_tilt().
Vector3 platform_at(const M1Geometry& geometry, Frame frame, const Pose& pose, const Turn& tilt);
inline PlatformPose platform_at(const M1Geometry& geometry, Frame frame, const Pose& pose) {
  const double tilt_rad = platform_tilt(geometry, pose);
  return {platform_at(geometry, frame, pose, Turn(tilt_rad)), tilt_rad};
}
/// The way back. `c_rad`, `e_mm`: what the mechanism does not say.
Pose pose_at(const M1Geometry& geometry, Frame frame, const PlatformPose& platform, double c_rad,
             double e_mm);

/// The same rails, legs and platform with the tool in the frame, where no X, Y, Z limits the pose. With the
/// tool in the frame already: `geometry`.
M1Geometry with_tool_in_frame(const M1Geometry& geometry);

/// The kinematics of a geometry whose tool is on the platform. `fixed_tool`: of with_tool_in_frame(geometry).
std::unique_ptr<Kinematics> make_tool_on_platform(const M1Geometry& geometry,
                                                  std::unique_ptr<Kinematics> fixed_tool);

/// +1: the platform brings part and tool together on its way up; -1: on its way down.
inline double approach_direction(const M1Geometry& geometry) {
  return geometry.tool == ToolPlacement::kPlatform ? -1 : 1;
}

}  // namespace kinebus
