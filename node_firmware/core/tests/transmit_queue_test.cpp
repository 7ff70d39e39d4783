#include "node_firmware/core/transmit_queue.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace kinebus {
namespace {

using Kind = TransmitQueue::Action::Kind;

// Three mailboxes that send the lowest identifier first, as bxCAN does.
struct Controller {
  std::array<std::optional<CanFrame>, 3> mailboxes;
  std::vector<CanFrame> sent;

  void serve(TransmitQueue& queue) {
    for (auto action = queue.next(); action.kind != Kind::kNothing; action = queue.next()) {
      auto& mailbox = mailboxes[static_cast<std::size_t>(action.mailbox)];
      if (action.kind == Kind::kLoad) {
        ASSERT_FALSE(mailbox.has_value());
        mailbox = action.frame;
      } else {
        mailbox.reset();
        queue.on_empty(action.mailbox, false);
      }
    }
  }
  bool send_one(TransmitQueue& queue) {
    int best = -1;
    for (int i = 0; i < 3; ++i) {
      const auto& mailbox = mailboxes[static_cast<std::size_t>(i)];
      if (mailbox && (best < 0 || mailbox->id < mailboxes[static_cast<std::size_t>(best)]->id)) best = i;
    }
    if (best < 0) return false;
    sent.push_back(*mailboxes[static_cast<std::size_t>(best)]);
    mailboxes[static_cast<std::size_t>(best)].reset();
    queue.on_empty(best, true);
    return true;
  }
};

TEST(TransmitQueue, UrgentFrameIsSentBeforeThreeOthersThatWaitAlready) {
  TransmitQueue queue;
  Controller controller;
  for (const std::uint32_t id : {0x701u, 0x581u, 0x281u}) queue.push(CanFrame::make(id, {1}));
  controller.serve(queue);
  queue.push(CanFrame::make(0x081, {2}));
  controller.serve(queue);
  ASSERT_TRUE(controller.send_one(queue));
  EXPECT_EQ(controller.sent[0].id, 0x081u);
  do controller.serve(queue);
  while (controller.send_one(queue));
  ASSERT_EQ(controller.sent.size(), 4u);
  EXPECT_EQ(controller.sent[3].id, 0x701u);
  EXPECT_TRUE(queue.idle());
}

TEST(TransmitQueue, NothingIsLostOrReorderedWithinAnIdentifier) {
  std::mt19937 random(4711);
  TransmitQueue queue;
  Controller controller;
  std::array<std::uint8_t, 5> next{};
  std::size_t pushed = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (queue.has_room() && random() % 2 == 0) {
      const auto which = static_cast<std::uint32_t>(random() % next.size());
      queue.push(CanFrame::make(0x081 + 0x100 * which, {next[which]++}));
      ++pushed;
    }
    controller.serve(queue);
    if (random() % 3 == 0) controller.send_one(queue);
  }
  do controller.serve(queue);
  while (controller.send_one(queue));
  ASSERT_EQ(controller.sent.size(), pushed);
  std::array<std::uint8_t, 5> expected{};
  for (const CanFrame& frame : controller.sent)
    ASSERT_EQ(frame.data[0], expected[(frame.id - 0x081) / 0x100]++) << "id " << frame.id;
}

TEST(TransmitQueue, TakesBackTheLeastUrgentOnceAndLoadsWhenItIsEmpty) {
  TransmitQueue queue;
  EXPECT_TRUE(queue.idle());
  for (const std::uint32_t id : {0x281u, 0x701u, 0x581u}) queue.push(CanFrame::make(id, {}));
  EXPECT_FALSE(queue.idle());
  // The most urgent first; each into the next mailbox.
  int next = 0;
  for (const std::uint32_t id : {0x281u, 0x581u, 0x701u}) {
    const auto load = queue.next();
    ASSERT_EQ(load.kind, Kind::kLoad);
    EXPECT_EQ(load.mailbox, next++);
    EXPECT_EQ(load.frame.id, id);
  }
  EXPECT_FALSE(queue.idle()) << "in mailboxes";
  queue.push(CanFrame::make(0x701, {1}));
  queue.push(CanFrame::make(0x702, {1}));
  EXPECT_EQ(queue.next().kind, Kind::kNothing) << "none is less urgent";
  queue.push(CanFrame::make(0x601, {}));
  const auto abort = queue.next();
  ASSERT_EQ(abort.kind, Kind::kAbort);
  EXPECT_EQ(abort.mailbox, 2) << "701h";
  EXPECT_EQ(queue.next().kind, Kind::kNothing) << "asked for already";
  queue.on_empty(2, false);
  const auto load = queue.next();
  ASSERT_EQ(load.kind, Kind::kLoad);
  EXPECT_EQ(load.frame.id, 0x601u);
  // What was taken back goes before its equal.
  queue.on_empty(0, true);
  EXPECT_EQ(queue.next().frame, CanFrame::make(0x701, {}));
  queue.on_empty(1, true);
  EXPECT_EQ(queue.next().frame, CanFrame::make(0x702, {1})) << "one of an identifier at a time";
  EXPECT_EQ(queue.next().kind, Kind::kNothing);
  queue.on_empty(0, true);
  EXPECT_EQ(queue.next().frame, CanFrame::make(0x701, {1}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(queue.idle());
    queue.on_empty(i, true);
  }
  EXPECT_TRUE(queue.idle());
  queue.on_empty(1, true);
  EXPECT_TRUE(queue.idle()) << "an empty one";
}

TEST(TransmitQueue, HasRoomForWhatIsTakenBack) {
  TransmitQueue queue(1);
  int pushed = 0;
  while (queue.has_room()) queue.push(CanFrame::make(0x700u + static_cast<std::uint32_t>(pushed++), {}));
  EXPECT_EQ(pushed, 5);
  ASSERT_EQ(queue.next().kind, Kind::kLoad);
  EXPECT_EQ(queue.next().kind, Kind::kNothing) << "one mailbox is given";
  EXPECT_TRUE(queue.has_room());
}

}  // namespace
}  // namespace kinebus
