#pragma once
// How a job asks for its motion to be shaped: M593, SET_INPUT_SHAPER.

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

/// What `asked`, merged of all that a job has said, makes of the machine file's `before`. A shaper that is
/// not named stays the one in force, or is the dialect's usual one. Error: a shaper without a frequency;
/// directions shaped apart on a machine that turns or tilts the part, where Z goes along with X and Y.
Result<VibrationDescription, Sentence> shaped_by_job(const Kinematics& kinematics,
                                                     const VibrationDescription& before,
                                                     const canonical::InputShaping& asked);

/// What is stated takes the place of what was stated before.
void merge_shaping(canonical::InputShaping& all, const canonical::InputShaping& more);

}  // namespace kinebus
