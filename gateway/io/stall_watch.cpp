#include "gateway/io/stall_watch.hpp"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>

namespace kinebus {
namespace {

/// A sample is at most so old when a stall begins.
constexpr LocalTime kSample = std::chrono::milliseconds{100};

LocalTime of(const timeval& time) {
  return std::chrono::seconds{time.tv_sec} + std::chrono::microseconds{time.tv_usec};
}

}  // namespace

StallWatch::Usage StallWatch::usage() {
  rusage used{};
  ::getrusage(RUSAGE_THREAD, &used);
  return {.processor = of(used.ru_utime) + of(used.ru_stime),
          .disk_faults = used.ru_majflt,
          .preempted = used.ru_nivcsw};
}

void StallWatch::sleeps(LocalTime now, LocalTime until) {
  slept_ = now;
  until_ = std::max(now, until);
  if (now - sampled_ < kSample) return;
  sampled_ = now;
  before_ = usage();
}

std::optional<StallWatch::Stall> StallWatch::wakes(LocalTime now) {
  const bool first = began_ == LocalTime::max();
  const LocalTime in_turn = first ? LocalTime{0} : slept_ - began_;
  const LocalTime late = first ? LocalTime{0} : std::max(now - until_, LocalTime{0});
  began_ = now;
  const LocalTime lost = in_turn + late;
  if (lost < kNoticed) return std::nullopt;
  const Usage after = usage();
  const bool busy = 2 * (after.processor - before_.processor) > lost;
  Sentence why;
  if (busy)
    why = say("it was busy itself");
  else if (after.disk_faults > before_.disk_faults)
    why = say("it waited for the disk (%1 pages)", after.disk_faults - before_.disk_faults);
  else if (after.preempted > before_.preempted)
    why = say("other programs had the processor");
  else
    why = say("it was stopped, or the computer was");
  before_ = after;
  sampled_ = now;
  const int policy = ::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  if (policy != SCHED_FIFO && policy != SCHED_RR) why = say("%1; it has no real-time priority", why);
  return Stall{lost, why};
}

}  // namespace kinebus
