#pragma once
// What happened, numbered, for clients that watch and for those who ask later. Bounded: alarms are kept
// longer than the rest.

#include <cstdint>
#include <deque>
#include <vector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

class EventLog {
 public:
  static constexpr std::size_t kCapacity = 1000;
  static constexpr std::size_t kAlarmCapacity = 300;

  /// Gives the event its number.
  void add(joblink::Event event);
  std::uint64_t newest() const { return newest_; }
  /// The first kept event after `id`; nullptr: none.
  const joblink::Event* after(std::uint64_t id) const;
  /// Gives `take` what came after `after_id`, oldest first, until it answers false.
  template <typename Take>
  void each(std::uint64_t after_id, bool alarms_only, const Take& take) const {
    for (const joblink::Event& event : alarms_only ? alarms_ : events_)
      if (event.id() > after_id && !take(event)) return;
  }

 private:
  std::deque<joblink::Event> events_, alarms_;
  std::uint64_t newest_ = 0;
};

}  // namespace kinebus
