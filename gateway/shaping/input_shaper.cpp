#include "gateway/shaping/input_shaper.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace kinebus {
namespace {

/// `spacing`: of the pulses, in damped periods. Each pulse is weakened by what the vibration of the first has
/// lost until then.
InputShaper spaced(std::span<const double> undamped, double spacing, double frequency_hz,
                   double damping_ratio) {
  const double root = std::sqrt(1 - damping_ratio * damping_ratio);
  const double step_s = spacing / (frequency_hz * root);
  const double loss = std::exp(-2 * std::numbers::pi * spacing * damping_ratio / root);
  InputShaper shaper;
  shaper.count = undamped.size();
  double sum = 0, factor = 1;
  for (std::size_t i = 0; i < shaper.count; ++i, factor *= loss) {
    shaper.pulses[i] = {static_cast<double>(i) * step_s, undamped[i] * factor};
    sum += shaper.pulses[i].weight;
  }
  for (std::size_t i = 0; i < shaper.count; ++i) shaper.pulses[i].weight /= sum;
  return shaper;
}

}  // namespace

double InputShaper::mean_s() const {
  double mean = 0;
  for (const Pulse& p : all()) mean += p.weight * p.time_s;
  return mean;
}

double InputShaper::variance_s2() const {
  const double mean = mean_s();
  double variance = 0;
  for (const Pulse& p : all()) variance += p.weight * (p.time_s - mean) * (p.time_s - mean);
  return variance;
}

InputShaper make_shaper(ShaperKind kind, double frequency_hz, double damping_ratio) {
  assert(kind == ShaperKind::kNone || (frequency_hz > 0 && damping_ratio >= 0 && damping_ratio < 1));
  constexpr double v = kShaperTolerance;
  const auto of = [&](std::span<const double> weights, double spacing) {
    return spaced(weights, spacing, frequency_hz, damping_ratio);
  };
  switch (kind) {
    case ShaperKind::kNone:
      break;
    case ShaperKind::kZv:
      return of(std::array{1.0, 1.0}, 0.5);
    case ShaperKind::kMzv:
      return of(std::array{1.0, std::numbers::sqrt2, 1.0}, 0.375);
    case ShaperKind::kZvd:
      return of(std::array{1.0, 2.0, 1.0}, 0.5);
    case ShaperKind::kZvdd:
      return of(std::array{1.0, 3.0, 3.0, 1.0}, 0.5);
    case ShaperKind::kZvddd:
      return of(std::array{1.0, 4.0, 6.0, 4.0, 1.0}, 0.5);
    case ShaperKind::kEi:
      return of(std::array{(1 + v) / 4, (1 - v) / 2, (1 + v) / 4}, 0.5);
    case ShaperKind::kTwoHump: {
      const double x = std::cbrt(v * v * (std::sqrt(1 - v * v) + 1));
      const double outer = (3 * x * x + 2 * x + 3 * v * v) / (16 * x);
      return of(std::array{outer, 0.5 - outer, 0.5 - outer, outer}, 0.5);
    }
    case ShaperKind::kThreeHump: {
      const double outer = (1 + 3 * v + 2 * std::sqrt(2 * v * (v + 1))) / 16;
      const double inner = (1 - v) / 4;
      return of(std::array{outer, inner, 1 - 2 * (outer + inner), inner, outer}, 0.5);
    }
  }
  return {};
}

double residual_vibration(const InputShaper& shaper, double frequency_hz, double damping_ratio) {
  const double w = 2 * std::numbers::pi * frequency_hz;
  const double damped = w * std::sqrt(1 - damping_ratio * damping_ratio);
  double cosine = 0, sine = 0;
  for (const InputShaper::Pulse& p : shaper.all()) {
    const double grown = p.weight * std::exp(damping_ratio * w * p.time_s);
    cosine += grown * std::cos(damped * p.time_s);
    sine += grown * std::sin(damped * p.time_s);
  }
  return std::exp(-damping_ratio * w * shaper.duration_s()) * std::hypot(cosine, sine);
}

double frequency_for_rates(ShaperKind kind, double frequency_hz, double damping_ratio, double slowest_rate) {
  if (kind == ShaperKind::kNone || slowest_rate >= 1 || slowest_rate <= 0) return frequency_hz;
  constexpr double kFrequencyError = 0.1, kCoarse = 0.04, kFine = 0.005, kMostScale = 1.5;
  constexpr int kRates = 14;
  const auto worst_at = [&](double scale) {
    const InputShaper shaper = make_shaper(kind, scale * frequency_hz, damping_ratio);
    double worst = 0;
    for (int i = 0; i <= kRates; ++i) {
      const double rate = slowest_rate + (1 - slowest_rate) * i / kRates;
      for (const double error : {1 - kFrequencyError, 1.0, 1 + kFrequencyError})
        worst = std::max(worst, residual_vibration(shaper, frequency_hz * error / rate, damping_ratio));
    }
    return worst;
  };
  const auto best_of = [&](double from, double to, double step) {
    double best = from, least = worst_at(from);
    for (double scale = from + step; scale <= to; scale += step) {
      const double worst = worst_at(scale);
      if (worst >= least) continue;
      least = worst;
      best = scale;
    }
    return best;
  };
  const double coarse = best_of(1, kMostScale / slowest_rate, kCoarse);
  return frequency_hz * best_of(std::max(1.0, coarse - kCoarse), coarse + kCoarse, kFine);
}

}  // namespace kinebus
