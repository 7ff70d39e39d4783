// PoseError in words.

#include <cstdio>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {
namespace {

std::string amount_text(double amount, bool angular) {
  char text[48];
  if (angular)
    std::snprintf(text, sizeof text, "%.3f deg", amount / kRadPerDeg);
  else
    std::snprintf(text, sizeof text, "%.3f mm", amount);
  return text;
}

std::string describe(const PoseError& error, const std::string& joint) {
  constexpr const char* kAxisNames[kPoseAxes] = {"X", "Y", "Z", "A", "C", "E"};
  switch (error.kind) {
    case PoseError::Kind::kOutOfReach:
      return joint + ": out of reach, the leg is " + amount_text(error.amount, false) + " too short";
    case PoseError::Kind::kJointLimit:
      return joint + ": would be " + amount_text(error.amount, error.angular) + " beyond its travel";
    case PoseError::Kind::kLegAngle:
      return joint + ": the leg leans " + amount_text(error.amount, true) + " too far from its rail";
    case PoseError::Kind::kClearance:
      return joint + ": leg, rail and platform come " + amount_text(error.amount, true) +
             " too near to each other";
    case PoseError::Kind::kPoseLimit: {
      const std::string axis = error.joint >= 0 && error.joint < kPoseAxes ? kAxisNames[error.joint] : "?";
      return axis + " is " + amount_text(error.amount, error.angular) + " outside the workspace";
    }
    case PoseError::Kind::kSingular: {
      char text[96];
      std::snprintf(text, sizeof text, "too near to a singular pose: condition number %.3g", error.amount);
      return text;
    }
    case PoseError::Kind::kNoConvergence:
      return "no pose fits these joint positions (" + amount_text(error.amount, false) + " remain)";
  }
  return "unknown pose error";
}

}  // namespace

std::string to_string(const PoseError& error) {
  return describe(error, error.joint < 0 ? "machine" : "joint " + std::to_string(error.joint + 1));
}

std::string to_string(const PoseError& error, const Kinematics& kinematics) {
  const bool named = error.joint >= 0 && error.joint < kinematics.joint_count();
  return describe(error, named ? kinematics.joint_info(error.joint).name : "machine");
}

}  // namespace kinebus
