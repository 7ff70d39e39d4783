#pragma once
// Who is on the bus: every board with an id or without one, what it is, and what its ids are used for.

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/canopen/boards/all.hpp"
#include "tools/node_id/node_ids.hpp"

namespace kinebus {

enum class BoardFunction : std::uint8_t {
  kUnknown,     ///< no board of Kinebus, or its id is another's, too
  kAxisPair,    ///< two CiA 402 drives
  kHeat,        ///< heaters, temperatures, fans
  kBootLoader,  ///< waits for a program
};
/// "axis pair", "heat node", "boot loader waiting"
const char* words_of(BoardFunction function);

struct BusBoard {
  NodeIds::Board board;
  const BoardFacts* kind = nullptr;  ///< by 1018h:2; nullptr: none that is known
  BoardFunction function = BoardFunction::kUnknown;
  std::string name{};      ///< 1008h; empty: it does not tell, or has no id yet
  bool shares_id = false;  ///< another board has the same id: neither can be used
};

/// The facts of the board with this product code (1018h:2); nullptr: there is none.
const BoardFacts* board_with_product(std::uint32_t product_code);
/// What a node with this product code is when its program runs.
BoardFunction function_of(std::uint32_t product_code);

/// In the order of NodeIds::find(). Nothing else may speak on the bus.
std::vector<BusBoard> find_bus_boards(const BusAccess& bus, NodeIds& ids);

/// What is wrong with the boards as they are, and what to do; a line each.
std::vector<std::string> board_troubles(const std::vector<BusBoard>& boards);

}  // namespace kinebus
