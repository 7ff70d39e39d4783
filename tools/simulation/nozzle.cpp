#include "tools/simulation/nozzle.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace kinebus {

Nozzle::Truth Nozzle::truth(const AdvanceModel& assumed, double error, std::uint64_t seed) {
  Truth truth;
  const double usual = Truth::kUsual_mm_per_s;
  const double press_s = assumed.acts() ? assumed.at(usual) / usual : 0.04;
  constexpr double kMeltShare = 0.15;  // where nobody has measured it
  const double melt_s = assumed.melt_s > 0 ? assumed.melt_s : kMeltShare * press_s;
  truth.press_s = press_s * (1 + (seed % 2 == 0 ? -error : error));
  truth.melt_s = melt_s * (1 + (seed / 2 % 2 == 0 ? -3 * error : 3 * error));
  return truth;
}

Nozzle::Truth Nozzle::hidden(std::uint64_t seed) {
  std::mt19937_64 random(seed ^ 0xA54FF53A5F1D36F1ULL);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
  };
  Truth truth;
  truth.press_s = between(0.025, 0.085);
  truth.melt_s = between(0.08, 0.2) * truth.press_s;
  truth.power = between(0.82, 0.98);
  return truth;
}

double Nozzle::secant_s(const Truth& truth, double from, double to) {
  const auto pressed = [&truth](double flow) {
    return truth.press_s * Truth::kUsual_mm_per_s * std::pow(flow / Truth::kUsual_mm_per_s, truth.power);
  };
  return (pressed(to) - pressed(from)) / (to - from);
}

double Nozzle::feed(double fed_mm, double dt_s) {
  constexpr double kStep_s = 1e-4;
  const int steps = std::max(1, static_cast<int>(std::ceil(dt_s / kStep_s)));
  const double dt = dt_s / steps, usual = Truth::kUsual_mm_per_s;
  const double follows = 1 - std::exp(-dt / truth_.melt_s);
  double out = 0;
  for (int i = 0; i < steps; ++i) {
    pressed_ += fed_mm / steps;
    const double driven =
        pressed_ > 0 ? usual * std::pow(pressed_ / (truth_.press_s * usual), 1 / truth_.power) : 0;
    flow_ += follows * (driven - flow_);
    const double left = std::clamp(1 + pressed_ / truth_.void_mm, 0.0, 1.0);
    const double step = (flow_ + truth_.ooze_mm_per_s * left) * dt;
    pressed_ -= step;
    out += step;
  }
  return out;
}

}  // namespace kinebus
