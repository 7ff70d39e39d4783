// The vectors are the designers' own: vectors_sip64 of their reference implementation, key 00h..0Fh, message
// 00h, 01h, ..; the one of 15 bytes is that of the publication's appendix A.

#include "protocol/motion/siphash.hpp"

#include <gtest/gtest.h>

#include <array>

namespace kinebus {
namespace {

constexpr SipHashKey kPublishedKey{0x0706050403020100, 0x0f0e0d0c0b0a0908};

constexpr std::uint64_t of_length(std::size_t length) {
  std::array<std::uint8_t, 64> message{};
  for (std::size_t i = 0; i < message.size(); ++i) message[i] = static_cast<std::uint8_t>(i);
  return siphash_2_4(kPublishedKey, std::span<const std::uint8_t>(message).first(length));
}

TEST(SipHash, IsThatOfThePublication) {
  EXPECT_EQ(of_length(15), 0xa129ca6149be45e5);
}

TEST(SipHash, IsThatOfTheReferenceImplementation) {
  EXPECT_EQ(of_length(0), 0x726fdb47dd0e0e31);
  EXPECT_EQ(of_length(1), 0x74f839c593dc67fd);
  EXPECT_EQ(of_length(7), 0xab0200f58b01d137);
  EXPECT_EQ(of_length(8), 0x93f5f5799a932462);
  EXPECT_EQ(of_length(16), 0x3f2acc7f57c29bdb);
  EXPECT_EQ(of_length(63), 0x958a324ceb064572);
}

TEST(SipHash, IsKnownToTheCompiler) {
  static_assert(of_length(15) == 0xa129ca6149be45e5);
}

}  // namespace
}  // namespace kinebus
