// Frames of absolute scales: what is read, what is not believed, and when nothing is known.

#include "node_firmware/board/absolute_scale.hpp"

#include <gtest/gtest.h>

#include <random>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

std::uint32_t frame_of(std::uint32_t position, const AbsoluteScale::Settings& settings) {
  const std::uint32_t mask = (1u << settings.bits) - 1, value = position & mask;
  const std::uint32_t coded = settings.gray ? value ^ value >> 1 : value;
  return 1u << 31 | coded << (31 - settings.bits);
}

TEST(AbsoluteScale, CountsInBothCodesWithAnyNumberOfBitsAndAcrossItsEnd) {
  constexpr unsigned kSeed = 9;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (unsigned bits = 8; bits <= 30; ++bits)
    for (const bool gray : {false, true}) {
      SCOPED_TRACE(bits);
      const AbsoluteScale::Settings settings{.bits = bits, .gray = gray};
      AbsoluteScale scale(settings);
      std::int64_t true_counts = 0;
      const auto start = static_cast<std::uint32_t>(random());
      const int most = (1 << (bits - 1)) - 1;
      std::uniform_int_distribution<int> step(-most, most);
      for (int i = 0; i < 200; ++i) {
        scale.take(i * 1ms, frame_of(start + static_cast<std::uint32_t>(true_counts), settings));
        ASSERT_EQ(scale.counts(), static_cast<std::int32_t>(true_counts));
        true_counts += step(random);
      }
    }
}

TEST(AbsoluteScale, ACableThatIsOffOrAShortIsNoReading) {
  const AbsoluteScale::Settings settings{.bits = 24, .counts_per_m = 1'000'000};
  AbsoluteScale scale(settings);
  EXPECT_TRUE(scale.silent(0ms));
  scale.take(0ms, 0xFFFF'FFFF);
  scale.take(1ms, 0);
  EXPECT_TRUE(scale.silent(1ms));
  scale.take(2ms, frame_of(77, settings));
  EXPECT_FALSE(scale.silent(52ms));
  for (LocalTime at = 3ms; at < 60ms; at += 1ms) scale.take(at, 0xFFFF'FFFF);
  EXPECT_TRUE(scale.silent(60ms));
  EXPECT_EQ(scale.counts(), 0);
}

TEST(AbsoluteScale, ABitThatIsTurnedOverIsNotBelievedAndNothingIsLostByIt) {
  const AbsoluteScale::Settings settings{.bits = 26, .counts_per_m = 1'000'000};
  for (unsigned bit = 12; bit < 26; ++bit) {
    AbsoluteScale scale(settings);
    std::uint32_t at = 5'000'000;
    for (int i = 0; i < 20; ++i, at += 450) {  // 450 mm/s
      const std::uint32_t turned = i == 10 ? 1u << bit : 0;
      scale.take(i * 1ms, frame_of(at ^ turned, settings));
      ASSERT_EQ(scale.counts(), 450 * (turned == 0 ? i : i - 1)) << bit;
    }
  }
}

TEST(AbsoluteScale, WhereItHasGoneUnreadIsBelievedWhenItSaysSoTwice) {
  const AbsoluteScale::Settings settings{.bits = 26, .counts_per_m = 1'000'000};
  AbsoluteScale scale(settings);
  scale.take(0ms, frame_of(1000, settings));
  scale.take(1ms, frame_of(301'000, settings));
  EXPECT_EQ(scale.counts(), 0);
  scale.take(2ms, frame_of(301'100, settings));
  EXPECT_EQ(scale.counts(), 300'100);
}

}  // namespace
}  // namespace kinebus
