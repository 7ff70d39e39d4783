#pragma once
// The board's record in the chip's one-time programmable memory: no erase reaches it.

#include "node_firmware/boot/board_record.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"

namespace kinebus::stm32::record {

inline constexpr std::uint32_t kAddress = 0x1FFF'7800, kBytes = 512;

inline std::span<const std::uint8_t> memory() {
  return flash::bytes(kAddress, kBytes);
}
/// False: no slot is left, or the chip did not take it.
inline bool add(const BoardRecord& record) {
  const auto slot = board_record::free_slot(memory());
  if (!slot) return false;
  auto at = static_cast<std::uint32_t>(kAddress + *slot);
  for (const std::uint32_t word : board_record::encode(record)) {
    // A blank word is left as it is.
    if (word != board_record::kBlank && !flash::program(at, word)) return false;
    at += 4;
  }
  return true;
}

}  // namespace kinebus::stm32::record
