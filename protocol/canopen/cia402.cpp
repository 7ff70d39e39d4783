#include "protocol/canopen/cia402.hpp"

namespace kinebus::cia402 {
namespace {

Stop ramp_of_quick_stop(std::int16_t option) {
  switch (option) {
    case 1:
    case 5:
      return Stop::kSlowDown;
    case 2:
    case 6:
      return Stop::kQuickStop;
    default:  // 3, 4, 7 and 8
      return Stop::kCurrentLimit;
  }
}

Stop ramp_of_halt_or_fault(std::int16_t option) {
  return option == 1 ? Stop::kSlowDown : option == 2 ? Stop::kQuickStop : Stop::kCurrentLimit;
}

}  // namespace

void PowerStateMachine::enter(State state) {
  state_ = state;
  stop_ = Stop::kNone;
  after_ = After::kNothing;
}

void PowerStateMachine::begin_stop(Stop ramp, After after) {
  stop_ = ramp;
  after_ = after;
}

void PowerStateMachine::on_initialised() {
  if (state_ == State::kNotReadyToSwitchOn) enter(State::kSwitchOnDisabled);
}

void PowerStateMachine::on_controlword(std::uint16_t word, const StopOptions& options) {
  const bool reset_edge = (word & control::kFaultReset) != 0 && (last_ & control::kFaultReset) == 0;
  last_ = word;
  const bool voltage = (word & control::kEnableVoltage) != 0;
  const bool no_quick_stop = (word & control::kQuickStop) != 0;
  const bool switch_on = (word & control::kSwitchOn) != 0;
  const bool enable = (word & control::kEnableOperation) != 0;
  halt_ = (word & control::kHalt) != 0;

  switch (state_) {
    case State::kNotReadyToSwitchOn:
    case State::kFaultReactionActive:
      return;
    case State::kFault:
      if (reset_edge && !fault_present_) enter(State::kSwitchOnDisabled);  // transition 15
      return;
    case State::kSwitchOnDisabled:
      if (voltage && no_quick_stop && !switch_on) enter(State::kReadyToSwitchOn);  // 2
      return;
    case State::kReadyToSwitchOn:
      if (!voltage || !no_quick_stop)
        enter(State::kSwitchOnDisabled);  // 7
      else if (switch_on)
        enter(enable ? State::kOperationEnabled : State::kSwitchedOn);  // 3, and 4 in the same command
      return;
    case State::kSwitchedOn:
      if (!voltage || !no_quick_stop)
        enter(State::kSwitchOnDisabled);  // 10
      else if (!switch_on)
        enter(State::kReadyToSwitchOn);  // 6
      else if (enable)
        enter(State::kOperationEnabled);  // 4
      return;
    case State::kOperationEnabled:
      if (!voltage) {
        enter(State::kSwitchOnDisabled);  // 9: power goes at once
      } else if (!no_quick_stop) {        // 11
        enter(State::kQuickStopActive);
        if (options.quick_stop == 0)
          enter(State::kSwitchOnDisabled);
        else
          begin_stop(ramp_of_quick_stop(options.quick_stop),
                     options.quick_stop < 5 ? After::kSwitchOnDisabled : After::kNothing);
      } else if (!switch_on) {  // 8
        if (options.shutdown == 0)
          enter(State::kReadyToSwitchOn);
        else
          begin_stop(Stop::kSlowDown, After::kReadyToSwitchOn);
      } else if (!enable) {  // 5
        if (options.disable_operation == 0)
          enter(State::kSwitchedOn);
        else
          begin_stop(Stop::kSlowDown, After::kSwitchedOn);
      } else if (halt_) {
        begin_stop(ramp_of_halt_or_fault(options.halt), After::kNothing);
      } else {
        begin_stop(Stop::kNone, After::kNothing);  // commands of a stop withdrawn before its end
      }
      return;
    case State::kQuickStopActive:
      if (!voltage)
        enter(State::kSwitchOnDisabled);  // 12
      else if (no_quick_stop && switch_on && enable && stop_ == Stop::kNone)
        enter(State::kOperationEnabled);  // 16: allowed with options 5 to 8, at rest
      return;
  }
}

void PowerStateMachine::on_stop_finished(const StopOptions&) {
  switch (after_) {
    case After::kNothing:
      if (state_ == State::kQuickStopActive)
        stop_ = Stop::kNone;  // rests, powered, until the master moves on
      return;                 // a halt holds as long as its bit is set
    case After::kSwitchOnDisabled:
      return enter(State::kSwitchOnDisabled);
    case After::kReadyToSwitchOn:
      return enter(State::kReadyToSwitchOn);
    case After::kSwitchedOn:
      return enter(State::kSwitchedOn);
    case After::kFault:
      return enter(State::kFault);
  }
}

void PowerStateMachine::on_fault(const StopOptions& options, bool power_lost) {
  if (state_ == State::kFault) return;
  const bool ramp = !power_lost && options.fault_reaction != 0 &&
                    (state_ == State::kOperationEnabled || state_ == State::kQuickStopActive);
  if (state_ == State::kFaultReactionActive && !power_lost) return;
  if (!ramp) return enter(State::kFault);  // 13 and 14 at once
  enter(State::kFaultReactionActive);
  begin_stop(ramp_of_halt_or_fault(options.fault_reaction), After::kFault);
}

bool PowerStateMachine::powered() const {
  return state_ == State::kSwitchedOn || state_ == State::kOperationEnabled ||
         state_ == State::kQuickStopActive || state_ == State::kFaultReactionActive;
}

std::uint16_t PowerStateMachine::statusword(bool voltage) const {
  std::uint16_t word = 0;
  switch (state_) {
    case State::kNotReadyToSwitchOn:
      word = 0x00;
      break;
    case State::kSwitchOnDisabled:
      word = 0x40;
      break;
    case State::kReadyToSwitchOn:
      word = 0x21;
      break;
    case State::kSwitchedOn:
      word = 0x23;
      break;
    case State::kOperationEnabled:
      word = 0x27;
      break;
    case State::kQuickStopActive:
      word = 0x07;
      break;
    case State::kFaultReactionActive:
      word = 0x0F;
      break;
    case State::kFault:
      word = 0x08;
      break;
  }
  if (voltage) word |= 0x10;
  return static_cast<std::uint16_t>(word | status::kRemote);
}

State state_of(std::uint16_t statusword) {
  if ((statusword & 0x4F) == 0x40) return State::kSwitchOnDisabled;
  if ((statusword & 0x4F) == 0x0F) return State::kFaultReactionActive;
  if ((statusword & 0x4F) == 0x08) return State::kFault;
  switch (statusword & 0x6F) {
    case 0x21:
      return State::kReadyToSwitchOn;
    case 0x23:
      return State::kSwitchedOn;
    case 0x27:
      return State::kOperationEnabled;
    case 0x07:
      return State::kQuickStopActive;
    default:
      return State::kNotReadyToSwitchOn;
  }
}

std::uint16_t next_controlword(State state) {
  switch (state) {
    case State::kFault:
      return control::kFaultReset;
    case State::kSwitchOnDisabled:
      return control::kShutdown;
    case State::kReadyToSwitchOn:
      return control::kSwitchedOn;
    case State::kSwitchedOn:
    case State::kQuickStopActive:
    case State::kOperationEnabled:
      return control::kOperation;
    case State::kNotReadyToSwitchOn:
    case State::kFaultReactionActive:
      return 0;
  }
  return 0;
}

}  // namespace kinebus::cia402
