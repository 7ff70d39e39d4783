#include "gateway/machine/current_state.hpp"

#include <cstdlib>

namespace kinebus {

void CurrentState::enter(BusTime now, MachineState state) {
  if (state == state_) return;
  // A program error, and no state to go on from: the daemon ends, and the nodes stop on the path by
  // themselves.
  if (!may_follow(state_, state)) std::abort();
  state_ = state;
  since_ = now;
  ++visit_;
  events_.push({.kind = MachineEvent::Kind::kState,
                .when = now,
                .state = state,
                .words = sentence(state),
                .advice = {}});
}

}  // namespace kinebus
