#pragma once
// Local time: a counter of the board that goes round every 18 minutes. Interrupts note its 32 bits; the main
// loop, which alone keeps the 64-bit time, makes times of them.

#include <concepts>
#include <cstdint>

#include "node_firmware/core/motion_plan.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// Free-running, in kPlanCount (250 ns) steps.
template <typename T>
concept LocalCounter = requires {
  { T::counts() } -> std::same_as<PlanCounts>;
};

template <LocalCounter Counter>
class LocalClock {
 public:
  /// Main loop only; at least every 17 minutes.
  LocalTime now() {
    counts_ += static_cast<std::uint32_t>(Counter::counts() - static_cast<std::uint32_t>(counts_));
    return LocalTime{counts_ * kPlanCount.count()};
  }
  /// Of a count that an interrupt noted a short while ago.
  LocalTime at(std::uint32_t counts) const {
    const auto difference = static_cast<std::int32_t>(counts - static_cast<std::uint32_t>(counts_));
    return LocalTime{(counts_ + difference) * kPlanCount.count()};
  }

 private:
  std::int64_t counts_ = 0;
};

}  // namespace kinebus
