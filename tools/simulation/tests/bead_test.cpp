// Beads: the nozzle's melt by itself, and what pressure advance makes of it on the whole machine.

#include <cmath>
#include <memory>
#include <string>

#include "tools/simulation/bead_reference.hpp"
#include "tools/simulation/tests/bead_benchmark.hpp"
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

MachineDescription m1_advanced(const AdvanceModel& model) {
  MachineDescription machine = default_m1();
  machine.vibration.every = {ShaperKind::kMzv, 45, 0.1};
  machine.pressure_advance = model;
  return machine;
}

SimulationReport bench(const MachineDescription& machine, std::uint64_t seed) {
  static const BeadBenchmark job;
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
  static const BeadBenchmark job;
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
