#include "gateway/machine/state.hpp"

#include <array>

namespace kinebus {
namespace {

using S = MachineState;
using C = MachineCommand;

constexpr std::uint32_t bit(S s) {
  return 1u << static_cast<unsigned>(s);
}
template <typename... States>
constexpr std::uint32_t set(States... states) {
  return (0u | ... | bit(states));
}
constexpr std::uint32_t kAny = (1u << kMachineStates) - 1;
constexpr std::uint32_t kInMotion = set(S::kMoving, S::kRunning, S::kHolding, S::kHeld);

struct CommandRule {
  C command;
  std::string_view name;
  std::uint32_t states;  ///< in which it may be given
};
constexpr std::array<CommandRule, kMachineCommands> kCommands{{
    {C::kBringUp, "bring up", set(S::kOff)},
    {C::kHome, "home", set(S::kUnhomed, S::kReady)},
    {C::kReference, "go to the bed reference", set(S::kReady)},
    {C::kJog, "jog", set(S::kReady)},
    {C::kRun, "run a job", set(S::kReady)},
    {C::kHold, "hold", set(S::kMoving, S::kRunning)},
    // Other than held: when a job was interrupted (Core::resume).
    {C::kResume, "resume", set(S::kHeld, S::kOff, S::kUnhomed, S::kReady)},
    {C::kCancel, "cancel", kInMotion | set(S::kChecking, S::kOff, S::kUnhomed, S::kReady)},
    {C::kStop, "stop", kAny},
    {C::kClear, "clear", set(S::kStopped, S::kAlarm)},
    {C::kFeedOverride, "set the feed override", kAny},
    {C::kMotorsOff, "switch the motors off", set(S::kUnhomed, S::kReady, S::kStopped, S::kAlarm)},
    {C::kThermal, "set a temperature", kAny & ~set(S::kAlarm)},
}};

struct StateRule {
  S state;
  std::string_view name;
  std::uint32_t from;  ///< the states that it may follow
};
// kStopping and kAlarm may follow every state: a stop or a fault asks for no permission.
constexpr std::array<StateRule, kMachineStates> kStates{{
    {S::kOff, "off", set(S::kUnhomed, S::kReady, S::kStopped, S::kAlarm)},
    {S::kBringUp, "bring-up", set(S::kOff)},
    {S::kUnhomed, "not homed", set(S::kBringUp, S::kCancelling, S::kStopped, S::kAlarm)},
    {S::kHoming, "homing", set(S::kUnhomed, S::kReady)},
    {S::kReady, "ready",
     set(S::kBringUp, S::kHoming, S::kMoving, S::kChecking, S::kRunning, S::kCancelling, S::kStopped,
         S::kAlarm)},
    {S::kMoving, "moving", set(S::kReady, S::kHeld)},
    {S::kChecking, "checking the job", set(S::kReady)},
    {S::kRunning, "running", set(S::kReady, S::kChecking, S::kHeld)},
    {S::kHolding, "holding", set(S::kMoving, S::kRunning)},
    {S::kHeld, "held", set(S::kHolding, S::kStopped, S::kAlarm)},
    {S::kCancelling, "cancelling", kInMotion},
    {S::kStopping, "stopping", kAny},
    {S::kStopped, "stopped", set(S::kStopping)},
    {S::kAlarm, "alarm", kAny},
}};

constexpr bool tables_are_in_order() {
  for (unsigned i = 0; i < kCommands.size(); ++i)
    if (static_cast<unsigned>(kCommands[i].command) != i) return false;
  for (unsigned i = 0; i < kStates.size(); ++i)
    if (static_cast<unsigned>(kStates[i].state) != i) return false;
  return true;
}
static_assert(tables_are_in_order());

}  // namespace

std::string_view to_string(MachineState state) {
  return kStates[static_cast<std::size_t>(state)].name;
}
std::string_view to_string(MachineCommand command) {
  return kCommands[static_cast<std::size_t>(command)].name;
}

bool allowed(MachineCommand command, MachineState state) {
  return (kCommands[static_cast<std::size_t>(command)].states & bit(state)) != 0;
}

bool may_follow(MachineState from, MachineState to) {
  return (kStates[static_cast<std::size_t>(to)].from & bit(from)) != 0;
}

}  // namespace kinebus
