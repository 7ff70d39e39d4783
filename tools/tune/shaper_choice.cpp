#include "tools/tune/shaper_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gateway/description/machine_schema.hpp"

namespace kinebus {
namespace {

constexpr std::array kCandidates = {ShaperKind::kZv,        ShaperKind::kMzv,  ShaperKind::kZvd,
                                    ShaperKind::kEi,        ShaperKind::kZvdd, ShaperKind::kTwoHump,
                                    ShaperKind::kThreeHump, ShaperKind::kZvddd};
constexpr double kFrequencyError = 0.1;

double worst_left(const InputShaper& shaper, const ShaperQuestion& question) {
  constexpr int kRates = 10;
  const bool slows = question.slowest_rate > 0 && question.slowest_rate < 1;
  double worst = 0;
  for (int i = 0; i <= (slows ? kRates : 0); ++i) {
    const double rate = slows ? question.slowest_rate + (1 - question.slowest_rate) * i / kRates : 1;
    for (const std::vector<FittedMode>& modes : question.axes)
      for (const double error :
           {1 - kFrequencyError, 1 - kFrequencyError / 2, 1.0, 1 + kFrequencyError / 2, 1 + kFrequencyError})
        worst = std::max(worst, vibration_left(shaper, modes, error / rate));
  }
  return worst;
}

}  // namespace

double vibration_left(const InputShaper& shaper, const std::vector<FittedMode>& modes, double error) {
  double left = 0, all = 0;
  for (const FittedMode& m : modes) {
    // A step of the acceleration moves a spring by a / w^2.
    const double swing = m.share / (m.frequency_hz * m.frequency_hz);
    all += swing;
    left += swing * residual_vibration(shaper, m.frequency_hz * error, m.damping_ratio);
  }
  return left / all;
}

std::vector<ShaperRating> rate_shapers(const ShaperQuestion& question) {
  double low_hz = 1e9, high_hz = 0, damping = 0;
  for (const std::vector<FittedMode>& modes : question.axes) {
    low_hz = std::min(low_hz, modes[0].frequency_hz);
    high_hz = std::max(high_hz, modes[0].frequency_hz);
    damping += modes[0].damping_ratio / static_cast<double>(question.axes.size());
  }
  // As the machine file takes them.
  damping = std::clamp(damping, 0.0, 0.5);
  std::vector<ShaperRating> ratings;
  for (const ShaperKind kind : kCandidates) {
    ShaperRating best{.kind = kind, .damping_ratio = damping, .left = 1e9};
    const double step_hz = std::max(0.01 * low_hz, 1e-3);
    for (double f = low_hz; f <= high_hz + 1e-9; f += step_hz) {
      const InputShaper shaper =
          make_shaper(kind, frequency_for_rates(kind, f, damping, question.slowest_rate), damping);
      const double left = worst_left(shaper, question);
      if (left >= best.left) continue;
      best.left = left;
      best.frequency_hz = f;
      best.left_as_measured = 0;
      for (const std::vector<FittedMode>& modes : question.axes)
        best.left_as_measured = std::max(best.left_as_measured, vibration_left(shaper, modes, 1));
      best.deviation_mm = 0.5 * question.accel_mm_per_s2 * shaper.variance_s2();
      best.accel_mm_per_s2 =
          question.deviation_mm > 0
              ? std::min(question.accel_mm_per_s2, 2 * question.deviation_mm / shaper.variance_s2())
              : question.accel_mm_per_s2;
    }
    ratings.push_back(best);
  }
  return ratings;
}

const ShaperRating& best_shaper(const std::vector<ShaperRating>& ratings) {
  const ShaperRating* best = nullptr;
  for (const ShaperRating& r : ratings)
    if (r.left <= kMostLeft && (best == nullptr || r.deviation_mm < best->deviation_mm)) best = &r;
  if (best != nullptr) return *best;
  return *std::min_element(ratings.begin(), ratings.end(),
                           [](const ShaperRating& a, const ShaperRating& b) { return a.left < b.left; });
}

std::string_view shaper_name(ShaperKind kind) {
  for (const machine_schema::Choice& choice : machine_schema::kShapers)
    if (choice.value == static_cast<int>(kind)) return choice.word;
  return "none";
}

}  // namespace kinebus
