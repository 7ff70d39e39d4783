// PoseError in words.

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {
namespace {

std::string amount_text(double amount, bool angular) {
  return angular ? printed("%.3f deg", amount / kRadPerDeg) : printed("%.3f mm", amount);
}

Sentence describe(const PoseError& error, const Sentence& joint) {
  constexpr const char* kAxisNames[kPoseAxes] = {"X", "Y", "Z", "A", "C", "E"};
  switch (error.kind) {
    case PoseError::Kind::kOutOfReach:
      return say("%1: out of reach, the leg is %2 too short", joint, amount_text(error.amount, false));
    case PoseError::Kind::kJointLimit:
      return say("%1: would be %2 beyond its travel", joint, amount_text(error.amount, error.angular));
    case PoseError::Kind::kLegAngle:
      return say("%1: the leg leans %2 too far from its rail", joint, amount_text(error.amount, true));
    case PoseError::Kind::kClearance:
      return say("%1: leg, rail and platform come %2 too near to each other", joint,
                 amount_text(error.amount, true));
    case PoseError::Kind::kPoseLimit: {
      const std::string axis = error.joint >= 0 && error.joint < kPoseAxes ? kAxisNames[error.joint] : "?";
      return say("%1 is %2 outside the workspace", axis, amount_text(error.amount, error.angular));
    }
    case PoseError::Kind::kSingular: {
      return say("too near to a singular pose: condition number %1", printed("%.3g", error.amount));
    }
    case PoseError::Kind::kNoConvergence:
      return say("no pose fits these joint positions (%1 remain)", amount_text(error.amount, false));
  }
  return say("unknown pose error");
}

}  // namespace

Sentence to_string(const PoseError& error) {
  return describe(error, error.joint < 0 ? say("machine") : say("joint %1", error.joint + 1));
}

Sentence to_string(const PoseError& error, const Kinematics& kinematics) {
  const bool named = error.joint >= 0 && error.joint < kinematics.joint_count();
  return describe(error,
                  named ? Sentence::verbatim(kinematics.joint_info(error.joint).name) : say("machine"));
}

}  // namespace kinebus
