#pragma once
// A machine that is not as its file says, and what measuring devices would read at it: proves a calibration
// from end to end. Both are machine descriptions; the calibration of `truth` is the truth about it.

#include <cstdint>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "tools/calibrate/fit/geometry_model.hpp"

namespace kinebus {

/// Where drive and joint agree by definition: the home switch, or 0.
double anchor_of(const JointDescription& joint);
/// How far the drive has gone from the switch's edge when this joint's controller stands at `position` and
/// came there in `direction`, mm or rad by the drive train alone.
double drive_from_home(const JointDescription& joint, double position, int direction);
/// Where the joint of the true machine is then.
double true_position(const JointDescription& believed, const JointDescription& truth, double position,
                     int direction);

struct HiddenErrors {
  double geometry_mm = 0.5, scale = 2e-3, backlash_mm = 0.1, switch_mm = 0.3, lean = 5e-4;
  double periodic_mm = 0;  ///< with the pitch of a turn of the motor
};
/// Each error drawn evenly within +- of that (backlash: half to all of it). Four-leg machines.
MachineDescription with_hidden_errors(const MachineDescription& machine, const HiddenErrors& errors,
                                      std::uint64_t seed);

/// CSV of all rails, forth and back every `step` mm.
std::string measure_rails(const MachineDescription& believed, const MachineDescription& truth, double step,
                          double noise_mm, std::uint64_t seed);
/// CSV of touch probe points at `poses`, each come to with the joints moving upwards (the gap closed the same
/// way).
std::string measure_points(const MachineDescription& believed, const MachineDescription& truth,
                           const std::vector<Pose>& poses, double noise_mm, std::uint64_t seed);

struct Accuracy {
  double rms_mm = 0, worst_mm = 0;
  int poses = 0;
};
/// The tool against where it was commanded, at random poses of the workspace, joints come from random sides.
Accuracy accuracy(const MachineDescription& believed, const MachineDescription& truth, int poses,
                  std::uint64_t seed);

/// Random poses of the machine's workspace with C = 0 that the machine's rules allow.
std::vector<Pose> random_poses(const MachineDescription& machine, int count, std::uint64_t seed);

}  // namespace kinebus
