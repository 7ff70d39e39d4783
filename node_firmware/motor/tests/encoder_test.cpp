#include "node_firmware/motor/encoder.hpp"

#include <gtest/gtest.h>

namespace kinebus::motor {
namespace {

std::uint16_t frame(int raw) {
  auto word = static_cast<std::uint16_t>(raw & 0x3FFF);
  if ((std::popcount(word) & 1) != 0) word |= 0x8000;
  return word;
}
constexpr std::int64_t kTurnOfCounts = 51'200 * (std::int64_t{1} << 32);

TEST(Encoder, CountsTurnsBothWays) {
  Encoder encoder;
  for (int raw = 16'000; raw < 16'000 + 3 * 16'384; raw += 20) ASSERT_TRUE(encoder.on_frame(frame(raw)));
  EXPECT_NEAR(static_cast<double>(encoder.position()) / static_cast<double>(kTurnOfCounts), 3, 0.01);
  for (int raw = 16'000 + 3 * 16'384; raw > 0; raw -= 20) ASSERT_TRUE(encoder.on_frame(frame(raw)));
  EXPECT_NEAR(static_cast<double>(encoder.position()) / static_cast<double>(kTurnOfCounts),
              -16'000.0 / 16'384, 0.01);
}

TEST(Encoder, WrongParityErrorFlagAndJumpsAreNoPosition) {
  Encoder encoder;
  ASSERT_TRUE(encoder.on_frame(frame(100)));
  EXPECT_FALSE(encoder.on_frame(frame(101) ^ 0x8000));
  EXPECT_FALSE(encoder.on_frame(0xFFFF));
  EXPECT_FALSE(encoder.on_frame(frame(8000)));
  EXPECT_EQ(encoder.position(), 0);
  EXPECT_EQ(encoder.errors(), 3u);
  EXPECT_TRUE(encoder.on_frame(frame(110)));
  EXPECT_EQ(encoder.position(), 10 * kCountsPerEncoderStep);
  EXPECT_FALSE(encoder.lost());
}

TEST(Encoder, UnpluggedIsLostAfterAMillisecond) {
  Encoder encoder;
  ASSERT_TRUE(encoder.on_frame(frame(100)));
  for (int i = 0; i < Encoder::kMostBad; ++i) {
    EXPECT_FALSE(encoder.lost());
    encoder.on_frame(0xFFFF);
  }
  EXPECT_TRUE(encoder.lost());
  EXPECT_FALSE(encoder.known());
}

}  // namespace
}  // namespace kinebus::motor
