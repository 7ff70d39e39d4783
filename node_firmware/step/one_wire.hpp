#pragma once
// Bytes of an asynchronous serial line (8 data bits, the lowest first, no parity, one stop bit) as what a
// timer puts out to and takes in from a port of the chip, kSamples times a bit.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinebus::step {

inline constexpr std::size_t kSamples = 4;  ///< a bit
inline constexpr std::size_t kBitsOfByte = 10;

/// Words that set (lower half) and reset (upper half) `pin` of a port. `words`: kSamples * kBitsOfByte for
/// each byte. Returns how many were written.
constexpr std::size_t put_bytes(std::span<const std::uint8_t> bytes, std::uint32_t pin,
                                std::span<std::uint32_t> words) {
  std::size_t at = 0;
  for (const std::uint8_t byte : bytes) {
    const unsigned bits = 1u << 9 | static_cast<unsigned>(byte) << 1;
    for (std::size_t bit = 0; bit < kBitsOfByte; ++bit)
      for (std::size_t i = 0; i < kSamples; ++i) words[at++] = (bits >> bit & 1) != 0 ? pin : pin << 16;
  }
  return at;
}

/// What was on the pin: up to bytes.size() bytes. Returns how many came whole; a byte without its stop bit
/// ends it. A bit is taken 0.5 to 0.75 of its length behind the edge that began its byte: a slow rise of a
/// quarter of a bit, and 2 % between the clocks, do no harm.
constexpr std::size_t take_bytes(std::span<const std::uint16_t> samples, std::uint32_t pin,
                                 std::span<std::uint8_t> bytes) {
  const auto high = [&](std::size_t at) { return (samples[at] & pin) != 0; };
  constexpr std::size_t kMiddle = kSamples / 2, kStop = kMiddle + 9 * kSamples;
  std::size_t at = 0;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    while (at < samples.size() && high(at)) ++at;
    if (at + kStop >= samples.size() || high(at + kMiddle) || !high(at + kStop)) return n;
    unsigned byte = 0;
    for (std::size_t bit = 0; bit < 8; ++bit)
      byte |= (high(at + kMiddle + (bit + 1) * kSamples) ? 1u : 0u) << bit;
    bytes[n] = static_cast<std::uint8_t>(byte);
    at += kStop;
  }
  return bytes.size();
}

}  // namespace kinebus::step
