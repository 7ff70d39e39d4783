// Every board of the set gets its node ids.

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/machine_setup/boards_report.hpp"
#include "tools/machine_setup/program_step.hpp"
#include "tools/machine_setup/role_boards.hpp"
#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {
namespace {

const BusBoard* pick(SetupState& s, const BoardRole& role, const std::vector<const BusBoard*>& boards) {
  if (boards.size() == 1) return boards.front();
  std::vector<std::string> words, descriptions;
  for (const BusBoard* one : boards) {
    words.push_back(std::to_string(one->board.serial()));
    descriptions.push_back(one->board.node_id == 0 ? "no id yet"
                                                   : fmt::format("node {}", one->board.node_id));
  }
  std::vector<SetupChoice> choices;
  for (std::size_t i = 0; i < words.size(); ++i) choices.push_back({words[i], descriptions[i]});
  const std::size_t chosen = s.dialogue.choose(
      role.name,
      fmt::format("Which board is {}? By serial number; the test of its motors will show it.", role.name),
      choices, 0);
  return boards[chosen];
}

/// Who has an id that the role needs and is not of it; nullptr: nobody.
const BusBoard* in_the_way(const BusBoards& boards, const BoardRole& role, const BusBoard& wanted) {
  for (const BusBoard& one : boards)
    if (&one != &wanted && one.board.node_id >= role.first_id &&
        one.board.node_id < role.first_id + role.ids &&
        one.board.serial() - wanted.board.serial() >= role.ids)
      return &one;
  return nullptr;
}

/// It gets an id far away, from which it can be called later.
void make_way(SetupState& s, NodeIds& ids, const BusBoards& boards, const BoardRole& role,
              const BusBoard& other) {
  const std::string what =
      fmt::format("{}: node {} is {} ({})", role.name, other.board.node_id,
                  other.kind != nullptr ? other.kind->device_name : "another board", words_of(other));
  const auto free = free_id(boards);
  if (!free || follows(boards, other) ||
      !s.dialogue.yes(role.name, fmt::format("{}. Is that one to be node {}?", what, *free), true))
    throw std::runtime_error(
        fmt::format("{}: give that one another id first (kinebus-node-id give ID --serial {})", what,
                    other.board.serial()));
  if (const std::string failed = ids.give(other.board, *free); !failed.empty())
    throw std::runtime_error(fmt::format("{}: {}", what, failed));
}

void list(SetupState& s, const BusBoards& boards) {
  std::string lines;
  for (const BusBoard& one : boards) lines += as_line(one);
  if (s.host.usb) lines += as_lines(s.host.usb());
  if (!lines.empty()) lines.pop_back();  // say() ends the line
  if (!lines.empty()) s.dialogue.say(lines);
}

/// False: it has none, as was said.
bool lend_id(SetupState& s, NodeIds& ids, const BusBoards& boards, const BusBoard& board) {
  const auto free = free_id(boards);
  const std::string failed = free ? ids.lend(board.board, *free) : "no node id is free";
  if (!failed.empty()) s.dialogue.say(fmt::format("{}: {}", words_of(board), failed));
  return failed.empty();
}

/// What can be done where no board can have the role as it is. Throws when the person gives up.
void help(SetupState& s, NodeIds& ids, const BusBoards& boards, const BoardRole& role,
          const std::vector<BoardRole>& roles) {
  for (const BusBoard* one : without_program(boards, role, roles)) {
    // Without an id it does not even say whether it has a program.
    const bool nameless = one->board.node_id == 0;
    if (nameless ? lend_id(s, ids, boards, *one) : offer_program(s, role, *one)) return;
  }
  for (const std::string& trouble : board_troubles(boards)) s.dialogue.say(trouble);
  s.dialogue.say(
      fmt::format("{}: no board with {} answers on {}. Has it power, its program, and a place "
                  "on the bus with both ends terminated?",
                  role.name, role.kind->hardware_version, s.first.interface));
  if (!s.dialogue.yes(role.name, "Look again?", true))
    throw std::runtime_error(fmt::format("{}: not found", role.name));
}

/// False: its boot loader cannot keep an id, and has another one for now.
bool give_first(SetupState& s, NodeIds& ids, const BusBoards& boards, const BusBoard& board,
                const BoardRole& role) {
  const std::string failed = ids.give(board.board, role.first_id);
  if (failed.empty()) return true;
  if (board.board.node_id == 0 && lend_id(s, ids, boards, board))
    for (const BusBoard& one : find_bus_boards(s.host.bus, ids))
      if (one.board.identity == board.board.identity && one.function == BoardFunction::kBootLoader)
        return false;
  throw std::runtime_error(fmt::format("{} ({}): {}", role.name, words_of(board), failed));
}

/// False: something was done, and the boards are looked at again.
bool give_role(SetupState& s, NodeIds& ids, const BoardRole& role, const std::vector<BoardRole>& roles) {
  const BusBoards boards = find_bus_boards(s.host.bus, ids);
  if (const BusBoard* there = holder(boards, role)) {
    if (!keep_id_of_new_program(s, ids, *there))
      throw std::runtime_error(fmt::format("{}: its id is lost with its power", role.name));
    s.dialogue.say(fmt::format("{}: node {}, {}", role.name, role.first_id, words_of(*there)));
    return true;
  }
  const auto able = candidates(boards, role, roles);
  if (able.empty()) return help(s, ids, boards, role, roles), false;
  const BusBoard* board = pick(s, role, able);
  if (const BusBoard* other = in_the_way(boards, role, *board))
    return make_way(s, ids, boards, role, *other), false;
  if (!give_first(s, ids, boards, *board, role)) return false;
  s.dialogue.say(role.ids == 1 ? fmt::format("{}: node {}", role.name, role.first_id)
                               : fmt::format("{}: nodes {} to {}", role.name, role.first_id,
                                             role.first_id + role.ids - 1));
  return true;
}

}  // namespace

void give_ids(SetupState& s) {
  NodeIds ids(s.host.bus, {});
  if (ids.gateway_speaks())
    throw std::runtime_error(
        fmt::format("a gateway runs on {}: stop it first (systemctl stop kinebusd)", s.first.interface));
  s.dialogue.say("\nLooking for the boards ...");
  list(s, find_bus_boards(s.host.bus, ids));
  const BoardPlan plan = plan_of(s.first);
  for (const BoardRole& role : plan.roles)
    while (!give_role(s, ids, role, plan.roles)) {
    }
  const BusBoards boards = find_bus_boards(s.host.bus, ids);
  for (const BusBoard& one : boards)
    if (one.board.node_id != 0 && !one.shares_id) s.serials[one.board.node_id] = one.board.serial();
  for (const HeatNodePlace& heat : plan.heat_nodes)
    if (std::none_of(boards.begin(), boards.end(), [&](const BusBoard& one) {
          return one.board.node_id == heat.node && one.function == BoardFunction::kHeat;
        }))
      s.dialogue.say(fmt::format("heat: no heat node {} ({}) answers: heaters and fans cannot be tested now",
                                 heat.node, heat.board));
}

}  // namespace kinebus
