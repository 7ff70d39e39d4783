#pragma once
// The machine that is asked about.

#include <memory>
#include <string>
#include <vector>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/description/machine_description.hpp"

namespace kinebus::kinematics_tool {

/// A machine, and what of it takes part in its kinematics: all but the filament.
class Subject {
 public:
  /// The error: why no machine can have this geometry.
  static Result<Subject, std::string> of(MachineDescription machine);

  const MachineDescription& machine() const { return machine_; }
  const Kinematics& kinematics() const { return *kinematics_; }
  /// nullptr: the machine file does not say what is solid.
  const bodies::CollisionModel* collision_model() const { return collision_model_.get(); }

  struct Axis {
    std::string name;   ///< "X", "tower1"
    std::size_t index;  ///< in a Pose or JointVector
    bool rotary;
    double unit() const { return rotary ? kRadPerDeg : 1; }  ///< of a number that a person reads
    std::string column(const char* per = "") const;          ///< "x_mm", "x_mm_per_s"
  };
  const std::vector<Axis>& pose_axes() const { return pose_axes_; }
  const std::vector<Axis>& joints() const { return joints_; }
  /// So many joints belong to the mechanism that is not a table on its own: forward() needs them at least.
  std::size_t mechanism_joints() const;

 private:
  MachineDescription machine_;
  std::unique_ptr<Kinematics> kinematics_;
  std::unique_ptr<const bodies::CollisionModel> collision_model_;
  std::vector<Axis> pose_axes_, joints_;
};

}  // namespace kinebus::kinematics_tool
