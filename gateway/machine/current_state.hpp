#pragma once
// The state that the machine is in, and since when.

#include <cstdint>

#include "gateway/status/event_queue.hpp"
#include "gateway/status/state.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class CurrentState {
 public:
  explicit CurrentState(EventQueue& events) : events_(events) {}

  MachineState now() const { return state_; }
  bool is(MachineState state) const { return state_ == state; }
  template <typename... States>
  bool is_one_of(States... states) const {
    return (false || ... || (state_ == states));
  }
  BusTime since() const { return since_; }
  /// Grows with every change.
  std::uint64_t visit() const { return visit_; }
  /// Nothing is under way there, but perhaps an interrupted job waits.
  bool idle() const { return is_one_of(MachineState::kOff, MachineState::kUnhomed, MachineState::kReady); }
  /// Records of a run may go to the nodes.
  bool streams() const {
    return is_one_of(MachineState::kMoving, MachineState::kRunning, MachineState::kHolding,
                     MachineState::kHeld);
  }

  /// Tells it. The program ends on a change that the table does not know.
  void enter(BusTime now, MachineState state);

 private:
  EventQueue& events_;
  MachineState state_ = MachineState::kOff;
  BusTime since_{0};
  std::uint64_t visit_ = 0;
};

}  // namespace kinebus
