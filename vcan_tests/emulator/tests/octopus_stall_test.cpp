// Homing at a mechanical stop by the driver's load, on the Octopus' real image: the motor model is the judge.
// It is told another motor than the settings were made for, and load that is never quiet.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "vcan_tests/emulator/tests/octopus_bench.hpp"

namespace kinebus::emulator {
namespace {

constexpr double kStop = -30'000;  // from where the carriage stood at power-up
constexpr int kFast = 60'000, kAcceleration = 600'000, kBackOff = 8'000, kTravel = 90'000;
constexpr int kFullStep = 256, kTurn = 1024;

constexpr Tmc2209Parameters k2209Motor{
    .clock_hz = 12.4e6, .torque_nm_per_a = 0.27, .free_load = 371, .full_load = 34, .load_noise = 28};
constexpr SpiDriverParameters k5160Motor{
    .clock_hz = 12.4e6, .torque_nm_per_a = 0.27, .free_load = 221, .full_load = 9, .load_noise = 17};
constexpr SpiDriverParameters k2130Motor{.kind = SpiDriverKind::kTmc2130,
                                         .sense_ohm = 0.11,
                                         .bond_ohm = 0.02,
                                         .clock_hz = 12.7e6,
                                         .torque_nm_per_a = 0.27,
                                         .free_load = 187,
                                         .full_load = 14,
                                         .load_noise = 13};

std::unique_ptr<Chip> with_2209(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<OctopusBoard>(image, options);
  board->tmc(0) = Tmc2209(k2209Motor);
  return board;
}
std::unique_ptr<Chip> with_5160(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<OctopusBoard>(image, options);
  board->plug(0, k5160Motor);
  return board;
}
std::unique_ptr<Chip> with_2130(const ElfImage& image, const BoardOptions& options) {
  auto board = std::make_unique<OctopusBoard>(image, options);
  board->plug(0, k2130Motor);
  return board;
}

struct Socket {
  const char* chip;
  BoardMaker make;
  int threshold;
};

struct OctopusStall : testing::TestWithParam<Socket> {
  OctopusStall() : octopus({}, GetParam().make) {
    octopus.board.rotor(0).set_load(0.02);
    octopus.board.rotor(0).set_end_stop(kStop, false);
    octopus.bench.write(id_of(0), 0x2130, 1, 1, static_cast<int>(SwitchFunction::kHomeA));
    octopus.bench.write(id_of(0), 0x2132, 1, 2, 160);
    octopus.write(0, 0x6098, 0, 1, -4);
    octopus.write(0, 0x6099, 1, 4, kFast);
    octopus.write(0, 0x609A, 0, 4, kAcceleration);
    octopus.write(0, 0x2140, 9, 4, kTravel);
    octopus.write(0, 0x2140, 10, 4, kBackOff);
    octopus.write(0, 0x607F, 0, 4, 400'000);
    octopus.write(0, 0x2170, 3, 1, GetParam().threshold);
    octopus.write(0, 0x2170, 4, 4, 30'000);
  }
  /// The statusword at its end.
  std::uint16_t home() {
    octopus.enable(0, 6);
    octopus.write(0, 0x6040, 0, 2, 0x0F);
    octopus.write(0, 0x6040, 0, 2, 0x1F);
    std::uint16_t word = 0;
    for (int i = 0; i < 600; ++i) {
      octopus.bench.run(10ms);
      word = octopus.statusword(0);
      if ((word & (cia402::status::kHomingAttained | cia402::status::kHomingError)) != 0) break;
    }
    octopus.write(0, 0x6040, 0, 2, 0x0F);
    return word;
  }
  void move_to(int counts) {
    octopus.enable(0, 1);
    octopus.move(0, counts, 50'000, 400'000);
    for (int i = 0; i < 600 && !octopus.bench.reached(kId, 0); ++i) octopus.bench.run(10ms);
    octopus.bench.run(50ms);
  }
  /// Where zero lies, from the stop on: measured at the rotor, off the stop.
  double zero_off_stop() {
    return octopus.board.true_counts(0) - static_cast<double>(octopus.read(0, 0x6064)) - kStop;
  }
  bool attained(std::uint16_t word) { return (word & cia402::status::kHomingAttained) != 0; }
  bool refused(std::uint16_t word) { return (word & cia402::status::kHomingError) != 0 && !attained(word); }
  void expect_stands() {
    octopus.bench.run(500ms);  // brakes
    octopus.board.clear_edges();
    octopus.bench.run(100ms);
    EXPECT_TRUE(octopus.board.driver(0).edges().empty());
    EXPECT_TRUE(octopus.board.driver(0).enabled());
  }
  OneOctopus octopus;
};

TEST_P(OctopusStall, FindsItsStopAtTheSamePlaceFromWhereverItBegins) {
  octopus.board.wire_diag(0);
  std::vector<double> zeros;
  // Free, on the stop itself as a homing has just left it (-1), and anywhere.
  for (const int from : {0, -1, 23'456, 9'001, 17'777, 31'234}) {
    if (from > 0) move_to(from);
    if (from < 0) {
      ASSERT_TRUE(attained(home()));
    }
    const std::uint16_t word = home();
    ASSERT_TRUE(attained(word)) << std::hex << word << " from " << std::dec << from << " at "
                                << octopus.board.true_counts(0) << ", " << octopus.read(0, 0x6064);
    EXPECT_NEAR(octopus.board.true_counts(0), kStop, 1) << "it stands at the stop";
    const double pressed = static_cast<double>(octopus.read(0, 0x6064));
    move_to(5'000);
    zeros.push_back(zero_off_stop());
    fmt::print("from {}: zero {:.0f} counts off the stop, the field went on by {:.0f}\n", from, zeros.back(),
               -pressed);
  }
  const auto [least, most] = std::ranges::minmax(zeros);
  fmt::print("repeats within {:.0f} counts, {:.2f} full steps\n", most - least, (most - least) / kFullStep);
  EXPECT_LE(most - least, kFullStep);
  EXPECT_LT(std::max(std::abs(least), std::abs(most)), kTurn / 2) << "no electrical turn is lost";
}

TEST_P(OctopusStall, AThresholdThatNeverSaysStopIsAnErrorAndNoPosition) {
  octopus.board.wire_diag(0);
  octopus.write(0, 0x2170, 3, 1, 0x01);
  const std::uint16_t word = home();
  EXPECT_TRUE(refused(word));
  EXPECT_EQ(word & cia402::status::kHomingWaits, 0);
  expect_stands();
}

TEST_P(OctopusStall, AThresholdThatSaysStopAtOnceIsAnErrorAndNoPosition) {
  octopus.board.wire_diag(0);
  octopus.write(0, 0x2170, 3, 1, 255);
  const std::uint16_t word = home();
  EXPECT_TRUE(refused(word));
  EXPECT_NE(word & cia402::status::kHomingWaits, 0);
  EXPECT_GT(octopus.board.true_counts(0), kStop + 1000) << "it was nowhere near the stop";
  expect_stands();
}

// A rail that is tight at one moment is no stop: what was met once is not met there again.
TEST_P(OctopusStall, ALoadThatComesOnceIsNoStop) {
  octopus.board.wire_diag(0);
  octopus.enable(0, 6);
  octopus.write(0, 0x6040, 0, 2, 0x1F);
  for (int i = 0; i < 200 && octopus.board.true_counts(0) > kStop / 2; ++i) octopus.bench.run(2ms);
  octopus.board.rotor(0).set_load(0.37);
  octopus.bench.run(12ms);
  octopus.board.rotor(0).set_load(0.02);
  std::uint16_t word = 0;
  for (int i = 0; i < 300; ++i) {
    octopus.bench.run(10ms);
    word = octopus.statusword(0);
    if ((word & (cia402::status::kHomingAttained | cia402::status::kHomingError)) != 0) break;
  }
  EXPECT_TRUE(refused(word)) << std::hex << word;
  EXPECT_NE(word & cia402::status::kHomingWaits, 0);
  EXPECT_GT(octopus.board.true_counts(0), kStop + 1000);
  expect_stands();
}

// The stop's socket is open then, and reads as if it told a stop all the time.
TEST_P(OctopusStall, WithoutTheJumperForDiagNothingMoves) {
  const std::uint16_t word = home();
  EXPECT_TRUE(refused(word));
  EXPECT_NE(word & cia402::status::kHomingWaits, 0);
  EXPECT_EQ(octopus.board.driver(0).steps(), 0);
}

TEST_P(OctopusStall, ADriverThatStandsAloneOrIsToldNoThresholdTellsNoLoadAndNothingMoves) {
  octopus.board.wire_diag(0);
  octopus.write(0, 0x2170, 3, 1, 0);
  EXPECT_TRUE(refused(home()));
  octopus.write(0, 0x2170, 3, 1, GetParam().threshold);
  octopus.write(0, 0x2170, 1, 1, 0);
  octopus.bench.run(50ms);
  EXPECT_TRUE(refused(home()));
  EXPECT_EQ(octopus.board.driver(0).steps(), 0);
}

INSTANTIATE_TEST_SUITE_P(Each, OctopusStall,
                         testing::Values(Socket{"tmc2209", &with_2209, 75},
                                         Socket{"tmc5160", &with_5160, 150},
                                         Socket{"tmc2130", &with_2130, 146}),
                         [](const auto& socket) { return socket.param.chip; });

}  // namespace
}  // namespace kinebus::emulator
