#pragma once
// How long a piece of Thumb-2 code takes on a Cortex-M4, estimated from the instruction timings of its
// technical reference manual. An estimate: flash wait states (hidden by the ART cache but for jumps) are one
// cycle a taken branch, divisions take their mean, bus contention is left out.

#include <cstdint>
#include <span>

namespace kinebus::emulator {

struct CodeCost {
  std::uint32_t instructions = 0;
  std::uint32_t cycles = 0;
};

/// `code`: the half-words of one basic block.
CodeCost estimate_cost(std::span<const std::uint16_t> code);
/// On a Cortex-M0+ of 64 MHz with two wait states: its manual's timings, and both wait states for each
/// jump and each literal, since lines of 8 bytes are fetched ahead in a straight line only.
/// in_flash: false for RAM, which has no wait states.
CodeCost estimate_small_cost(std::span<const std::uint16_t> code, bool in_flash);

/// All of it are instructions of the ARMv6-M.
bool small_core_runs(std::span<const std::uint16_t> code);

/// 1 or 2 half-words.
constexpr int thumb_length(std::uint16_t first) {
  return (first & 0xF800) >= 0xE800 ? 2 : 1;
}

}  // namespace kinebus::emulator
