#pragma once
// How registers are written down, for every chip.

#include <cstdint>

namespace kinebus::stm32 {

using Reg = volatile std::uint32_t;

/// The one place where a number becomes a peripheral.
template <typename T>
inline T& peripheral(std::uint32_t address) {
  return *reinterpret_cast<T*>(address);  // NOLINT(performance-no-int-to-ptr): hardware is at fixed addresses
}

constexpr std::uint32_t bit(int n) {
  return std::uint32_t{1} << n;
}

}  // namespace kinebus::stm32
