#include "tools/tune/tune_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "tools/simulation/simulate.hpp"

namespace kinebus {
namespace {

constexpr double kReading_mm = 0.01;

}  // namespace

PatternMeter::PatternMeter(const PressurePattern& pattern)
    : pattern_(pattern), lines_(static_cast<std::size_t>(pattern.lines)) {
  const double up = pattern.speeds_up_mm(), down = pattern.slows_down_mm() - kBrakes_mm;
  for (auto& line : lines_)
    line = {{{up, kWidthOver_mm, 0, 0},
             {down, kWidthOver_mm, 0, 0},
             {up + kNearBehind_mm, kNear_mm, 0, 0},
             {pattern.slows_down_mm() - kNearBefore_mm, kNear_mm, 0, 0}}};
}

void PatternMeter::add(const Pose& pose, double laid) {
  const double length = std::hypot(pose[kX] - last_[kX], pose[kY] - last_[kY]);
  const double row = (pose[kY] - pattern_.line_y_mm(0)) / pattern_.pitch_mm;
  const auto line = static_cast<std::ptrdiff_t>(std::lround(row));
  const bool prints = placed_ && std::abs(row - static_cast<double>(line)) < 0.01 &&
                      std::abs(pose[kZ] - pattern_.height_mm) < 0.05 && pose[kX] > last_[kX];
  if (prints && line >= 0 && line < pattern_.lines)
    for (Stretch& stretch : lines_[static_cast<std::size_t>(line)]) {
      if (pose[kX] < stretch.from_mm || pose[kX] >= stretch.from_mm + stretch.over_mm) continue;
      stretch.laid_mm += laid;
      stretch.length_mm += length;
    }
  last_ = pose;
  placed_ = true;
}

double PatternMeter::width(const Stretch& stretch) const {
  if (!(stretch.length_mm > 0)) return 0;
  return pattern_.width_mm * stretch.laid_mm / (stretch.length_mm * pattern_.filament_per_mm());
}

std::vector<LineWidths> PatternMeter::widths() const {
  std::vector<LineWidths> all;
  for (const auto& [faster, slower, faster_near, slower_near] : lines_)
    all.push_back({pattern_.advance_s(static_cast<int>(all.size())), width(faster), width(slower),
                   width(faster_near), width(slower_near)});
  return all;
}

Result<std::vector<LineWidths>, std::string> print_simulated(const MachineDescription& machine,
                                                             const PressurePattern& pattern,
                                                             const Nozzle::Truth& truth, std::uint64_t seed) {
  const std::string text = (pattern.hotend_celsius > 0 ? "" : "M104 S210\n") + pattern_job(pattern);
  Nozzle nozzle(truth);
  PatternMeter meter(pattern);
  SimulateOptions options;
  options.simulation.seed = seed;
  const double dt_s = to_seconds(options.simulation.sample_period);
  std::optional<double> fed;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    const double e = sample.pose[kE];
    meter.add(sample.pose, fed ? nozzle.feed(e - *fed, dt_s) : 0);
    fed = e;
  };
  StringSource same(text);
  const SimulationReport report = simulate(machine, std::make_unique<StringSource>(text), same, options);
  if (!report.finished)
    return Error<std::string>(report.outcome +
                              (report.messages.empty() ? "" : ": " + report.messages.front()));
  std::mt19937_64 random(seed ^ 0x510E527FADE682D1ULL);
  std::normal_distribution<double> off(0, kReading_mm);
  std::vector<LineWidths> widths = meter.widths();
  for (LineWidths& w : widths)
    for (double* width : {&w.faster_mm, &w.slower_mm, &w.faster_near_mm, &w.slower_near_mm})
      *width = std::max(0.0, kReading_mm * std::round((*width + off(random)) / kReading_mm));
  return widths;
}

}  // namespace kinebus
