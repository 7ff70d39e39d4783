#pragma once
// Handover and fault record through a reset after which a loader of the maker's runs first and takes the RAM
// for itself: in the backup registers, which it leaves alone.

#include <algorithm>
#include <array>
#include <bit>

#include "node_firmware/board/fault_record.hpp"
#include "node_firmware/port/stm32f4/handover_port.hpp"
#include "node_firmware/port/stm32f4/reset_port.hpp"

namespace kinebus::stm32::backup {

struct Records {
  Handover handover;
  FaultRecord fault;
};
using Words = std::array<std::uint32_t, sizeof(Records) / 4>;
static_assert(Words{}.size() <= 20, "so many registers there are");

/// Before a reset, and when something has changed that a reset at any time must find so.
inline void save() {
  const auto words = std::bit_cast<Words>(Records{handover_ram, fault_ram});
  enable_clock(rcc().APB1ENR, Rcc::kPower);
  pwr().CR = pwr().CR | Pwr::kBackupWritable;
  std::copy(words.begin(), words.end(), backup_registers().begin());
  barrier();
}
/// At start, before the records are looked at.
inline void load() {
  Words words{};
  std::copy_n(backup_registers().begin(), words.size(), words.begin());
  const auto records = std::bit_cast<Records>(words);
  handover_ram = records.handover;
  fault_ram = records.fault;
}

}  // namespace kinebus::stm32::backup
