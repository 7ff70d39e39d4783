#pragma once
// Where the tool is: the one pose and the one frame that G-code, motion, kinematics and the machine share.

#include <array>
#include <cstdint>

namespace kinebus {

enum PoseAxis : std::uint8_t { kX, kY, kZ, kA, kC, kE };  ///< mm, mm, mm, rad, rad, mm of filament
inline constexpr int kPoseAxes = 6;
using Pose = std::array<double, kPoseAxes>;

/// What X Y Z of a pose mean: where the tool is relative to the part, whichever of both moves. Both frames
/// have their zero at the table's centre, and are the same at A = C = 0; m = R_X(A) R_Z(C) q on every
/// machine.
enum class Frame : std::uint8_t {
  kPart,     ///< q, in table coordinates: they turn with the table (tool-centre-point control, G43.4)
  kMachine,  ///< m, along the tool's axes: X Y Z do not follow A and C (G49). Of a tool that does not tilt
             ///< these are the axes of the machine frame {O}
};

}  // namespace kinebus
