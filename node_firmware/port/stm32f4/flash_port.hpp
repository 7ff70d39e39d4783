#pragma once
// The chip's flash: erase a sector, program a word, with bounded waits. The processor stands still meanwhile:
// it runs from the same flash.

#include <span>

#include "node_firmware/core/page_store.hpp"
#include "node_firmware/port/stm32/pin_table.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

namespace flash {

inline bool wait_idle() {
  // 4 s at the core's speed: twice the longest erase of 128 kB.
  if (!wait_until([] { return (flash_interface().SR & FlashInterface::kBusy) == 0; }, 100'000'000))
    return false;
  const bool good = (flash_interface().SR & FlashInterface::kErrors) == 0;
  flash_interface().SR = FlashInterface::kErrors | FlashInterface::kEndOfOperation;
  return good;
}
inline void unlock() {
  if ((flash_interface().CR & FlashInterface::kLock) == 0) return;
  flash_interface().KEYR = FlashInterface::kKey1;
  flash_interface().KEYR = FlashInterface::kKey2;
}
inline void lock() {
  flash_interface().CR = FlashInterface::kLock;
}

/// The caches still hold what was there before.
inline void forget_caches() {
  FlashInterface& f = flash_interface();
  const std::uint32_t acr = f.ACR;
  f.ACR = acr & ~(FlashInterface::kInstructionCache | FlashInterface::kDataCache);
  f.ACR = f.ACR | FlashInterface::kInstructionCacheReset | FlashInterface::kDataCacheReset;
  f.ACR = acr & ~(FlashInterface::kInstructionCacheReset | FlashInterface::kDataCacheReset);
}

inline bool erase(unsigned sector) {
  unlock();
  bool good = wait_idle();
  flash_interface().CR =
      FlashInterface::kSizeWord | FlashInterface::kSectorErase | FlashInterface::sector(sector);
  flash_interface().CR = flash_interface().CR | FlashInterface::kStart;
  good = wait_idle() && good;
  lock();
  forget_caches();
  return good;
}

inline bool program(std::uint32_t address, std::uint32_t word) {
  unlock();
  bool good = wait_idle();
  flash_interface().CR = FlashInterface::kSizeWord | FlashInterface::kProgram;
  peripheral<Reg>(address) = word;
  good = wait_idle() && good;
  lock();
  return good && peripheral<Reg>(address) == word;
}

inline std::span<const std::uint8_t> bytes(std::uint32_t address, std::size_t length) {
  return {&peripheral<const std::uint8_t>(address), length};
}

}  // namespace flash

/// Two sectors, of which the first kBytes are the pages of the parameters.
template <const auto& kSectors, std::uint32_t kBytes>
class ParameterFlash final : public FlashPages {
 public:
  std::span<const std::uint8_t> page(std::size_t which) const override {
    return flash::bytes(kSectors[which].address, kBytes);
  }
  bool erase(std::size_t which) override { return flash::erase(kSectors[which].number); }
  bool program(std::size_t which, std::uint32_t offset, std::uint32_t word) override {
    return flash::program(kSectors[which].address + offset, word);
  }
};

}  // namespace kinebus::stm32
