// Energy over frequency as a heat node finds it in whole numbers, against the same in doubles and against
// what really swings.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "node_firmware/heat/tests/heat_node_bench.hpp"
#include "node_firmware/heat/vibration_meter.hpp"
#include "node_firmware/port/host/accelerometer_plant.hpp"

namespace kinebus::heat {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Gain of the triangle of 15 readings.
double decimation_gain(double hz, double rate) {
  const double x = std::numbers::pi * hz / rate;
  return x == 0 ? 1 : std::pow(std::sin(8 * x) / (8 * std::sin(x)), 2);
}

struct MeterBench {
  VibrationMeter meter{38'246, AccelerometerPlant::kRange};
  AccelerometerPlant chip;
  LocalTime now{0};
  explicit MeterBench(std::uint32_t seed = 1) : chip(seed) {}
  void run(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += 0.005) {
      now += 5ms;
      chip.step(0.005);
      meter.on_readings(now, chip.take());
    }
  }
  double energy(int axis, int band) const {
    return std::ldexp(static_cast<double>(meter.energy(axis, band)), meter.exponent(axis));
  }
  double around(int axis, double hz) const {
    const double width = chip.rate() / VibrationMeter::kDecimation / VibrationMeter::kPoints;
    const auto middle = static_cast<int>(std::lround(hz / width));
    double sum = 0;
    for (int band = middle - 3; band <= middle + 3; ++band) sum += energy(axis, band);
    return sum;
  }
};

TEST(FixedFft, IsTheTransformWithinItsLastBits) {
  std::mt19937 random(7);
  std::uniform_int_distribution<std::int32_t> any(-100'000, 100'000);
  FixedFft fft;
  std::vector<std::complex<double>> in;
  for (int i = 0; i < FixedFft::kPoints; ++i) {
    fft.input(i) = {any(random), any(random)};
    in.emplace_back(fft.input(i).re, fft.input(i).im);
  }
  fft.begin();
  int calls = 1;
  while (!fft.step(100)) ++calls;
  EXPECT_EQ(calls, (FixedFft::kButterflies + 99) / 100) << "in small pieces";
  for (const int bin : {0, 1, 100, 511, 512, 777, 1023}) {
    std::complex<double> sum;
    for (int i = 0; i < FixedFft::kPoints; ++i)
      sum += in[static_cast<std::size_t>(i)] * std::polar(1.0, -kTurn * bin * i / FixedFft::kPoints);
    EXPECT_NEAR(fft.output(bin).re, sum.real(), 400) << bin;
    EXPECT_NEAR(fft.output(bin).im, sum.imag(), 400) << bin;
  }
}

TEST(Vibration, EnergyOfASineIsThatOfItsAmplitudeAtEveryFrequency) {
  for (const double hz : {15.0, 40.0, 83.7, 118.0}) {
    MeterBench bench;
    constexpr double kAmplitude = 500;  // mm/s^2
    bench.chip.feels = [hz](double t) {
      return AccelerometerPlant::Vector{kAmplitude * std::sin(kTurn * hz * t), 0,
                                        2 * kAmplitude * std::cos(kTurn * hz * t)};
    };
    bench.run(0.2);
    bench.meter.begin(bench.now);
    bench.run(20);
    ASSERT_GT(bench.meter.windows(), 20);
    const double counts = kAmplitude / AccelerometerPlant::kCount * decimation_gain(hz, bench.chip.rate());
    // Hann's squares spread the middle one's energy over three: 1 + 2 / 4.
    const double expected = 1.5 * std::ldexp(1.0, 24) * counts * counts * bench.meter.windows();
    EXPECT_NEAR(bench.around(0, hz) / expected, 1, 0.02) << hz;
    EXPECT_NEAR(bench.around(2, hz) / (4 * expected), 1, 0.02) << hz;
    EXPECT_LT(bench.around(1, hz) / expected, 0.02) << "the other direction feels noise alone, " << hz;
  }
}

TEST(Vibration, OfASweepEveryBandGetsTheSameWhereverTheWindowsLie) {
  for (const int begins_ms : {0, 170, 430}) {
    MeterBench bench;
    // 20 to 100 Hz, 2 Hz a second.
    bench.chip.feels = [](double t) {
      const double phase = kTurn * (20 * t + t * t);
      return AccelerometerPlant::Vector{0, t < 45 ? 800 * std::sin(phase) : 0, 0};
    };
    bench.run(0.001 * begins_ms + 0.2);
    bench.meter.begin(bench.now);
    bench.run(42);
    const double width = bench.chip.rate() / VibrationMeter::kDecimation / VibrationMeter::kPoints;
    std::vector<double> level;
    for (double hz = 35; hz < 85; hz += 2) {
      double sum = 0;
      for (int k = 0; k < 5; ++k) sum += bench.energy(1, static_cast<int>(hz / width) + k);
      level.push_back(sum / std::pow(decimation_gain(hz + 2.5 * width, bench.chip.rate()), 2));
    }
    const auto [low, high] = std::minmax_element(level.begin(), level.end());
    EXPECT_LT(*high / *low, 1.06) << begins_ms << " ms";
  }
}

TEST(Vibration, KnowsItsRateByTheNodesClockAndTellsWhatClips) {
  MeterBench bench;
  bench.chip.feels = [](double t) {
    return AccelerometerPlant::Vector{t > 5 && t < 5.01 ? 170'000.0 : 0, 0, 0};
  };
  bench.run(0.1);
  bench.meter.begin(bench.now);
  bench.run(0.5);
  EXPECT_EQ(bench.meter.rate_mhz(), 0u) << "too soon";
  bench.run(19.5);
  EXPECT_NEAR(bench.meter.rate_mhz() / 1000.0, bench.chip.rate(), 2);
  EXPECT_NEAR(bench.meter.clipped(), 32, 2);
}

TEST(Vibration, AChipThatFallsSilentIsToldAndOneThatIsBackCanMeasure) {
  MeterBench bench;
  bench.run(0.1);
  bench.meter.begin(bench.now);
  bench.run(3);
  EXPECT_EQ(bench.meter.state(), VibrationState::kMeasures);
  bench.chip.silent = true;
  bench.run(0.45);
  EXPECT_EQ(bench.meter.state(), VibrationState::kMeasures);
  bench.run(0.1);
  EXPECT_EQ(bench.meter.state(), VibrationState::kSilent);
  EXPECT_EQ(bench.meter.write(heat_object::kVibrationCommand, 1), AbortCode::kHardware);
  bench.chip.silent = false;
  bench.run(0.02);
  EXPECT_EQ(bench.meter.state(), VibrationState::kReady);
  EXPECT_EQ(bench.meter.write(heat_object::kVibrationCommand, 1), AbortCode::kNone);
}

TEST(Vibration, IsReadByAnyMasterAndMissedWhereThereIsNone) {
  HeatNodeBench bench;
  EXPECT_EQ(bench.read({0x2270, 0}), 1u);
  ASSERT_EQ(bench.plant.command("shake 50 2000"), "");
  ASSERT_EQ(bench.write({0x2271, 0}, 1, 1), 0u);
  EXPECT_EQ(bench.read({0x2270, 0}), 2u);
  bench.run(10);
  EXPECT_GE(bench.read({0x2273, 0}).value_or(0), 10u);
  const double width = bench.read({0x2272, 0}).value_or(0) / 1000.0 / 8192;
  const auto peak = static_cast<std::uint32_t>(std::lround(50 / width));
  std::uint32_t highest = 0, at = 0;
  for (std::uint32_t band = 10; band < kVibrationBands; ++band) {
    ASSERT_EQ(bench.write({0x2276, 0}, band, 2), 0u);
    const std::uint32_t energy = bench.read({0x2277, 1}).value_or(0);
    if (energy > highest) highest = energy, at = band;
  }
  EXPECT_EQ(at, peak);
  EXPECT_EQ(bench.write({0x2276, 0}, kVibrationBands, 2), 0x0609'0031u);
  EXPECT_EQ(bench.write({0x2271, 0}, 2, 1), 0u);
  EXPECT_EQ(bench.read({0x2270, 0}), 1u);
  ASSERT_EQ(bench.plant.command("accelerometer silent"), "");
  bench.run(1);
  EXPECT_EQ(bench.read({0x2270, 0}), 3u);
  EXPECT_EQ(bench.write({0x2271, 0}, 1, 1), 0x0606'0000u);

  HeatNode bare({.node_id = 5}, LocalTime{0});
  bare.on_frame(LocalTime{1s}, CanFrame{.id = 0x605, .length = 8, .data = {0x40, 0x70, 0x22}});
  int answers = 0;
  while (const auto frame = bare.next_frame()) {
    if (frame->id != 0x585) continue;
    ++answers;
    EXPECT_EQ(frame->data[4], 0) << "none is fitted";
  }
  EXPECT_EQ(answers, 1);
}

}  // namespace
}  // namespace kinebus::heat
