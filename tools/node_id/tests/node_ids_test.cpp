#include "tools/node_id/node_ids.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <memory>

#include "node_firmware/core/node.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

// Boards with the real node core and a flash each. A frame takes 130 us.
class Bus {
 public:
  explicit Bus(std::vector<std::uint32_t> serials) {
    for (const std::uint32_t serial : serials) boards_.push_back({.serial = serial});
    power_cycle();
  }
  void power_cycle() {
    for (Board& board : boards_)
      board.node =
          std::make_unique<LoneNode>(NodeOptions{.identity = {.serial = board.serial}}, now_, board.flash);
  }
  NodeIds ids() {
    return {{.send = [this](const CanFrame& frame) { tell_all(frame, nullptr); },
             .receive = [this](LocalTime until) { return receive(until); },
             .now = [this] { return now_; }},
            {}};
  }
  std::uint8_t id_of(std::uint32_t serial) {
    for (const Board& board : boards_)
      if (board.serial == serial) return board.node->node_id();
    return 0xEE;
  }
  std::deque<CanFrame> others;  ///< frames of somebody else

 private:
  struct Board {
    std::uint32_t serial = 0;
    std::unique_ptr<LoneNode> node{};
    std::vector<std::uint8_t> flash{};
  };
  void tell_all(const CanFrame& frame, const Board* but) {
    for (Board& board : boards_)
      if (&board != but) board.node->on_frame(now_, frame);
  }
  std::optional<CanFrame> receive(LocalTime until) {
    for (;; now_ += 1ms) {
      if (!others.empty()) {
        const CanFrame frame = others.front();
        others.pop_front();
        return frame;
      }
      for (Board& board : boards_) {
        board.node->on_time(now_);
        if (const auto image = board.node->image_to_store(); !image.empty()) {
          board.flash.assign(image.begin(), image.end());
          board.node->on_image_stored(true);
        }
        if (const auto frame = board.node->next_frame()) {
          tell_all(*frame, &board);
          now_ += 130us;
          return frame;
        }
      }
      if (now_ >= until) return std::nullopt;
    }
  }

  std::vector<Board> boards_;
  LocalTime now_{1s};
};

TEST(NodeIds, NewBoardsAreAllFoundAndKeepWhatTheyAreGiven) {
  Bus bus({0x1001, 0x0FFF'0002, 7});
  NodeIds ids = bus.ids();
  auto boards = ids.find();
  ASSERT_EQ(boards.size(), 3u);
  for (const auto& board : boards) EXPECT_EQ(board.node_id, 0);
  // In whatever order: each gets the id that is meant for it.
  for (const auto& board : boards) {
    const std::uint8_t id = board.serial() == 7 ? 1 : board.serial() == 0x1001 ? 2 : 3;
    EXPECT_EQ(ids.give(board, id), "");
  }
  for (int round = 0; round < 2; ++round, bus.power_cycle()) {
    EXPECT_EQ(bus.id_of(7), 1);
    EXPECT_EQ(bus.id_of(0x1001), 2);
    EXPECT_EQ(bus.id_of(0x0FFF'0002), 3);
    boards = ids.find();
    ASSERT_EQ(boards.size(), 3u);
    EXPECT_EQ(boards[0].serial(), 7u);
    EXPECT_EQ(boards[2].node_id, 3);
  }
}

TEST(NodeIds, AnotherIdAndNoneAgain) {
  Bus bus({5, 6});
  NodeIds ids = bus.ids();
  for (const auto& board : ids.find())
    EXPECT_EQ(ids.give(board, static_cast<std::uint8_t>(board.serial())), "");
  EXPECT_EQ(ids.give(ids.find()[0], 20), "");
  EXPECT_EQ(bus.id_of(5), 20);
  EXPECT_EQ(ids.forget(ids.find()[0]), "");
  bus.power_cycle();
  EXPECT_EQ(bus.id_of(5), 20);
  EXPECT_EQ(bus.id_of(6), 0);
  const auto boards = ids.find();
  ASSERT_EQ(boards.size(), 2u);
  EXPECT_EQ(boards[1].serial(), 6u);
  EXPECT_EQ(boards[1].node_id, 0);
}

TEST(NodeIds, TwoBoardsWithOneIdAreToldApart) {
  Bus bus({5, 6});
  NodeIds ids = bus.ids();
  for (const auto& board : ids.find()) EXPECT_EQ(ids.give(board, 2), "");
  const auto boards = ids.find();
  ASSERT_EQ(boards.size(), 2u);
  EXPECT_EQ(boards[1].serial(), 6u);
  EXPECT_EQ(ids.give(boards[1], 3), "");
  EXPECT_EQ(bus.id_of(5), 2);
  EXPECT_EQ(bus.id_of(6), 3);
}

NodeIds::Board octopus(std::uint32_t serial, std::uint8_t id, std::uint8_t further = 0) {
  constexpr std::uint8_t kHeat = Stm32f446OctopusBoard::kFacts.consecutive_ids - 1;
  const std::uint32_t product =
      further == kHeat ? HeatBoard::kFacts.product_code : Stm32f446OctopusBoard::kFacts.product_code;
  return {.identity = {kVendorId, product, kRevisionNumber, serial + further},
          .node_id = static_cast<std::uint8_t>(id == 0 ? 0 : id + further)};
}

TEST(NodeIds, ABoardOfSeveralNodesWantsAllItsIdsFree) {
  constexpr std::uint8_t kIds = Stm32f446OctopusBoard::kFacts.consecutive_ids;
  const NodeIds::Board other{.identity = {kVendorId, kProductCode, kRevisionNumber, 9}, .node_id = 14};
  std::vector<NodeIds::Board> all{other, octopus(1000, 0)};
  EXPECT_EQ(NodeIds::ids_of(other), 1);
  EXPECT_EQ(NodeIds::ids_of(all[1]), kIds);
  EXPECT_EQ(NodeIds::refused(all, all[1], 14 - kIds), "");
  EXPECT_NE(NodeIds::refused(all, all[1], 14 - kIds + 1).find("node 14 is there already"), std::string::npos);
  EXPECT_NE(NodeIds::refused(all, all[1], 14), "");
  EXPECT_EQ(NodeIds::refused(all, all[1], 15), "");
  EXPECT_EQ(NodeIds::refused(all, all[1], 127 - kIds), "");
  EXPECT_NE(NodeIds::refused(all, all[1], 128 - kIds).find("ids in a row"), std::string::npos);
}

TEST(NodeIds, FurtherNodesOfABoardFollowItAndAreNotInItsWay) {
  std::vector<NodeIds::Board> all;
  for (std::uint8_t i = 0; i < Stm32f446OctopusBoard::kFacts.consecutive_ids; ++i)
    all.push_back(octopus(1000, 7, i));
  EXPECT_EQ(NodeIds::board_of(all, all[0]), nullptr);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(NodeIds::board_of(all, all[i]), all.data());
  EXPECT_EQ(NodeIds::boards_of(all, {7, 9, 10, 33}), (std::set<std::uint8_t>{7, 33}))
      << "one board, and who did not answer";
  EXPECT_EQ(NodeIds::refused(all, all[0], 9), "") << "its own are no hindrance";
  EXPECT_NE(NodeIds::refused(all, all[2], 60).find("serial number 1000"), std::string::npos);
  // A second board with the same ids is one of its own.
  all.push_back(octopus(5000, 7));
  EXPECT_EQ(NodeIds::board_of(all, all.back()), nullptr);
  EXPECT_NE(NodeIds::refused(all, all.back(), 10), "");
  EXPECT_EQ(NodeIds::refused(all, all.back(), 30), "");
}

TEST(NodeIds, ABoardThatHasGoneIsSaidSo) {
  Bus bus({5});
  NodeIds ids = bus.ids();
  EXPECT_NE(ids.give({.identity = {kVendorId, kProductCode, kRevisionNumber, 99}}, 3), "");
  EXPECT_EQ(bus.id_of(5), 0);
}

TEST(NodeIds, AGatewayIsHeard) {
  Bus bus({5});
  NodeIds ids = bus.ids();
  EXPECT_FALSE(ids.gateway_speaks());
  bus.others.push_back({.id = cob_id::kSync, .length = 1});
  EXPECT_TRUE(ids.gateway_speaks());
}

}  // namespace
}  // namespace kinebus
