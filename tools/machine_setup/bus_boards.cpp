#include "tools/machine_setup/bus_boards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "tools/card/node_sdo.hpp"

namespace kinebus {
namespace {

constexpr ObjectAddress kDeviceName{0x1008, 0};
constexpr std::string_view kBootLoaderName = "Kinebus boot loader";
/// 1000h: low word the device profile.
constexpr std::uint32_t kDriveProfile = 402, kControllerProfile = 404;

}  // namespace

const char* words_of(BoardFunction function) {
  static constexpr std::array kWords{"unknown", "axis pair", "heat node", "boot loader waiting"};
  return kWords[static_cast<std::size_t>(function)];
}

const BoardFacts* board_with_product(std::uint32_t product_code) {
  for (const BoardDescription& board : kBoards)
    if (board.facts.product_code == product_code) return &board.facts;
  return nullptr;
}

BoardFunction function_of(std::uint32_t product_code) {
  const BoardFacts* facts = board_with_product(product_code);
  if (facts == nullptr) return BoardFunction::kUnknown;
  switch (facts->device_type & 0xFFFF) {
    case kDriveProfile:
      return BoardFunction::kAxisPair;
    case kControllerProfile:
      return BoardFunction::kHeat;
    default:
      return BoardFunction::kUnknown;
  }
}

std::vector<BusBoard> find_bus_boards(const BusAccess& bus, NodeIds& ids) {
  std::vector<BusBoard> boards;
  for (const NodeIds::Board& found : ids.find()) boards.push_back({.board = found});
  std::map<std::uint8_t, int> users;
  for (const BusBoard& one : boards) ++users[one.board.node_id];
  for (BusBoard& one : boards) {
    const bool vendor = one.board.identity[0] == kVendorId;
    one.shares_id = one.board.node_id != 0 && users[one.board.node_id] > 1;
    if (vendor) one.kind = board_with_product(one.board.identity[1]);
    if (one.shares_id) continue;  // both would answer
    if (vendor) one.function = function_of(one.board.identity[1]);
    if (one.board.node_id == 0) continue;
    try {
      one.name = NodeSdo(bus, one.board.node_id).read_text(kDeviceName);
    } catch (const CardError&) {
      continue;  // it need not have one
    }
    if (vendor && one.name == kBootLoaderName) one.function = BoardFunction::kBootLoader;
  }
  return boards;
}

std::vector<std::string> board_troubles(const std::vector<BusBoard>& boards) {
  std::vector<std::string> troubles;
  std::map<std::uint8_t, std::vector<const BusBoard*>> shared;
  for (const BusBoard& one : boards)
    if (one.shares_id) shared[one.board.node_id].push_back(&one);
  for (const auto& [id, users] : shared) {
    std::string serials;
    for (const BusBoard* user : users)
      serials += (serials.empty() ? "" : " and ") + std::to_string(user->board.serial());
    troubles.push_back(
        fmt::format("node {} is the id of {} boards, serial numbers {}: nothing can be asked of them before "
                    "one has another id (kinebus-node-id give ID --serial {})",
                    id, users.size(), serials, users.back()->board.serial()));
  }
  for (const BusBoard& one : boards)
    if (one.function == BoardFunction::kBootLoader)
      troubles.push_back(fmt::format(
          "node {} waits in its boot loader, without a program that it can run: kinebus-flash -n {} {}.bin",
          one.board.node_id, one.board.node_id,
          one.kind != nullptr ? one.kind->order_code : std::string_view("IMAGE")));
  const auto nameless =
      std::count_if(boards.begin(), boards.end(), [](const BusBoard& one) { return one.board.node_id == 0; });
  if (nameless > 0)
    troubles.push_back(
        fmt::format("{} {} no node id yet: kinebus-setup walk gives it one, or kinebus-node-id give",
                    nameless, nameless == 1 ? "board has" : "boards have"));
  return troubles;
}

}  // namespace kinebus
