#pragma once
// Nobody waits for ever: a state in which the machine is on its way to another lasts no longer than that way
// takes, and a job that runs gets on.

#include <string>

#include "gateway/status/state.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class PatienceChecker {
 public:
  /// `rest`: so long a job may stand still, for it dwells or heats.
  explicit PatienceChecker(BusTime rest = kRest) : rest_(rest) {}

  /// `tau`: path time; of a running job it must go on.
  void on_sample(BusTime now, MachineState state, PathTime tau) {
    if (state != state_ || (in_motion(state) && tau != tau_)) {
      state_ = state;
      tau_ = tau;
      since_ = now;
      return;
    }
    const BusTime waited = now - since_;
    const BusTime most = state == MachineState::kRunning ? rest_ : longest(state);
    if (waited <= most || !complaint_.empty()) return;
    complaint_ = std::string(to_string(state)) + " for " + std::to_string(waited.count() / 1'000'000) + " ms";
  }
  /// Empty: all is well.
  const std::string& complaint() const { return complaint_; }

  /// Longest stay in a state that is a way to another; max(): one to stay in.
  static BusTime longest(MachineState state) {
    using namespace std::chrono_literals;
    switch (state) {
      case MachineState::kBringUp:
        return 20s;
      case MachineState::kHoming:
        return 60s;
      case MachineState::kChecking:
        return 30s;
      case MachineState::kRunning:
      case MachineState::kMoving:
      case MachineState::kHolding:
      case MachineState::kCancelling:
      case MachineState::kStopping:
        return kRest;
      default:
        return BusTime::max();
    }
  }

 private:
  static constexpr BusTime kRest = std::chrono::seconds{4};
  static bool in_motion(MachineState state) {
    return state == MachineState::kRunning || state == MachineState::kMoving;
  }
  BusTime rest_;
  MachineState state_ = MachineState::kOff;
  PathTime tau_{0};
  BusTime since_{0};
  std::string complaint_;
};

}  // namespace kinebus
