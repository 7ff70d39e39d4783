#pragma once
// Microseconds of 32 bits from local counts of 32 bits that go round four times as often; for interrupts,
// too.

#include <atomic>
#include <cstdint>

#include "node_firmware/board/local_clock.hpp"

namespace kinebus {

template <LocalCounter Counter>
class Microseconds {
 public:
  /// Main loop; at least every 8 minutes.
  void keep() {
    const std::uint32_t half = halves_.load(std::memory_order_relaxed);
    if ((Counter::counts() >> 31) != (half & 1)) halves_.store(half + 1, std::memory_order_relaxed);
  }
  std::uint32_t now() const { return at(Counter::counts()); }
  /// Of a count that was noted less than 8 minutes ago.
  std::uint32_t at(std::uint32_t counts) const {
    const std::uint32_t half = halves_.load(std::memory_order_relaxed), now = Counter::counts();
    const std::uint64_t halves = half + ((now >> 31) != (half & 1) ? 1u : 0u);
    const std::uint64_t quarters = halves << 31 | (now & 0x7FFF'FFFF);
    return static_cast<std::uint32_t>((quarters - static_cast<std::uint32_t>(now - counts)) >> 2);
  }

 private:
  static_assert(kPlanCount == LocalTime{250});
  std::atomic<std::uint32_t> halves_{0};
};

}  // namespace kinebus
