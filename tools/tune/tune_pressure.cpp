#include "tools/tune/tune_pressure.hpp"

#include <cmath>
#include <random>

#include "tools/simulation/simulate.hpp"

namespace kinebus {
namespace {

constexpr double kReading_mm = 0.01;

/// Filament and way within a stretch of a line.
struct Stretch {
  double from_mm = 0;
  double laid_mm = 0, length_mm = 0;
  void add(double x_mm, double laid, double length) {
    if (x_mm < from_mm || x_mm >= from_mm + kWidthOver_mm) return;
    laid_mm += laid;
    length_mm += length;
  }
};

}  // namespace

Result<std::vector<LineWidths>, std::string> print_simulated(const MachineDescription& machine,
                                                             const PressurePattern& pattern,
                                                             const Nozzle::Truth& truth, std::uint64_t seed) {
  const std::string text = (pattern.hotend_celsius > 0 ? "" : "M104 S210\n") + pattern_job(pattern);
  Nozzle nozzle(truth);
  std::vector<std::array<Stretch, 2>> lines(static_cast<std::size_t>(pattern.lines));
  for (auto& [faster, slower] : lines) {
    faster.from_mm = pattern.speeds_up_mm();
    slower.from_mm = pattern.slows_down_mm() - kBrakes_mm;
  }
  SimulateOptions options;
  options.simulation.seed = seed;
  const double dt_s = to_seconds(options.simulation.sample_period);
  bool placed = false;
  Pose last{};
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    const Pose pose = sample.pose;
    const double out = placed ? nozzle.feed(pose[kE] - last[kE], dt_s) : 0;
    const double length = std::hypot(pose[kX] - last[kX], pose[kY] - last[kY]);
    const double row = (pose[kY] - pattern.line_y_mm(0)) / pattern.pitch_mm;
    const auto line = static_cast<std::ptrdiff_t>(std::lround(row));
    const bool prints = placed && std::abs(row - static_cast<double>(line)) < 0.01 &&
                        std::abs(pose[kZ] - pattern.height_mm) < 0.05 && pose[kX] > last[kX];
    if (prints && line >= 0 && line < pattern.lines)
      for (Stretch& stretch : lines[static_cast<std::size_t>(line)]) stretch.add(pose[kX], out, length);
    last = pose;
    placed = true;
  };
  StringSource same(text);
  const SimulationReport report = simulate(machine, std::make_unique<StringSource>(text), same, options);
  if (!report.finished)
    return Error<std::string>(report.outcome +
                              (report.messages.empty() ? "" : ": " + report.messages.front()));
  std::mt19937_64 random(seed ^ 0x510E527FADE682D1ULL);
  std::normal_distribution<double> off(0, kReading_mm);
  std::vector<LineWidths> widths;
  for (int i = 0; i < pattern.lines; ++i) {
    const auto read = [&](const Stretch& stretch) {
      if (!(stretch.length_mm > 0)) return 0.0;
      const double width =
          pattern.width_mm * stretch.laid_mm / (stretch.length_mm * pattern.filament_per_mm());
      return std::max(0.0, kReading_mm * std::round((width + off(random)) / kReading_mm));
    };
    const auto& [faster, slower] = lines[static_cast<std::size_t>(i)];
    widths.push_back({pattern.advance_s(i), read(faster), read(slower)});
  }
  return widths;
}

}  // namespace kinebus
