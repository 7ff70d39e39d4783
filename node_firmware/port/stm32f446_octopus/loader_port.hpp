#pragma once
// The maker's boot loader has run before: what it has left on is switched off, so that the chip is as after a
// reset.

#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

/// Interrupts stay off. False: the chip's own oscillator does not start.
inline bool end_loader() {
  disable_interrupts();
  sys_tick().CTRL = 0;
  for (Reg& enabled : nvic().ICER) enabled = 0xFFFF'FFFF;
  for (Reg& pending : nvic().ICPR) pending = 0xFFFF'FFFF;
  Rcc& r = rcc();
  r.CR = r.CR | Rcc::kHsiOn;
  if (!wait_until([&] { return (r.CR & Rcc::kHsiReady) != 0; })) return false;
  r.CFGR = 0;
  if (!wait_until([&] { return (r.CFGR & Rcc::kSwitchStatusMask) == 0; })) return false;
  // The PLL takes no new setting while it runs.
  r.CR = r.CR & ~(Rcc::kPllOn | Rcc::kClockSecurity);
  return wait_until([&] { return (r.CR & Rcc::kPllReady) == 0; });
}

}  // namespace kinebus::stm32
