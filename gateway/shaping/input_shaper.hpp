#pragma once
// Input shapers: a few pulses whose answers of one vibration cancel each other. A motion convolved with them
// moves a spring without leaving it swinging.

#include <array>
#include <cstddef>
#include <span>

#include "gateway/shaper_kind.hpp"

namespace kinebus {

/// Pulses at times from 0 on, s; weights > 0 whose sum is 1. One pulse at 0: the motion stays as it is.
struct InputShaper {
  static constexpr std::size_t kMostPulses = 5;
  struct Pulse {
    double time_s = 0, weight = 0;
    friend bool operator==(const Pulse&, const Pulse&) = default;
  };
  std::array<Pulse, kMostPulses> pulses{{{0, 1}}};
  std::size_t count = 1;

  std::span<const Pulse> all() const { return {pulses.data(), count}; }
  double duration_s() const { return pulses[count - 1].time_s; }
  /// How much later the shaped motion is.
  double mean_s() const;
  /// Of the pulses' times. At an acceleration of at most a, a shaped place is within a / 2 times this of the
  /// one that the motion would have without, a mean time earlier.
  double variance_s2() const;
  friend bool operator==(const InputShaper&, const InputShaper&) = default;
};

/// Vibration that EI and the humps leave at their own frequency, or between their zeros, to unshaped.
inline constexpr double kShaperTolerance = 0.05;

/// `frequency_hz`: of the vibration as it swings undamped, > 0; `damping_ratio` 0 .. 0.9.
InputShaper make_shaper(ShaperKind kind, double frequency_hz, double damping_ratio);

/// For which frequency a shaper is to be made so that it leaves least of a vibration of `frequency_hz`, known
/// to 10 %, at every rate of path time from `slowest_rate` (0.3 .. 1) to 1, which stretches its pulses: to
/// unshaped at the same rate. At slowest_rate 1 or 0 the frequency itself. Cost: about 0.3 ms.
double frequency_for_rates(ShaperKind kind, double frequency_hz, double damping_ratio, double slowest_rate);

/// What a shaped step of acceleration leaves of a vibration: its amplitude at the last pulse, to the one that
/// the unshaped step begins with.
double residual_vibration(const InputShaper& shaper, double frequency_hz, double damping_ratio);

}  // namespace kinebus
