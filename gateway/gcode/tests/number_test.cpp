#include "gateway/gcode/number.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace kinebus::gcode {
namespace {

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::string random_decimal(std::mt19937& random) {
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  std::string text;
  if (below(3) == 0) text += below(2) == 0 ? '-' : '+';
  const unsigned longest = below(4) == 0 ? 40 : 9;
  const unsigned whole = below(longest);
  for (unsigned i = 0; i < whole; ++i) text += static_cast<char>('0' + below(10));
  const unsigned decimals = below(longest);
  if (decimals > 0 || whole == 0) {
    text += '.';
    for (unsigned i = 0; i < decimals + (whole == 0 ? 1 : 0); ++i) text += static_cast<char>('0' + below(10));
  } else if (below(2) == 0) {
    text += '.';
  }
  return text;
}

TEST(Number, RandomDecimalsAreReadAsStrtodReadsThem) {
  constexpr unsigned kSeed = 1;
  std::mt19937 random(kSeed);
  for (int i = 0; i < 300000; ++i) {
    const std::string text = random_decimal(random);
    double value = 0;
    const char* const end = text.data() + text.size();
    ASSERT_EQ(parse_decimal(text.data(), end, value), end) << text << " (seed " << kSeed << ")";
    ASSERT_TRUE(same_bits(value, std::strtod(text.c_str(), nullptr))) << text << " (seed " << kSeed << ")";
  }
}

TEST(Number, StopsBeforeWhatIsNoDigit) {
  const auto rest = [](const std::string& text) -> std::string {
    double value = 0;
    const char* const end = parse_decimal(text.data(), text.data() + text.size(), value);
    return end == nullptr ? "none" : std::string(end, text.data() + text.size());
  };
  EXPECT_EQ(rest("1E5"), "E5");
  EXPECT_EQ(rest("1.2.3"), ".3");
  EXPECT_EQ(rest("-.5X"), "X");
  EXPECT_EQ(rest("7. Y"), " Y");
  EXPECT_EQ(rest("1 2"), " 2");
  for (const char* text : {"", "-", "+", ".", "-.", "X1", "--1", " 1", "nan", "inf"})
    EXPECT_EQ(rest(text), "none") << text;
}

TEST(Number, TooLargeIsNoNumberAndTooSmallIsZero) {
  double value = 1;
  const std::string large(400, '9');
  EXPECT_EQ(parse_decimal(large.data(), large.data() + large.size(), value), nullptr);
  const std::string small = "." + std::string(400, '0') + "1";
  EXPECT_NE(parse_decimal(small.data(), small.data() + small.size(), value), nullptr);
  EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace kinebus::gcode
