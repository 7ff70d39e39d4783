// M66: an input is read, or waited for at rest.
#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {

bool Core::await_input(Code code) {
  using Until = canonical::AwaitInput::Until;
  constexpr double kLongest_s = 86'400;
  if (has('E'))
    return fail(block_.column_of('E'),
                say("M66 E reads an analogue input, which machines of this kind do not "
                    "have: P reads a digital one"));
  if (!has('P')) return fail(code.column, say("M66 needs the input P"));
  canonical::AwaitInput wait;
  int until = 0;
  const bool timed = has('Q');
  if (!take_integer('P', 0, 7, wait.index) || !take_integer('L', 0, 4, until) ||
      !take_if_given('Q', wait.seconds))
    return false;
  wait.until = static_cast<Until>(until);
  if (wait.until == Until::kNow) {
    wait.seconds = 0;
  } else if (!timed || !(wait.seconds > 0 && wait.seconds <= kLongest_s)) {
    return fail(
        timed ? block_.column_of('Q') : code.column,
        say("M66 L1 to L4 waits at most Q seconds: more than 0, at most %1", printed("%.6g", kLongest_s)));
  }
  emit(wait);
  set_input(wait.until == Until::kRises || wait.until == Until::kOn ? 1 : 0);
  return true;
}

}  // namespace kinebus::gcode
