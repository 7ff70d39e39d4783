#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>

namespace kinebus {

/// SPI in mode 3 of at most 5 MHz, bytes both ways, and a chip's select line.
template <typename T>
concept ByteBus = requires(T& bus, std::uint8_t byte) {
  bus.select(true);
  { bus.exchange(byte) } -> std::same_as<std::optional<std::uint8_t>>;
  bus.wait_us(1u);
};

/// To the chip that is selected: `first`, then `bytes`, in whose place is what it has answered meanwhile.
/// False: the bus stands. `kPause_us`: from select to clock, and at the end before the next select.
template <unsigned kPause_us = 0, ByteBus Bus>
bool talk(Bus& bus, std::uint8_t first, std::span<std::uint8_t> bytes) {
  bus.select(true);
  if constexpr (kPause_us != 0) bus.wait_us(kPause_us);
  bool good = bus.exchange(first).has_value();
  for (std::uint8_t& byte : bytes) {
    const auto got = good ? bus.exchange(byte) : std::nullopt;
    good = got.has_value();
    byte = got.value_or(0);
  }
  bus.select(false);
  if constexpr (kPause_us != 0) bus.wait_us(kPause_us);
  return good;
}

}  // namespace kinebus
