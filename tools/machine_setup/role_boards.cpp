#include "tools/machine_setup/role_boards.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinebus {
namespace {

bool has_product(const BusBoard& board, const BoardFacts* kind) {
  return board.kind != nullptr && kind != nullptr && board.kind->product_code == kind->product_code;
}

bool is_taken(const BusBoard& one, const std::vector<BoardRole>& roles) {
  return std::any_of(roles.begin(), roles.end(), [&](const BoardRole& role) {
    return !one.shares_id && one.board.node_id == role.first_id && is_of(one, role);
  });
}

}  // namespace

bool is_of(const BusBoard& board, const BoardRole& role) {
  return has_product(board, role.kind) && board.function != BoardFunction::kBootLoader;
}

const BusBoard* holder(const BusBoards& boards, const BoardRole& role) {
  for (const BusBoard& one : boards)
    if (!one.shares_id && one.board.node_id == role.first_id && is_of(one, role)) return &one;
  return nullptr;
}

bool follows(const BusBoards& boards, const BusBoard& one) {
  std::vector<NodeIds::Board> all;
  all.reserve(boards.size());
  for (const BusBoard& each : boards) all.push_back(each.board);
  return NodeIds::board_of(all, one.board) != nullptr;
}

std::vector<const BusBoard*> candidates(const BusBoards& boards, const BoardRole& role,
                                        const std::vector<BoardRole>& roles) {
  std::vector<const BusBoard*> found;
  for (const BusBoard& one : boards)
    if (is_of(one, role) && !is_taken(one, roles) && !follows(boards, one)) found.push_back(&one);
  return found;
}

std::vector<const BusBoard*> without_program(const BusBoards& boards, const BoardRole& role,
                                             const std::vector<BoardRole>& roles) {
  std::vector<const BusBoard*> found;
  for (const BusBoard& one : boards) {
    const bool waits = one.function == BoardFunction::kBootLoader &&
                       (has_product(one, role.kind) || has_product(one, role.otherwise));
    const bool other_use = has_product(one, role.otherwise);
    if ((waits || other_use) && !one.shares_id && !is_taken(one, roles) && !follows(boards, one))
      found.push_back(&one);
  }
  return found;
}

std::optional<std::uint8_t> free_id(const BusBoards& boards) {
  constexpr std::uint8_t kHighest = 119, kLowest = 60;  // a board with several nodes has room above
  for (std::uint8_t id = kHighest; id >= kLowest; --id)
    if (std::none_of(boards.begin(), boards.end(),
                     [&](const BusBoard& one) { return one.board.node_id == id; }))
      return id;
  return std::nullopt;
}

std::string words_of(const BusBoard& one) {
  return fmt::format("serial number {}{}", one.board.serial(),
                     one.board.node_id == 0 ? "" : fmt::format(", node {}", one.board.node_id));
}

}  // namespace kinebus
