#pragma once
// Why this chip has begun anew: the flags of RCC_CSR, and the record behind the handover in RAM
// (sections.ld).

#include "node_firmware/board/fault_record.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

extern "C" kinebus::FaultRecord fault_ram;

namespace kinebus::stm32 {

/// A reset from within pulls the pin too, and power-on sets the flag of the brown-out too: the most telling
/// first.
constexpr ResetCause reset_cause(std::uint32_t csr) {
  if ((csr & (Rcc::kWatchdogReset | Rcc::kWindowWatchdogReset)) != 0) return ResetCause::kWatchdog;
  if ((csr & Rcc::kSoftwareReset) != 0) return ResetCause::kSoftware;
  if ((csr & Rcc::kPowerOnReset) != 0) return ResetCause::kPowerOn;
  if ((csr & Rcc::kBrownOutReset) != 0) return ResetCause::kBrownOut;
  return (csr & Rcc::kPinReset) != 0 ? ResetCause::kResetPin : ResetCause::kOther;
}

/// Once: the flags and the record are gone then.
/// `clock`: what start_clocks() has returned, which is told if nothing worse is to be.
inline ResetReport take_reset_report(std::uint16_t clock) {
  ResetReport report = fault_ram.take();
  report.cause = reset_cause(rcc().CSR);
  if (report.reason == fault_reason::kNone) report.reason = clock;
  rcc().CSR = rcc().CSR | Rcc::kClearResetFlags;
  return report;
}

}  // namespace kinebus::stm32
