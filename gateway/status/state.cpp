#include "gateway/status/state.hpp"

#include <array>

namespace kinebus {
namespace {

using S = MachineState;

constexpr std::uint32_t bit(S s) {
  return 1u << static_cast<unsigned>(s);
}
template <typename... States>
constexpr std::uint32_t set(States... states) {
  return (0u | ... | bit(states));
}
constexpr std::uint32_t kAny = (1u << kMachineStates) - 1;
constexpr std::uint32_t kInMotion = set(S::kMoving, S::kRunning, S::kHolding, S::kHeld);

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
     set(S::kBringUp, S::kHoming, S::kMoving, S::kChecking, S::kRunning, S::kHolding, S::kHeld,
         S::kCancelling, S::kStopped, S::kAlarm)},
    {S::kMoving, phrase("moving"), set(S::kReady, S::kHeld)},
    {S::kChecking, phrase("checking the job"), set(S::kReady)},
    {S::kRunning, phrase("running"), set(S::kReady, S::kChecking, S::kHeld)},
    {S::kHolding, phrase("holding"), set(S::kMoving, S::kRunning, S::kHeld)},
    {S::kHeld, phrase("held"), set(S::kHolding, S::kStopped, S::kAlarm)},
    {S::kCancelling, phrase("cancelling"), kInMotion},
    {S::kStopping, phrase("stopping"), kAny},
    {S::kStopped, phrase("stopped"), set(S::kStopping)},
    {S::kAlarm, phrase("alarm"), kAny},
}};

constexpr bool table_is_in_order() {
  for (unsigned i = 0; i < kStates.size(); ++i)
    if (static_cast<unsigned>(kStates[i].state) != i) return false;
  return true;
}
static_assert(table_is_in_order());

}  // namespace

std::string_view to_string(MachineState state) {
  return kStates[static_cast<std::size_t>(state)].name;
}
Sentence sentence(MachineState state) {
  return say(kStates[static_cast<std::size_t>(state)].name);
}

bool may_follow(MachineState from, MachineState to) {
  return (kStates[static_cast<std::size_t>(to)].from & bit(from)) != 0;
}

}  // namespace kinebus
