#pragma once
// The states of the machine as a whole, and which may follow which. What may be commanded in which state:
// gateway/machine/commands.hpp.

#include <cstdint>
#include <string_view>

#include "gateway/sentence.hpp"

namespace kinebus {

enum class MachineState : std::uint8_t {
  kOff,       ///< drives without power, positions unknown; the bus may be empty
  kBringUp,   ///< finding, checking, configuring and enabling the nodes
  kUnhomed,   ///< drives hold, positions unknown
  kHoming,    ///< carriages on their way to the switches
  kReady,     ///< positions known, at rest, nothing to do
  kMoving,    ///< a single move: bed reference, jog
  kChecking,  ///< a job is checked before motion
  kRunning,   ///< a job runs
  kHolding,   ///< the path's rate goes to 0 on command, or by a heater's fault: then the tool is lifted, too
  kHeld,      ///< at rest on the path, the job or move can go on
  kCancelling,  ///< ramp to rest on the path, then the queued motion is dropped
  kStopping,    ///< latched stop, ramp under way
  kStopped,     ///< latched stop, at rest on the path; clear() lifts it
  kAlarm,       ///< at rest with a fault; clear() after its cause is gone
};
inline constexpr int kMachineStates = 14;
std::string_view to_string(MachineState state);
Sentence sentence(MachineState state);

/// Whether the machine may go from one state to another; the program ends on any other change.
bool may_follow(MachineState from, MachineState to);

}  // namespace kinebus
