// The whole machine in virtual time: homes, goes to the bed reference, prints; measured from outside.

#include <fmt/format.h>

#include <array>
#include <random>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

TEST(WholeMachine, PrintsASlicedPartWithinBounds) {
  expect_within_bounds(simulate_text(generated_job("print", 1500)));
}

TEST(WholeMachine, PrintsADenseCurveWithinBounds) {
  expect_within_bounds(simulate_text(generated_job("dense-curve", 5000)));
}

TEST(WholeMachine, MovesFiveAxesUnderToolCentrePointControlWithinBounds) {
  expect_within_bounds(simulate_text(generated_job("five-axis", 5000)));
}

TEST(WholeMachine, PrintsTheDemoWithHeatingWithinBounds) {
  expect_within_bounds(simulate_text(generated_job("demo", 600)));
}

constexpr const char* kCorners =
    "G1 Z5 F18000\nG1 X80 Y0\nG1 X0 Y80\nG1 X-80 Y0 Z40\nG1 X0 Y-80\nG1 X0.3 Y-80\nG1 X0 Y-80\n"
    "G2 X-80 Y0 I0 J80\nG3 X-60 Y20 I0 J20\nG1 X-70 Y-20\nG1 X70 Y-20\nG1 X-70 Y-20\nG1 X0 Y0 Z5\n";

TEST(WholeMachine, KeepsTheBlendToleranceAtFullSpeed) {
  expect_within_bounds(simulate_text(std::string("G21 G90\n") + kCorners));
}

TEST(WholeMachine, ExactPathIsExact) {
  expect_within_bounds(simulate_text(std::string("G21 G90 G61\n") + kCorners), 1.5);
}

TEST(WholeMachine, TiltsAndTurnsInTheMachineFrameWithinBounds) {
  expect_within_bounds(simulate_text(
      "G21 G90\nG0 Z30\nG0 A25 C180\nG1 X40 Y10 F9000\nG1 X-30 A-20 C-90 F6000\nG0 X0 Y0 A0 C720\nG4 P200\n"
      "G43.4\nG1 X30 Y0 Z25 A10 C700 F6000\nG49\nG0 A0 C720\nG0 X0 Y0 Z20\n"));
}

TEST(WholeMachine, KeepsTheJerkLimitOfEveryJoint) {
  MachineDescription machine = default_m1();
  machine.path.tool_jerk_mm_per_s3 = 100'000;
  for (const std::string& job : {generated_job("print", 300), generated_job("dense-curve", 1500),
                                 generated_job("five-axis", 1500), "G21 G90\n" + std::string(kCorners)}) {
    const SimulationReport r = simulate_on(machine, job);
    expect_within_bounds(r);
    EXPECT_GT(r.max_joint_jerk_ratio, 0);
    EXPECT_LE(r.max_joint_jerk_ratio, 1.0) << to_table(r);
  }
}

/// Lines, arcs, dwells, retractions and rotations of all sizes and speeds, inside the workspace.
std::string random_job(std::uint64_t seed, int moves) {
  std::mt19937_64 random(seed);
  const auto in = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  std::string text = "G21 G90 M83\nM104 S200\nG1 Z30 F6000\nG43.4\n";
  double x = 0, y = 0, z = 30;
  bool five_axes = false;
  for (int i = 0; i < moves; ++i) {
    const double length = std::exp(in(std::log(0.02), std::log(60))), angle = in(0, 6.2832);
    const double feed = std::exp(in(std::log(300), std::log(18000)));
    x = std::clamp(x + length * std::cos(angle), -60.0, 60.0);
    y = std::clamp(y + length * std::sin(angle), -60.0, 60.0);
    z = std::clamp(z + in(-0.2, 0.2) * length, 10.0, 60.0);
    switch (random() % 12) {
      case 0:
        text += fmt::format("G4 P{}\n", random() % 50);
        break;
      case 1:
        text += fmt::format("G1 E{:.3f} F2400\n", in(-2, 2));
        break;
      case 2:
        text += random() % 3 == 0 ? "G61\n" : fmt::format("G64 P{:.3f}\n", in(0.001, 0.2));
        break;
      case 3:
        five_axes = !five_axes;
        break;
      case 4:
        text += fmt::format("G0 X{:.3f} Y{:.3f} Z{:.3f}\n", x, y, z);
        break;
      case 5: {
        const double radius = in(0.5, 15);
        text += fmt::format("G1 X{:.3f} Y{:.3f} F{:.0f}\nG{} X{:.3f} Y{:.3f} I{:.3f} J0\n", x, y, feed,
                            2 + random() % 2, x, y, x > 0 ? -radius : radius);
        break;
      }
      default:
        if (five_axes)
          text += fmt::format("G1 X{:.3f} Y{:.3f} Z{:.3f} A{:.3f} C{:.3f} E{:.4f} F{:.0f}\n", x, y, z,
                              in(-20, 20), in(-400, 400), in(0, 0.03) * length, feed);
        else
          text += fmt::format("G1 X{:.3f} Y{:.3f} Z{:.3f} E{:.4f} F{:.0f}\n", x, y, z, in(0, 0.03) * length,
                              feed);
    }
  }
  return text + "M104 S0\n";
}

TEST(WholeMachine, KeepsTheMachinesLimitsOnRandomJobsAndSeeds) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(fmt::format("random_job({0}, 120), seed {0}", seed));
    // Wide blends (up to G64 P0.2) leave the programmed path on purpose.
    expect_within_bounds(simulate_text(random_job(seed, 120), seed), 200 + 1.5);
  }
}

TEST(WholeMachine, SameSeedGivesTheSameRunFrameByFrame) {
  const std::string job = generated_job("five-axis", 1500);
  const SimulationReport a = simulate_text(job, 7), b = simulate_text(job, 7), c = simulate_text(job, 8);
  expect_within_bounds(a);
  expect_within_bounds(c);
  EXPECT_EQ(a.trace_hash, b.trace_hash);
  EXPECT_EQ(a.max_tracking_error_um, b.max_tracking_error_um);
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_NE(a.trace_hash, c.trace_hash);
}

TEST(WholeMachine, HoldsAndResumesOnThePathWithoutAStep) {
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
  expect_within_bounds(simulate_text(generated_job("print", 400), 3, options));
  EXPECT_GE(holds, 10);
}

TEST(WholeMachine, HoldsAndResumesWithLimitedJerk) {
  MachineDescription machine = default_m1();
  machine.path.tool_jerk_mm_per_s3 = 100'000;
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
  const SimulationReport r = simulate_on(machine, generated_job("print", 400), 3, options);
  expect_within_bounds(r);
  EXPECT_LE(r.max_joint_jerk_ratio, 1.0);
  EXPECT_GE(holds, 10);
}

TEST(WholeMachine, OverridesChangeTheTimeAndNothingElse) {
  const std::string job = generated_job("print", 400);
  SimulateOptions options;
  options.operate = [](Gateway& gateway, double) {
    EXPECT_TRUE(gateway.carry_out(command::SetFeedOverride{0.4}));
  };
  const SimulationReport plain = simulate_text(job, 3), slow = simulate_text(job, 3, options);
  expect_within_bounds(plain);
  expect_within_bounds(slow);
  EXPECT_NEAR(slow.job_time_s / plain.job_time_s, 2.5, 0.1);
}

TEST(WholeMachine, StopsOnThePathFromFullSpeed) {
  SimulateOptions options;
  options.operate = [&](Gateway& gateway, double job_s) {
    if (job_s > 0.9 && gateway.state() == MachineState::kRunning) {
      EXPECT_TRUE(gateway.carry_out(command::Stop{}));
    }
  };
  const SimulationReport r = simulate_text(std::string("G21 G90\n") + kCorners, 5, options);
  EXPECT_FALSE(r.finished);
  EXPECT_EQ(r.outcome, "ended in state stopped");
  EXPECT_LE(r.max_tracking_error_um, 1.5);
  EXPECT_LE(r.max_path_error_um, 6.5);
  EXPECT_LE(r.max_velocity_step_ratio, 1.0);
  EXPECT_LE(r.max_node_time_skew_us, 2.0);
}

TEST(WholeMachine, SlowsThePathWhenTheBusIsTooSmallForIt) {
  std::string job = "G21 G90 M83\nM104 S200\nG1 Z10 F6000\n";  // a saw of 0.2 mm teeth
  for (int i = 0; i < 800; ++i)
    job += fmt::format("G1 X{:.1f} Y{:.2f} E0.01 F18000\n", 0.1 * i, i % 2 == 0 ? 0.07 : -0.07);
  MachineDescription machine = default_m1();
  const SimulationReport fast = simulate_text(job);
  expect_within_bounds(fast);
  machine.bus.budget = 0.04;
  StringSource same(job);
  const SimulationReport slow = simulate(machine, std::make_unique<StringSource>(job), same, {});
  expect_within_bounds(slow);
  EXPECT_GT(fast.bus_load_peak_1s, 0.06);
  EXPECT_LT(slow.bus_load_peak_1s, 0.055);  // the budget, SYNC, status and heartbeats
  EXPECT_GT(slow.bus_slowdowns, 0u);
}

// Its belts find no switch: the tool stands at the bed's centre when power comes. Where the tool is follows
// here from the motors alone.
TEST(WholeMachine, ACoreXysToolIsWhereTheJobSays) {
  const auto machine = load_machine(machines_folder() / "corexy.toml");
  ASSERT_TRUE(machine) << to_string(machine.error());
  std::array<double, 3> tool{}, farthest{};
  SimulateOptions options;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    const JointVector& q = sample.joints;
    tool = {0.5 * (q[0] + q[1]), 0.5 * (q[0] - q[1]), q[2]};
    for (std::size_t i = 0; i < tool.size(); ++i) farthest[i] = std::max(farthest[i], std::abs(tool[i]));
  };
  const SimulationReport r =
      simulate_on(*machine, "G21 G90\nG1 X60 Y-40 Z30 F6000\nG1 X-70\nG1 X15 Y25\n", 1, options);
  expect_within_bounds(r);
  constexpr double kCounts_mm = 2e-3;
  EXPECT_NEAR(tool[0], 15, kCounts_mm);
  EXPECT_NEAR(tool[1], 25, kCounts_mm);
  EXPECT_NEAR(tool[2], 30, kCounts_mm);
  EXPECT_NEAR(farthest[0], 70, 0.01);
  EXPECT_NEAR(farthest[1], 40, 0.01);
}

TEST(WholeMachine, AJobWithAnErrorDoesNotBegin) {
  const SimulationReport r = simulate_text("G21 G90\nG1 X10 F3000\nG1 X500\n");
  EXPECT_FALSE(r.finished);
  EXPECT_TRUE(r.trouble);
  EXPECT_EQ(r.segments, 0u);
  ASSERT_FALSE(r.messages.empty());
  EXPECT_NE(r.messages.front().find("line 3"), std::string::npos) << r.messages.front();
}

}  // namespace
}  // namespace kinebus
