#include "gateway/machine/commands.hpp"

namespace kinebus {
namespace {

using S = MachineState;

constexpr std::uint32_t kAny = (1u << kMachineStates) - 1;

template <typename... States>
constexpr std::uint32_t in(States... states) {
  return (0u | ... | (1u << static_cast<unsigned>(states)));
}

struct Row {
  CommandKind command;
  const char* name;
  std::uint32_t states;  ///< in which it may be given
};

constexpr std::array<Row, kCommandKinds> kTable{{
    {command::kind<command::BringUp>, phrase("bring up"), in(S::kOff)},
    {command::kind<command::Home>, phrase("home"), in(S::kUnhomed, S::kReady)},
    {command::kind<command::GoToReference>, phrase("go to the bed reference"), in(S::kReady)},
    {command::kind<command::Jog>, phrase("jog"), in(S::kReady, S::kMoving)},
    {command::kind<command::Run>, phrase("run a job"), in(S::kReady)},
    {command::kind<command::OpenLines>, phrase("move"), in(S::kReady)},
    {command::kind<command::Hold>, phrase("hold"), in(S::kMoving, S::kRunning)},
    // Resume and cancel at rest are for an interrupted job, a jog in motion follows jogs alone
    // (Gateway::Core::may).
    {command::kind<command::Resume>, phrase("resume"), in(S::kHeld, S::kOff, S::kUnhomed, S::kReady)},
    {command::kind<command::Cancel>, phrase("cancel"),
     in(S::kMoving, S::kRunning, S::kHolding, S::kHeld, S::kChecking, S::kOff, S::kUnhomed, S::kReady)},
    {command::kind<command::Stop>, phrase("stop"), kAny},
    {command::kind<command::Clear>, phrase("clear"), in(S::kStopped, S::kAlarm)},
    {command::kind<command::SetFeedOverride>, phrase("set the feed override"), kAny},
    {command::kind<command::MotorsOff>, phrase("switch the motors off"),
     in(S::kUnhomed, S::kReady, S::kStopped, S::kAlarm)},
    {command::kind<command::SetTemperature>, phrase("set a temperature"), kAny & ~in(S::kAlarm)},
    {command::kind<command::SetFan>, phrase("set the fan"), kAny},
    {command::kind<command::SetOutput>, phrase("set an output"), kAny},
    {command::kind<command::SetSpindle>, phrase("turn the spindle"), kAny & ~in(S::kAlarm)},
    {command::kind<command::SetWorkOffset>, phrase("set a work offset"), kAny},
    // In motion it waits for the end of it.
    {command::kind<command::SetMotorCurrents>, phrase("set a motor's currents"),
     kAny & ~in(S::kOff, S::kBringUp)},
    {command::kind<command::TuneMotor>, phrase("measure a motor"), in(S::kUnhomed, S::kReady)},
    {command::kind<command::JogMotor>, phrase("jog"), in(S::kReady)},
    {command::kind<command::TuneHeater>, phrase("measure a heater"), in(S::kUnhomed, S::kReady)},
    {command::kind<command::ExcludeObject>, phrase("leave an object out"),
     in(S::kRunning, S::kHolding, S::kHeld)},
    // Not in a job, which says itself where it needs it.
    {command::kind<command::MovePin>, phrase("move the probe's pin"),
     in(S::kUnhomed, S::kReady, S::kStopped, S::kAlarm)},
    {command::kind<command::StepAside>, phrase("set the job aside"), in(S::kHeld)},
    {command::kind<command::MoveFilament>, phrase("move the filament"), in(S::kReady)},
}};

constexpr bool table_is_in_order() {
  for (CommandKind i = 0; i < kTable.size(); ++i)
    if (kTable[i].command != i) return false;
  return true;
}
static_assert(table_is_in_order());

}  // namespace

Sentence sentence(CommandKind command) {
  return say(kTable[command].name);
}

bool allowed(CommandKind command, MachineState state) {
  return (kTable[command].states & in(state)) != 0;
}

}  // namespace kinebus
