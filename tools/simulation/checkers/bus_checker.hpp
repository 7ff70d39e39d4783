#pragma once
// How full the bus is: mean over the job, and its busiest second (sliding by milliseconds).

#include <algorithm>
#include <array>
#include <cstdint>

#include "tools/simulation/bus/bus_model.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class BusChecker {
 public:
  void on_sample(const Sample& sample, const BusModel::Statistics& bus) {
    if (!sample.in_job) return;
    if (samples_ == 0) first_ = bus;
    const std::uint64_t oldest = ring_[samples_ % kWindow];
    ring_[samples_ % kWindow] = bus.bits;
    if (samples_ >= kWindow) peak_bits_ = std::max(peak_bits_, bus.bits - oldest);
    ++samples_;
    bits_ = bus.bits - first_.bits;
    frames_ = bus.frames - first_.frames;
  }
  /// Fractions of 1 Mbit/s, for samples of a millisecond.
  double mean() const {
    return samples_ > 0 ? static_cast<double>(bits_) / (1000.0 * static_cast<double>(samples_)) : 0;
  }
  double peak_1s() const { return samples_ > kWindow ? 1e-6 * static_cast<double>(peak_bits_) : mean(); }
  /// For displays: the load of the last 100 samples.
  double last_100ms() const {
    if (samples_ <= 100) return mean();
    return 1e-5 * static_cast<double>(ring_[(samples_ - 1) % kWindow] - ring_[(samples_ - 101) % kWindow]);
  }
  std::uint64_t frames() const { return frames_; }

 private:
  static constexpr std::size_t kWindow = 1000;
  std::array<std::uint64_t, kWindow> ring_{};
  BusModel::Statistics first_;
  std::uint64_t samples_ = 0, peak_bits_ = 0, bits_ = 0, frames_ = 0;
};

}  // namespace kinebus
