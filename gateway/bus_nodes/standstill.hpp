#pragma once
// With the nodes that have axes at rest: empties their queues and reads where they stand, exactly. The
// beginning of every new motion after bring-up, homing, a cancel or a lost stream.

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "gateway/bus_nodes/bring_up.hpp"
#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/description/machine_description.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {

class Standstill {
 public:
  enum class Outcome : std::uint8_t { kBusy, kDone, kFailed };
  struct Node {
    std::array<AxisState, kAxesPerNode> position{};
    std::array<bool, kAxesPerNode> known{};
    StreamStatus stream;
    PathTime found{0};
  };

  Standstill(const MachineDescription& machine, std::deque<NodeLink>& links);

  /// `tau`: path time of the gateway. Nodes that rest at another one take it when their queues are empty.
  void start(PathTime tau);
  Outcome on_time();
  void abort();
  bool busy() const { return busy_; }
  const StepFailure& failure() const { return failure_; }

  // After kDone.
  const Node& node(std::size_t i) const { return nodes_[i]; }
  /// The path time that all nodes had reached when they were found.
  PathTime path_time() const;
  /// Every joint that homes knows its position.
  bool positions_known() const;

 private:
  const MachineDescription& machine_;
  std::deque<NodeLink>& links_;
  std::vector<Node> nodes_;
  PathTime tau_{0};
  bool busy_ = false, equal_ = false;
  StepFailure failure_;
};

}  // namespace kinebus
