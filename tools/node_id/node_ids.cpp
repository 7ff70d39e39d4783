#include "tools/node_id/node_ids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocol/bytes.hpp"
#include "protocol/canopen/boards/all.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kHighestId = 126;  // 127 is the gateway's
constexpr std::uint8_t kGatewayId = 127;
constexpr LocalTime kListen = 600ms;
constexpr std::uint16_t kIdentity = 0x1018;

/// What a Kinebus node answers to a store while a motor of its has power.
constexpr std::uint8_t kStoreRefused = 255;

std::string words(LssMaster::Status status, std::uint8_t error) {
  switch (status) {
    case LssMaster::Status::kNotFound:
      return "it does not answer to its identity any more";
    case LssMaster::Status::kRefused:
      return fmt::format("it refuses (LSS error {})", error);
    case LssMaster::Status::kTimeout:
      return "it does not answer";
    default:
      return {};
  }
}

}  // namespace

std::uint8_t NodeIds::ids_of(const Board& board) {
  for (const BoardDescription& known : kBoards)
    if (board.identity[0] == kVendorId && known.facts.product_code == board.identity[1])
      return known.facts.consecutive_ids;
  return 1;
}

const NodeIds::Board* NodeIds::board_of(const std::vector<Board>& all, const Board& node) {
  if (node.node_id == 0) return nullptr;
  const Board* found = nullptr;
  for (const Board& board : all) {
    const std::uint32_t further = node.serial() - board.serial();
    if (board.node_id == 0 || further == 0 || further >= ids_of(board) ||
        node.node_id != board.node_id + further)
      continue;
    // All axis pairs of a board say that they are of such a board: it is the first that has the others.
    if (found == nullptr || board.node_id < found->node_id) found = &board;
  }
  return found;
}

std::set<std::uint8_t> NodeIds::boards_of(const std::vector<Board>& all,
                                          const std::set<std::uint8_t>& nodes) {
  std::set<std::uint8_t> firsts;
  for (const std::uint8_t node : nodes) {
    const auto named =
        std::find_if(all.begin(), all.end(), [&](const Board& board) { return board.node_id == node; });
    const Board* first = named == all.end() ? nullptr : board_of(all, *named);
    firsts.insert(first == nullptr ? node : first->node_id);
  }
  return firsts;
}

std::string NodeIds::refused(const std::vector<Board>& all, const Board& board, std::uint8_t node_id) {
  if (const Board* first = board_of(all, board); first != nullptr)
    return fmt::format(
        "it is one of the {} nodes of the board with serial number {}, whose id it follows: "
        "give that one another id",
        ids_of(*first), first->serial());
  const int last = node_id + ids_of(board) - 1;
  if (last > kHighestId)
    return fmt::format("it is {} nodes with ids in a row: {} at most, not {} ({} is the gateway's)",
                       ids_of(board), kHighestId + 1 - ids_of(board), node_id, kGatewayId);
  const auto is_same_board = [&](const Board& other) {
    const Board* first = board_of(all, other);
    return other.identity == board.identity ||
           (first != nullptr && first->identity == board.identity && first->node_id == board.node_id);
  };
  for (const Board& other : all)
    if (other.node_id >= node_id && other.node_id <= last && !is_same_board(other))
      return fmt::format("node {} is there already: serial number {}{}", other.node_id, other.serial(),
                         last > node_id ? fmt::format("; the board takes {} to {}", node_id, last) : "");
  return {};
}

bool NodeIds::gateway_speaks() {
  for (const LocalTime end = bus_.now() + kListen; bus_.now() < end;)
    if (const auto frame = bus_.receive(end);
        frame && (frame->id == cob_id::kSync || frame->id == cob_id::kHeartbeat + kGatewayId))
      return true;
  return false;
}

LssMaster::Status NodeIds::serve(LssMaster& master) {
  while (master.status() == LssMaster::Status::kBusy) {
    while (const auto frame = master.next_frame()) bus_.send(*frame);
    if (const auto frame = bus_.receive(master.next_deadline())) master.on_frame(*frame);
    master.on_time(bus_.now());
  }
  return master.status();
}

std::optional<std::uint32_t> NodeIds::read(std::uint8_t node_id, ObjectAddress address,
                                           std::optional<std::uint32_t> wanted) {
  bus_.send(sdo::frame_of(cob_id::kSdoRequest + node_id, 0x40, address));
  for (const LocalTime end = bus_.now() + options_.answer; bus_.now() < end;) {
    const auto frame = bus_.receive(end);
    if (!frame || frame->id != cob_id::kSdoReply + node_id || frame->length != 8) continue;
    if (sdo::address_in(*frame) != address) continue;
    if (sdo::specifier(*frame) != sdo::kReplyInitiateUpload) return std::nullopt;
    const std::uint32_t value = get_u32_le(frame->bytes().subspan(4));
    if (!wanted || value == *wanted) return value;
  }
  return std::nullopt;
}

/// Everybody is asked at once for the serial number, and whoever answers is there: two with one id are two.
std::vector<NodeIds::Board> NodeIds::find_configured() {
  for (std::uint8_t id = 1; id <= kHighestId; ++id)
    bus_.send(sdo::frame_of(cob_id::kSdoRequest + id, 0x40, {kIdentity, 4}));
  std::vector<Board> boards;
  for (const LocalTime end = bus_.now() + options_.answer; bus_.now() < end;) {
    const auto frame = bus_.receive(end);
    if (!frame || frame->length != 8 || frame->id <= cob_id::kSdoReply ||
        frame->id > cob_id::kSdoReply + kHighestId ||
        sdo::address_in(*frame) != ObjectAddress{kIdentity, 4} ||
        sdo::specifier(*frame) != sdo::kReplyInitiateUpload)
      continue;
    Board board{.node_id = static_cast<std::uint8_t>(frame->id - cob_id::kSdoReply)};
    board.identity[3] = get_u32_le(frame->bytes().subspan(4));
    boards.push_back(board);
  }
  for (Board& board : boards)
    for (std::uint8_t part = 0; part < 3; ++part)
      board.identity[part] =
          read(board.node_id, {kIdentity, static_cast<std::uint8_t>(part + 1)}).value_or(0);
  const auto place = [](const Board& board) { return std::pair(board.node_id, board.serial()); };
  std::sort(boards.begin(), boards.end(),
            [&](const Board& a, const Board& b) { return place(a) < place(b); });
  return boards;
}

std::vector<NodeIds::Board> NodeIds::find() {
  std::vector<Board> boards = find_configured();
  // A board that was found is in configuration and answers to no further scan: the next scan finds another.
  LssMaster master({.timeout = options_.answer, .scan_wait = options_.scan_wait});
  for (int most = kHighestId; most > 0; --most) {
    if (!master.fastscan(bus_.now()) || serve(master) != LssMaster::Status::kDone) break;
    boards.push_back({.identity = master.identity()});
  }
  if (master.switch_all(bus_.now(), false)) serve(master);
  return boards;
}

/// The board's pending id, stored; all boards wait again afterwards, whatever became of it.
std::string NodeIds::configure(const Board& board, std::uint8_t node_id, bool store) {
  LssMaster master({.timeout = options_.answer, .scan_wait = options_.scan_wait});
  const LocalTime now = bus_.now();
  std::string failed;
  if (master.switch_all(now, false)) serve(master);
  if (master.select(bus_.now(), board.identity)) failed = words(serve(master), 0);
  if (failed.empty() && master.configure_node_id(bus_.now(), node_id)) {
    const auto status = serve(master);
    failed = words(status, master.error_code());
  }
  if (store && failed.empty() && master.store(bus_.now())) {
    const auto status = serve(master);
    failed = words(status, master.error_code());
    if (!failed.empty() && master.error_code() == kStoreRefused)
      failed = "its motors have power: switch them off first (kinebus motors-off)";
    if (!failed.empty()) {
      failed = "it cannot store its id: " + failed;
      // What is pending would count at its next reset, and be lost with its power.
      const std::uint8_t kept = board.node_id == 0 ? kUnconfiguredNodeId : board.node_id;
      if (master.configure_node_id(bus_.now(), kept)) serve(master);
    }
  }
  if (master.switch_all(bus_.now(), false)) serve(master);
  return failed;
}

std::string NodeIds::give(const Board& board, std::uint8_t node_id) {
  if (board.node_id == node_id) return {};
  if (std::string failed = configure(board, node_id); !failed.empty()) return failed;
  // One that had an id takes the new one at its next reset of communication.
  if (board.node_id != 0) bus_.send(nmt_frame(NmtCommand::kResetCommunication, board.node_id));
  if (shows_itself(board, node_id)) return {};
  return fmt::format("the id is stored, but nobody shows itself as node {}: switch the board off and on",
                     node_id);
}

bool NodeIds::shows_itself(const Board& board, std::uint8_t node_id) {
  for (const LocalTime end = bus_.now() + options_.boot; bus_.now() < end;) {
    bus_.receive(std::min(end, bus_.now() + options_.answer));
    if (read(node_id, {kIdentity, 4}, board.serial())) return true;
  }
  return false;
}

std::string NodeIds::lend(const Board& board, std::uint8_t node_id) {
  if (std::string failed = configure(board, node_id, false); !failed.empty()) return failed;
  return shows_itself(board, node_id) ? std::string()
                                      : fmt::format("nobody shows itself as node {}", node_id);
}

std::string NodeIds::forget(const Board& board) {
  if (std::string failed = configure(board, kUnconfiguredNodeId); !failed.empty()) return failed;
  bus_.send(nmt_frame(NmtCommand::kResetCommunication, board.node_id));
  return {};
}

}  // namespace kinebus
