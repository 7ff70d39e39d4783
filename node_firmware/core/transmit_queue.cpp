#include "node_firmware/core/transmit_queue.hpp"

#include <algorithm>

namespace kinebus {

void TransmitQueue::insert(const CanFrame& frame, bool before_equals) {
  if (count_ == kWaiting) return;
  std::size_t at = 0;
  while (at < count_ && (before_equals ? waiting_[at].id < frame.id : waiting_[at].id <= frame.id)) ++at;
  for (std::size_t i = count_; i > at; --i) waiting_[i] = waiting_[i - 1];
  waiting_[at] = frame;
  ++count_;
}

bool TransmitQueue::in_mailbox(std::uint32_t id) const {
  return std::any_of(mailboxes_.begin(), mailboxes_.end(),
                     [&](const Mailbox& m) { return m.frame && m.frame->id == id; });
}

TransmitQueue::Action TransmitQueue::next() {
  std::size_t first = 0;
  while (first < count_ && in_mailbox(waiting_[first].id)) ++first;
  if (first == count_) return {};
  const CanFrame frame = waiting_[first];
  int highest = 0;
  for (int i = 0; i < given(); ++i) {
    Mailbox& mailbox = mailboxes_[static_cast<std::size_t>(i)];
    if (mailbox.aborting) return {};  // there will be room in a moment
    if (!mailbox.frame) {
      mailbox.frame = frame;
      std::copy(waiting_.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                waiting_.begin() + static_cast<std::ptrdiff_t>(count_),
                waiting_.begin() + static_cast<std::ptrdiff_t>(first));
      --count_;
      return {Action::Kind::kLoad, i, frame};
    }
    if (mailbox.frame->id > mailboxes_[static_cast<std::size_t>(highest)].frame->id) highest = i;
  }
  Mailbox& least = mailboxes_[static_cast<std::size_t>(highest)];
  if (frame.id >= least.frame->id) return {};
  least.aborting = true;
  return {Action::Kind::kAbort, highest, {}};
}

void TransmitQueue::on_empty(int mailbox, bool sent) {
  Mailbox& m = mailboxes_[static_cast<std::size_t>(mailbox)];
  if (m.frame && !sent) insert(*m.frame, true);
  m = {};
}

bool TransmitQueue::idle() const {
  return count_ == 0 && std::none_of(mailboxes_.begin(), mailboxes_.end(),
                                     [](const Mailbox& m) { return m.frame.has_value(); });
}

}  // namespace kinebus
