#include "gateway/jobs/journal/journal_queue.hpp"

namespace kinebus::journal {

void Queue::push(const Record& record) {
  if (!enabled_) return;
  if (records_.size() >= kCapacity) {
    ++lost_;
    return;
  }
  records_.push_back(record);
  ++pushed_;
}

std::optional<Record> Queue::pop() {
  if (records_.empty()) return std::nullopt;
  std::optional<Record> record(std::move(records_.front()));
  records_.pop_front();
  return record;
}

}  // namespace kinebus::journal
