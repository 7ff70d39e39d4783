#pragma once
// The option bytes: brown-out reset at 2.7 V, below which neither flash nor 168 MHz are in specification, and
// write protection of the boot loader's sectors. All other options stay as they are; a chip that is read
// protected is left alone.

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"
#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::stm32::options {

inline constexpr std::uint32_t kBootSectors =
    FlashInterface::not_write_protected(0) | FlashInterface::not_write_protected(1);
static_assert(board::kBootBytes == 2 * 0x4000, "sectors 0 and 1, of 16 KiB");

/// Bits of ProgramFlash.
inline std::uint8_t missing() {
  const std::uint32_t set = flash_interface().OPTCR;
  unsigned bits = 0;
  if ((set & FlashInterface::kBrownOutLevel) != 0) bits |= ProgramFlash::kNoBrownOut;
  if ((set & kBootSectors) != 0) bits |= ProgramFlash::kBootLoaderOpen;
  return static_cast<std::uint8_t>(bits);
}

/// The chip erases all options and writes them anew: up to a second in which the power must stay.
inline bool protect() {
  FlashInterface& f = flash_interface();
  if (missing() == 0) return true;
  if ((f.OPTCR & FlashInterface::kReadProtection) != FlashInterface::kNotReadProtected) return false;
  if (!flash::wait_idle()) return false;
  f.OPTKEYR = FlashInterface::kOptionKey1;
  f.OPTKEYR = FlashInterface::kOptionKey2;
  if ((f.OPTCR & FlashInterface::kOptionLock) != 0) return false;
  f.OPTCR = f.OPTCR & ~(FlashInterface::kBrownOutLevel | kBootSectors);
  f.OPTCR = f.OPTCR | FlashInterface::kOptionStart;
  const bool good = flash::wait_idle();
  f.OPTCR = f.OPTCR | FlashInterface::kOptionLock;
  return good && missing() == 0;
}

}  // namespace kinebus::stm32::options
