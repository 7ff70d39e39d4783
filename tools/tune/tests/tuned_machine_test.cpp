// From wrong start values on the simulated machine: what tuning finds, against the hidden truth.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gateway/description/machine_file.hpp"
#include "node_firmware/heat/vibration_meter.hpp"
#include "tools/simulation/accelerometer.hpp"
#include "tools/simulation/simulate.hpp"
#include "tools/simulation/tests/bead_benchmark.hpp"
#include "tools/tune/melt_fit.hpp"
#include "tools/tune/tune_pressure.hpp"
#include "tools/tune/tune_vibration.hpp"

namespace kinebus {
namespace {

TEST(TunedMachine, VibrationIsFoundFromWrongStartValues) {
  for (const std::uint64_t seed : {3U, 4U}) {
    const auto truth = FlexibleFrame::hidden(seed);
    MachineDescription machine = default_m1();
    machine.vibration.every = {ShaperKind::kZv, 20, 0.3};
    TuneVibration how;
    how.excitation.from_hz = 15;
    how.excitation.hz_per_s = 5;
    std::array<std::optional<VibrationRecording>, 3> readings;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Excitation e = how.excitation;
      e.axis = axis;
      auto shaken = shake_simulated(machine, e, truth, seed);
      ASSERT_TRUE(shaken) << shaken.error();
      readings[axis] = std::move(*shaken);
    }
    const auto tuning = tune_vibration(machine, how, readings);
    ASSERT_TRUE(tuning) << tuning.error();
    EXPECT_TRUE(tuning->shared);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_TRUE(tuning->axes[axis].fit) << tuning->axes[axis].problem;
      const FittedMode& found = tuning->axes[axis].fit->modes[0];
      const FlexibleFrame::Mode& mode = truth[axis][0];
      EXPECT_NEAR(found.frequency_hz, mode.frequency_hz, 0.02 * mode.frequency_hz)
          << seed << " axis " << axis;
      EXPECT_NEAR(found.damping_ratio, mode.damping_ratio, 0.2 * mode.damping_ratio)
          << seed << " axis " << axis;
    }
    const AxisVibration& every = tuning->machine.vibration.every;
    const InputShaper shaper = make_shaper(every.shaper, every.frequency_hz, every.damping_ratio);
    const ShaperRating& promised = tuning->axes[0].ratings[tuning->axes[0].best];
    for (const auto& modes : truth) {
      std::vector<FittedMode> hidden;
      for (const auto& m : modes) hidden.push_back({m.frequency_hz, m.damping_ratio, m.share});
      // One for all three: directions far apart leave more. What was promised with a margin of 10 % of the
      // frequency holds for the machine as it is.
      EXPECT_LE(vibration_left(shaper, hidden, 1), promised.left + 0.005) << seed;
    }
    // The machine file takes it.
    const auto again = parse_machine(write_machine(tuning->machine), "tuned");
    ASSERT_TRUE(again) << to_string(again.error());
    EXPECT_EQ(again->vibration, tuning->machine.vibration);
  }
}

/// The same by an ADXL345 on a heat node, which sums up on the node: as M956 tells it.
std::string shaken_on_the_node(const MachineDescription& machine, const Excitation& excitation,
                               const std::array<FlexibleFrame::Modes, 3>& truth, std::uint64_t seed) {
  const std::string text = excitation_job(machine, excitation);
  FlexibleFrame frame(truth);
  Accelerometer chip({}, seed);
  heat::VibrationMeter meter(38'300, 4095);
  SimulateOptions options;
  options.simulation.seed = seed;
  options.simulation.sample_period = std::chrono::nanoseconds{312'500};
  std::vector<heat::VibrationMeter::Reading> queue;
  LocalTime now{0};
  meter.begin(now);
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    frame.move_to({sample.pose[kX], sample.pose[kY], sample.pose[kZ]}, now.count() == 0 ? 0 : 312.5e-6);
    now += options.simulation.sample_period;
    const auto felt = chip.read(frame.acceleration_mm_per_s2());
    heat::VibrationMeter::Reading reading{};
    for (std::size_t i = 0; i < 3; ++i) reading[i] = static_cast<std::int16_t>(std::lround(felt[i] / 38.3));
    queue.push_back(reading);
    if (queue.size() < 16) return;
    meter.on_readings(now, queue);
    queue.clear();
  };
  StringSource same(text);
  const SimulationReport report = simulate(machine, std::make_unique<StringSource>(text), same, options);
  EXPECT_TRUE(report.finished) << report.outcome;
  std::string told = fmt::format("rate_hz {:.3f} windows {} clipped {}", 1e-3 * meter.rate_mhz(),
                                 meter.windows(), meter.clipped());
  for (int band = 0; band < kVibrationBands; ++band)
    told += fmt::format("\n{:.6g},{:.6g},{:.6g}", std::ldexp(meter.energy(0, band), meter.exponent(0)),
                        std::ldexp(meter.energy(1, band), meter.exponent(1)),
                        std::ldexp(meter.energy(2, band), meter.exponent(2)));
  return told;
}

TEST(TunedMachine, VibrationIsFoundByWhatANodeSumsUp) {
  constexpr std::uint64_t kSeed = 3;
  const auto truth = FlexibleFrame::hidden(kSeed);
  MachineDescription machine = default_m1();
  machine.vibration.every = {ShaperKind::kZv, 20, 0.3};
  TuneVibration how;
  how.excitation.from_hz = 15;
  how.excitation.hz_per_s = 5;
  std::array<std::optional<VibrationRecording>, 3> readings;
  how.excitation.axis = 1;
  auto summed = read_node_spectrum(shaken_on_the_node(machine, how.excitation, truth, kSeed));
  ASSERT_TRUE(summed) << summed.error();
  readings[1] = std::move(*summed);
  const auto tuning = tune_vibration(machine, how, readings);
  ASSERT_TRUE(tuning) << tuning.error();
  ASSERT_TRUE(tuning->axes[1].fit) << tuning->axes[1].problem;
  const FittedMode& found = tuning->axes[1].fit->modes[0];
  const FlexibleFrame::Mode& mode = truth[1][0];
  fmt::print("by the node: {:.2f} Hz, {:.3f}; truth {:.2f} Hz, {:.3f}\n", found.frequency_hz,
             found.damping_ratio, mode.frequency_hz, mode.damping_ratio);
  EXPECT_NEAR(found.frequency_hz, mode.frequency_hz, 0.02 * mode.frequency_hz);
  EXPECT_NEAR(found.damping_ratio, mode.damping_ratio, 0.2 * mode.damping_ratio);
}

TEST(TunedMachine, ASpectrumThatIsNoneIsRefusedWithItsLine) {
  const auto error = [](const std::string& text) {
    const auto read = read_node_spectrum(text);
    return read ? std::string() : read.error();
  };
  EXPECT_EQ(error(""), "1: expected \"rate_hz R windows W clipped C\"");
  EXPECT_EQ(error("rate_hz 3200 windows 9 clipped 0 x"), "1: expected \"rate_hz R windows W clipped C\"");
  EXPECT_EQ(error("rate_hz 32 windows 9 clipped 0"), "1: 32 readings a second; expected 1000 to 20000");
  EXPECT_EQ(error("rate_hz 3200 windows 10 clipped 50"),
            "1: 50 readings of some 20480 clipped; expected less than one in a thousand");
  EXPECT_EQ(error("rate_hz 3200 windows 9 clipped 0\n1,2,3\n1,2\n"), "3: expected three numbers, x,y,z");
  EXPECT_EQ(error("rate_hz 3200 windows 9 clipped 0\n1,-2,3\n"), "2: expected three numbers, x,y,z");
  EXPECT_EQ(error("rate_hz 3200 windows 9 clipped 0\n1,2,3\n"), "1 bands; expected at least 100");
}

/// Printed with what was found, against the same advance by Klipper's formulas, in the same melt.
void expect_even_beads(MachineDescription machine, const Nozzle::Truth& truth, std::uint64_t seed) {
  machine.vibration.every = {ShaperKind::kMzv, 45, 0.1};
  SimulateOptions options;
  options.simulation.seed = seed;
  options.nozzle.emplace();
  options.nozzle->truth = truth;
  static const BeadBenchmark job;
  const SimulationReport r = simulate_flexible(
      machine, [] { return std::make_unique<StringSource>(job.text()); }, {}, options);
  ASSERT_TRUE(r.finished && r.bead) << to_table(r);
  EXPECT_FALSE(r.trouble);
  EXPECT_GT(r.bead->beads, 1000u);
  EXPECT_LE(r.bead->ratio(), 1.0 / 3) << to_table(r);
  EXPECT_LE(r.bead->ratio_worst(), 1.0 / 3) << to_table(r);
  EXPECT_LE(r.job_time_s, 1.15 * r.bead->reference_time_s);
}

TEST(TunedMachine, PressureIsFoundFromWrongStartValues) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Nozzle::Truth truth = Nozzle::hidden(seed);
    MachineDescription machine = default_m1();
    machine.pressure_advance.advance_s = 0.01;
    PressurePattern pattern;
    const auto widths = print_simulated(machine, pattern, truth, seed);
    ASSERT_TRUE(widths) << widths.error();
    const auto choice = choose_advance(*widths);
    ASSERT_TRUE(choice) << choice.error() << "\n" << write_widths(*widths);
    const double per_mm = pattern.filament_per_mm();
    const double secant_s =
        Nozzle::secant_s(truth, pattern.slow_mm_per_s * per_mm, pattern.fast_mm_per_s * per_mm);
    EXPECT_NEAR(choice->advance_s, secant_s, 0.1 * secant_s) << write_widths(*widths);
    const auto melt = choose_melt(machine, pattern, *widths, choice->advance_s);
    ASSERT_TRUE(melt) << melt.error() << "\n" << write_widths(*widths);
    EXPECT_NEAR(melt->advance_s, secant_s, 0.05 * secant_s) << write_widths(*widths);
    EXPECT_NEAR(melt->melt_s, truth.melt_s, 0.002) << write_widths(*widths);
    machine.pressure_advance.advance_s = melt->advance_s;
    machine.pressure_advance.melt_s = melt->melt_s;
    machine.pressure_advance.smooth_s = shortest_window_s(machine, pattern);
    expect_even_beads(machine, truth, seed);
  }
}

}  // namespace
}  // namespace kinebus
