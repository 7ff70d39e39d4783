#pragma once
// The bus of a machine (its gateway, and nodes of any ids and boards) as a DBC file, for any CAN viewer: PDOs
// as the boards' object tables map them by default, the gateway's broadcasts, EMCY, NMT, heartbeat, SYNC, SDO
// and LSS. What a motion record means goes by its duration: start and end records are multiplexed signals.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/canopen/boards/all.hpp"

namespace kinebus {

struct DbcNode {
  std::uint8_t id = 0;  ///< 1..126, each once
  const BoardDescription* board = nullptr;
};

std::string dbc_text(std::span<const DbcNode> nodes);

/// Nodes 1 to `last`, all of one board.
std::vector<DbcNode> nodes_of(const BoardDescription& board, std::uint8_t last = 3);

struct NodeList {
  std::vector<DbcNode> nodes;
  std::string error;  ///< empty: the list was good
};
/// "1-3,20:heat": ids and ranges of ids, with the board's name behind those that are not of `board`.
NodeList read_nodes(std::string_view list, const BoardDescription& board);

/// "stm32f405, heat", for messages.
std::string names_of_boards();

}  // namespace kinebus
