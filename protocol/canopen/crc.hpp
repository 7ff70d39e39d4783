#pragma once
// The two checksums of the protocol: CRC-16 of SDO block transfer (CiA 301: CCITT polynomial 1021h, start 0,
// not reflected) and CRC-32 (IEEE 802.3) of stored parameters. Nibble tables: 16 entries each, made at
// compile time.

#include <array>
#include <cstdint>
#include <span>

namespace kinebus {

class Crc16 {
 public:
  constexpr void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      step(static_cast<std::uint8_t>(byte >> 4));
      step(static_cast<std::uint8_t>(byte & 0xF));
    }
  }
  constexpr std::uint16_t value() const { return crc_; }

 private:
  static constexpr std::array<std::uint16_t, 16> kTable = [] {
    std::array<std::uint16_t, 16> table{};
    for (unsigned i = 0; i < 16; ++i) {
      unsigned crc = i << 12;
      for (int bit = 0; bit < 4; ++bit) crc = (crc & 0x8000u) != 0 ? (crc << 1) ^ 0x1021u : crc << 1;
      table[i] = static_cast<std::uint16_t>(crc & 0xFFFFu);
    }
    return table;
  }();
  constexpr void step(std::uint8_t nibble) {
    crc_ = static_cast<std::uint16_t>((crc_ << 4) ^ kTable[((crc_ >> 12) ^ nibble) & 0xF]);
  }
  std::uint16_t crc_ = 0;
};

class Crc32 {
 public:
  constexpr void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      crc_ ^= byte;
      crc_ = (crc_ >> 4) ^ kTable[crc_ & 0xF];
      crc_ = (crc_ >> 4) ^ kTable[crc_ & 0xF];
    }
  }
  constexpr std::uint32_t value() const { return ~crc_; }

 private:
  static constexpr std::array<std::uint32_t, 16> kTable = [] {
    std::array<std::uint32_t, 16> table{};
    for (std::uint32_t i = 0; i < 16; ++i) {
      std::uint32_t crc = i;
      for (int bit = 0; bit < 4; ++bit) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xEDB8'8320u : crc >> 1;
      table[i] = crc;
    }
    return table;
  }();
  std::uint32_t crc_ = 0xFFFF'FFFFu;
};

}  // namespace kinebus
