// The image counts quadrature scales with its timers, and leads a motor by one.

#include <gtest/gtest.h>

#include <cmath>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/tests/one_board.hpp"

namespace kinebus::emulator {
namespace {

constexpr double kCountsPerMm = 1280;  // 40 mm a turn
constexpr std::uint16_t kScale = 0x2160, kInputFunction = 0x2130;

/// Carriages with scales of 0.01 mm; A's belt is 0.5 % too long. `broken`: A's cable is off from there on.
BoardOptions with_scales(const bool* broken = nullptr) {
  BoardOptions options;
  options.axes[0] = {.switch_input = 1, .switch_counts = -2 * kCountsPerMm, .active_above = false};
  options.axes[0].scale = [broken, last = 0](double counts) mutable {
    if (broken == nullptr || !*broken)
      last = static_cast<int>(std::floor(counts / kCountsPerMm * 100 * 1.005));
    return last;
  };
  options.axes[1].scale = [](double counts) {
    return static_cast<int>(std::floor(-counts / kCountsPerMm * 100));
  };
  return options;
}

std::int64_t scale_counts(OneBoard& node, int axis) {
  return node.bench.read(OneBoard::kId, static_cast<std::uint16_t>(kScale + 0x800 * axis), 4);
}

TEST(Scale, BothAreCountedOnceTheyAreFittedInTheirDirection) {
  OneBoard node(with_scales());
  node.configure(2000, 0);
  node.enable(1);
  for (int axis = 0; axis < 2; ++axis) node.write(axis, kScale, 1, 1, 1);
  node.write(1, kScale, 3, 1, 1);
  node.bench.run(10ms);
  const std::int64_t a = scale_counts(node, 0), b = scale_counts(node, 1);
  for (int axis = 0; axis < 2; ++axis)
    node.bench.move(OneBoard::kId, axis, std::lround(400 * kCountsPerMm), 400'000, 4'000'000);
  node.bench.run(2s);
  // 400 mm are more than 16 bits of counts.
  EXPECT_NEAR(static_cast<double>(scale_counts(node, 0) - a), 40'200, 3);
  EXPECT_NEAR(static_cast<double>(scale_counts(node, 1) - b), 40'000, 3) << "2960h:3 turns it round";
  EXPECT_TRUE(node.board.strange_accesses().empty());
  EXPECT_TRUE(node.board.lost_accesses().empty());
}

/// The same scales, read by SSI on the encoder ports: A's 24 bits in Gray code, B's 12 in binary, which begin
/// anew every 41 mm.
BoardOptions with_absolute_scales(const bool* broken = nullptr) {
  BoardOptions options = with_scales();
  for (std::size_t axis = 0; axis < 2; ++axis)
    options.absolute_scales[axis] = {.bits = axis == 0 ? 24u : 12u, .gray = axis == 0};
  if (broken != nullptr) options.absolute_scales[0].unplugged = [broken] { return *broken; };
  return options;
}
void fit_absolute(OneBoard& node, int axis) {
  node.write(axis, kScale, 2, 4, 100'000);
  node.write(axis, kScale, 1, 1, axis == 0 ? 32 + 24 : 12);
}

TEST(Scale, AbsoluteOnesAreReadOnTheEncoderPortsInBothCodesAndAcrossTheirEnds) {
  OneBoard node(with_absolute_scales());
  node.configure(2000, 0);
  node.enable(1);
  for (int axis = 0; axis < 2; ++axis) fit_absolute(node, axis);
  node.write(1, kScale, 3, 1, 1);
  node.bench.run(20ms);
  const std::int64_t a = scale_counts(node, 0), b = scale_counts(node, 1);
  for (int axis = 0; axis < 2; ++axis)
    node.bench.move(OneBoard::kId, axis, std::lround(400 * kCountsPerMm), 400'000, 4'000'000);
  node.bench.run(2s);
  EXPECT_NEAR(static_cast<double>(scale_counts(node, 0) - a), 40'200, 3);
  EXPECT_NEAR(static_cast<double>(scale_counts(node, 1) - b), 40'000, 3);
  // The port is the encoder's again: one that is not there is told.
  node.write(1, kScale, 1, 1, 0);
  node.bench.run(20ms);
  EXPECT_TRUE(node.bench.emergencies(OneBoard::kId).empty());
  EXPECT_TRUE(node.board.strange_accesses().empty());
  EXPECT_TRUE(node.board.lost_accesses().empty());
}

TEST(Scale, AnAbsoluteOneAndAnEncoderExcludeEachOtherOnBothPorts) {
  OneBoard node(with_absolute_scales());
  for (int axis = 0; axis < 2; ++axis) {
    node.write(axis, 0x2150, 6, 1, 1);
    EXPECT_EQ(
        node.bench.try_write(OneBoard::kId, static_cast<std::uint16_t>(kScale + 0x800 * axis), 1, 1, 24),
        static_cast<std::uint32_t>(AbortCode::kDeviceState));
  }
}

TEST(Scale, HasThePinsOfEncoderASoThatOneOfBothIsRefused) {
  OneBoard node(with_scales());
  node.write(0, 0x2150, 6, 1, 1);
  EXPECT_EQ(node.bench.try_write(OneBoard::kId, kScale, 1, 1, 1),
            static_cast<std::uint32_t>(AbortCode::kDeviceState));
  node.write(0, 0x2150, 6, 1, 0);
  node.write(0, kScale, 1, 1, 1);
  node.write(0, kScale, 1, 1, 0);
  node.bench.run(10ms);
  node.write(0, 0x2150, 6, 1, 1);  // the pins are the encoder's again
  node.bench.run(100ms);
  EXPECT_TRUE(node.bench.emergencies(OneBoard::kId).empty());
}

/// Homed, the loop closed: 0.5 mm at most, 1 mm/s.
void close_loop(OneBoard& node, bool absolute = false) {
  node.configure(2000, 0);
  node.write(0, kInputFunction, 1, 1, 1);
  node.write(0, kScale, 6, 4, std::lround(kCountsPerMm * 65536 / 100));
  node.write(0, kScale, 8, 4, std::lround(kCountsPerMm));
  node.write(0, kScale, 7, 4, std::lround(kCountsPerMm / 2));
  if (absolute)
    fit_absolute(node, 0);
  else
    node.write(0, kScale, 1, 1, 1);
  node.write(0, 0x6098, 0, 1, 22);
  node.write(0, 0x607C, 0, 4, 0);
  node.enable(6);
  node.bench.write(OneBoard::kId, 0x6040, 0, 2, 0x1F);
  node.bench.run(6s);
  ASSERT_EQ(node.bench.read(OneBoard::kId, 0x6041, 0) & 0x3400, 0x1400) << "homed";
  node.bench.write(OneBoard::kId, 0x6040, 0, 2, 0x0F);
  node.bench.write(OneBoard::kId, 0x6060, 0, 1, 1);
  node.bench.run(20ms);
}

class LedScale : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Scale, LedScale, testing::Bool(),
                         [](const auto& kind) { return kind.param ? "Absolute" : "Quadrature"; });

TEST_P(LedScale, LeadsTheRotorToWhereTheCarriageIsToBe) {
  OneBoard node(GetParam() ? with_absolute_scales() : with_scales());
  close_loop(node, GetParam());
  const double home = node.board.true_counts(0);
  node.bench.move(OneBoard::kId, 0, std::lround(40 * kCountsPerMm), 40'000, 400'000);
  node.bench.run(6s);
  const std::int64_t moved = scale_counts(node, 0) - node.bench.read(OneBoard::kId, kScale, 5);
  EXPECT_NEAR(static_cast<double>(moved), 4000, 2) << "hundredths of a millimetre from the edge";
  EXPECT_LT(node.board.true_counts(0) - home, 40 * kCountsPerMm) << "the rotor has gone less than commanded";
  EXPECT_TRUE(node.bench.emergencies(OneBoard::kId).empty());
}

TEST_P(LedScale, WhoseCableComesOffStopsTheMotionAndTheMotorHolds) {
  bool broken = false;
  OneBoard node(GetParam() ? with_absolute_scales(&broken) : with_scales(&broken));
  close_loop(node, GetParam());
  node.bench.move(OneBoard::kId, 0, std::lround(100 * kCountsPerMm), 20'000, 400'000);
  node.bench.run(500ms);
  broken = true;
  const double there = node.board.true_counts(0);
  node.bench.run(4s);
  EXPECT_TRUE(node.told(emcy::kIncrementalEncoder));
  EXPECT_LT(node.board.true_counts(0) - there, 4 * kCountsPerMm);
  EXPECT_EQ(node.bench.read(OneBoard::kId, 0x6041, 0) & 0x6F, 0x27) << "it holds";
  // What does not answer is not told as it was; a counter cannot know.
  if (GetParam()) {
    const CanFrame answer = node.bench.upload(OneBoard::kId, kScale, 4);
    EXPECT_EQ(answer.data[0], 0x80);
    EXPECT_EQ(get_u32_le(std::span(answer.data).subspan(4)), static_cast<std::uint32_t>(AbortCode::kNoData));
  }
}

}  // namespace
}  // namespace kinebus::emulator
