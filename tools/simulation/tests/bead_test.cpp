// Beads: the nozzle's melt by itself, and what pressure advance makes of it on the whole machine.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>

#include "tools/simulation/bead_reference.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

TEST(Nozzle, WhatIsFedComesOutAndSteadyFlowPressesAsStated) {
  Nozzle::Truth truth;
  truth.ooze_mm_per_s = 0;
  Nozzle nozzle(truth);
  double fed = 0, out = 0;
  for (int i = 0; i < 2000; ++i) {
    fed += 2e-3;
    out += nozzle.feed(2e-3, 1e-3);
  }
  EXPECT_NEAR(nozzle.pressed_mm(), truth.press_s * 2, 1e-3);
  EXPECT_NEAR(fed - out, nozzle.pressed_mm(), 1e-9);
  for (int i = 0; i < 1000; ++i) out += nozzle.feed(0, 1e-3);
  EXPECT_NEAR(out, fed, 1e-3);
}

TEST(Nozzle, OozesUntilItIsDrawnBack) {
  Nozzle nozzle(Nozzle::Truth{});
  EXPECT_GT(nozzle.feed(0, 1), 0.01);
  nozzle.feed(-1, 0.1);
  EXPECT_LT(nozzle.feed(0, 1), 1e-9);
}

/// Beads of 0.45 x 0.2 mm: a skirt, corners, squares of 3 and 1.5 mm, changes of speed, a zigzag; travels
/// with retraction.
class Benchmark {
 public:
  Benchmark() {
    text_ = "G21 G90 M83\nG92 E0\nM104 S210\nG1 Z5 F6000\nG1 E1 F600\n";
    travel(-35, -35);
    line(-5, -35, 1200);
    rectangle(-30, -30, 60, 60, 6000);
    rectangle(-25, -25, 20, 10, 4800);
    for (int i = 0; i < 6; ++i) rectangle(-20 + 7 * i, -5, 3, 3, 3600);
    for (int i = 0; i < 4; ++i) rectangle(-20 + 7 * i, 5, 1.5, 1.5, 3000);
    travel(-25, 15);
    for (int i = 0; i < 3; ++i) {
      line(x_ + 8, 15, 6000);
      line(x_ + 4, 15, 1200);
      line(x_ + 5, 15, 4800);
    }
    travel(-25, 20);
    for (int i = 0; i < 20; ++i) line(x_ + 2, i % 2 == 0 ? 22 : 20, 5400);
  }
  const std::string& text() const { return text_; }

 private:
  void travel(double x, double y) {
    text_ += fmt::format("G1 E-0.8 F2100\nG0 X{:.3f} Y{:.3f} F12000\nG1 E0.8 F2100\n", x, y);
    x_ = x, y_ = y;
  }
  void line(double x, double y, int feed) {
    constexpr double kPerMm = 0.45 * 0.2 / (1.75 * 1.75 * 0.7853981634);
    const double e = std::hypot(x - x_, y - y_) * kPerMm;
    text_ += fmt::format("G1 X{:.3f} Y{:.3f} E{:.5f} F{}\n", x, y, e, feed);
    x_ = x, y_ = y;
  }
  void rectangle(double x, double y, double width, double height, int feed) {
    travel(x, y);
    line(x + width, y, feed);
    line(x + width, y + height, feed);
    line(x, y + height, feed);
    line(x, y, feed);
  }
  std::string text_;
  double x_ = 0, y_ = 0;
};

MachineDescription m1_advanced(const AdvanceModel& model) {
  MachineDescription machine = default_m1();
  machine.vibration.every = {ShaperKind::kMzv, 45, 0.1};
  machine.pressure_advance = model;
  return machine;
}

SimulationReport bench(const MachineDescription& machine, std::uint64_t seed) {
  static const Benchmark job;
  SimulateOptions options;
  options.simulation.seed = seed;
  return simulate_flexible(
      machine, [] { return std::make_unique<StringSource>(job.text()); }, {}, options);
}

// What MZV at 45 Hz and 3000 mm/s^2 make of a path, um, with the blends and the tracking error.
constexpr double kMostShaped_um = 62 * (50.0 / 45) * (50.0 / 45) * 0.6 * 1.1 + 6.5;

TEST(Bead, IsEvenerThanByKlippersFormulasWhateverTheMeltReallyIs) {
  // Seeds: compression and melt stronger or weaker than stated, each of the four ways.
  double squares = 0, reference_squares = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const SimulationReport r = bench(m1_advanced({.advance_s = 0.04, .melt_s = 0.006}), seed);
    expect_within_bounds(r, kMostShaped_um);
    ASSERT_TRUE(r.bead);
    EXPECT_GT(r.bead->beads, 1000u);
    EXPECT_LE(r.bead->ratio(), 0.7) << to_table(r);
    EXPECT_LE(r.bead->ratio_worst(), 0.75) << to_table(r);
    EXPECT_LE(r.job_time_s, 1.1 * r.vibration->unshaped_job_time_s);
    squares += r.bead->rms * r.bead->rms;
    reference_squares += r.bead->reference_rms * r.bead->reference_rms;
  }
  EXPECT_LE(std::sqrt(squares / reference_squares), 0.47);
}

TEST(Bead, LinearAdvanceIsAsGoodAsTheReferenceAndFarBetterThanNone) {
  const SimulationReport linear = bench(m1_advanced({.advance_s = 0.04}), 1);
  const SimulationReport none = bench(m1_advanced({}), 1);
  ASSERT_TRUE(linear.bead && none.bead);
  expect_within_bounds(linear, kMostShaped_um);
  EXPECT_LE(linear.bead->ratio(), 1.1) << to_table(linear);
  EXPECT_LE(linear.bead->rms, 0.5 * none.bead->rms) << to_table(none);
}

TEST(Bead, FilamentIsExactThroughHoldsInTheMiddleOfFastLines) {
  static const Benchmark job;
  SimulateOptions options;
  int holds = 0;
  options.operate = [&](Gateway& gateway, double job_s) {
    const MachineState state = gateway.state();
    if (state == MachineState::kRunning && job_s > 1.5 + 0.9 * holds && gateway.carry_out(command::Hold{}))
      ++holds;
    if (state == MachineState::kHeld) {
      EXPECT_TRUE(gateway.carry_out(command::Resume{}));
    }
  };
  double end_e = 0;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) { end_e = sample.pose[kE]; };
  const MachineDescription machine = m1_advanced({.advance_s = 0.04, .melt_s = 0.006});
  // Every sample of the extruder is within half a microstep of the plan: joint error of expect_within_bounds.
  expect_within_bounds(simulate_on(machine, job.text(), 1, options), kMostShaped_um);
  EXPECT_GE(holds, 8);
  const double held_e = end_e;
  options.operate = nullptr;
  simulate_on(machine, job.text(), 1, options);
  EXPECT_NEAR(held_e, end_e, 23.2 / (200 * 256));
}

}  // namespace
}  // namespace kinebus
