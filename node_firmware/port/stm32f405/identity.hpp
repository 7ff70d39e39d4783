#pragma once
// Who this board is.

#include <array>
#include <cstdint>

#include "node_firmware/port/stm32f405/registers.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus::stm32 {

/// 32 bits of the chip's 96-bit unique number, for 1018h:4.
inline std::uint32_t serial_number() {
  Crc32 crc;
  for (int word = 0; word < 3; ++word) {
    std::array<std::uint8_t, 4> bytes{};
    put_u32_le(bytes, unique_id()[word]);
    crc.add(bytes);
  }
  return crc.value();
}

}  // namespace kinebus::stm32
