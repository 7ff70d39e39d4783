#pragma once
// One CAN 2.0 frame, as every part of Kinebus passes it on.

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace kinebus {

/// A classic CAN data or remote frame (no FD). Comparable; 16 bytes; no padding semantics on the wire.
struct CanFrame {
  std::uint32_t id = 0;  ///< 11 or 29 bits, without flags
  bool extended = false;
  bool remote = false;
  std::uint8_t length = 0;  ///< data bytes, 0..8
  std::array<std::uint8_t, 8> data{};

  static constexpr CanFrame make(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    return from_bytes(id, {bytes.begin(), bytes.size()});
  }
  static constexpr CanFrame from_bytes(std::uint32_t id, std::span<const std::uint8_t> bytes) {
    CanFrame frame;
    frame.id = id;
    frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 8));
    std::copy_n(bytes.begin(), frame.length, frame.data.begin());
    return frame;
  }
  constexpr std::span<const std::uint8_t> bytes() const { return {data.data(), length}; }

  friend constexpr bool operator==(const CanFrame&, const CanFrame&) = default;
};

}  // namespace kinebus
