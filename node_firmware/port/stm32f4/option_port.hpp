#pragma once
// The option bytes: brown-out reset at 2.7 V, below which neither flash nor 168 MHz are in specification, and
// write protection of sectors. All other options stay as they are; a chip that is read protected is left
// alone.

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"

namespace kinebus::stm32::options {

/// Bits of ProgramFlash. `sectors`: to be write protected, as bits of OPTCR (not_write_protected); 0: none.
inline std::uint8_t missing(std::uint32_t sectors) {
  const std::uint32_t set = flash_interface().OPTCR;
  unsigned bits = 0;
  if ((set & FlashInterface::kBrownOutLevel) != 0) bits |= ProgramFlash::kNoBrownOut;
  if ((set & sectors) != 0) bits |= ProgramFlash::kBootLoaderOpen;
  return static_cast<std::uint8_t>(bits);
}

/// The chip erases all options and writes them anew: up to a second in which the power must stay.
inline bool protect(std::uint32_t sectors) {
  FlashInterface& f = flash_interface();
  if (missing(sectors) == 0) return true;
  if ((f.OPTCR & FlashInterface::kReadProtection) != FlashInterface::kNotReadProtected) return false;
  if (!flash::wait_idle()) return false;
  f.OPTKEYR = FlashInterface::kOptionKey1;
  f.OPTKEYR = FlashInterface::kOptionKey2;
  if ((f.OPTCR & FlashInterface::kOptionLock) != 0) return false;
  f.OPTCR = f.OPTCR & ~(FlashInterface::kBrownOutLevel | sectors);
  f.OPTCR = f.OPTCR | FlashInterface::kOptionStart;
  const bool good = flash::wait_idle();
  f.OPTCR = f.OPTCR | FlashInterface::kOptionLock;
  return good && missing(sectors) == 0;
}

}  // namespace kinebus::stm32::options
