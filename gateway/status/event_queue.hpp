#pragma once
// The events that wait to be fetched. Bounded: when nobody fetches, the oldest go.

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "gateway/status/alarm.hpp"
#include "gateway/status/event.hpp"

namespace kinebus {

class EventQueue {
 public:
  static constexpr std::size_t kCapacity = 1000;

  void push(MachineEvent event) {
    if (events_.size() >= kCapacity) events_.pop_front();
    events_.push_back(std::move(event));
  }
  void message(BusTime when, Sentence words, std::uint32_t line = 0) {
    push({.kind = MachineEvent::Kind::kMessage,
          .when = when,
          .line = line,
          .words = std::move(words),
          .advice = {}});
  }
  void alarm(BusTime when, AlarmCode code, Sentence words, std::uint8_t node = 0, std::uint32_t line = 0) {
    push({.kind = MachineEvent::Kind::kAlarm,
          .when = when,
          .code = static_cast<std::uint16_t>(code),
          .node = node,
          .line = line,
          .words = std::move(words),
          .advice = advice_for(code)});
  }
  std::optional<MachineEvent> pop() {
    if (events_.empty()) return std::nullopt;
    MachineEvent event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

 private:
  std::deque<MachineEvent> events_;
};

}  // namespace kinebus
