#pragma once
// Forward kinematics of any machine: every pose that its joints allow, by elimination where the mechanism is
// parallel.

#include <string>
#include <utility>
#include <vector>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

struct Assembly {
  /// The mechanism's own coordinates as its paper has them: {"phi_deg", 36.48}, {"yp_mm", ...}.
  std::vector<std::pair<std::string, double>> mechanism;
  Pose pose{};             ///< of the tool, in the frame asked for
  double residual_mm = 0;  ///< largest closure error, by substitution
  bool mirrored = false;   ///< closes only with a part built as its mirror image
  bool as_described = true;
  std::string words;  ///< "as described", "mirrored triangle", "leg 2's carriage below the platform"
};

/// For type m4, whose tool triangle may be mounted mirrored.
bool can_be_mirrored(const KinematicsGeometry& geometry);

/// All assemblies for `joints` (mm, rad; the joints' true positions), those as described first. `mirrored`:
/// also those of a mirrored part. Empty: these joints close in no pose.
std::vector<Assembly> assemblies(const MachineDescription& machine, const Kinematics& kinematics, Frame frame,
                                 const JointVector& joints, bool mirrored);

}  // namespace kinebus
