#include "tools/simulation/bead_reference.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/simulation/planned_phases.hpp"

namespace kinebus {
namespace {

constexpr double kTick_s = 1e-3;
constexpr int kHalfWindow = 20;  // ticks: smooth_time is 40 ms
constexpr std::size_t kHistory = 256;

/// Of the plan, each tick.
struct Point {
  std::array<double, 3> tip{};
  double e = 0, flow = 0;  ///< flow: where a move of X or Y extrudes
  std::uint32_t line = 0;
};

double tool_path(const Phase& phase) {
  const Pose a = phase.at(0).x, m = phase.at(0.5 * phase.duration_s).x, b = phase.at(phase.duration_s).x;
  const auto far = [](const Pose& p, const Pose& q) {
    return std::hypot(q[kX] - p[kX], q[kY] - p[kY], q[kZ] - p[kZ]);
  };
  return far(a, m) + far(m, b);
}

class Klipper {
 public:
  Klipper(double advance_s, const VibrationDescription& vibration, const Nozzle::Truth& truth,
          const BeadLines& lines)
      : advance_s_(advance_s), smoothed_(truth, lines), plain_(truth, lines), history_(kHistory) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      AxisVibration v = vibration.axis(axis);
      if (v.frequency_hz == 0) v = {ShaperKind::kMzv, 45, 0.1};
      const double root = std::sqrt(1 - v.damping_ratio * v.damping_ratio);
      const double k = std::exp(-0.75 * v.damping_ratio * std::numbers::pi / root);
      const double period_s = 1 / (v.frequency_hz * root);
      const double a = 1 - 1 / std::numbers::sqrt2;
      const std::array<double, 3> weights{a, (std::numbers::sqrt2 - 1) * k, a * k * k};
      const double sum = weights[0] + weights[1] + weights[2];
      double mean_s = 0;
      for (std::size_t i = 0; i < 3; ++i)
        mean_s += weights[i] / sum * 0.375 * static_cast<double>(i) * period_s;
      for (std::size_t i = 0; i < 3; ++i)
        pulses_[axis][i] = {0.375 * static_cast<double>(i) * period_s - mean_s, weights[i] / sum};
    }
  }

  void take(const Point& point) {
    if (count_ == 0)
      for (Point& p : history_) p = {point.tip, point.e, 0, point.line};
    history_[count_++ % kHistory] = point;
    plain_.move_to(point.tip, point.e, point.line, kTick_s);
    lay();
  }
  /// The tool rests for as long as it takes until all is out.
  void finish() {
    Point rest = history_[(count_ - 1) % kHistory];
    rest.flow = 0;
    for (std::size_t i = 0; i < kHistory; ++i) {
      history_[count_++ % kHistory] = rest;
      lay();
    }
  }
  const BeadMeter& smoothed() const { return smoothed_; }
  const BeadMeter& plain() const { return plain_; }

 private:
  const Point& at(int ticks) const {  // from the middle of the history
    return history_[(count_ + kHistory / 2 + static_cast<std::size_t>(ticks + static_cast<int>(kHistory))) %
                    kHistory];
  }
  double place(std::size_t axis, double seconds) const {
    const double ticks = seconds / kTick_s, whole = std::floor(ticks);
    const double a = at(static_cast<int>(whole)).tip[axis], b = at(static_cast<int>(whole) + 1).tip[axis];
    return a + (ticks - whole) * (b - a);
  }
  void lay() {
    Point out = at(0);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      out.tip[axis] = 0;
      for (const auto& [time_s, weight] : pulses_[axis]) out.tip[axis] += weight * place(axis, -time_s);
    }
    out.e = 0;
    double sum = 0;
    for (int i = -kHalfWindow; i <= kHalfWindow; ++i) {
      const double weight = kHalfWindow - std::abs(i);
      out.e += weight * (at(i).e + advance_s_ * at(i).flow);
      sum += weight;
    }
    smoothed_.move_to(out.tip, out.e / sum, out.line, kTick_s);
  }

  double advance_s_;
  BeadMeter smoothed_, plain_;
  std::array<std::array<std::array<double, 2>, 3>, 2> pulses_{};  ///< X, Y: time s, weight
  std::vector<Point> history_;
  std::size_t count_ = 0;
};

}  // namespace

BeadReference bead_reference(const MachineDescription& machine,
                             const std::function<std::unique_ptr<ByteSource>()>& open,
                             const Nozzle::Truth& truth, double limit_s) {
  BeadReference reference;
  MachineDescription plain = machine;
  plain.vibration = {};
  plain.pressure_advance = {};
  const auto kinematics = make_kinematics(plain);
  if (!kinematics) return reference;
  auto text = open();
  for_each_phase(plain, **kinematics, *text, limit_s, [&](const Phase& phase) {
    const double length = tool_path(phase);
    const double filament = phase.at(phase.duration_s).x[kE] - phase.at(0).x[kE];
    reference.lines.add(phase.line, length, std::max(0.0, filament));
    reference.time_s += phase.duration_s;
  });
  const AdvanceModel& known = machine.pressure_advance;
  const double usual = Nozzle::Truth::kUsual_mm_per_s;
  const double advance_s = known.acts() ? known.at(usual) / usual : 0.04;
  Klipper klipper(advance_s, machine.vibration, truth, reference.lines);
  text = open();
  double start_s = 0;
  std::uint64_t ticks = 0;
  for_each_phase(plain, **kinematics, *text, limit_s, [&](const Phase& phase) {
    for (; static_cast<double>(ticks) * kTick_s < start_s + phase.duration_s; ++ticks) {
      const PosePoint p = phase.at(static_cast<double>(ticks) * kTick_s - start_s);
      const bool prints = p.x1[kE] > 0 && std::hypot(p.x1[kX], p.x1[kY]) > 0;
      klipper.take({{p.x[kX], p.x[kY], p.x[kZ]}, p.x[kE], prints ? p.x1[kE] : 0, phase.line});
    }
    start_s += phase.duration_s;
  });
  if (ticks > 0) klipper.finish();
  reference.klipper = {klipper.smoothed().rms(), klipper.smoothed().worst()};
  reference.plain = {klipper.plain().rms(), klipper.plain().worst()};
  return reference;
}

}  // namespace kinebus
