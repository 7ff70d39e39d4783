#pragma once
// What every machine's kinematics offers. Pure functions of a pose; no state, no heap, no I/O.
//
// Pose: where the tool tip is relative to the part, and the rotations, in one of two frames
// (gateway/pose.hpp).

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gateway/pose.hpp"
#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

inline constexpr int kMaxJoints = 8;
using JointVector =
    std::array<double, kMaxJoints>;  ///< mm for linear, rad for rotary joints; unused entries 0

/// A pose and its first two derivatives by any one parameter s (path length, time): x(s), dx/ds, d2x/ds2.
struct PosePoint {
  Pose x{};
  Pose x1{};
  Pose x2{};
};
/// Joints and their first two derivatives by the same parameter.
struct JointPoint {
  JointVector q{};
  JointVector q1{};
  JointVector q2{};
};

/// Why a pose cannot be taken. `joint`: which joint or leg, -1 where none; `amount`: by how much (mm, rad or
/// ratio).
struct PoseError {
  enum class Kind : std::uint8_t {
    kOutOfReach,     ///< amount: mm that the leg is too short
    kJointLimit,     ///< amount: mm or rad outside the joint's travel
    kLegAngle,       ///< amount: rad over the allowed lateral leg angle
    kClearance,      ///< amount: rad too near to a rail (joint < 4 legs), or a leg to the platform
    kPoseLimit,      ///< joint: the PoseAxis; amount: mm or rad outside
    kSingular,       ///< amount: condition number reached
    kNoConvergence,  ///< forward kinematics; amount: residual, mm
  };
  Kind kind{};
  int joint = -1;
  double amount = 0;
  bool angular = false;  ///< kJointLimit, kPoseLimit: amount is rad, not mm
};

struct JointInfo {
  std::string name;         ///< "tower1", "C", "E"
  bool rotary = false;      ///< rad instead of mm
  double min = 0, max = 0;  ///< travel; min == max: unlimited
};

class Kinematics {
 public:
  virtual ~Kinematics() = default;

  virtual std::string name() const = 0;
  virtual int joint_count() const = 0;
  virtual JointInfo joint_info(int joint) const = 0;

  /// Joints for a pose. Only geometry is checked (kOutOfReach), not limits. Cost M1: <= 60 ns.
  virtual Result<void, PoseError> inverse(Frame frame, const Pose& pose, JointVector& joints) const = 0;

  /// Joints and their first and second derivatives along a path: q1 = J x1, q2 = J x2 + J' x1 (both terms).
  /// Cost M1: <= 200 ns.
  virtual Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                                JointPoint& joints) const = 0;

  /// Jacobian dq/dx, row-major joint_count() x kPoseAxes. Cost M1 together with inverse: <= 150 ns.
  virtual Result<void, PoseError> jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                           std::span<double> matrix) const = 0;

  /// Pose for joints, by damped Newton from `pose` (any pose of the workspace will do; a near one is faster).
  virtual Result<void, PoseError> forward(Frame frame, const JointVector& joints, Pose& pose) const = 0;

  /// All that must hold for the machine to stand at this pose: reach, joint travel, pose limits, leg angles,
  /// conditioning. The first violated rule is reported.
  virtual Result<void, PoseError> check(Frame frame, const Pose& pose) const = 0;

  /// Condition number of the Jacobian of the machine's parallel part, rotations scaled as the machine states.
  virtual double condition(Frame frame, const Pose& pose) const = 0;

  /// The joints' home switch positions' pose aside, where the machine waits before a job (M1: table centre
  /// under the nozzle at the configured height).
  virtual Pose bed_reference() const = 0;
};

/// In plain words with units: "tower3: the carriage would be 4.210 mm beyond its travel". Without the
/// kinematics, joints are named by their number from 1.
Sentence to_string(const PoseError& error);
Sentence to_string(const PoseError& error, const Kinematics& kinematics);

}  // namespace kinebus
