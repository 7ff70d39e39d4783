#include "node_firmware/heat/pin_probe.hpp"

#include <utility>

namespace kinebus::heat {

void PinProbe::fit(bool fitted) {
  if (std::exchange(fitted_, fitted) == fitted) return;
  step_ = Step::kIdle;
  state_ = PinState::kUnknown;
  pulse_ = 0;
}

bool PinProbe::command(LocalTime now, PinCommand command) {
  if (!fitted_ || command < PinCommand::kDeploy || command > PinCommand::kReset) return false;
  command_ = command;
  again_ = false;
  if (command == PinCommand::kSelfTest) {
    set_pulse(kSelfTestPulse);
    state_ = PinState::kSelfTest;
    return true;
  }
  const bool was_in = state_ == PinState::kStowed && command == PinCommand::kDeploy;
  begin(now, command == PinCommand::kReset ? Step::kReset : was_in ? Step::kCheck : Step::kMove);
  return true;
}

void PinProbe::set_pulse(std::uint16_t us) {
  step_ = Step::kIdle;
  state_ = PinState::kUnknown;
  pulse_ = us;
}

void PinProbe::begin(LocalTime now, Step step) {
  state_ = PinState::kMoves;
  step_ = step;
  switch (step) {
    case Step::kReset:
      pulse_ = kResetPulse;
      break;
    case Step::kMove:
      pulse_ = command_ == PinCommand::kDeploy ? kDownPulse : kUpPulse;
      break;
    case Step::kCheck:
    case Step::kLook:
      pulse_ = kTouchPulse;
      break;
    case Step::kSettle:
      pulse_ = kUpPulse;
      break;
    case Step::kIdle:
      break;
  }
  until_ = now + (step == Step::kReset || step == Step::kMove ? kWay : kMode);
}

/// Once more after a reset, then it is so.
void PinProbe::wrong(LocalTime now, PinState as) {
  if (!std::exchange(again_, true)) return begin(now, Step::kReset);
  step_ = Step::kIdle;
  state_ = as;
  // Up: what may still come in, comes in.
  pulse_ = kUpPulse;
}

void PinProbe::on_sample(LocalTime now, bool level) {
  level_ = level;
  if (step_ == Step::kIdle || now < until_) return;
  const bool out = command_ == PinCommand::kDeploy;
  switch (step_) {
    case Step::kCheck:
      if (level) return begin(now, Step::kMove);
      // No second try: what falls out again by itself is not to be relied on.
      step_ = Step::kIdle;
      state_ = PinState::kNotIn;
      pulse_ = kUpPulse;
      return;
    case Step::kReset:
      return begin(now, Step::kMove);
    case Step::kMove:
      if (level) return wrong(now, PinState::kAlarm);
      return begin(now, Step::kLook);
    case Step::kLook:
      if (level == out) return wrong(now, out ? PinState::kNotOut : PinState::kNotIn);
      if (!out) return begin(now, Step::kSettle);
      break;
    case Step::kSettle:
      if (level) return wrong(now, PinState::kAlarm);
      break;
    case Step::kIdle:
      return;
  }
  step_ = Step::kIdle;
  state_ = out ? PinState::kDeployed : PinState::kStowed;
}

}  // namespace kinebus::heat
