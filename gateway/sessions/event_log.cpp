#include "gateway/sessions/event_log.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {

void EventLog::add(joblink::Event event) {
  event.set_id(++newest_);
  if (event.kind() == joblink::EVENT_ALARM) {
    if (alarms_.size() >= kAlarmCapacity) alarms_.pop_front();
    alarms_.push_back(event);
  }
  if (events_.size() >= kCapacity) events_.pop_front();
  events_.push_back(std::move(event));
}

const joblink::Event* EventLog::after(std::uint64_t id) const {
  const auto found = std::upper_bound(events_.begin(), events_.end(), id,
                                      [](std::uint64_t i, const joblink::Event& e) { return i < e.id(); });
  return found != events_.end() ? &*found : nullptr;
}

}  // namespace kinebus
