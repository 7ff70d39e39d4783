// The current loop of the image, measured on the emulated winding: what it makes of a step, and how smooth
// the current is.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "vcan_tests/emulator/tests/one_board.hpp"

namespace kinebus::emulator {
namespace {

constexpr double kSampleS = 5e-6;

/// Current of a motor along a direction of its phases, sampled.
std::vector<double> record(OneBoard& node, int axis, BusTime span) {
  std::vector<double> samples;
  for (BusTime t{0}; t < span; t += 5us) {
    node.bench.run(5us);
    // The rotor stands at 0: that is along phase A.
    samples.push_back(node.board.motor(axis).current_a(0));
  }
  return samples;
}

double mean(std::span<const double> samples) {
  double sum = 0;
  for (const double s : samples) sum += s;
  return sum / static_cast<double>(samples.size());
}

struct StepResponse {
  double rise_s = 0, overshoot = 0, settling_s = 0, bandwidth_hz = 0;
};

/// Of a record that rests, steps and rests again.
StepResponse evaluate(const std::vector<double>& samples) {
  constexpr std::size_t kRest = 200;  // 1 ms
  const double low = mean(std::span(samples).first(kRest)), high = mean(std::span(samples).last(kRest));
  std::vector<double> unit;
  for (const double s : samples) unit.push_back((s - low) / (high - low));
  const auto first_above = [&](double level) {
    return static_cast<double>(std::ranges::find_if(unit, [&](double u) { return u > level; }) -
                               unit.begin());
  };
  StepResponse r;
  r.rise_s = (first_above(0.9) - first_above(0.1)) * kSampleS;
  r.overshoot = *std::ranges::max_element(unit) - 1;
  const auto last_out =
      std::find_if(unit.rbegin(), unit.rend(), [](double u) { return std::abs(u - 1) > 0.05; });
  r.settling_s = (static_cast<double>(unit.rend() - last_out) - first_above(0.02)) * kSampleS;
  // The step's derivative is the impulse response; its transform is the frequency response.
  for (double f = 50; f < 10'000 && r.bandwidth_hz == 0; f += 10) {
    std::complex<double> sum = 0;
    for (std::size_t i = 1; i < unit.size(); ++i)
      sum += (unit[i] - unit[i - 1]) *
             std::polar(1.0, -2 * std::numbers::pi * f * kSampleS * static_cast<double>(i));
    if (std::abs(sum) < std::numbers::sqrt2 / 2) r.bandwidth_hz = f;
  }
  return r;
}

TEST(Current, FollowsAStepWithABandwidthOfAKilohertz) {
  OneBoard node;
  node.configure(1500, 0);
  node.enable(1);
  node.bench.run(200ms);
  // The measurement of the winding begins with two currents under control: 0.6 A, and 250 ms later 1.5 A at
  // once.
  node.write(0, 0x2150, 8, 1, 1);
  node.bench.run(240ms);
  std::vector<double> samples;
  for (int i = 0; i < 10 && (samples.empty() || samples.back() < 1.2); ++i) {
    if (samples.size() > 400) samples.erase(samples.begin(), samples.end() - 400);
    const auto more = record(node, 0, 2ms);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  const auto more = record(node, 0, 8ms);
  samples.insert(samples.end(), more.begin(), more.end());
  const StepResponse r = evaluate(samples);
  fmt::print(
      "current step 0.6 to 1.5 A: rises (10 to 90 %) in {:.0f} us, overshoot {:.1f} %, within 5 % after "
      "{:.0f} us; bandwidth {:.0f} Hz\n",
      r.rise_s * 1e6, r.overshoot * 100, r.settling_s * 1e6, r.bandwidth_hz);
  EXPECT_GE(r.bandwidth_hz, 1000);
  EXPECT_LT(r.overshoot, 0.25);
  EXPECT_LT(r.settling_s, 1e-3);
}

TEST(Current, RipplesLittleAtRest) {
  OneBoard node;
  node.configure(2500, 0);
  node.enable(1);
  node.bench.run(400ms);
  const auto samples = record(node, 0, 10ms);
  const double middle = mean(samples);
  double square = 0;
  for (const double s : samples) square += (s - middle) * (s - middle);
  const auto [least, most] = std::ranges::minmax(samples);
  const double rms = std::sqrt(square / static_cast<double>(samples.size()));
  fmt::print("current at rest: {:.4f} A of 2.5 A, ripple {:.1f} mA rms, {:.1f} mA from peak to peak\n",
             middle, rms * 1e3, (most - least) * 1e3);
  EXPECT_NEAR(middle, 2.5, 0.02);
  // The node tells what it measures, not what it is told.
  EXPECT_NEAR(static_cast<double>(node.bench.read(OneBoard::kId, 0x2150, 9)), 2500, 25);
  EXPECT_NEAR(static_cast<double>(node.bench.read(OneBoard::kId, 0x2950, 9)), 2500, 25);
  // A microstep's share of 2.5 A is 15 mA.
  EXPECT_LT(rms, 0.015);
}

}  // namespace
}  // namespace kinebus::emulator
