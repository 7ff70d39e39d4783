#pragma once
// Currents of drivers that have two full scales (VSENSE) and 32 steps of each.

#include <algorithm>
#include <cstdint>

namespace kinebus::step {

struct CurrentScale {
  bool fine = false;  ///< VSENSE: the smaller full scale
  std::uint8_t run = 0, hold = 0;
};
/// What the sense resistors stand for: amplitudes of a phase's current.
struct FullScale {
  std::uint32_t coarse_ma = 0, fine_ma = 0;
};
/// Never more than asked for, but for the smallest that there is.
constexpr CurrentScale scale_of(std::uint32_t run_ma, std::uint32_t hold_ma, FullScale full) {
  const bool fine = std::max(run_ma, hold_ma) <= full.fine_ma;
  const auto part = [scale = fine ? full.fine_ma : full.coarse_ma](std::uint32_t ma) {
    return static_cast<std::uint8_t>(std::clamp<std::uint32_t>(ma * 32 / scale, 1, 32) - 1);
  };
  return {.fine = fine, .run = part(run_ma), .hold = part(hold_ma)};
}

}  // namespace kinebus::step
