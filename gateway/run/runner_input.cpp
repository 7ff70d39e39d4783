// M66: at rest until an input is as asked, or the time is over. A hold stops the time, and what the input
// does meanwhile does not count.

#include "gateway/gcode/interpreter.hpp"
#include "gateway/run/runner.hpp"

namespace kinebus {

using Until = canonical::AwaitInput::Until;

void Runner::begin_input(const canonical::AwaitInput& wait) {
  awaited_input_ = wait;
  dwell_left_ = BusTime{static_cast<std::int64_t>(wait.seconds * 1e9)};
  wait_ = Wait::kInput;
  doing_ = say("waiting for input %1", wait.index);
  look_at_input_anew();
}

void Runner::look_at_input_anew() {
  if (wait_ != Wait::kInput) return;
  if (const Input* const input = heat_.input(awaited_input_.index)) input_before_ = input->changes();
}

/// Or never will; then #5399 says so.
bool Runner::input_has_come(BusTime now) {
  const Input* const input = heat_.input(awaited_input_.index);
  const InputLevel level = input != nullptr ? input->level() : InputLevel::kUnknown;
  const Input::Changes changes = input != nullptr ? input->changes() : Input::Changes{};
  bool come = false;
  switch (awaited_input_.until) {
    case Until::kNow:
      if (level == InputLevel::kUnknown && input != nullptr) return false;  // its node tells soon
      end_input(input == nullptr ? gcode::kNoInput : level == InputLevel::kOn ? 1 : 0);
      return true;
    case Until::kRises:
      come = changes.rises != input_before_.rises;
      break;
    case Until::kFalls:
      come = changes.falls != input_before_.falls;
      break;
    case Until::kOn:
      come = level == InputLevel::kOn;
      break;
    case Until::kOff:
      come = level == InputLevel::kOff;
      break;
  }
  if (!come && dwell_left_ > BusTime{0}) return false;
  if (!come)
    events_out_.message(now, say("input %1 has not come in time: #5399 is -1", awaited_input_.index),
                        last_line_);
  const bool high = awaited_input_.until == Until::kRises || awaited_input_.until == Until::kOn;
  end_input(!come ? gcode::kNoInput : high ? 1 : 0);
  return true;
}

void Runner::end_input(double value) {
  journal::Learned learned{.what = journal::Learned::What::kInput};
  learned.at[kX] = value;
  learn(learned);
  pipeline_.input_read(value);
  if (live_) answers_.push_back({.input = value});
  check_what_follows();
}

}  // namespace kinebus
