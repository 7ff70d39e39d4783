#pragma once
// Why this chip has begun anew: the flags of RCC_CSR, and what lies in the RAM that a reset keeps
// (sections.ld).

#include "node_firmware/board/fault_record.hpp"
#include "node_firmware/boot/handover.hpp"
#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

extern "C" kinebus::FaultRecord fault_ram;
extern "C" kinebus::Handover handover_ram;

namespace kinebus::g0b1 {

/// A reset from within pulls the pin too: the most telling first. Power-on and brown-out are one flag.
constexpr ResetCause reset_cause(std::uint32_t csr) {
  if ((csr & (Rcc::kWatchdogReset | Rcc::kWindowWatchdogReset)) != 0) return ResetCause::kWatchdog;
  if ((csr & Rcc::kSoftwareReset) != 0) return ResetCause::kSoftware;
  if ((csr & Rcc::kPowerOnReset) != 0) return ResetCause::kPowerOn;
  return (csr & Rcc::kPinReset) != 0 ? ResetCause::kResetPin : ResetCause::kOther;
}

/// Once: the flags and the record are gone then.
inline ResetReport take_reset_report() {
  ResetReport report = fault_ram.take();
  report.cause = reset_cause(rcc().CSR);
  rcc().CSR = rcc().CSR | Rcc::kClearResetFlags;
  return report;
}

}  // namespace kinebus::g0b1
