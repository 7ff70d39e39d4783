#pragma once
// Frames on their way into a controller with three transmit mailboxes, which sends the lowest identifier
// first. An urgent frame never waits behind others: when all mailboxes are taken by less urgent ones, the
// least urgent is taken back. Frames of one identifier keep their order: only one of them is in a mailbox.

#include <array>
#include <cstddef>
#include <optional>

#include "protocol/can/frame.hpp"

namespace kinebus {

class TransmitQueue {
 public:
  static constexpr int kMailboxes = 3;
  static constexpr std::size_t kWaiting = 8;

  struct Action {
    enum class Kind : std::uint8_t { kNothing, kLoad, kAbort };
    Kind kind = Kind::kNothing;
    int mailbox = 0;
    CanFrame frame{};  ///< kLoad
  };

  /// A controller gives it `mailboxes` of them, the first ones.
  explicit constexpr TransmitQueue(int mailboxes = kMailboxes) : withheld_(kMailboxes - mailboxes) {}
  /// Room for one more, even when all mailboxes are taken back.
  bool has_room() const { return count_ + kMailboxes < kWaiting; }
  /// Only with has_room().
  void push(const CanFrame& frame) { insert(frame, false); }
  /// What to do with the mailboxes now; call until kNothing.
  Action next();
  /// The mailbox is empty: its frame was sent, or was taken back and waits again.
  void on_empty(int mailbox, bool sent);
  bool idle() const;

 private:
  struct Mailbox {
    std::optional<CanFrame> frame;
    bool aborting = false;
  };
  void insert(const CanFrame& frame, bool before_equals);
  bool in_mailbox(std::uint32_t id) const;

  int given() const { return kMailboxes - withheld_; }

  int withheld_;  // of the mailboxes: with all of them the queue is all zeros, which takes no flash
  std::array<Mailbox, kMailboxes> mailboxes_{};
  std::array<CanFrame, kWaiting> waiting_{};  // most urgent first
  std::size_t count_ = 0;
};

}  // namespace kinebus
