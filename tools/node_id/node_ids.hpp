#pragma once
// Node ids given over the bus (CiA 305, layer setting services): who is there, with an id or without one, and
// which board gets which. Works on a bus where nothing else asks questions.

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {

/// The way to the bus: frames out, frames in until a time, and that time.
struct BusAccess {
  std::function<void(const CanFrame&)> send;
  /// The next frame that others sent; nullopt: none until `until`.
  std::function<std::optional<CanFrame>(LocalTime until)> receive;
  std::function<LocalTime()> now;
};

class NodeIds {
 public:
  struct Board {
    LssIdentity identity{};
    std::uint8_t node_id = 0;  ///< 0: none yet
    std::uint32_t serial() const { return identity[3]; }
  };
  /// So many ids a board takes from its own on: it may be several nodes.
  static std::uint8_t ids_of(const Board& board);
  /// The board of which `node` is a further node, whose id goes with the board's; nullptr: it is no such.
  static const Board* board_of(const std::vector<Board>& all, const Board& node);
  /// Of each of these nodes' boards its first node, which answers for the board.
  static std::set<std::uint8_t> boards_of(const std::vector<Board>& all, const std::set<std::uint8_t>& nodes);
  /// Why `board` cannot have the id, and those that go with it; empty: it can. `all`: as find() gives them.
  static std::string refused(const std::vector<Board>& all, const Board& board, std::uint8_t node_id);

  struct Options {
    LocalTime answer = std::chrono::milliseconds{200};    ///< of a node to a question
    LocalTime scan_wait = std::chrono::milliseconds{10};  ///< silence this long means "no node"
    LocalTime boot = std::chrono::seconds{3};             ///< until a node shows itself with its new id
  };

  NodeIds(BusAccess bus, const Options& options) : bus_(std::move(bus)), options_(options) {}

  /// Somebody who moves the machine is heard: SYNC or the gateway's heartbeat within 0.6 s.
  bool gateway_speaks();
  /// All boards: those with ids by their ids, then those without one by their identities.
  std::vector<Board> find();
  /// Those with ids alone: by questions that every node may be asked at any time.
  std::vector<Board> find_configured();
  /// The board keeps the id through power-off and is there with it at once. Empty: done; else what went
  /// wrong.
  std::string give(const Board& board, std::uint8_t node_id);
  /// A board without an id has this one until it is switched off: nothing is stored, which a boot loader
  /// could not.
  std::string lend(const Board& board, std::uint8_t node_id);
  /// The board keeps the id that it has.
  std::string keep(const Board& board) { return configure(board, board.node_id); }
  /// The board is without an id from now on.
  std::string forget(const Board& board);

 private:
  LssMaster::Status serve(LssMaster& master);
  /// `wanted`: answers of another node with the same id do not count.
  std::optional<std::uint32_t> read(std::uint8_t node_id, ObjectAddress address,
                                    std::optional<std::uint32_t> wanted = std::nullopt);
  std::string configure(const Board& board, std::uint8_t node_id, bool store = true);
  bool shows_itself(const Board& board, std::uint8_t node_id);

  BusAccess bus_;
  Options options_;
};

}  // namespace kinebus
