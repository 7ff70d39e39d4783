#pragma once
// After clear(): the latch is lifted on all nodes and their drives follow again.

#include <cstdint>
#include <deque>
#include <vector>

#include "gateway/bus_nodes/bring_up.hpp"
#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "gateway/stream/path_rate.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class Clearing {
 public:
  enum class Outcome : std::uint8_t { kBusy, kLifted, kFailed };

  Clearing(const std::vector<NodeAxes>& axes, std::deque<NodeLink>& links, PathRate& rate)
      : axes_(axes), links_(links), rate_(rate) {}

  void begin(BusTime now);
  void abort() { busy_ = false; }
  bool busy() const { return busy_; }
  Outcome on_time(BusTime now);
  /// After kLifted: all nodes rest where the gateway believes. Nodes that rest elsewhere on the path have
  /// missed something, and what is queued is to be dropped.
  bool together() const { return together_; }
  const StepFailure& failure() const { return failure_; }

 private:
  const std::vector<NodeAxes>& axes_;
  std::deque<NodeLink>& links_;
  PathRate& rate_;
  bool busy_ = false, together_ = false;
  int repeats_ = 0;  ///< of controlwords
  BusTime since_{0}, next_repeat_{0};
  StepFailure failure_;
};

}  // namespace kinebus
