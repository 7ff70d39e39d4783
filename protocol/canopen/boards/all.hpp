#pragma once
// Every board there is, for programs that speak of boards by name.

#include "protocol/canopen/board_objects.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"
#include "protocol/canopen/boards/stm32g0b1_ebb.hpp"

namespace kinebus {

struct BoardDescription {
  const BoardFacts& facts;
  const ObjectTable& objects;
  std::span<const ObjectNames> names;  ///< by place in `objects`
  const object_table::PdoSet& pdos;
};

template <typename Board>
inline constexpr BoardDescription kBoardDescription{Board::kFacts, BoardObjects<Board>::kTable,
                                                    BoardObjects<Board>::kNames, Board::kPdos};

inline constexpr std::array kBoards{kBoardDescription<Stm32f405Board>,
                                    kBoardDescription<Stm32f446OctopusBoard>,
                                    kBoardDescription<Stm32g0b1EbbBoard>, kBoardDescription<HeatBoard>};

/// nullptr: no board is called so.
constexpr const BoardDescription* find_board(std::string_view name) {
  for (const BoardDescription& board : kBoards)
    if (board.facts.name == name) return &board;
  return nullptr;
}

}  // namespace kinebus
