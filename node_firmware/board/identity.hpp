#pragma once
// Which one of its kind a board is.

#include <array>
#include <cstdint>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus {

/// 32 bits of a chip's unique number, for 1018h:4.
inline std::uint32_t serial_number(std::span<const volatile std::uint32_t> unique_id) {
  Crc32 crc;
  for (const volatile std::uint32_t& word : unique_id) {
    std::array<std::uint8_t, 4> bytes{};
    put_u32_le(bytes, word);
    crc.add(bytes);
  }
  return crc.value();
}

}  // namespace kinebus
