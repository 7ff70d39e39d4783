// kinebus-node-id: which board on the bus has which node id, and a new one for a board.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "protocol/host/guarded_main.hpp"
#include "protocol/host/patient_can.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/host/usage.hpp"
#include "tools/node_id/node_ids.hpp"

namespace {

using namespace kinebus;
using namespace std::chrono_literals;
using Board = NodeIds::Board;

struct Arguments {
  std::string interface = "can0";
  double wait_ms = 10;
  int node_id = 0;
  std::optional<std::uint32_t> serial;
};

std::string name_of(const Board& board) {
  return fmt::format("serial number {} ({:08X}h)", board.serial(), board.serial());
}

void print(const std::vector<Board>& boards) {
  if (boards.empty()) fmt::print("no board answers\n");
  for (const Board& board : boards) {
    if (board.node_id != 0)
      fmt::print("node {:<3}", board.node_id);
    else
      fmt::print("no id   ");
    fmt::print("  {}, vendor {:08X}h, product {:08X}h, revision {:08X}h", name_of(board), board.identity[0],
               board.identity[1], board.identity[2]);
    if (const Board* first = NodeIds::board_of(boards, board); first != nullptr)
      fmt::print(", of the board of node {}", first->node_id);
    else if (const int count = NodeIds::ids_of(board); count > 1)
      fmt::print(", a board of {} nodes with ids in a row", count);
    fmt::print("\n");
  }
}

/// The board that is meant; nullptr: said why not.
const Board* choose(const std::vector<Board>& boards, const Arguments& arguments) {
  std::vector<const Board*> meant;
  for (const Board& board : boards)
    if (arguments.serial ? board.serial() == *arguments.serial : board.node_id == 0) meant.push_back(&board);
  if (meant.size() == 1) return meant.front();
  if (meant.empty()) {
    fmt::print(stderr, "{}; there are:\n",
               arguments.serial ? "no board has this serial number"
                                : "every board has an id (--serial says which one gets another)");
  } else {
    fmt::print(stderr, "{} boards are meant: say which one with --serial, or connect one alone\n",
               meant.size());
  }
  print(boards);
  return nullptr;
}

int give(NodeIds& ids, const Arguments& arguments) {
  const std::vector<Board> boards = ids.find();
  const auto node_id = static_cast<std::uint8_t>(arguments.node_id);
  const Board* board = choose(boards, arguments);
  if (board == nullptr) return 1;
  if (const std::string why = NodeIds::refused(boards, *board, node_id); !why.empty())
    return fmt::print(stderr, "{}: {}\n", name_of(*board), why), 1;
  if (const std::string failed = ids.give(*board, node_id); !failed.empty())
    return fmt::print(stderr, "{}: {}\n", name_of(*board), failed), 1;
  if (const int last = node_id + NodeIds::ids_of(*board) - 1; last > node_id)
    fmt::print("nodes {} to {}: {}\n", node_id, last, name_of(*board));
  else
    fmt::print("node {}: {}\n", node_id, name_of(*board));
  return 0;
}

int forget(NodeIds& ids, const Arguments& arguments) {
  const std::vector<Board> boards = ids.find();
  const auto is_meant = [&](const Board& b) { return b.node_id == arguments.node_id; };
  if (std::count_if(boards.begin(), boards.end(), is_meant) > 1)
    return fmt::print(stderr, "several boards have this id: give others to them, by --serial\n"), 1;
  const auto board = std::find_if(boards.begin(), boards.end(), is_meant);
  if (board == boards.end()) return fmt::print(stderr, "there is no node {}\n", arguments.node_id), 1;
  if (const Board* first = NodeIds::board_of(boards, *board); first != nullptr)
    return fmt::print(stderr, "node {} is of the board of node {}: forget that one\n", arguments.node_id,
                      first->node_id),
           1;
  if (const std::string failed = ids.forget(*board); !failed.empty())
    return fmt::print(stderr, "node {}: {}\n", arguments.node_id, failed), 1;
  fmt::print("no id: {}\n", name_of(*board));
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app(
      "kinebus-node-id: which board has which node id (CiA 305).\n"
      "A new board has none: connect it, and give it one. It keeps it.");
  Arguments arguments;
  app.add_option("-i,--interface", arguments.interface, "SocketCAN interface")->capture_default_str();
  app.add_option("--wait", arguments.wait_ms, "Milliseconds of silence that mean \"no such board\"")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  app.require_subcommand(1);
  auto* list_command = app.add_subcommand("list", "All boards on the bus, with an id and without");
  auto* give_command = app.add_subcommand("give", "Gives a board an id, which it keeps through power-off");
  auto* forget_command = app.add_subcommand("forget", "A node is a board without an id again");
  for (auto* command : {give_command, forget_command})
    command->add_option("id", arguments.node_id, "Node id")->required()->check(CLI::Range(1, 126));
  give_command->add_option("--serial", arguments.serial,
                           "The board with this serial number; without it the one that has no id");
  if (const auto end = parse_arguments(app, argc, argv)) return *end;

  SocketCan can;
  if (const std::string error = can.open(arguments.interface, false); !error.empty())
    return fmt::print(stderr, "{}\n", error), 1;
  NodeIds ids({.send = [&](const CanFrame& frame) { send_or_throw(can, frame); },
               .receive = [&](LocalTime until) { return receive_until(can, until); },
               .now = monotonic_now},
              {.scan_wait = LocalTime{std::llround(arguments.wait_ms * 1e6)}});
  if (ids.gateway_speaks())
    return fmt::print(stderr, "a gateway runs on {}: stop it first (systemctl stop kinebusd)\n",
                      arguments.interface),
           1;
  if (*list_command) return print(ids.find()), 0;
  return *give_command ? give(ids, arguments) : forget(ids, arguments);
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-node-id", [&] { return run(argc, argv); });
}
