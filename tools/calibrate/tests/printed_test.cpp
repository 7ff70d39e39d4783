// The calibration's proof in motion: a job on the whole simulated machine, homed at its own switches, with
// hidden errors in geometry, scale, backlash and switches. What is measured is the true tool.

#include <gtest/gtest.h>

#include "tools/calibrate/hidden.hpp"
#include "tools/calibrate/rehearsal.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

SimulationReport print(const std::string& job, const MachineDescription& machine,
                       const MachineDescription& truth, std::uint64_t seed) {
  SimulateOptions options;
  options.simulation.seed = seed;
  options.simulation.plant = &truth;
  options.limit_s = 30;
  StringSource same(job);
  return simulate(machine, std::make_unique<StringSource>(job), same, options);
}

class CalibratedPrint : public ::testing::TestWithParam<const char*> {};

TEST_P(CalibratedPrint, GoesFromHalfAMillimetreToTwentyFiveMicrometres) {
  const std::string job = generated_job(GetParam(), 2000);
  const MachineDescription nominal = default_m1();
  for (const std::uint64_t seed : {1u, 2u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const MachineDescription truth = with_hidden_errors(nominal, {}, seed);
    const auto machine = calibrated(nominal, truth, {.seed = seed});
    ASSERT_TRUE(machine) << machine.error();
    const SimulationReport before = print(job, nominal, truth, seed),
                           after = print(job, *machine, truth, seed);
    EXPECT_FALSE(after.trouble) << to_table(after);
    EXPECT_GT(before.rms_tracking_error_um, 400) << to_table(before);
    EXPECT_LE(after.rms_tracking_error_um, 25) << to_table(after);
    EXPECT_LE(after.rms_path_error_um, 25) << to_table(after);
    EXPECT_LE(after.max_joint_velocity_ratio, 1.0);
    EXPECT_LE(after.max_joint_acceleration_ratio, 1.0);
    EXPECT_EQ(after.underruns, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Jobs, CalibratedPrint, ::testing::Values("print", "five-axis"), [](const auto& job) {
  return std::string(job.param) == "print" ? "Print" : "FiveAxis";
});

}  // namespace
}  // namespace kinebus
