#pragma once
// An agent as an edge node of Sparkplug B (Eclipse Sparkplug 3.0), its machines as devices, sans-IO.
//
//   connect: will = death(), then birth() -> NBIRTH, a DBIRTH for each machine that answers
//   show(machine) -> DDATA; DBIRTH when it begins to answer, DDEATH when it ends to
//   is_rebirth(message) -> birth() again

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/fleet/machine_view.hpp"
#include "gateway/fleet/outward/message.hpp"
#include "gateway/fleet/outward/sparkplug.pb.h"

namespace kinebus::fleet {

class SparkplugNode {
 public:
  /// `connections`: any number, best another one whenever the program starts.
  SparkplugNode(const std::string& group, const std::string& node, std::uint64_t connections);

  /// Every connection has a number of its own, which ties its death to its birth: call before it is made.
  void next_connection() { death_sequence_ = connections_++ % 256; }
  MqttMessage death(std::uint64_t now_ms) const;
  std::vector<MqttMessage> birth(std::uint64_t now_ms, const std::vector<MachineView>& machines);
  MqttMessage show(std::uint64_t now_ms, const MachineView& machine);

  /// Commands for this node come here.
  std::string command_topic() const { return topic("NCMD"); }
  bool is_rebirth(std::string_view payload) const;

 private:
  std::string topic(const char* type) const { return prefix_ + type + "/" + node_; }
  std::string sealed(sparkplug::Payload& payload, std::uint64_t now_ms);

  std::string prefix_, node_;
  std::uint64_t sequence_ = 0, connections_, death_sequence_ = 0;
  std::map<std::string, bool> born_;  ///< machines
};

}  // namespace kinebus::fleet
