#pragma once
// Joint mm or rad <-> counts of a node's axis: the one place where this happens.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "gateway/calibration/joint_map.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {

/// One axis of a node: which joint it moves, and how. Calibration stays out of the kinematics: a rail whose
/// measured travel is (1 + scale_correction) times the commanded one gets that number here (paper M5's
/// table), one whose error bends gets a map, one with play gets a gap.
struct AxisScaling {
  int joint = -1;                    ///< index into JointVector; -1: the axis is not used and holds
  double counts_per_unit = 1280;     ///< counts per mm or rad; 51,200 a turn and 40 mm a turn: 1280
  bool reversed = false;             ///< counts grow when the joint value falls
  double scale_correction = 0;       ///< ratio, |x| < 0.1
  double offset = 0;                 ///< mm or rad: the joint's value where the counts are 0
  double tolerance_counts = 0.5;     ///< how far the streamed motion may leave q(tau)
  double acceleration_limit = 5000;  ///< mm/s^2 or rad/s^2, of the joint; segments stay below. 0: not limited

  std::shared_ptr<const JointMap> map{};  ///< what the motor must do for the joint; none: the same
  double gap = 0;                         ///< backlash, mm or rad
  double take_up_per_s2 = 0;              ///< acceleration with which it is taken up
  double home_side = 1;                   ///< side of the gap after homing, see BacklashTakeUp

  /// Counts per joint unit, with sign and correction.
  double slope() const { return (reversed ? -counts_per_unit : counts_per_unit) / (1 + scale_correction); }
  /// `side`: of the gap, -1..1.
  double to_counts(double joint_value, double side) const {
    return slope() * ((map ? map->to_drive(joint_value) : joint_value) + side * gap / 2 - offset);
  }
  double to_joint(double counts, double side) const {
    const double drive = counts / slope() + offset - side * gap / 2;
    return map ? map->to_joint(drive) : drive;
  }
  double to_counts(double joint_value) const { return to_counts(joint_value, home_side); }
  double to_joint(double counts) const { return to_joint(counts, home_side); }
};

/// A node and its two axes.
struct NodeAxes {
  std::uint8_t node_id = 0;
  std::array<AxisScaling, kAxesPerNode> axes{};
};

inline constexpr double kCountFraction = 4294967296.0;  ///< 2^32: AxisState's fractions of a count

/// Position with 32 fractional bits, as the node counts it.
inline std::int64_t to_fixed(double counts) {
  return std::llround(counts * kCountFraction);
}
inline double to_counts(std::int64_t fixed) {
  return static_cast<double>(fixed) / kCountFraction;
}

}  // namespace kinebus
