// Input shaping on the whole machine: every bound of unshaped motion holds against the shaped plan, and a
// frame that is not as the machine file says comes to rest behind corners.

#include <filesystem>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

MachineDescription m1_shaped(ShaperKind kind, double deviation_mm = 0) {
  MachineDescription machine = default_m1();
  machine.vibration.every = {kind, 45, 0.1};
  machine.vibration.deviation_mm = deviation_mm;
  return machine;
}

constexpr const char* kShapedCorners =
    "G21 G90\nG1 Z5 F18000\nG1 X40 Y0 F6000\nG1 X40 Y40\nG1 X0 Y40\nG1 X0 Y0\nG1 X30 Y30 F9000\nG1 X60 Y0\n"
    "G4 P100\nG1 X0 Y-30\nG2 X-40 Y10 I0 J40\nG1 X-40 Y-30\nG1 X0 Y0 Z12\n";

// What 3000 mm/s^2 and these shapers may make of a path, um, with the blends and the tracking error.
constexpr double kMostShaped_um = 3000 * 0.5 * 1000 * 0.125 / (45 * 45) * 1.05 + 6.5;

TEST(ShapedMotion, KeepsEveryBoundButThePathThatItIsAllowedToLeave) {
  for (const std::string& job : {generated_job("print", 300), generated_job("dense-curve", 1500),
                                 generated_job("five-axis", 1500), std::string(kShapedCorners)})
    expect_within_bounds(simulate_on(m1_shaped(ShaperKind::kZvd), job), kMostShaped_um);
}

TEST(ShapedMotion, WithLimitedJerkToo) {
  MachineDescription machine = m1_shaped(ShaperKind::kMzv);
  machine.path.tool_jerk_mm_per_s3 = 100'000;
  const SimulationReport r = simulate_on(machine, kShapedCorners);
  expect_within_bounds(r, kMostShaped_um);
  EXPECT_LE(r.max_joint_jerk_ratio, 1.0);
}

TEST(ShapedMotion, HoldsAndResumesOnTheShapedPath) {
  SimulateOptions options;
  int holds = 0;
  options.operate = [&](Gateway& gateway, double job_s) {
    const MachineState state = gateway.state();
    if (state == MachineState::kRunning && job_s > 1 + 0.7 * holds && gateway.carry_out(command::Hold{}))
      ++holds;
    if (state == MachineState::kHeld) {
      EXPECT_TRUE(gateway.carry_out(command::Resume{}));
    }
  };
  expect_within_bounds(simulate_on(m1_shaped(ShaperKind::kEi), generated_job("print", 400), 3, options),
                       kMostShaped_um);
  EXPECT_GE(holds, 10);
}

TEST(ShapedMotion, AStatedDeviationIsKept) {
  const SimulationReport r = simulate_on(m1_shaped(ShaperKind::kEi, 0.020), kShapedCorners);
  expect_within_bounds(r, 20 + 6.5);
}

TEST(ShapedMotion, ACoreXyShapesXAndYApart) {
  auto machine = load_machine(machines_folder() / "corexy.toml");
  ASSERT_TRUE(machine);
  machine->vibration.x = {ShaperKind::kMzv, 62, 0.1};
  machine->vibration.y = {ShaperKind::kZvd, 41, 0.1};
  const SimulationReport r = simulate_flexible(
      *machine,
      [] {
        return std::make_unique<StringSource>(
            "G21 G90\nG0 X50 Y50 Z5 F9000\nG1 X100 Y50\nG1 X100 Y100\nG1 X50 Y50\nG1 X80 Y50\n");
      },
      {}, {});
  ASSERT_TRUE(r.vibration);
  EXPECT_TRUE(r.finished) << r.outcome;
  EXPECT_LE(r.vibration->ratio_rms(), 0.10) << to_table(r);
  EXPECT_GT(r.vibration->plan_deviation_um, 10);
  EXPECT_LE(r.vibration->plan_deviation_um, 150);
  EXPECT_LE(r.max_joint_velocity_ratio, 1.0);
  EXPECT_LE(r.max_joint_acceleration_ratio, 1.0);
  EXPECT_EQ(r.underruns, 0u);
}

TEST(ShapedMotion, AFrameOtherThanStatedComesToRestBehindCorners) {
  for (const ShaperKind kind : {ShaperKind::kZvd, ShaperKind::kTwoHump})
    for (const std::uint64_t seed : {1U, 2U}) {
      SimulateOptions options;
      options.simulation.seed = seed;
      const SimulationReport r = simulate_flexible(
          m1_shaped(kind), [] { return std::make_unique<StringSource>(kShapedCorners); }, {}, options);
      ASSERT_TRUE(r.vibration);
      EXPECT_TRUE(r.finished) << r.outcome;
      EXPECT_GT(r.vibration->samples, 300u);
      EXPECT_GT(r.vibration->unshaped_rms_um, 3);
      EXPECT_LE(r.vibration->ratio_rms(), 0.05) << to_table(r);
      EXPECT_LE(r.vibration->ratio_peak(), 0.10) << to_table(r);
      EXPECT_GT(r.vibration->plan_deviation_um, 10);
      EXPECT_LE(r.vibration->plan_deviation_um, kMostShaped_um * 1.6);
    }
}

TEST(ShapedMotion, WithoutShapingTheRatiosAreOne) {
  const SimulationReport r =
      simulate_flexible(default_m1(), [] { return std::make_unique<StringSource>(kShapedCorners); }, {}, {});
  ASSERT_TRUE(r.vibration);
  EXPECT_EQ(r.vibration->ratio_rms(), 1);
  EXPECT_EQ(r.vibration->ratio_peak(), 1);
  EXPECT_LE(r.vibration->plan_deviation_um, 5.1);
}

}  // namespace
}  // namespace kinebus
