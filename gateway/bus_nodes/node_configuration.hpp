#pragma once
// What the machine description means for one node's object dictionary: the value of every parameter, and the
// fingerprint (2116h) of a node that has them all. A node without axes is told its heartbeats and SYNC's
// counter, and what the heaters, sensors and fans on it are; what it measures itself of its heaters stays its
// own, so no fingerprint is held against it.

#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/sentence.hpp"
#include "protocol/canopen/object.hpp"

namespace kinebus {

/// The object of that axis of a node.
constexpr ObjectAddress on_axis(ObjectAddress base, std::size_t axis) {
  return {static_cast<std::uint16_t>(base.index + axis * kAxisOffset), base.subindex};
}

struct ParameterWrite {
  ObjectAddress address;
  std::uint8_t size = 0;  ///< bytes
  std::int64_t value = 0;
};

struct NodeConfiguration {
  std::optional<std::uint32_t> fingerprint;  ///< none: of a node without axes
  /// Every parameter outside the PDO and COB-ID objects, which keep their defaults, but for TPDO4: it tells
  /// the following errors of a node that has an encoder. In the order of addresses.
  std::vector<ParameterWrite> writes;
  /// What a node does not keep and its fingerprint does not cover: written at every bring-up. Empty: nothing.
  std::vector<ParameterWrite> settings{};
  /// Written before them, unless the node has them all: what makes a heat node take its settings.
  std::vector<ParameterWrite> before{};
  /// 2170h:5 of axes that home by their drivers' load: looked at once the parameters are right.
  std::vector<ObjectAddress> load_sensors{};
  std::optional<std::uint32_t> product{};  ///< 1018h:2 that a node with these objects has
};

NodeConfiguration configure_node(const MachineDescription& machine, std::uint8_t node_id);

/// The words for a driver that cannot tell its load, by what 2170h:5 says; none: it can.
std::optional<Sentence> load_sensor_missing(const MachineDescription& machine, std::uint8_t node_id,
                                            ObjectAddress sensor, std::int64_t state);

/// How fast that joint looks for its switch (6099h:1), mm/s or rad/s.
ParameterWrite homing_speed(const JointDescription& joint, double per_s);

/// Counts that the node shows when the joint stands at its home switch: the negative of its 607Ch.
std::int32_t home_counts(const JointDescription& joint);

}  // namespace kinebus
