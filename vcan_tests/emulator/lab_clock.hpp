#pragma once
// The clock that a lab's guest and the boards beside it share (tools/vm/run --slow).

#include <dlfcn.h>
#include <poll.h>

#include <ctime>

#include "protocol/time.hpp"

namespace kinebus::emulator {

/// Where there is such a clock, it waits for the boards, and they for the guest; elsewhere nothing happens.
class LabClock {
 public:
  LabClock()
      : hold_(reinterpret_cast<void (*)(long long)>(::dlsym(RTLD_DEFAULT, "kinebus_hold_clock"))),
        seen_(reinterpret_cast<long long (*)()>(::dlsym(RTLD_DEFAULT, "kinebus_guest_seen"))) {}
  ~LabClock() { go_on(); }
  LabClock(const LabClock&) = delete;
  LabClock& operator=(const LabClock&) = delete;

  /// It goes no farther than here until it is told again.
  void wait_at(LocalTime here) const {
    if (hold_ != nullptr) hold_(here.count());
  }
  void go_on() const { wait_at(LocalTime{0}); }
  /// For what comes from the guest: a millisecond at most, and less where it waits, too.
  void wait(pollfd what) const {
    const timespec patience{0, hold_ != nullptr ? 100'000 : 1'000'000};
    ::ppoll(&what, 1, &patience, nullptr);
  }
  /// Its processor has not run for a while: another program of this computer had it.
  bool guest_is_behind(LocalTime here) const {
    const LocalTime seen{seen_ != nullptr ? seen_() : 0};
    return seen.count() != 0 && here > seen + kBehind;
  }

 private:
  // An idle guest's tick is 4 ms.
  static constexpr LocalTime kBehind = std::chrono::milliseconds{20};
  void (*hold_)(long long);
  long long (*seen_)();
};

}  // namespace kinebus::emulator
