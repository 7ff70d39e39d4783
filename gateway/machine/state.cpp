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
  const char* name;
  std::uint32_t states;  ///< in which it may be given
};
constexpr std::array<CommandRule, kMachineCommands> kCommands{{
    {C::kBringUp, phrase("bring up"), set(S::kOff)},
    {C::kHome, phrase("home"), set(S::kUnhomed, S::kReady)},
    {C::kReference, phrase("go to the bed reference"), set(S::kReady)},
    {C::kJog, phrase("jog"), set(S::kReady)},
    {C::kRun, phrase("run a job"), set(S::kReady)},
    {C::kHold, phrase("hold"), set(S::kMoving, S::kRunning)},
    // Other than held: when a job was interrupted (Core::resume).
    {C::kResume, phrase("resume"), set(S::kHeld, S::kOff, S::kUnhomed, S::kReady)},
    {C::kCancel, phrase("cancel"), kInMotion | set(S::kChecking, S::kOff, S::kUnhomed, S::kReady)},
    {C::kStop, phrase("stop"), kAny},
    {C::kClear, phrase("clear"), set(S::kStopped, S::kAlarm)},
    {C::kFeedOverride, phrase("set the feed override"), kAny},
    {C::kMotorsOff, phrase("switch the motors off"), set(S::kUnhomed, S::kReady, S::kStopped, S::kAlarm)},
    {C::kThermal, phrase("set a temperature"), kAny & ~set(S::kAlarm)},
}};

struct StateRule {
  S state;
  const char* name;
  std::uint32_t from;  ///< the states that it may follow
};
// kStopping and kAlarm may follow every state: a stop or a fault asks for no permission.
constexpr std::array<StateRule, kMachineStates> kStates{{
    {S::kOff, phrase("off"), set(S::kUnhomed, S::kReady, S::kStopped, S::kAlarm)},
    {S::kBringUp, phrase("bring-up"), set(S::kOff)},
    {S::kUnhomed, phrase("not homed"), set(S::kBringUp, S::kCancelling, S::kStopped, S::kAlarm)},
    {S::kHoming, phrase("homing"), set(S::kUnhomed, S::kReady)},
    {S::kReady, phrase("ready"),
     set(S::kBringUp, S::kHoming, S::kMoving, S::kChecking, S::kRunning, S::kCancelling, S::kStopped,
         S::kAlarm)},
    {S::kMoving, phrase("moving"), set(S::kReady, S::kHeld)},
    {S::kChecking, phrase("checking the job"), set(S::kReady)},
    {S::kRunning, phrase("running"), set(S::kReady, S::kChecking, S::kHeld)},
    {S::kHolding, phrase("holding"), set(S::kMoving, S::kRunning)},
    {S::kHeld, phrase("held"), set(S::kHolding, S::kStopped, S::kAlarm)},
    {S::kCancelling, phrase("cancelling"), kInMotion},
    {S::kStopping, phrase("stopping"), kAny},
    {S::kStopped, phrase("stopped"), set(S::kStopping)},
    {S::kAlarm, phrase("alarm"), kAny},
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

Sentence sentence(MachineState state) {
  return say(kStates[static_cast<std::size_t>(state)].name);
}
Sentence sentence(MachineCommand command) {
  return say(kCommands[static_cast<std::size_t>(command)].name);
}

bool allowed(MachineCommand command, MachineState state) {
  return (kCommands[static_cast<std::size_t>(command)].states & bit(state)) != 0;
}

bool may_follow(MachineState from, MachineState to) {
  return (kStates[static_cast<std::size_t>(to)].from & bit(from)) != 0;
}

}  // namespace kinebus
