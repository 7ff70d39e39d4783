// Every board of the set gets its node ids.

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/machine_setup/bus_boards.hpp"
#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {
namespace {

using Boards = std::vector<BusBoard>;

bool is_of(const BusBoard& board, const BoardRole& role) {
  return board.kind != nullptr && role.kind != nullptr && board.kind->product_code == role.kind->product_code;
}

/// The board that has the role's ids already.
const BusBoard* holder(const Boards& boards, const BoardRole& role) {
  for (const BusBoard& one : boards)
    if (!one.shares_id && one.board.node_id == role.first_id && is_of(one, role)) return &one;
  return nullptr;
}

/// Of a board that carries several nodes, one that has its id from the first.
bool follows(const Boards& boards, const BusBoard& one) {
  std::vector<NodeIds::Board> all;
  for (const BusBoard& each : boards) all.push_back(each.board);
  return NodeIds::board_of(all, one.board) != nullptr;
}

/// Boards that could be given the role.
std::vector<const BusBoard*> candidates(const Boards& boards, const BoardRole& role,
                                        const std::vector<BoardRole>& roles) {
  std::vector<const BusBoard*> found;
  for (const BusBoard& one : boards) {
    const bool taken = std::any_of(roles.begin(), roles.end(), [&](const BoardRole& other) {
      return !one.shares_id && one.board.node_id == other.first_id && is_of(one, other);
    });
    if (is_of(one, role) && !taken && !follows(boards, one)) found.push_back(&one);
  }
  return found;
}

std::string words_of(const BusBoard& one) {
  return fmt::format("serial number {}{}", one.board.serial(),
                     one.board.node_id == 0 ? "" : fmt::format(", node {}", one.board.node_id));
}

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

void give(SetupState& s, NodeIds& ids, const BusBoard& board, const BoardRole& role) {
  if (const std::string failed = ids.give(board.board, role.first_id); !failed.empty())
    throw std::runtime_error(fmt::format("{} ({}): {}", role.name, words_of(board), failed));
  s.dialogue.say(role.ids == 1 ? fmt::format("{}: node {}", role.name, role.first_id)
                               : fmt::format("{}: nodes {} to {}", role.name, role.first_id,
                                             role.first_id + role.ids - 1));
}

/// Who has an id that the role needs and is not of it; nullptr: nobody.
const BusBoard* in_the_way(const Boards& boards, const BoardRole& role, const BusBoard& wanted) {
  for (const BusBoard& one : boards)
    if (&one != &wanted && one.board.node_id >= role.first_id &&
        one.board.node_id < role.first_id + role.ids &&
        one.board.serial() - wanted.board.serial() >= role.ids)
      return &one;
  return nullptr;
}

/// It gets an id far away, from which it can be called later.
void make_way(SetupState& s, NodeIds& ids, const Boards& boards, const BoardRole& role,
              const BusBoard& other) {
  const std::string what =
      fmt::format("{}: node {} is {} ({})", role.name, other.board.node_id,
                  other.kind != nullptr ? other.kind->device_name : "another board", words_of(other));
  constexpr std::uint8_t kHighest = 119, kLowest = 60;  // a board with several nodes has room above
  std::uint8_t free = kHighest;
  const auto used = [&](std::uint8_t id) {
    return std::any_of(boards.begin(), boards.end(),
                       [&](const BusBoard& one) { return one.board.node_id == id; });
  };
  while (free > kLowest && used(free)) --free;
  if (follows(boards, other) ||
      !s.dialogue.yes(role.name, fmt::format("{}. Is that one to be node {}?", what, free), true))
    throw std::runtime_error(
        fmt::format("{}: give that one another id first (kinebus-node-id give ID --serial {})", what,
                    other.board.serial()));
  if (const std::string failed = ids.give(other.board, free); !failed.empty())
    throw std::runtime_error(fmt::format("{}: {}", what, failed));
}

/// A board that could have the role, with the program of its other use.
void tell_of_other_program(SetupState& s, const Boards& boards, const BoardRole& role) {
  for (const BusBoard& one : boards) {
    if (role.otherwise == nullptr || one.kind == nullptr || follows(boards, one) ||
        one.kind->product_code != role.otherwise->product_code)
      continue;
    const std::string give = one.board.node_id != 0 ? ""
                                                    : fmt::format("kinebus-node-id give {} --serial {}; ",
                                                                  role.first_id, one.board.serial());
    s.dialogue.say(
        fmt::format("{} ({}) answers. If that is the {}, it wants the program for this use: {}kinebus-flash "
                    "-i {} --node {} "
                    "--force {}.bin",
                    one.kind->device_name, words_of(one), role.name, give, s.first.interface,
                    one.board.node_id != 0 ? one.board.node_id : role.first_id, role.program));
  }
}

}  // namespace

void give_ids(SetupState& s) {
  NodeIds ids(s.host.bus, {});
  if (ids.gateway_speaks())
    throw std::runtime_error(
        fmt::format("a gateway runs on {}: stop it first (systemctl stop kinebusd)", s.first.interface));
  s.dialogue.say("\nLooking for the boards ...");
  const BoardPlan plan = plan_of(s.first);
  for (const BoardRole& role : plan.roles) {
    for (;;) {
      const Boards boards = find_bus_boards(s.host.bus, ids);
      if (const BusBoard* there = holder(boards, role)) {
        s.dialogue.say(fmt::format("{}: node {}, {}", role.name, role.first_id, words_of(*there)));
        break;
      }
      const auto able = candidates(boards, role, plan.roles);
      if (able.empty()) {
        for (const std::string& trouble : board_troubles(boards)) s.dialogue.say(trouble);
        s.dialogue.say(
            fmt::format("{}: no board with {} answers on {}. Has it power, its program, and a place "
                        "on the bus with both ends terminated?",
                        role.name, role.kind->hardware_version, s.first.interface));
        tell_of_other_program(s, boards, role);
        if (!s.dialogue.yes(role.name, "Look again?", true))
          throw std::runtime_error(fmt::format("{}: not found", role.name));
        continue;
      }
      const BusBoard* board = pick(s, role, able);
      if (const BusBoard* other = in_the_way(boards, role, *board)) {
        make_way(s, ids, boards, role, *other);
        continue;
      }
      give(s, ids, *board, role);
      break;
    }
  }
  const Boards boards = find_bus_boards(s.host.bus, ids);
  for (const BusBoard& one : boards)
    if (one.board.node_id != 0 && !one.shares_id) s.serials[one.board.node_id] = one.board.serial();
  for (const HeatNodePlace& heat : plan.heat_nodes)
    if (std::none_of(boards.begin(), boards.end(), [&](const BusBoard& one) {
          return one.board.node_id == heat.node && one.function == BoardFunction::kHeat;
        }))
      s.dialogue.say(fmt::format("heat: no heat node {} ({}) answers: heaters and fans cannot be tested now",
                                 heat.node, heat.board));
}

void offer_programs(SetupState& s) {
  if (s.answers.get("programs")) return;
  const BoardPlan plan = plan_of(s.first);
  for (const BoardRole& role : plan.roles) {
    // One image for all boards of a kind.
    if (std::any_of(plan.roles.begin(), plan.roles.end(), [&](const BoardRole& other) {
          return other.kind == role.kind && other.first_id < role.first_id;
        }))
      continue;
    for (;;) {
      const std::string image = s.dialogue.line(
          fmt::format("\nProgram for {} ({}.bin) to write over CAN; empty: they keep the one that they have",
                      role.name, role.program));
      if (image.empty()) break;
      std::vector<std::uint8_t> nodes;
      for (const BoardRole& other : plan.roles)
        if (other.kind == role.kind) nodes.push_back(other.first_id);
      if (s.host.flash(image, nodes)) break;
    }
  }
  s.answers.set("programs", "yes");
}

}  // namespace kinebus
