#pragma once
// What is said on the one wire of a TMC2209: datagrams with a CRC (its datasheet, "UART single wire
// interface"). The lowest bit of a byte goes first.
//
//   write, 8 bytes:    05h | node | register + 80h | value, highest byte first | CRC
//   request, 4 bytes:  05h | node | register | CRC
//   answer, 8 bytes:   05h | FFh | register | value, highest byte first | CRC

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinebus::tmc2209 {

inline constexpr std::uint8_t kSync = 0x05, kMaster = 0xFF, kWrite = 0x80;
inline constexpr std::size_t kRequestBytes = 4, kValueBytes = 8;

/// x^8 + x^2 + x + 1, from 0, the lowest bit of each byte first.
constexpr std::uint8_t crc8(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0;
  for (unsigned byte : bytes) {
    for (int bit = 0; bit < 8; ++bit, byte >>= 1)
      crc = ((crc >> 7 ^ byte) & 1) != 0 ? (crc << 1 ^ 0x07u) & 0xFF : crc << 1 & 0xFF;
  }
  return static_cast<std::uint8_t>(crc);
}

/// What is to be said, and whether an answer comes.
struct Datagram {
  std::array<std::uint8_t, kValueBytes> bytes{};
  std::uint8_t length = 0;
  bool read = false;
  std::uint8_t address() const { return bytes[2] & 0x7F; }
  std::span<const std::uint8_t> said() const { return std::span(bytes).first(length); }
};

constexpr Datagram read_of(std::uint8_t address, std::uint8_t node = 0) {
  Datagram d{.bytes = {kSync, node, address}, .length = kRequestBytes, .read = true};
  d.bytes[3] = crc8(std::span(d.bytes).first(3));
  return d;
}
constexpr Datagram write_of(std::uint8_t address, std::uint32_t value, std::uint8_t node = 0) {
  Datagram d{.bytes = {kSync, node, static_cast<std::uint8_t>(address | kWrite)}, .length = kValueBytes};
  for (std::size_t i = 0; i < 4; ++i) d.bytes[3 + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  d.bytes[7] = crc8(std::span(d.bytes).first(7));
  return d;
}
/// The value of an answer; none: garbled, or the answer to something else.
constexpr std::optional<std::uint32_t> answer_of(std::span<const std::uint8_t> bytes, std::uint8_t address) {
  if (bytes.size() != kValueBytes || bytes[0] != kSync || bytes[1] != kMaster || bytes[2] != address ||
      bytes[7] != crc8(bytes.first(7)))
    return std::nullopt;
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes.subspan(3, 4)) value = value << 8 | byte;
  return value;
}

}  // namespace kinebus::tmc2209
