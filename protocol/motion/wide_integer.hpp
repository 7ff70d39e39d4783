#pragma once
// 128-bit unsigned, for processors and compilers without one: just what path time needs.

#include <cstdint>

namespace kinebus {

struct U128 {
  std::uint64_t high = 0, low = 0;
};
constexpr U128 multiply(std::uint64_t x, std::uint64_t y) {
  const std::uint64_t x0 = x & 0xFFFF'FFFFu, x1 = x >> 32, y0 = y & 0xFFFF'FFFFu, y1 = y >> 32;
  const std::uint64_t low = x0 * y0;
  const std::uint64_t middle = x1 * y0 + (low >> 32);
  const std::uint64_t middle2 = x0 * y1 + (middle & 0xFFFF'FFFFu);
  return {x1 * y1 + (middle >> 32) + (middle2 >> 32), (middle2 << 32) | (low & 0xFFFF'FFFFu)};
}
constexpr U128 add(U128 x, U128 y) {
  const std::uint64_t low = x.low + y.low;
  return {x.high + y.high + (low < x.low ? 1u : 0u), low};
}
constexpr U128 subtract(U128 x, U128 y) {
  return {x.high - y.high - (x.low < y.low ? 1u : 0u), x.low - y.low};
}
/// 0 < bits < 64; the result fits.
constexpr std::uint64_t shift_right(U128 x, int bits) {
  return (x.high << (64 - bits)) | (x.low >> bits);
}
/// The result fits.
constexpr U128 multiply(U128 x, std::uint64_t y) {
  U128 product = multiply(x.low, y);
  product.high += x.high * y;
  return product;
}

}  // namespace kinebus
