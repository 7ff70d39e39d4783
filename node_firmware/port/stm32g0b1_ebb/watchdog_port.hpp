#pragma once
// The independent watchdog, on its own oscillator of 32 kHz. It counts on while flash keeps the processor
// waiting.

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

namespace kinebus::g0b1 {

class WatchdogPort {
 public:
  /// Resets the processor when it is not fed for 100 ms.
  void start() {
    watchdog().KR = IndependentWatchdog::kStart;
    set(3, 100);  // 32 kHz / 32 = 1 kHz
  }
  /// Before flash is erased (3 pages of 40 ms) or written (630 double words of 125 us): 2 s.
  void allow_flash() { set(6, 250); }  // 125 Hz
  void back_to_normal() { set(3, 100); }
  void feed() { watchdog().KR = IndependentWatchdog::kFeed; }

 private:
  static void wait() {
    static_cast<void>(wait_until([] { return watchdog().SR == 0; }, 100'000));
  }
  static void set(std::uint32_t prescaler, std::uint32_t reload) {
    watchdog().KR = IndependentWatchdog::kUnlock;
    wait();
    watchdog().PR = prescaler;
    watchdog().RLR = reload;
    wait();
    watchdog().KR = IndependentWatchdog::kFeed;
  }
};
static_assert(WatchdogDriver<WatchdogPort>);

}  // namespace kinebus::g0b1
