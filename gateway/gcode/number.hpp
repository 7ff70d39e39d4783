#pragma once
// Decimal numbers as G-code writes them: sign, digits, point. No exponent (X1E5 is two words), no blanks
// inside.

#include <array>
#include <charconv>
#include <cstdint>

namespace kinebus::gcode {

/// 10^0 .. 10^22: every power of ten that a double holds exactly.
inline constexpr std::array<double, 23> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                        1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                        1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// Reads a number at `first`. Returns the end of the number, or nullptr when there is none (no digit) or it
/// is not finite. The value is the double nearest to the decimal, as strtod gives it: up to 2^53 the digits
/// and the power of ten are both exact, so that one division rounds once; longer numbers go through
/// std::from_chars.
inline const char* parse_decimal(const char* first, const char* last, double& value) {
  const char* p = first;
  const bool negative = p != last && *p == '-';
  if (p != last && (*p == '-' || *p == '+')) ++p;
  const char* const digits = p;
  std::uint64_t mantissa = 0;
  while (p != last && static_cast<unsigned char>(*p - '0') < 10) {
    mantissa = mantissa * 10 + static_cast<unsigned char>(*p - '0');
    ++p;
  }
  std::ptrdiff_t count = p - digits;
  std::ptrdiff_t decimals = 0;
  if (p != last && *p == '.') {
    const char* const fraction = ++p;
    while (p != last && static_cast<unsigned char>(*p - '0') < 10) {
      mantissa = mantissa * 10 + static_cast<unsigned char>(*p - '0');
      ++p;
    }
    decimals = p - fraction;
    count += decimals;
  }
  if (count == 0) return nullptr;
  // 15 digits are below 2^53.
  if (count <= 15) [[likely]] {
    const double magnitude = static_cast<double>(mantissa) / kPowersOfTen[static_cast<std::size_t>(decimals)];
    value = negative ? -magnitude : magnitude;
    return p;
  }
  double magnitude = 0;
  const auto [end, code] = std::from_chars(digits, p, magnitude, std::chars_format::fixed);
  if (code == std::errc::result_out_of_range) {
    // Digits alone can be too small for a double (many zeros after the point) or too large.
    bool small = true;
    for (const char* d = digits; d != p && *d != '.'; ++d) small = small && *d == '0';
    if (!small) return nullptr;
    magnitude = 0;
  } else if (code != std::errc{}) {
    return nullptr;
  }
  value = negative ? -magnitude : magnitude;
  return p;
}

}  // namespace kinebus::gcode
