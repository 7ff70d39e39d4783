#pragma once
// Little-endian numbers in byte spans: the only way in which numbers become wire bytes and back.
// The caller guarantees that the span is long enough.

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinebus {

template <typename T>
constexpr void put_le(std::span<std::uint8_t> bytes, T value, std::size_t count = sizeof(T)) {
  auto raw = static_cast<std::uint64_t>(value);
  for (std::size_t i = 0; i < count; ++i, raw >>= 8) bytes[i] = static_cast<std::uint8_t>(raw & 0xFF);
}

constexpr std::uint64_t get_le(std::span<const std::uint8_t> bytes, std::size_t count) {
  std::uint64_t raw = 0;
  for (std::size_t i = 0; i < count; ++i) raw |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
  return raw;
}

constexpr std::uint16_t get_u16_le(std::span<const std::uint8_t> b) {
  return static_cast<std::uint16_t>(get_le(b, 2));
}
constexpr std::uint32_t get_u32_le(std::span<const std::uint8_t> b) {
  return static_cast<std::uint32_t>(get_le(b, 4));
}
constexpr std::uint64_t get_u64_le(std::span<const std::uint8_t> b) {
  return get_le(b, 8);
}
constexpr std::int16_t get_i16_le(std::span<const std::uint8_t> b) {
  return static_cast<std::int16_t>(get_u16_le(b));
}
constexpr std::int32_t get_i32_le(std::span<const std::uint8_t> b) {
  return static_cast<std::int32_t>(get_u32_le(b));
}
constexpr void put_u16_le(std::span<std::uint8_t> b, std::uint16_t v) {
  put_le(b, v);
}
constexpr void put_u32_le(std::span<std::uint8_t> b, std::uint32_t v) {
  put_le(b, v);
}
constexpr void put_u64_le(std::span<std::uint8_t> b, std::uint64_t v) {
  put_le(b, v);
}
constexpr void put_i32_le(std::span<std::uint8_t> b, std::int32_t v) {
  put_le(b, static_cast<std::uint32_t>(v));
}

}  // namespace kinebus
