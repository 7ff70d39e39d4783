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

/// 1 or 2 half-words.
constexpr int thumb_length(std::uint16_t first) {
  return (first & 0xF800) >= 0xE800 ? 2 : 1;
}

}  // namespace kinebus::emulator
