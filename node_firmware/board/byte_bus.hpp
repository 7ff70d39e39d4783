#pragma once

#include <concepts>
#include <cstdint>
#include <optional>

namespace kinebus {

/// SPI in mode 3 of at most 5 MHz, bytes both ways, and a chip's select line.
template <typename T>
concept ByteBus = requires(T& bus, std::uint8_t byte) {
  bus.select(true);
  { bus.exchange(byte) } -> std::same_as<std::optional<std::uint8_t>>;
  bus.wait_us(1u);
};

}  // namespace kinebus
