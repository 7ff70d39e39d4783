#pragma once
// The independent watchdog, on its own 32 kHz oscillator (17 to 47 kHz over all chips).

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

class WatchdogPort {
 public:
  /// Resets the processor when it is not fed for 100 ms (68 to 190 ms).
  void start() {
    watchdog().KR = IndependentWatchdog::kStart;
    set(3, 100);  // 32 kHz / 32 = 1 kHz
  }
  /// Before flash is erased or written (1250 words of 100 us): 4 s.
  void allow_flash() { set(6, 500); }  // 125 Hz
  void back_to_normal() { set(3, 100); }
  void feed() { watchdog().KR = IndependentWatchdog::kFeed; }

 private:
  static void set(std::uint32_t prescaler, std::uint32_t reload) {
    watchdog().KR = IndependentWatchdog::kUnlock;
    static_cast<void>(wait_until([] { return watchdog().SR == 0; }, 100'000));
    watchdog().PR = prescaler;
    watchdog().RLR = reload;
    static_cast<void>(wait_until([] { return watchdog().SR == 0; }, 100'000));
    watchdog().KR = IndependentWatchdog::kFeed;
  }
};
static_assert(WatchdogDriver<WatchdogPort>);

}  // namespace kinebus::stm32
