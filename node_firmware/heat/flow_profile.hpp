#pragma once
// The power that the filament to come will take, as the master has told it last: what is heated ahead for.

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/canopen/heat_units.hpp"
#include "protocol/time.hpp"

namespace kinebus::heat {

/// Means over steps of kStep, the first from when it was told. It moves with the master's path time because
/// the master tells it again; without that it is over with its last step.
class FlowProfile {
 public:
  static constexpr LocalTime kStep = std::chrono::milliseconds{kFlowStepMs};
  static constexpr LocalTime kTold = std::chrono::seconds{3};

  void set(std::size_t step, std::int32_t mw, LocalTime now) {
    steps_[step] = mw;
    told_ = now;
    ever_told_ = true;
  }
  std::int32_t step(std::size_t n) const { return steps_[n]; }
  void clear() {
    steps_.fill(0);
    ever_told_ = false;
  }
  /// The master tells, of no flow, too.
  bool told(LocalTime now) const { return ever_told_ && now - told_ < kTold; }

  /// mW at that time: straight between the middles of the steps.
  std::int32_t power(LocalTime at) const {
    const LocalTime since = at - told_;
    if (since < LocalTime{0} || since >= kStep * static_cast<int>(steps_.size())) return 0;
    const LocalTime from_middle = since - kStep / 2;
    if (from_middle <= LocalTime{0}) return steps_.front();
    const auto n = static_cast<std::size_t>(from_middle / kStep);
    if (n + 1 >= steps_.size()) return steps_.back();
    const std::int64_t part = (from_middle % kStep).count();
    const std::int64_t way = std::int64_t{steps_[n + 1]} - steps_[n];
    return steps_[n] + static_cast<std::int32_t>(way * part / kStep.count());
  }

 private:
  std::array<std::int32_t, kFlowSteps> steps_{};  // mW
  LocalTime told_{0};
  bool ever_told_ = false;
};

}  // namespace kinebus::heat
