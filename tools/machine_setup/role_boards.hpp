#pragma once
// Which of the boards on the bus could have a role of the set.

#include <optional>
#include <string>
#include <vector>

#include "tools/machine_setup/board_set.hpp"
#include "tools/machine_setup/bus_boards.hpp"

namespace kinebus {

using BusBoards = std::vector<BusBoard>;

/// It is what the role is, by the program that runs.
bool is_of(const BusBoard& board, const BoardRole& role);
/// The board that has the role's ids already; nullptr: none.
const BusBoard* holder(const BusBoards& boards, const BoardRole& role);
/// Of a board that carries several nodes, one that has its id from the first.
bool follows(const BusBoards& boards, const BusBoard& one);
/// Boards that could be given the role's ids.
std::vector<const BusBoard*> candidates(const BusBoards& boards, const BoardRole& role,
                                        const std::vector<BoardRole>& roles);
/// Boards that could have the role if they had its program: they wait without one, or have that of the
/// board's other use.
std::vector<const BusBoard*> without_program(const BusBoards& boards, const BoardRole& role,
                                             const std::vector<BoardRole>& roles);
/// Far away from those of roles; nullopt: all are used.
std::optional<std::uint8_t> free_id(const BusBoards& boards);
/// "serial number 950, node 40"
std::string words_of(const BusBoard& one);

}  // namespace kinebus
