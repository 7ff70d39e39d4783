#pragma once
// Whether the nodes still have the machine file's parameters. Bring-up compares their fingerprints (2116h);
// this does so again after each SDO request that another device has sent to one of them. While nobody else
// asks, it costs no frame.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/description/machine_description.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class ParameterWatch {
 public:
  struct Change {
    std::size_t node = 0;  ///< its place among the links
    std::uint32_t found = 0, expected = 0;
  };

  ParameterWatch(const MachineDescription& machine, std::deque<NodeLink>& links);

  /// A frame that this gateway has not sent.
  void on_frame(BusTime when, const CanFrame& frame);
  /// `may_ask`: the nodes answer, and nothing else is asked of them. A node whose parameters are others,
  /// once.
  std::optional<Change> on_time(BusTime now, bool may_ask);
  /// This gateway has changed the node's parameters itself: they are the description's, and are compared.
  void changed(const MachineDescription& machine, std::size_t node, BusTime now);
  /// Bring-up compares them all.
  void forget();

 private:
  struct Node {
    std::optional<std::uint32_t> expected;  ///< none: a node that does not tell
    std::optional<BusTime> ask;             ///< when its fingerprint is to be read
  };

  std::deque<NodeLink>& links_;
  std::vector<Node> nodes_;
};

}  // namespace kinebus
