#pragma once
// Whether a heater that nobody has measured still warms as it did. The fastest that it ever became warmer is
// about what full power does; what is short of that, its losses take, and those grow slowly. A cartridge that
// slips out of its hole is short of nearly all of it at once, and gets red hot while it is.

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinebus::heat {

class HeatingPace {
 public:
  /// `rise_s`: WatchSettings'. All times of this rule are shares of it; it is longer than dead time and lag.
  void configure(std::uint16_t rise_s) { step_ticks_ = rise_s < 4 ? 2u : rise_s / 2u; }
  /// Nothing is known of what was before.
  void start();
  /// Once a tick. `power`: given since the last one. `most`: parts of kFullPower that what is around it may
  /// begin to take. True: more than that is missing.
  bool step(std::int32_t measured, std::uint32_t power, std::int32_t most);

 private:
  static constexpr std::size_t kSteps = 20;  // in rise_s
  static constexpr std::size_t kSlope = 5;  // of them make a slope: noise and the converter's steps are small
  static constexpr std::size_t kBack = 10;  // so long ago a fault that shows now had not begun to show
  struct Step {
    std::int32_t measured = 0;  // mC, a mean
    std::uint32_t least = 0;    // of the power
    std::int32_t taken = 0;     // parts of kFullPower that warmed nothing
  };
  const Step& before(std::size_t steps) const { return steps_[(at_ + kSteps - steps) % kSteps]; }
  bool judge(std::int32_t most);

  std::uint32_t step_ticks_ = 10;
  std::array<Step, kSteps> steps_{};
  std::size_t at_ = 0, seen_ = 0, judged_ = 0;
  std::int64_t sum_ = 0;
  std::uint32_t ticks_ = 0, least_ = 0, missing_ = 0;
  std::int32_t gain_ = 0;    // mC over a slope: the fastest so far
  std::int32_t lowest_ = 0;  // mC
  std::int32_t usual_ = 0;   // taken, the most of late
};

}  // namespace kinebus::heat
