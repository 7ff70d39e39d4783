#pragma once
// SipHash-2-4: 64 bits that only who has the 128-bit key can make for a message (Aumasson, Bernstein:
// "SipHash: a fast short-input PRF", 2012). Additions, rotations and exclusive ors alone: it needs neither
// tables nor multiplications, on a core without 64-bit registers some 600 instructions for 16 bytes.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/bytes.hpp"

namespace kinebus {

/// The key's bytes 0 to 7 and 8 to 15, little-endian, as the publication numbers them.
struct SipHashKey {
  std::uint64_t low = 0, high = 0;
  friend constexpr bool operator==(const SipHashKey&, const SipHashKey&) = default;
};

namespace siphash {
struct State {
  std::array<std::uint64_t, 4> v;

  constexpr void rounds(int count) {
    for (int i = 0; i < count; ++i) {
      v[0] += v[1];
      v[2] += v[3];
      v[1] = std::rotl(v[1], 13) ^ v[0];
      v[3] = std::rotl(v[3], 16) ^ v[2];
      v[0] = std::rotl(v[0], 32);
      v[2] += v[1];
      v[0] += v[3];
      v[1] = std::rotl(v[1], 17) ^ v[2];
      v[3] = std::rotl(v[3], 21) ^ v[0];
      v[2] = std::rotl(v[2], 32);
    }
  }
  constexpr void take(std::uint64_t word) {
    v[3] ^= word;
    rounds(2);
    v[0] ^= word;
  }
};
}  // namespace siphash

constexpr std::uint64_t siphash_2_4(const SipHashKey& key, std::span<const std::uint8_t> message) {
  siphash::State state{{key.low ^ 0x736f6d6570736575, key.high ^ 0x646f72616e646f6d,
                        key.low ^ 0x6c7967656e657261, key.high ^ 0x7465646279746573}};
  // The last word holds what is left of the message, and its length.
  std::uint64_t last = static_cast<std::uint64_t>(message.size()) << 56;
  const std::size_t whole = message.size() / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8) state.take(get_u64_le(message.subspan(i)));
  for (std::size_t i = whole; i < message.size(); ++i)
    last |= static_cast<std::uint64_t>(message[i]) << (8 * (i - whole));
  state.take(last);
  state.v[2] ^= 0xFF;
  state.rounds(4);
  return state.v[0] ^ state.v[1] ^ state.v[2] ^ state.v[3];
}

}  // namespace kinebus
