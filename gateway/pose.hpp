#pragma once
// Where the tool is: the one pose and the one frame that G-code, motion, kinematics and the machine share.

#include <array>
#include <cstdint>

namespace kinebus {

enum PoseAxis : std::uint8_t { kX, kY, kZ, kA, kC, kE };  ///< mm, mm, mm, rad, rad, mm of filament
inline constexpr int kPoseAxes = 6;
using Pose = std::array<double, kPoseAxes>;

/// What X Y Z of a pose mean. Both have their zero at the table's centre (M1: platform point with the nozzle
/// on it; the bed reference position), and are the same at A = C = 0. M1: p = n - m = n - R_X(A) R_Z(C) q.
enum class Frame : std::uint8_t {
  kPart,     ///< q, in table coordinates: they turn with the table (tool-centre-point control, G43.4)
  kMachine,  ///< m, along the axes of the machine frame {O}: X Y Z do not follow A and C (G49)
};

}  // namespace kinebus
