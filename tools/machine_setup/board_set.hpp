#pragma once
// Machines and sets of boards that a set-up knows, and which connector of which board each part of the
// machine goes to.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/canopen/boards/all.hpp"

namespace kinebus {

enum class SetupMachine : std::uint8_t { kM1, kDelta, kCoreXy, kCartesian };
enum class BoardSet : std::uint8_t { kOctopus, kOctopusEbb, kOctopusEbbHeat, kCards };

/// Something that is chosen by its word.
struct SetupChoice {
  std::string_view word, description;
};
/// In the order of SetupMachine; a word is the name of the shipped machine file that limits and geometry are
/// taken from.
std::span<const SetupChoice> setup_machines();
/// In the order of BoardSet.
std::span<const SetupChoice> board_sets();

/// A board that the machine needs, and the node ids that are its own.
struct BoardRole {
  std::string name;                  ///< "Octopus", "card 2"
  const BoardFacts* kind = nullptr;  ///< what its first node is
  std::uint8_t first_id = 1;
  std::uint8_t ids = 1;       ///< nodes on it, with ids in a row
  std::string program;        ///< its image, without .bin
  bool has_versions = false;  ///< boards v1.1 have other pins, and an image of their own: -v1.1
  /// What the same board is with its other program, whose change wants to be told of; nullptr: it has none.
  const BoardFacts* otherwise = nullptr;
};

/// Where a motor is connected.
struct MotorPlace {
  std::uint8_t node = 1, axis = 0;
  std::string connector;         ///< "MOTOR3 of the Octopus"
  std::string switch_connector;  ///< of the input beside it, number axis + 1
};
/// Where heaters, fans or the probe are connected.
struct DeviceConnector {
  std::uint8_t node = 0, channel = 0;
  std::string connector;
};
/// What the heat nodes of the boards have.
struct HeatNodePlace {
  std::uint8_t node = 0, heaters = 0, sensors = 0, outputs = 0;
  std::string board;
};

struct BoardPlan {
  std::vector<BoardRole> roles;
  std::vector<MotorPlace> motors;  ///< of the machine's joints, in their order
  std::vector<HeatNodePlace> heat_nodes;
  std::optional<DeviceConnector> hotend, bed;  ///< heaters with their sensors; none: no board has one
  /// The hot end's board measures a Pt100 or Pt1000 by a MAX31865, where it was bought with one.
  bool hotend_amplifier = false;
  std::optional<DeviceConnector> hotend_fan, part_fan;
  DeviceConnector probe;  ///< channel: the switch input
};

/// `joints`: how many the machine has; the last one is the extruder. `heat_node`: of a set of cards, the id
/// of the heat node on its bus; 0: there is none.
BoardPlan plan_boards(BoardSet set, std::size_t joints, std::uint8_t heat_node = 0);

/// "STOP3 (input 2 of node 2)", "input 4 of node 1".
std::string switch_words(BoardSet set, std::uint8_t node, int input);

}  // namespace kinebus
