#pragma once
// The chip's flash: one bank of 64 pages of 2 KiB, programmed by double words of 8 bytes, with bounded waits.
// The processor stands still meanwhile: it runs from the same bank.

#include <span>

#include "node_firmware/core/page_store.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

namespace kinebus::g0b1 {

namespace flash {

inline bool wait_idle() {
  // 200 ms at the core's speed: five times the longest erase.
  const std::uint32_t busy = FlashInterface::kBusy | FlashInterface::kConfigurationBusy;
  if (!wait_until([&] { return (flash_interface().SR & busy) == 0; }, 2'000'000)) return false;
  const bool good = (flash_interface().SR & FlashInterface::kErrors) == 0;
  flash_interface().SR = FlashInterface::kErrors | FlashInterface::kEndOfOperation;
  return good;
}
inline void unlock() {
  if ((flash_interface().CR & FlashInterface::kLock) == 0) return;
  flash_interface().KEYR = FlashInterface::kKey1;
  flash_interface().KEYR = FlashInterface::kKey2;
}
/// Begins and ends an operation of `kind`: the errors of what was before are not its own.
template <typename Operation>
bool operate(std::uint32_t kind, Operation operation) {
  static_cast<void>(wait_idle());
  unlock();
  flash_interface().CR = kind;
  operation();
  const bool good = wait_idle();
  flash_interface().CR = FlashInterface::kLock;
  return good;
}
inline bool erase(unsigned page) {
  const bool good = operate(FlashInterface::kPageErase | FlashInterface::page(page),
                            [] { flash_interface().CR = flash_interface().CR | FlashInterface::kStart; });
  // The cache still holds what was there before.
  FlashInterface& f = flash_interface();
  f.ACR = f.ACR & ~FlashInterface::kInstructionCache;
  f.ACR = f.ACR | FlashInterface::kInstructionCacheReset;
  f.ACR = (f.ACR & ~FlashInterface::kInstructionCacheReset) | FlashInterface::kInstructionCache;
  return good;
}
/// From the first on; false: one of them does not take it.
inline bool erase(const ebb::Pages& pages) {
  bool good = true;
  for (unsigned i = 0; i < pages.count; ++i) good = erase(pages.first + i) && good;
  return good;
}
inline bool program(std::uint32_t address, std::uint32_t low, std::uint32_t high) {
  const bool good = operate(FlashInterface::kProgram, [&] {
    peripheral<Reg>(address) = low;
    peripheral<Reg>(address + 4) = high;
  });
  return good && peripheral<Reg>(address) == low && peripheral<Reg>(address + 4) == high;
}

}  // namespace flash

/// Two runs of the chip's pages, of as many bytes, as the pages of a PageStore.
template <const auto& kPages>
class ParameterFlash final : public FlashPages {
 public:
  std::span<const std::uint8_t> page(std::size_t which) const override {
    return {&peripheral<const std::uint8_t>(kPages[which].address()), kPages[which].bytes()};
  }
  std::size_t unit() const override { return 8; }
  bool erase(std::size_t which) override { return flash::erase(kPages[which]); }
  /// The lower word of a pair waits for the other one, which comes next.
  bool program(std::size_t which, std::uint32_t offset, std::uint32_t word) override {
    if (offset % 8 == 0) {
      low_ = word;
      return true;
    }
    return flash::program(kPages[which].address() + offset - 4, low_, word);
  }

 private:
  std::uint32_t low_ = 0xFFFF'FFFF;
};

}  // namespace kinebus::g0b1
