#include "protocol/can/bit_length.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

/// ISO 11898-1 bit by bit: what the table must agree with.
int slow_bit_length(const CanFrame& f) {
  std::vector<int> bits{0};
  const auto put = [&](std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bits.push_back(static_cast<int>((value >> i) & 1));
  };
  if (f.extended) {
    put(f.id >> 18, 11);
    put(3, 2);
    put(f.id & 0x3FFFF, 18);
    put(f.remote ? 1 : 0, 1);
    put(0, 2);
  } else {
    put(f.id, 11);
    put(f.remote ? 1 : 0, 1);
    put(0, 2);
  }
  put(f.length, 4);
  if (!f.remote)
    for (const auto byte : f.bytes()) put(byte, 8);
  std::uint32_t crc = 0;
  for (const int bit : bits) {
    const bool invert = (static_cast<std::uint32_t>(bit) ^ (crc >> 14)) & 1;
    crc = (crc << 1) & 0x7FFF;
    if (invert) crc ^= 0x4599;
  }
  put(crc, 15);
  int total = 0, run = 0, level = -1;
  for (const int bit : bits) {
    ++total;
    run = bit == level ? run + 1 : 1;
    level = bit;
    if (run == 5) {
      ++total;
      level = 1 - bit;
      run = 1;
    }
  }
  return total + 1 + 2 + 7 + 3;
}

TEST(BitLength, AgreesWithIsoBitByBit) {
  std::mt19937 generator(3);
  const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
  for (int i = 0; i < 20000; ++i) {
    CanFrame f;
    f.extended = (random() & 3) == 0;
    f.remote = (random() & 15) == 0;
    f.id = random() & (f.extended ? 0x1FFFFFFFu : 0x7FFu);
    f.length = static_cast<std::uint8_t>(random() % 9);
    const auto fill = random() % 4;  // long runs bring the stuff bits
    for (int b = 0; b < f.length; ++b)
      f.data[static_cast<std::size_t>(b)] = fill == 0   ? std::uint8_t{0}
                                            : fill == 1 ? std::uint8_t{0xFF}
                                                        : static_cast<std::uint8_t>(random());
    ASSERT_EQ(bit_length(f), slow_bit_length(f)) << to_text(f).view();
    ASSERT_LE(bit_length(f), max_bit_length(f.length, f.extended));
  }
}

TEST(BitLength, IsWithinTheKnownBounds) {
  EXPECT_GE(bit_length(CanFrame::make(0x555, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55})), 111);
  EXPECT_GT(bit_length(CanFrame::make(0, {0, 0, 0, 0, 0, 0, 0, 0})), 125);
  EXPECT_EQ(max_bit_length(0), 55);
}

}  // namespace
}  // namespace kinebus
