#pragma once
// A linear scale that tells where it is by SSI: the master's clock shifts the position out, highest bit
// first, in binary or in Gray code. It is counted on beyond its own end like a scale of pulses, and what it
// cannot have gone in the time between two readings is not believed.

#include <cstdint>
#include <optional>

#include "protocol/time.hpp"

namespace kinebus {

class AbsoluteScale {
 public:
  struct Settings {
    unsigned bits = 24;  ///< of the position, 8..30
    bool gray = false;
    std::uint32_t counts_per_m = 0;  ///< 0: not told; any step is believed
  };
  /// Clocks of a frame. The line rests high, so the first bit is high; the position follows; the bit after it
  /// is low until the scale is ready again.
  static constexpr unsigned kFrameBits = 32;
  /// Without a reading for so long nothing is known.
  static constexpr LocalTime kSilent = std::chrono::milliseconds{50};

  explicit AbsoluteScale(const Settings& settings) : settings_(settings) {}

  /// A frame, its first bit the highest; read at `now`. A cable that is off, or a short of the line, is none.
  void take(LocalTime now, std::uint32_t frame) {
    if ((frame >> 31) == 0 || (frame >> (30 - settings_.bits) & 1u) != 0) return;
    const std::uint32_t raw = position_in(frame);
    if (!last_) {
      accept(now, raw);
      return;
    }
    if (believed(now - when_, step(raw, *last_))) {
      accept(now, raw);
      return;
    }
    // Two that agree with each other: it has gone there while nobody could read it.
    if (doubted_ && believed(now - doubted_when_, step(raw, *doubted_))) {
      accept(now, raw);
      return;
    }
    doubted_ = raw;
    doubted_when_ = now;
  }

  /// From wherever it stood when it was read first.
  std::int32_t counts() const { return static_cast<std::int32_t>(total_); }
  bool silent(LocalTime now) const { return !last_ || now - when_ > kSilent; }

 private:
  /// No carriage is faster, m/s.
  static constexpr std::int64_t kFastest = 2;
  /// Noise of the last digits.
  static constexpr std::int64_t kNoise = 8;

  std::uint32_t position_in(std::uint32_t frame) const {
    std::uint32_t value = frame << 1 >> (kFrameBits - settings_.bits);
    if (settings_.gray)
      for (unsigned shift = 1; shift < settings_.bits; shift *= 2) value ^= value >> shift;
    return value;
  }
  /// The shorter way round.
  std::int32_t step(std::uint32_t to, std::uint32_t from) const {
    const unsigned unused = 32 - settings_.bits;
    return static_cast<std::int32_t>((to - from) << unused) >> unused;
  }
  bool believed(LocalTime time, std::int32_t step) const {
    if (settings_.counts_per_m == 0) return true;
    const std::int64_t us = std::chrono::duration_cast<std::chrono::microseconds>(time).count() + 1;
    if (us > 1'000'000) return true;
    const std::int64_t most = us * kFastest * settings_.counts_per_m / 1'000'000 + kNoise;
    return (step < 0 ? -std::int64_t{step} : std::int64_t{step}) <= most;
  }
  void accept(LocalTime now, std::uint32_t raw) {
    if (last_) total_ += static_cast<std::uint32_t>(step(raw, *last_));
    last_ = raw;
    when_ = now;
    doubted_.reset();
  }

  Settings settings_;
  std::optional<std::uint32_t> last_, doubted_;
  LocalTime when_{0}, doubted_when_{0};
  std::uint32_t total_ = 0;
};

}  // namespace kinebus
