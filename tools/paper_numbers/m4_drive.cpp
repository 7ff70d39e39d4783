// The path of M4's table 4 as a job: pre-flight, and a run on the whole simulated machine.

#include "tools/paper_numbers/m4_path.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "gateway/jobs/job_plan.hpp"
#include "tools/simulation/simulate.hpp"

namespace kinebus::papers {
namespace {

constexpr int kLines = 600;    // chords of 1 mm: 0.6 um from the circle
constexpr int kFirstLine = 4;  // of the path, in the job
constexpr double kRoom_mm = 5000;

/// The path's t at which the closures are nearest to `y`, from `t` on; and by how much they miss, mm.
double miss(const M4Geometry& g, const M4Build& build, const Vector3& y, double& t) {
  const auto off = [&](double at) {
    const auto b = m4_blocks(g, m4_path_at(at, build), build);
    double worst = b ? 0 : HUGE_VAL;
    for (std::size_t i = 0; b && i < 3; ++i) worst = std::max(worst, std::abs((*b)[i] - y[i]));
    return worst;
  };
  double low = std::max(0.0, t - 0.02), high = std::min(kM4PathEnd_s, t + 0.02);
  while (high - low > 1e-9) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (off(a) < off(b) ? high : low) = off(a) < off(b) ? b : a;
  }
  t = (low + high) / 2;
  return off(t);
}

/// What pre-flight says of the path with AB level when the tool is upright, as the paper has it.
std::string refusal_of_papers_assembly(MachineDescription machine, const std::string& job) {
  auto& g = std::get<M4Geometry>(machine.kinematics);
  g.spindle_rad = 0;
  for (Interval& travel : g.travel_mm) travel = {-kRoom_mm, kRoom_mm};
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) return kinematics.error().what.english();
  StringSource source(job);
  JobPlan plan(machine, **kinematics, source);
  while (!plan.step(10'000)) {
  }
  for (const Problem& p : plan.problems().all())
    if (p.line >= kFirstLine)
      return printed("from line %u on (t = %.3f s): ", p.line,
                     kM4PathEnd_s * (p.line - kFirstLine) / kLines) +
             p.words;
  return "nothing to say";
}

}  // namespace

std::string m4_path_job(const M4Geometry& g) {
  const auto words = [&](double t) {
    const PlanarPose p = m4_path_at(t);
    // The tip hangs below P, along the tilted spindle.
    return printed("Y%.5f Z%.5f A%.5f", p.x_mm + g.tool_mm * std::sin(p.phi_rad) - g.table_y_mm,
                   p.y_mm - g.tool_mm * std::cos(p.phi_rad) - g.table_z_mm, -p.phi_rad / kRadPerDeg);
  };
  std::string job = "G21 G90 G43.4 H0\nG0 X0 " + words(0) + "\nG93\n";
  for (int k = 1; k <= kLines; ++k)
    job += "G1 " + words(kM4PathEnd_s * k / kLines) + printed(" F%.3f\n", 60 * kLines / kM4PathEnd_s);
  return job + "G94\nM2\n";
}

M4Drive drive_m4_path(const MachineDescription& machine) {
  const auto& g = std::get<M4Geometry>(machine.kinematics);
  const std::string job = m4_path_job(g);
  M4Drive drive;
  drive.refusal = refusal_of_papers_assembly(machine, job);

  const M4Build build{1, 1, g.spindle_rad};
  double t = 0;
  std::optional<double> began_s;
  SimulateOptions options;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t line) {
    if (!sample.in_job || line < kFirstLine || line >= kFirstLine + kLines) return;
    const double now_s =
        1e-9 * static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(sample.time).count());
    if (!began_s) began_s = now_s;
    drive.duration_s = now_s - *began_s;
    const Vector3 y{sample.joints[0], sample.joints[1], sample.joints[2]};
    drive.off_um = std::max(drive.off_um, 1000 * miss(g, build, y, t));
    drive.blocks_driven.push_back({drive.duration_s, y});
  };
  StringSource same(job);
  const SimulationReport report = simulate(machine, std::make_unique<StringSource>(job), same, options);
  drive.outcome = report.outcome;
  constexpr double kEndSeen_s = 0.01;
  if (!report.finished || t < kM4PathEnd_s - kEndSeen_s) drive.off_um = HUGE_VAL;
  drive.speed_ratio = report.max_joint_velocity_ratio;
  return drive;
}

}  // namespace kinebus::papers
