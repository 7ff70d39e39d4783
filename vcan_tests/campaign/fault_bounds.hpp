#pragma once
// What a run with given faults must come to, and how far it may go: the promise, kind by kind.

#include "vcan_tests/campaign/fault.hpp"
#include "vcan_tests/campaign/fault_run.hpp"

namespace kinebus {

struct FaultBounds {
  unsigned outcomes = 0;    ///< bit n: outcome n is allowed
  double path_um = 5;       ///< tool (or live carriages) from the planned path, through every stop and resume
  double skew_us = 2;       ///< path time between live nodes
  double step_ratio = 1.0;  ///< velocity steps against the stop limits
  double known_counts = 1.0;     ///< of a position that is said to be known
  double rest_ms = 150;          ///< cause to all at rest
  double ramp_ms = 2.14;         ///< E-stop input to all ramping: 2 ms and one frame
  unsigned sequence_breaks = 0;  ///< restarts of a stream's numbering
  int attempts = 3;              ///< of lifting, before the machine is taken as refusing
  bool clean_bus = true;         ///< what the gateway sends is what the nodes get
  bool allows(FaultOutcome outcome) const { return (outcomes >> static_cast<unsigned>(outcome) & 1u) != 0; }
};

FaultBounds bounds_of(const FaultPlan& plan);

}  // namespace kinebus
