#pragma once
// The states of the machine as a whole, and which command is allowed in which state. One table, no conditions
// scattered elsewhere.

#include <cstdint>
#include <string_view>

#include "gateway/sentence.hpp"

namespace kinebus {

enum class MachineState : std::uint8_t {
  kOff,         ///< drives without power, positions unknown; the bus may be empty
  kBringUp,     ///< finding, checking, configuring and enabling the nodes
  kUnhomed,     ///< drives hold, positions unknown
  kHoming,      ///< carriages on their way to the switches
  kReady,       ///< positions known, at rest, nothing to do
  kMoving,      ///< a single move: bed reference, jog
  kChecking,    ///< a job is checked before motion
  kRunning,     ///< a job runs
  kHolding,     ///< the path's rate goes to 0 on command
  kHeld,        ///< at rest on the path, the job or move can go on
  kCancelling,  ///< ramp to rest on the path, then the queued motion is dropped
  kStopping,    ///< latched stop, ramp under way
  kStopped,     ///< latched stop, at rest on the path; clear() lifts it
  kAlarm,       ///< at rest with a fault; clear() after its cause is gone
};
inline constexpr int kMachineStates = 14;
std::string_view to_string(MachineState state);
Sentence sentence(MachineState state);

enum class MachineCommand : std::uint8_t {
  kBringUp,
  kHome,
  kReference,
  kJog,
  kRun,
  kHold,
  kResume,
  kCancel,
  kStop,
  kClear,
  kFeedOverride,
  kMotorsOff,
  kThermal
};
inline constexpr int kMachineCommands = 13;
std::string_view to_string(MachineCommand command);
Sentence sentence(MachineCommand command);

/// Whether `command` may be given in `state`; the table is in state.cpp.
bool allowed(MachineCommand command, MachineState state);
/// Whether the machine may go from one state to another; the program ends on any other change.
bool may_follow(MachineState from, MachineState to);

}  // namespace kinebus
