#pragma once
// What the machine description means for each core that a job passes through.

#include <optional>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/sentence.hpp"
#include "gateway/shaping/path_shaper.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "gateway/stream/stream_group.hpp"

namespace kinebus {

MotionLimits motion_limits(const MachineDescription& machine);
/// Those to plan with, so that the machine's own hold after shaping. Equal where nothing is shaped.
MotionLimits limits_before_shaping(const MachineDescription& machine, const VibrationDescription& vibration);
PathShaper::Shapers axis_shapers(const VibrationDescription& vibration);
/// What leaves room for pressure advance within the limits of the extruder; unlimited without a window. In a
/// window beads and filament alone rest between each other, whatever the advance: 0, too.
FilamentLimits limits_before_advance(const MachineDescription& machine, const VibrationDescription& vibration,
                                     const AdvanceModel& model, const AdvanceWindow& window);
/// Of one joint, mm or rad a s^3: its own limit, or the tool's in proportion to their accelerations; infinite
/// where the tool's jerk is not limited.
double joint_jerk_limit(const MachineDescription& machine, const JointDescription& joint);

/// `start`: where the machine stands when the job begins, `home`: after G28; both Frame::kMachine.
gcode::Options interpreter_options(const MachineDescription& machine, const Pose& start, const Pose& home);

/// Nodes that have axes, in ascending order of their ids; an axis that no joint names has joint -1. Counts
/// are 0 where the joint value is 0.
std::vector<NodeAxes> node_axes(const MachineDescription& machine);

StreamGroup::Options stream_options(const MachineDescription& machine);

/// Why this machine's spindle cannot turn so fast (`rpm` < 0: the other way round); none: it can.
std::optional<Sentence> wrong_spindle_speed(const SpindleDescription& spindle, double rpm);

/// Which heater a canonical command names; none: a fan or an output.
std::optional<HeaterId> heater_of(const canonical::Thermal& thermal);
/// "bed", "hotend T1"
Sentence heater_words(HeaterId id);

/// Why this machine cannot do what is asked of its heaters and outputs; none: it can.
std::optional<Sentence> wrong_device_command(const MachineDescription& machine,
                                             const canonical::Thermal& thermal);
/// Why M66 cannot read it; none: it can.
std::optional<Sentence> missing_input(const MachineDescription& machine, const canonical::AwaitInput& wait);
/// What is asked of a fan that the machine does not have: sliced for another machine, and no reason to refuse
/// a job.
std::optional<Sentence> missing_fan(const MachineDescription& machine, const canonical::Thermal& thermal);

/// The same place in the other frame, by way of the joints.
Result<Pose, PoseError> convert_pose(const Kinematics& kinematics, Frame from, const Pose& pose, Frame to);

}  // namespace kinebus
