#include "tools/tune/vibration_excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/simulation/planned_phases.hpp"

namespace kinebus {
namespace {

// Of the tool's acceleration: the planner's own reserve is less.
constexpr double kAccelShare = 0.9;
constexpr double kFarthest_mm = 2;

}  // namespace

std::string excitation_job(const MachineDescription& machine, const Excitation& e) {
  const char axis = "XYZ"[e.axis];
  double most = kAccelShare * machine.path.tool_accel_mm_per_s2;
  if (machine.path.axis_accel_per_s2[e.axis] > 0)
    most = std::min(most, kAccelShare * machine.path.axis_accel_per_s2[e.axis]);
  std::string text =
      fmt::format("; shakes {} from {:g} to {:g} Hz\nG21\nM593 F0\nG61\nG91\n", axis, e.from_hz, e.to_hz);
  double time_s = 0, last_accel = 0;
  const bool sweeps = e.to_hz > e.from_hz;
  for (double f = e.from_hz; sweeps ? f < e.to_hz : time_s < e.single_s;) {
    // Half a period with +a, half with -a: forth and back take a period each half of it.
    const double accel = std::min({most, e.accel_per_hz * f, kFarthest_mm * 16 * f * f});
    const double way_mm = accel / (16 * f * f), peak_mm_per_s = accel / (4 * f);
    if (std::abs(accel - last_accel) > 0.5) text += fmt::format("M204 S{:.1f}\n", accel);
    last_accel = accel;
    text +=
        fmt::format("G1 {0}{1:.6f} F{2:.0f}\nG1 {0}-{1:.6f}\n", axis, way_mm, std::ceil(120 * peak_mm_per_s));
    time_s += 1 / f;
    if (sweeps) f += e.hz_per_s / f;
  }
  return text + "G90\n";
}

std::vector<double> planned_acceleration(const MachineDescription& machine, const Kinematics& kinematics,
                                         const Excitation& excitation, double period_s) {
  MachineDescription plain = machine;
  plain.vibration = {};
  StringSource text(excitation_job(plain, excitation));
  std::vector<double> speeds;
  double start_s = 0;
  for_each_phase(plain, kinematics, text, 0, [&](const Phase& phase) {
    for (; static_cast<double>(speeds.size()) * period_s < start_s + phase.duration_s;)
      speeds.push_back(phase.at(static_cast<double>(speeds.size()) * period_s - start_s).x1[excitation.axis]);
    start_s += phase.duration_s;
  });
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i) speeds[i] = (speeds[i + 1] - speeds[i]) / period_s;
  if (!speeds.empty()) speeds.pop_back();
  return speeds;
}

}  // namespace kinebus
