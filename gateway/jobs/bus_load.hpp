#pragma once
// How busy the bus is: the load over a sliding second, its peak and its mean.

#include <array>
#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus {

inline constexpr double kBusBitsPerSecond = 1'000'000;

/// Counts bits on the wire in buckets of 10 ms. Times must not run backwards by more than a second.
class BusLoad {
 public:
  void add(BusTime when, std::int64_t bits);
  /// Time passes with these bits, too evenly to be a peak.
  void skip(BusTime until, std::int64_t bits);
  /// Lets empty time pass too. Called by add().
  void advance(BusTime now);

  /// Fractions of 1 Mbit/s.
  double last_second() const { return static_cast<double>(window_bits_) / kBusBitsPerSecond; }
  double peak_second() const { return static_cast<double>(peak_bits_) / kBusBitsPerSecond; }
  double mean() const;
  std::int64_t total_bits() const { return total_bits_; }

 private:
  static constexpr std::int64_t kBucketNs = 10'000'000;
  static constexpr int kBuckets = 100;
  std::array<std::int64_t, kBuckets> buckets_{};
  std::int64_t bucket_ = -1;  ///< number of the newest bucket; -1: nothing counted yet
  std::int64_t first_bucket_ = 0;
  std::int64_t window_bits_ = 0, peak_bits_ = 0, total_bits_ = 0;
};

}  // namespace kinebus
