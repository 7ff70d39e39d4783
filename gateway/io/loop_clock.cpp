#include "gateway/io/loop_clock.hpp"

#include <algorithm>

#include "protocol/host/socketcan.hpp"

namespace kinebus {

LocalTime LoopClock::read_monotonic() {
  return monotonic_now();
}

LocalTime LoopClock::monotonic_at(LocalTime time) const {
  return time > LocalTime::max() - behind_ ? LocalTime::max() : time + behind_;
}

LocalTime LoopClock::read(LocalTime monotonic) {
  if (kind_ == Kind::kOwn && seen_ != LocalTime::max())
    behind_ += std::max(monotonic - seen_ - kLongestStep, LocalTime{0});
  seen_ = monotonic;
  return monotonic - behind_;
}

LocalTime LoopClock::woken(LocalTime from, LocalTime until, LocalTime monotonic) {
  if (kind_ == Kind::kOwn)
    behind_ += std::max(monotonic - behind_ - std::max(from, until) - kLongestStep, LocalTime{0});
  seen_ = monotonic;
  return monotonic - behind_;
}

}  // namespace kinebus
