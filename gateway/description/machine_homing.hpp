#pragma once
// A machine's homing, as its description has it: the order in which its joints home, and that they can.

#include <memory>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/description/machine_rules.hpp"
#include "gateway/homing/survey.hpp"

namespace kinebus {

/// The joints that home, in the order of the joints.
std::vector<homing::Joint> homing_joints(const MachineDescription& description);
homing::Plan homing_plan(const MachineDescription& description, const Kinematics& kinematics);

/// Refuses a machine with bodies whose homing runs into something from one of a few poses. More of them:
/// kinebus plan --home.
void judge_homing(const MachineDescription& description, std::vector<BrokenRule>& broken);

/// What the survey of homings needs, and what it refers to. The description must be one that has kinematics.
class HomingStudy {
 public:
  explicit HomingStudy(const MachineDescription& description);
  HomingStudy(const HomingStudy&) = delete;
  HomingStudy& operator=(const HomingStudy&) = delete;
  const homing::Machine& machine() const { return machine_; }
  /// The greatest part on the table; height 0: none.
  void set_part(double radius_mm, double height_mm);
  const homing::Plan& plan() const { return plan_; }
  const Kinematics& kinematics() const { return *kinematics_; }

 private:
  std::unique_ptr<Kinematics> kinematics_, mechanism_;
  MachineDescription bare_;  ///< what its bodies follow from
  homing::Machine machine_;
  homing::Plan plan_;
};

}  // namespace kinebus
