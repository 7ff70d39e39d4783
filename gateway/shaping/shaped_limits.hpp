#pragma once
// Whether the joints can follow a shaped phase.

#include <optional>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

class ShapedLimits {
 public:
  struct Excess {
    int joint = 0;
    bool acceleration = false;  ///< or its speed
    double ratio = 1;           ///< to the limit
  };
  /// `kinematics` must outlive this. Limits: of each joint, a second and a second^2.
  ShapedLimits(const Kinematics& kinematics, const JointVector& speed, const JointVector& accel)
      : kinematics_(&kinematics), speed_(speed), accel_(accel) {}

  /// The worst joint: its speed at both ends and in the middle, its acceleration in the middle, where a cubic
  /// has the mean of the phase; nullopt: all stay within their limits. A pose that cannot be taken is not
  /// judged here. Cost: three inverse_along.
  std::optional<Excess> excess(const Phase& phase) const;

 private:
  const Kinematics* kinematics_;
  JointVector speed_, accel_;
};

}  // namespace kinebus
