#pragma once
// From reset to main: memory. Runs before any constructor; touches no peripheral.

#include <cstdint>

#include "node_firmware/board/fault_record.hpp"
#include "node_firmware/board/runtime.hpp"

extern "C" {
// Set by the linker script.
extern std::uint32_t data_start, data_end, data_load, bss_start, bss_end;
extern void (*init_array_start[])();
extern void (*init_array_end[])();

int main();
}

namespace kinebus::stm32 {

/// Ends by a reset that tells of a main that has ended.
[[noreturn]] inline void run_program() {
  const std::uint32_t* from = &data_load;
  for (std::uint32_t* to = &data_start; to != &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_start; to != &bss_end;) *to++ = 0;
  for (auto* init = init_array_start; init != init_array_end; ++init) (*init)();
  main();
  power_off_and_reset(fault_reason::kMainEnded, nullptr);
}

}  // namespace kinebus::stm32
