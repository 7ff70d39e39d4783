#pragma once
// What is said to a TMC5160 or TMC2130 by SPI (their datasheets, "SPI interface"): mode 3, the highest bit
// first, 40 bits while CSN is low.
//
//   said:    register (+ 80h: write) | value, highest byte first
//   heard:   SPI_STATUS | what the datagram before this one has asked for; after a write, what was written

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinebus::tmc_spi {

inline constexpr std::size_t kDatagramBytes = 5;
inline constexpr std::uint8_t kWrite = 0x80;

using Datagram = std::array<std::uint8_t, kDatagramBytes>;

constexpr Datagram write_of(std::uint8_t address, std::uint32_t value) {
  Datagram d{static_cast<std::uint8_t>(address | kWrite)};
  for (std::size_t i = 0; i < 4; ++i) d[1 + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  return d;
}
/// Its answer comes with the next datagram.
constexpr Datagram read_of(std::uint8_t address) {
  return {address};
}

/// SPI_STATUS; bits 4 to 7 are of a TMC5160's own motion, which is not used.
namespace spi_status {
inline constexpr std::uint8_t kReset = 1, kDriverError = 2, kStall = 4, kStandstill = 8;
}  // namespace spi_status

struct Answer {
  std::uint8_t status = 0;
  std::uint32_t value = 0;
};
/// None: it is not whole. There is no CRC.
constexpr std::optional<Answer> answer_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != kDatagramBytes) return std::nullopt;
  Answer answer{.status = bytes[0]};
  for (const std::uint8_t byte : bytes.subspan(1)) answer.value = answer.value << 8 | byte;
  return answer;
}

}  // namespace kinebus::tmc_spi
