// The shipped M5, whose platform carries the spindle, in virtual time; where its tip is follows here from the
// carriages by the legs' lengths alone.

#include <fmt/format.h>

#include <numbers>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

/// Segments keep half a microstep, which is 0.1 um of a screw here: nodes whose clocks are 0.25 us apart
/// differ by a tenth of a microstep at 80 mm/s.
constexpr double kJointCounts = 0.5 + 0.1;

MachineDescription mill() {
  auto machine = load_machine(machines_folder() / "m5.toml");
  EXPECT_TRUE(machine) << to_string(machine.error());
  return *machine;
}

/// By how much the legs miss their lengths if the tip is at q from the table's centre, the part tilted by A
/// as the tool sees it: the tool leans by -A.
double worst_leg_mm(const M5Geometry& g, const JointVector& rails, const Pose& pose) {
  const double c = std::cos(-pose[kA]), s = std::sin(-pose[kA]);
  const auto turned = [&](const Vector3& v) {
    return Vector3{v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]};
  };
  const Vector3 arm = turned(g.nozzle_mm);
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const M1Leg& leg = g.legs[i];
    const Vector3 b = turned(leg.attachment_mm);
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double joint = g.table_mm[k] + pose[k] - arm[k] + b[k];
      const double carriage = leg.foot_mm[k] + (rails[i] + leg.connector_mm) * leg.rail[k];
      square += (joint - carriage) * (joint - carriage);
    }
    worst = std::max(worst, std::abs(std::sqrt(square) - leg.length_mm));
  }
  return worst;
}

TEST(ToolOnPlatform, FollowsAFiveAxisPathInThePartsFrameWhileTheSpindleLeans) {
  const MachineDescription machine = mill();
  const auto& g = std::get<M5Geometry>(machine.kinematics);
  ASSERT_EQ(g.tool, ToolPlacement::kPlatform);
  // A circle of 40 mm around a point of the work's own, the tool leaning up to 25 deg as it goes round.
  constexpr double kRadius_mm = 40, kLean_deg = 25;
  constexpr std::array<double, 3> kWork_mm{10, -5, 30};
  constexpr int kLines = 720;
  std::string job = fmt::format("G21 G90\nG10 L2 P1 X{} Y{} Z{}\nG54\nG43.4\nG0 X{} Y0 Z0\nG1 F2400\n",
                                kWork_mm[0], kWork_mm[1], kWork_mm[2], kRadius_mm);
  const int before = static_cast<int>(std::count(job.begin(), job.end(), '\n'));
  for (int n = 1; n <= kLines; ++n) {
    const double t = 2 * std::numbers::pi * n / kLines;
    job += fmt::format("G1 X{:.6f} Y{:.6f} A{:.6f}\n", kRadius_mm * std::cos(t), kRadius_mm * std::sin(t),
                       kLean_deg * std::sin(t));
  }
  job += "G49\n";
  double off_circle_um = 0, leg_um = 0, most_lean = 0, lean_error = 0;
  int samples = 0;
  SimulateOptions options;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    leg_um = std::max(leg_um, 1000 * worst_leg_mm(g, sample.joints, sample.pose));
    if (sample.line < static_cast<std::uint32_t>(before) + 2 ||
        sample.line > static_cast<std::uint32_t>(before + kLines))
      return;
    ++samples;
    const double x = sample.pose[kX] - kWork_mm[0], y = sample.pose[kY] - kWork_mm[1],
                 z = sample.pose[kZ] - kWork_mm[2];
    off_circle_um = std::max(off_circle_um, 1000 * std::hypot(std::hypot(x, y) - kRadius_mm, z));
    most_lean = std::max(most_lean, sample.pose[kA]);
    lean_error =
        std::max(lean_error, std::abs(sample.pose[kA] - kLean_deg * kRadPerDeg * std::sin(std::atan2(y, x))));
  };
  const SimulationReport report = simulate_on(machine, job, 1, options);
  expect_within_bounds(report, 1.5 + 5, kJointCounts);
  EXPECT_GT(samples, 5000);
  EXPECT_LT(leg_um, 1e-5) << "what the checkers take for the tool's place is none";
  // Chords of half a degree sag by 0.4 um; the plan may smooth short lines within 5 um.
  EXPECT_LT(off_circle_um, 1.5 + 5 + 0.4);
  EXPECT_GT(most_lean, 0.99 * kLean_deg * kRadPerDeg);
  EXPECT_LT(lean_error, 1e-3);
}

TEST(ToolOnPlatform, OneProgramIsMilledAlikeOnBothMachines) {
  // The same mechanism the other way round: its platform carries the part.
  MachineDescription other = mill();
  static_cast<M1Geometry&>(std::get<M5Geometry>(other.kinematics)) = M1Geometry{};
  for (std::size_t i = 0; i < 4; ++i) {
    other.joints[i].homing->method = 22;
    other.joints[i].homing->switch_position = 40;
  }
  const std::string job =
      "G21 G90 G61\nG43.4\nG0 X20 Y-30 Z15\nG1 X-25 Y10 A20 F1800\nG1 Y40 Z30 A-15\nG49\nG1 X10 Y20 Z40 A10\n"
      "G1 A0\n";
  for (const MachineDescription& machine : {mill(), other})
    expect_within_bounds(simulate_on(machine, job), 1.5, kJointCounts);
}

}  // namespace
}  // namespace kinebus
