#pragma once
// How a board names its pins and places. No registers: what compares a board with a schematic or models it
// reads this, too.

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinebus::stm32 {

enum class Port : std::uint8_t { A, B, C, D, E, F, G, H };
enum class Mode : std::uint8_t { kInput, kOutput, kAlternate, kAnalogue };
enum class Pull : std::uint8_t { kNone, kUp, kDown };

struct Pin {
  Port port;
  std::uint8_t number;
  Mode mode;
  Pull pull;
  std::uint8_t alternate;  ///< AF number
  bool high;               ///< outputs: level from reset on
  const char* signal;
};
struct SwitchPin {
  Port port;
  std::uint8_t line;  ///< pin number, and with it the EXTI line
};
struct OutputPin {
  Port port;
  std::uint8_t number;
};
struct InputPin {
  Port port;
  std::uint8_t number;
};

struct FlashSector {
  std::uint32_t address;
  std::uint8_t number;
};

/// No pin stands twice in a board's table.
template <std::size_t kCount>
constexpr bool pins_differ(const std::array<Pin, kCount>& pins) {
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (pins[i].port == pins[k].port && pins[i].number == pins[k].number) return false;
  return true;
}
/// Every input has an EXTI line of its own.
template <std::size_t kCount>
constexpr bool lines_differ(const std::array<SwitchPin, kCount>& pins) {
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (pins[i].line == pins[k].line) return false;
  return true;
}

/// What a board's table is written in.
namespace pin_words {
using stm32::InputPin;
using stm32::Mode;
using stm32::OutputPin;
using stm32::Pin;
using stm32::Port;
using stm32::Pull;
using stm32::SwitchPin;
using enum Port;
using enum Mode;
using enum Pull;
}  // namespace pin_words

}  // namespace kinebus::stm32
