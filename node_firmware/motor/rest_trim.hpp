#pragma once
// Brings a resting rotor onto its command to less than a step of its encoder. The angle of the current swings
// a little to both sides, slowly: friction then holds the rotor nowhere for long, and the mean of the encoder
// over a swing is finer than its step. What is measured becomes trim; then the swing dies away, and the rotor
// stays in the middle of what friction would allow. Afterwards it only watches.

#include <algorithm>
#include <cstdint>

#include "node_firmware/motor/sine.hpp"

namespace kinebus::motor {

class RestTrim {
 public:
  /// Counts to each side: more than friction holds back at a usual hold current, 1/43 of a full step.
  static constexpr int kSwingCounts = 6;
  /// A swing: 2^9 control periods, 25.6 ms. Of a whole settling: the first is not measured, four are, eight
  /// die away.
  static constexpr int kSwingBits = 9, kSwingPeriods = 1 << kSwingBits;
  static constexpr int kMeasuredUntil = 5, kStillFrom = 13;
  /// A settled rotor that is further off has been pushed away: one and a half steps of the encoder.
  static constexpr std::int32_t kAgain = 75 * kAnglePerCount / 16;

  struct Step {
    std::int32_t swing = 0;   ///< to be added to the angle; in its unit, as all here
    std::int32_t change = 0;  ///< by which the trim grows now
    bool measured = false;    ///< the last of the measured swings has just ended
  };

  /// Instead of step(), when the rotor is not to be settled: what is left of the swing, fading.
  std::int32_t leave() {
    cycle_ = period_ = 0;
    sum_ = 0;
    swing_ -= std::clamp(swing_, -kFade, kFade);
    return swing_;
  }
  /// Each control period at rest under a steady current. `error`: command less encoder.
  Step step(std::int32_t error) {
    Step now;
    sum_ += error;
    now.swing = swing_ = cycle_ < kStillFrom ? swing() : 0;
    if (++period_ < kSwingPeriods) return now;
    const auto mean = static_cast<std::int32_t>(sum_ >> kSwingBits);
    sum_ = 0;
    period_ = 0;
    if (cycle_ >= kStillFrom) {
      if (mean > kAgain || mean < -kAgain) cycle_ = 0;
      return now;
    }
    // Three quarters: the rotor answers a little late, and must not be chased over the goal.
    if (cycle_ > 0 && cycle_ < kMeasuredUntil) now.change = mean - (mean >> 2);
    ++cycle_;
    now.measured = cycle_ == kMeasuredUntil;
    return now;
  }

 private:
  std::int32_t swing() const {
    constexpr int kQuarter = kSwingPeriods / 4;
    // A triangle: 0, +quarter, 0, -quarter.
    const int folded = period_ < kQuarter ? period_ : 2 * kQuarter - period_;
    const int height = folded < -kQuarter ? -2 * kQuarter - folded : folded;
    constexpr int kDyingPeriods = (kStillFrom - kMeasuredUntil) << kSwingBits;
    const int left =
        cycle_ < kMeasuredUntil ? kDyingPeriods : ((kStillFrom - cycle_) << kSwingBits) - period_;
    constexpr int kUnit = kSwingCounts * kAnglePerCount / (kQuarter * kDyingPeriods);
    return kUnit * (height * left);
  }

  static constexpr std::int32_t kFade = kSwingCounts * kAnglePerCount / (kSwingPeriods / 4);
  std::int64_t sum_ = 0;
  std::int32_t swing_ = 0;
  int cycle_ = 0, period_ = 0;
};

}  // namespace kinebus::motor
