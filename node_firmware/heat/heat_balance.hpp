#pragma once
// What heat the block really gains against what the model says, by the sensor alone: its lag is undone, so
// that a heater which came loose shows a dead time and some ticks later. The model's observer, which control
// goes by, needs its own lag on top of that.

#include <array>
#include <cstddef>
#include <cstdint>

#include "node_firmware/heat/thermal_model.hpp"

namespace kinebus::heat {

class HeatBalance {
 public:
  /// Parts of kFullPower.
  struct Share {
    std::int32_t unexplained = 0;  ///< so much more heat comes than the model knows; negative: is missing
    std::int32_t before = 0;       ///< the model's disturbance of before that time
    std::int32_t power = 0;        ///< that should have come, a mean
    std::int32_t spread =
        0;  ///< of that power meanwhile: a dead time or lag that is wrong makes a part of it
  };

  /// Ticks that are taken together: so many that noise and the converter's steps stay small after the lag is
  /// undone. 0: this model's lag is too long for its rate.
  void configure(const ThermalModel& model);
  /// Nothing is known of what was before.
  void start() { seen_ = in_step_ = 0; }
  /// Once a tick, after the model's step; true: share() is new.
  bool step(std::int32_t measured, const ThermalModel& model);
  const Share& share() const { return share_; }

 private:
  static constexpr std::size_t kSpan = 4;  // steps between two temperatures that make a slope
  static constexpr std::size_t kKept = 4 * kSpan;
  static constexpr std::uint32_t kMostTicks = 16;
  struct Step {
    std::int32_t measured = 0;     // mC, a mean, 4 fractional bits
    std::int32_t expected = 0;     // what the block gains a tick: mC, 8 fractional bits
    std::int32_t disturbance = 0;  // parts of kFullPower
    std::int32_t least = 0, most = 0, power = 0;
  };
  const Step& before(std::size_t steps) const { return steps_[(at_ - steps) & (kKept - 1)]; }
  void judge(const ThermalModel& model);

  std::array<Step, kKept> steps_{};
  std::size_t at_ = 0;
  std::uint32_t seen_ = 0;  // steps
  std::uint32_t ticks_ = 0, in_step_ = 0;
  std::int64_t measured_sum_ = 0, expected_sum_ = 0, power_sum_ = 0;
  Step now_{};
  Share share_{};
};

}  // namespace kinebus::heat
