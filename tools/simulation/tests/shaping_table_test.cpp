// Shapers x frequency error x rate of path time, on a frame that is not the one they were made for: what is
// left of a corner's vibration, to the unshaped plan at full rate.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "gateway/motion/tests/test_machine.hpp"
#include "gateway/shaping/path_shaper.hpp"
#include "tools/simulation/checkers/vibration_checker.hpp"

namespace kinebus {
namespace {

constexpr double kFrequency_hz = 45, kDamping = 0.1;

/// A square, a zigzag, and back: corners of all kinds, with room to swing between them.
const std::vector<Phase>& corners() {
  static const std::vector<Phase> phases = [] {
    probe::Job job;
    job.feed(100).by({40, 0, 0, 0, 0, 0}).by({0, 40, 0, 0, 0, 0}).by({-40, 0, 0, 0, 0, 0});
    job.by({0, -40, 0, 0, 0, 0}).by({30, 30, 0, 0, 0, 0}).by({30, -30, 0, 0, 0, 0}).by({-60, 0, 8, 0, 0, 0});
    return probe::measure(probe::m1(), MotionLimits{}, job.lines(), 1, true).all;
  }();
  return phases;
}

/// `slowest`: the rate from which on the shaper is made for.
std::vector<Phase> shaped(ShaperKind kind, double slowest = 1) {
  if (kind == ShaperKind::kNone) return corners();
  const InputShaper one =
      make_shaper(kind, frequency_for_rates(kind, kFrequency_hz, kDamping, slowest), kDamping);
  PathShaper shaper({one, one, one});
  std::vector<Phase> out;
  Phase phase;
  for (const Phase& p : corners()) {
    shaper.push(p);
    while (shaper.next(phase)) out.push_back(phase);
  }
  return out;
}

struct Left {
  double rms_um = 0, peak_um = 0;
};

/// `rate`: of path time, by the machine's time.
Left vibration(const std::vector<Phase>& phases, double frequency_error, double damping_error,
               const std::function<double(double)>& rate) {
  const double f = kFrequency_hz * (1 + frequency_error), d = kDamping * (1 + damping_error);
  const FlexibleFrame::Modes modes{{{f, d, 0.9}, {2.7 * f, 0.6 * d, 0.1}}};
  static const MachineDescription machine = default_m1();
  std::vector<double> starts;
  double end_s = 0;
  for (const Phase& p : phases) {
    starts.push_back(end_s);
    end_s += p.duration_s;
  }
  const auto planned = [&](PathTime tau) -> std::optional<PlannedPose> {
    const double t = to_seconds(tau);
    if (t < 0 || t > end_s) return std::nullopt;
    const auto after = std::upper_bound(starts.begin(), starts.end(), t);
    const auto i = static_cast<std::size_t>(after - starts.begin()) - 1;
    return PlannedPose{phases[i].at(std::min(t - starts[i], phases[i].duration_s)).x, Frame::kPart, 1};
  };
  VibrationChecker checker(machine, probe::m1(), {modes, modes, modes}, planned, nullptr, Pose{});
  const Pose end = phases.back().at(phases.back().duration_s).x;
  double rest_s = 0, tau = 0;
  for (int i = 1; i < 60'000 && rest_s < 1; ++i) {
    const double before = tau;
    for (int k = 0; k < 10; ++k) tau += 1e-4 * rate(1e-3 * i + 1e-4 * k);
    Sample sample;
    sample.time = std::chrono::milliseconds{i};
    sample.tau = PathTime{static_cast<std::int64_t>(tau * 16e6)};
    sample.rate = (tau - before) * 1e3;
    sample.planned = planned(sample.tau);
    sample.pose = sample.planned ? sample.planned->pose : end;
    if (!sample.planned) rest_s += 1e-3;
    checker.on_sample(sample);
  }
  return {checker.rms_um(), checker.peak_um()};
}

double full(double) {
  return 1;
}

struct Named {
  const char* name;
  ShaperKind kind;
};
constexpr Named kShapers[] = {{"none", ShaperKind::kNone},      {"ZV", ShaperKind::kZv},
                              {"MZV", ShaperKind::kMzv},        {"ZVD", ShaperKind::kZvd},
                              {"EI", ShaperKind::kEi},          {"2HUMP", ShaperKind::kTwoHump},
                              {"3HUMP", ShaperKind::kThreeHump}};

bool robust(ShaperKind kind) {
  return kind >= ShaperKind::kZvd;
}

TEST(ShapingTable, WhatIsLeftByShaperFrequencyErrorAndRate) {
  constexpr double kErrors[] = {-0.10, 0, 0.10}, kRates[] = {1, 0.9, 0.8, 0.7, 0.6, 0.5};
  std::string table = fmt::format("{:8} {:>6} ", "shaper", "error");
  for (const double rate : kRates) table += fmt::format("   rate {:3.1f}    ", rate);
  for (const Named& named : kShapers) {
    const std::vector<Phase> phases = shaped(named.kind);
    for (const double error : kErrors) {
      // The damping is wrong, too, the one way and the other.
      const double damping_error = error > 0 ? 0.3 : -0.3;
      const Left unshaped = vibration(corners(), error, damping_error, full);
      EXPECT_GT(unshaped.rms_um, 2);
      table += fmt::format("\n{:8} {:+5.0f} % ", named.name, 100 * error);
      for (const double rate : kRates) {
        const Left left = vibration(phases, error, damping_error, [rate](double) { return rate; });
        const double rms = left.rms_um / unshaped.rms_um, peak = left.peak_um / unshaped.peak_um;
        table += fmt::format("  {:.3f} ({:.3f})", rms, peak);
        if (robust(named.kind) && rate == 1) {
          EXPECT_LE(rms, 0.05) << named.name << " " << error;
        }
        if (named.kind == ShaperKind::kThreeHump && rate > 0.65) {
          EXPECT_LE(rms, 0.05) << error << " at rate " << rate;
        }
      }
    }
  }
  fmt::print("vibration left, rms (peak), to unshaped at full rate\n{}\n", table);
}

TEST(ShapingTable, MadeForOverridesItLeavesNoMoreThanAtFullRate) {
  // Sampled each millisecond a plan is not straight within: what swings of that.
  constexpr double kSampling_um = 0.3;
  std::string table =
      "made for overrides from 50 %: vibration left, rms (peak), to unshaped at full rate [to unshaped at "
      "the same]\n";
  for (const Named& named : kShapers) {
    if (!robust(named.kind)) continue;
    const std::vector<Phase> phases = shaped(named.kind, 0.5);
    for (const double error : {-0.10, 0.10}) {
      table += fmt::format("{:8} {:+5.0f} % ", named.name, 100 * error);
      const double full_um = vibration(corners(), error, 3 * error, full).rms_um;
      for (const double rate : {1.0, 0.9, 0.8, 0.7, 0.6, 0.5}) {
        const auto at = [rate](double) { return rate; };
        const double unshaped_um = vibration(corners(), error, 3 * error, at).rms_um;
        const Left left = vibration(phases, error, 3 * error, at);
        table += fmt::format("  {:.3f} ({:.2f} um) [{:.3f}]", left.rms_um / full_um, left.peak_um,
                             left.rms_um / unshaped_um);
        if (named.kind == ShaperKind::kThreeHump) {
          EXPECT_LE(left.rms_um, 0.05 * full_um) << error << " at rate " << rate;
          EXPECT_LE(left.rms_um, std::max(0.05 * unshaped_um, kSampling_um)) << error << " at rate " << rate;
        }
      }
      table += "\n";
    }
  }
  fmt::print("{}", table);
}

TEST(ShapingTable, AHoldLeavesNoMoreThanItsOwnRamp) {
  // To rest in 200 ms and on again, in the midst of corners.
  const auto hold = [](double t) {
    return t < 1 ? 1.0 : t < 1.2 ? 1 - 5 * (t - 1) : t < 1.6 ? 0.0 : t < 1.8 ? 5 * (t - 1.6) : 1.0;
  };
  std::string table = "vibration left around a hold, rms (peak), to unshaped without a hold\n";
  for (const Named& named : kShapers) {
    if (named.kind == ShaperKind::kNone) continue;
    const Left unshaped = vibration(corners(), 0.1, 0.3, full);
    const Left left = vibration(shaped(named.kind), 0.1, 0.3, hold);
    table += fmt::format("{:8} {:.3f} ({:.3f})\n", named.name, left.rms_um / unshaped.rms_um,
                         left.peak_um / unshaped.peak_um);
    if (robust(named.kind)) {
      EXPECT_LE(left.rms_um, 0.05 * unshaped.rms_um) << named.name;
    }
  }
  fmt::print("{}", table);
}

TEST(FlexibleFrame, SwingsAtItsFrequencyAndDiesOutByItsDamping) {
  const FlexibleFrame::Modes modes{{{50, 0.05, 1}, {135, 0.05, 0}}};
  FlexibleFrame frame({modes, modes, modes});
  frame.move_to({0, 0, 0}, 0);
  // One millimetre at once, within a microsecond.
  frame.move_to({1, 0, 0}, 1e-6);
  EXPECT_NEAR(frame.deflection_mm()[0], -1, 1e-4);
  // The first maximum after a whole damped period.
  const double period_s = 1 / (50 * std::sqrt(1 - 0.0025));
  for (int i = 0; i < 100; ++i) frame.move_to({1, 0, 0}, period_s / 100);
  EXPECT_NEAR(frame.deflection_mm()[0], -std::exp(-2 * 3.14159265358979 * 0.05 / std::sqrt(1 - 0.0025)),
              1e-3);
  EXPECT_EQ(frame.deflection_mm()[1], 0);
}

TEST(FlexibleFrame, AConstantAccelerationBendsIt) {
  const FlexibleFrame::Modes modes{{{40, 0.2, 0.9}, {108, 0.1, 0.1}}};
  FlexibleFrame frame({modes, modes, modes});
  for (int i = 0; i <= 2000; ++i) {
    const double t = 1e-3 * i;
    frame.move_to({0, 0.5 * 1000 * t * t, 0}, i == 0 ? 0 : 1e-3);
  }
  EXPECT_NEAR(frame.deflection_mm()[1], frame.static_deflection_mm({0, 1000, 0})[1], 1e-4);
  EXPECT_LT(frame.deflection_mm()[1], -0.01);
}

TEST(FlexibleFrame, TheTruthIsOffByWhatIsAskedFor) {
  VibrationDescription assumed;
  assumed.every = {ShaperKind::kZvd, 40, 0.1};
  bool higher = false, lower = false;
  for (std::uint64_t seed = 1; seed < 20; ++seed)
    for (const FlexibleFrame::Modes& modes : FlexibleFrame::truth(assumed, {0.1, 0.3}, seed)) {
      EXPECT_NEAR(std::abs(modes[0].frequency_hz - 40), 4, 1e-9);
      EXPECT_NEAR(std::abs(modes[0].damping_ratio - 0.1), 0.03, 1e-9);
      higher = higher || modes[0].frequency_hz > 40;
      lower = lower || modes[0].frequency_hz < 40;
      EXPECT_GT(modes[1].share, 0);
    }
  EXPECT_TRUE(higher && lower);
}

}  // namespace
}  // namespace kinebus
