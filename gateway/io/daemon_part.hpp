#pragma once
// A part of the daemon that lives on its loop beside bus and core: hears the machine's news and sees the
// time.

#include "gateway/status/event.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class DaemonPart {
 public:
  virtual ~DaemonPart() = default;
  virtual void on_event(const MachineEvent& event) = 0;
  virtual void on_time(LocalTime now) = 0;  ///< called once a turn of the loop
  /// The loop was not run for `length` when it wanted to be. Told before on_time.
  virtual void on_stall(LocalTime /*now*/, LocalTime /*length*/) {}
  virtual LocalTime next_deadline() const = 0;
};

}  // namespace kinebus
