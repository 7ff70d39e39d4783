#pragma once
// Why the processor began anew, and what the program before it has left behind: 2121h, and an EMCY at start.

#include <cstdint>

namespace kinebus {

/// 2121h:1.
enum class ResetCause : std::uint8_t { kPowerOn, kResetPin, kBrownOut, kWatchdog, kSoftware, kOther };

/// 2121h:2. Up to FFh: the processor's exception of that number (2 the crystal has stopped, 3 hard fault, 16
/// + n an interrupt without handler: 17 the chip's supply is low).
namespace fault_reason {
inline constexpr std::uint16_t kNone = 0, kAssert = 0x100, kAbort = 0x101, kNoClock = 0x102,
                               kMainEnded = 0x103, kOtherCrystal = 0x104;
/// No fault: the crystal could not be measured, and the board runs as with its own one.
inline constexpr std::uint16_t kUnmeasuredCrystal = 0x105;
}  // namespace fault_reason

/// Of what a start of the clocks has returned: the core has its clock.
constexpr bool clocks_run(std::uint16_t reason) {
  return reason == fault_reason::kNone || reason == fault_reason::kUnmeasuredCrystal;
}

struct ResetReport {
  ResetCause cause = ResetCause::kPowerOn;
  std::uint16_t reason = fault_reason::kNone;
  std::uint32_t pc = 0, lr = 0;                   ///< of the program that ended so
  std::uint32_t cfsr = 0, hfsr = 0, address = 0;  ///< ARMv7-M fault status; BFAR
};

}  // namespace kinebus
