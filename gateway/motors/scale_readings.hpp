#pragma once
// Where the joints' linear scales have them. Read over SDO while the machine rests: then command and reading
// are of the same place, whatever the bus takes. A scale begins at the edge of the home switch.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class ScaleReadings {
 public:
  ScaleReadings(const MachineDescription& machine, const std::vector<NodeAxes>& axes);

  /// `rests`: positions are known and nothing moves. `may_ask`: nothing else is asked of the nodes.
  void on_time(BusTime now, std::deque<NodeLink>& links, bool rests, bool may_ask);
  /// mm; empty: no scale, or not read since the machine came to rest. `node`: its place among the axes'.
  std::optional<double> joint_mm(std::size_t node, std::size_t axis) const;

 private:
  struct Scale {
    std::size_t node = 0, axis = 0;
    double counts_per_mm = 0;
    double at_home_mm = 0;  ///< the joint, at the edge of its switch
    std::optional<std::int64_t> home{}, counts{};
    bool asked = false;  ///< since the machine came to rest
  };
  void take(std::size_t node, const SdoResult& answer);

  std::vector<Scale> scales_;
  std::size_t first_ = 0;  ///< whose turn it is to be asked first
  BusTime due_{0};
};

}  // namespace kinebus
