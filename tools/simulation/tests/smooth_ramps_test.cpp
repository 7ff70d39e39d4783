// Jerk and acceleration of every joint through holds, resumes and overrides at random moments: no greater
// than in undisturbed motion.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <random>
#include <string>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

MachineDescription gentle(const char* name, double jerk_mm_per_s3) {
  auto machine = load_machine(machines_folder() / name);
  EXPECT_TRUE(machine);
  machine->path.tool_jerk_mm_per_s3 = jerk_mm_per_s3;
  return std::move(*machine);
}

/// Somebody who holds, resumes and overrides all the time, also while a ramp is under way.
class Operator {
 public:
  explicit Operator(std::uint64_t seed) : random_(seed) {}

  void act(Gateway& gateway, double job_s) {
    if (job_s < next_s_) return;
    const MachineState state = gateway.state();
    if (state == MachineState::kHeld) {
      EXPECT_TRUE(gateway.carry_out(command::Resume{}));
    } else if (state == MachineState::kRunning && draw(0, 1) < 0.5) {
      holds += gateway.carry_out(command::Hold{}) ? 1 : 0;
    } else if (state == MachineState::kRunning) {
      const double ratios[]{0.5, 1.0, 1.5, 0.3, 0.8};
      overrides += gateway.carry_out(command::SetFeedOverride{ratios[random_() % std::size(ratios)]}) ? 1 : 0;
    }
    next_s_ = job_s + draw(0.02, 0.9);
  }

  int holds = 0, overrides = 0;

 private:
  double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  std::mt19937_64 random_;
  double next_s_ = 0.2;
};

/// Long and short lines with corners of all angles, at full speed; in five axes the platform tilts and turns.
std::string random_lines(bool five_axes) {
  std::mt19937_64 random(7);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::string text =
      five_axes ? "G43.4\nG1 X0 Y0 Z30 A0 C0 F3000\nG1 F12000\n" : "G1 X0 Y0 Z30 F3000\nG1 F18000\n";
  for (int i = 0; i < 3000; ++i) {
    std::array<char, 96> line{};
    const double reach = draw(0, 1) < 0.5 ? 3 : five_axes ? 25 : 90;
    if (five_axes)
      std::snprintf(line.data(), line.size(), "G1 X%.3f Y%.3f Z%.3f A%.3f C%.3f\n", draw(-reach, reach),
                    draw(-reach, reach), draw(25, 35), draw(-10, 10), draw(-40, 40));
    else
      std::snprintf(line.data(), line.size(), "G1 X%.3f Y%.3f\n", draw(-reach, reach), draw(-reach, reach));
    text += line.data();
  }
  return text;
}

/// `path_um`: see expect_within_bounds(). The job is longer than what is looked at.
void expect_smooth_ramps(const MachineDescription& machine, const std::string& job, double path_um = 6.5) {
  const char* const rounds = std::getenv("KINEBUS_ROUNDS");
  const unsigned seeds = rounds != nullptr ? static_cast<unsigned>(std::atoi(rounds)) : 1;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Operator somebody(seed);
    SimulateOptions options;
    options.operate = [&](Gateway& gateway, double job_s) { somebody.act(gateway, job_s); };
    options.limit_s = 40;
    const SimulationReport r = simulate_on(machine, job, seed, options);
    std::printf(
        "seed %u: %d holds, %d overrides: jerk %.4f of its limit (%s at %.3f s), %.4f below full rate, "
        "acceleration %.4f\n",
        seed, somebody.holds, somebody.overrides, r.max_joint_jerk_ratio, r.worst_jerk_joint.c_str(),
        r.worst_jerk_s, r.max_ramp_jerk_ratio, r.max_joint_acceleration_ratio);
    EXPECT_FALSE(r.trouble);
    EXPECT_GT(somebody.holds, 10);
    EXPECT_GT(somebody.overrides, 10);
    EXPECT_LE(r.max_joint_jerk_ratio, 1.0);
    EXPECT_GT(r.max_ramp_jerk_ratio, 0.05);
    EXPECT_LE(r.max_joint_acceleration_ratio, 1.0);
    EXPECT_LE(r.max_velocity_step_ratio, 1.0);
    EXPECT_LE(r.max_tracking_error_um, 1.5);
    EXPECT_LE(r.max_path_error_um, path_um);
    EXPECT_LE(r.max_node_time_skew_us, 2.0);
    EXPECT_EQ(r.underruns, 0u);
  }
}

TEST(SmoothRamps, KeepTheJointsJerkOnM1) {
  for (const char* kind : {"print", "dense-curve"})
    expect_smooth_ramps(gentle("m1.toml", 100'000), generated_job(kind, 6000));
}

TEST(SmoothRamps, KeepTheJointsJerkInFiveAxes) {
  for (const std::string& job : {generated_job("five-axis", 6000), random_lines(true)})
    expect_smooth_ramps(gentle("m1.toml", 100'000), job);
}

TEST(SmoothRamps, KeepTheJointsJerkOnACartesianMachine) {
  for (const std::string& job : {generated_job("print", 6000), random_lines(false)})
    for (const double jerk : {50'000.0, 100'000.0, 1'000'000.0})
      expect_smooth_ramps(gentle("cartesian.toml", jerk), job);
}

/// The run ends while the ramp of the hold is still under way: at rest nodes tell nothing, and are not
/// missed.
TEST(SmoothRamps, AHoldThatTheJobsEndOvertakesEndsHeldAndThenFinished) {
  const MachineDescription machine = gentle("m1.toml", 100'000);
  const std::string job = "G1 X20 Y5 Z10 F6000\nG1 X0 Y0\n";
  const double whole_s = simulate_on(machine, job).job_time_s;
  int held = 0;
  for (int i = 0; i < 40; ++i) {
    const double at_s = whole_s - 0.02 * i;
    SCOPED_TRACE(testing::Message() << "hold at " << at_s << " s of " << whole_s << " s");
    bool asked = false;
    SimulateOptions options;
    options.operate = [&](Gateway& gateway, double job_s) {
      if (job_s > at_s && !asked) asked = true, held += gateway.carry_out(command::Hold{}) ? 1 : 0;
      if (gateway.state() == MachineState::kHeld) {
        EXPECT_TRUE(gateway.carry_out(command::Resume{}));
      }
    };
    expect_within_bounds(simulate_on(machine, job, 1, options));
  }
  EXPECT_GT(held, 30);
}

}  // namespace
}  // namespace kinebus
