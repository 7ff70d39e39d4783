#pragma once
// Bit timing of bxCAN and FDCAN, found at compile time.

#include <cstdint>

namespace kinebus {

/// In the controller's units: prescaler, and segments in time quanta.
struct CanTiming {
  std::uint32_t prescaler = 0, segment1 = 0, segment2 = 0, jump = 0;

  constexpr std::uint32_t quanta() const { return 1 + segment1 + segment2; }
  constexpr std::uint32_t sample_permille() const { return 1000 * (1 + segment1) / quanta(); }
};

/// The setting with the most quanta whose sample point is nearest to `permille`; quanta() 1: none exists.
constexpr CanTiming can_timing(std::uint32_t clock_hz, std::uint32_t bit_rate, std::uint32_t permille) {
  CanTiming best;
  std::uint32_t best_error = 1000;
  for (std::uint32_t quanta = 25; quanta >= 8; --quanta) {
    if (clock_hz % (bit_rate * quanta) != 0) continue;
    const std::uint32_t prescaler = clock_hz / (bit_rate * quanta);
    if (prescaler > 1024) continue;
    for (std::uint32_t segment2 = 2; segment2 <= 8; ++segment2) {
      const std::uint32_t segment1 = quanta - 1 - segment2;
      if (segment1 < 1 || segment1 > 16) continue;
      const std::uint32_t point = 1000 * (1 + segment1) / quanta;
      const std::uint32_t error = point > permille ? point - permille : permille - point;
      if (error < best_error) {
        best_error = error;
        best = {prescaler, segment1, segment2, segment2 < 4 ? segment2 - 1 : 3};
      }
    }
  }
  return best;
}

}  // namespace kinebus
