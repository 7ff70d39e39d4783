#pragma once
// What every STM32F4 board here is clocked with, whatever its crystal: 168 MHz is the most that gives USB its
// 48 MHz from the same PLL, and CAN 21 time quanta a bit.

#include <cstdint>

namespace kinebus::stm32 {

inline constexpr std::uint32_t kCoreHz = 168'000'000;
inline constexpr std::uint32_t kApb1Hz = 42'000'000;  // its timers: 84 MHz
inline constexpr std::uint32_t kApb2Hz = 84'000'000;  // its timers: 168 MHz

/// Local time: TIM2, free-running, 32 bits, 4 MHz.
inline constexpr std::uint32_t kLocalHz = 4'000'000;
inline constexpr std::int64_t kLocalNs = 250;

}  // namespace kinebus::stm32
