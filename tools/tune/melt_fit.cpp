#include "tools/tune/melt_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "gateway/jobs/machine_setup.hpp"
#include "tools/simulation/planned_phases.hpp"
#include "tools/tune/tune_pressure.hpp"

namespace kinebus {
namespace {

constexpr double kSample_s = 0.5e-3;
constexpr double kLeast_s = 0.5e-3, kMost_s = 0.06;
constexpr std::size_t kLines = 5;
constexpr int kRounds = 3;
/// Melt flows the easier the faster it is pushed: of usual filaments, 0.8 to 1.
constexpr double kPower = 0.9;

std::vector<Pose> planned(const MachineDescription& machine, const PressurePattern& pattern) {
  std::vector<Pose> poses;
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) return poses;
  PressurePattern cold = pattern;
  cold.hotend_celsius = cold.bed_celsius = 0;
  StringSource text("M104 S210\n" + pattern_job(cold));
  double start_s = 0;
  for_each_phase(machine, **kinematics, text, 0, [&](const Phase& phase) {
    for (; static_cast<double>(poses.size()) * kSample_s < start_s + phase.duration_s;)
      poses.push_back(phase.at(static_cast<double>(poses.size()) * kSample_s - start_s).x);
    start_s += phase.duration_s;
  });
  return poses;
}

/// How much wider a line is right behind its slowing down than behind its speeding up.
double uneven(const LineWidths& widths) {
  return widths.slower_near_mm - widths.faster_near_mm;
}

class Model {
 public:
  /// The advance found is that between the pattern's two flows.
  Model(const std::vector<Pose>& poses, const PressurePattern& pattern, double advance_s)
      : poses_(poses), pattern_(pattern) {
    const double slow = pattern.slow_mm_per_s * pattern.filament_per_mm();
    const double fast = pattern.fast_mm_per_s * pattern.filament_per_mm();
    const double rise = std::pow(fast, kPower) - std::pow(slow, kPower);
    per_pressed_ = rise / (advance_s * (fast - slow));
  }
  std::vector<LineWidths> widths(double melt_s) const {
    // Exact for a pressure that holds over a step.
    constexpr int kSteps = 4;
    const double dt = kSample_s / kSteps, follows = 1 - std::exp(-dt / melt_s);
    PatternMeter meter(pattern_);
    double pressed = 0, flow = 0, fed = poses_.front()[kE];
    for (const Pose& pose : poses_) {
      double out = 0;
      for (int i = 0; i < kSteps; ++i) {
        pressed += (pose[kE] - fed) / kSteps;
        flow += follows * (std::pow(std::max(0.0, pressed) * per_pressed_, 1 / kPower) - flow);
        pressed -= flow * dt;
        out += flow * dt;
      }
      fed = pose[kE];
      meter.add(pose, out);
    }
    return meter.widths();
  }

 private:
  const std::vector<Pose>& poses_;
  const PressurePattern& pattern_;
  double per_pressed_ = 0;  ///< flow^kPower by what is pressed together
};

}  // namespace

namespace {

/// What the model's lines are more uneven than those measured, mm, each.
std::vector<double> excesses(const std::vector<LineWidths>& lines, const std::vector<LineWidths>& model) {
  std::vector<double> by;
  for (const LineWidths& line : lines)
    for (const LineWidths& w : model)
      if (std::abs(w.advance_s - line.advance_s) < 1e-5) by.push_back(uneven(w) - uneven(line));
  return by;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// How uneven lines are grows with T: their mean has one root. None above kMost_s: nullopt.
std::optional<double> melt_of(const Model& model, const std::vector<LineWidths>& lines) {
  double low = kLeast_s, high = kMost_s;
  if (mean(excesses(lines, model.widths(low))) > 0) return 0;
  if (mean(excesses(lines, model.widths(high))) < 0) return std::nullopt;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (mean(excesses(lines, model.widths(middle))) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Result<MeltChoice, std::string> choose_melt(const MachineDescription& machine, const PressurePattern& pattern,
                                            const std::vector<LineWidths>& widths, double advance_s) {
  std::vector<LineWidths> lines;
  for (const LineWidths& w : widths)
    if (w.near()) lines.push_back(w);
  std::sort(lines.begin(), lines.end(), [&](const LineWidths& a, const LineWidths& b) {
    return std::abs(a.advance_s - advance_s) < std::abs(b.advance_s - advance_s);
  });
  lines.resize(std::min(lines.size(), kLines));
  const std::vector<Pose> poses = planned(machine, pattern);
  if (poses.empty()) return Error<std::string>("this machine cannot print the pattern");
  MeltChoice choice{.advance_s = advance_s};
  // The widths of a melt of this very advance cross a little elsewhere: speeds change over some way.
  for (int i = 0; i < kRounds; ++i) {
    const Model model(poses, pattern, choice.advance_s);
    std::vector<double> off = excesses(lines, model.widths(kLeast_s));
    if (off.size() < 3)
      return Error<std::string>(
          "at least three lines of the pattern have to be measured near their changes of speed");
    const auto melt_s = melt_of(model, lines);
    if (!melt_s)
      return Error<std::string>(
          "the lines are more uneven near the changes of speed than late melt explains");
    choice.melt_s = *melt_s;
    if (choice.melt_s == 0) return choice;
    const std::vector<LineWidths> all = model.widths(choice.melt_s);
    off = excesses(lines, all);
    double squares = 0;
    for (const double by : off) squares += by * by;
    const double step_s = 0.2 * choice.melt_s;
    const double slope = (mean(excesses(lines, model.widths(choice.melt_s + step_s))) - mean(off)) / step_s;
    choice.sigma_s = slope > 0 ? std::sqrt(squares) / static_cast<double>(off.size()) / slope : 0;
    if (const auto crosses = choose_advance(all); crosses && i + 1 < kRounds)
      choice.advance_s *= advance_s / crosses->advance_s;
  }
  return choice;
}

double shortest_window_s(const MachineDescription& machine, const PressurePattern& pattern) {
  constexpr double kShortest_s = 0.006, kStep_s = 0.001;
  AdvanceModel model = machine.pressure_advance;
  const double needed = pattern.filament_per_mm() * machine.path.tool_accel_mm_per_s2;
  for (model.smooth_s = kShortest_s; model.smooth_s < machine.pressure_advance.smooth_s;
       model.smooth_s += kStep_s)
    if (limits_before_advance(machine, machine.vibration, model, AdvanceWindow(model)).flow_accel_mm_per_s2 >=
        needed)
      return model.smooth_s;
  return machine.pressure_advance.smooth_s;
}

}  // namespace kinebus
