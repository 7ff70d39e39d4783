#pragma once
// A node's estimate of the gateway's bus time, from when SYNC arrived by its own counter and from the stamp
// that says when that SYNC was on the bus. Arrivals are late by interrupt latency, never early, so the truth
// is the lower edge of the cloud of (bus time, local time) points; its slope is that of the thinnest strip
// that holds the cloud (the maximum-likelihood line for a latency anywhere in an interval), with far outliers
// left out.
//
// What limits it, measured (clock_estimate_test): latency uniform in 0..20 us, `n` SYNCs in the window: two
// nodes differ by 20 us * 6 / n at the worst in a hundred. The window holds 512 SYNCs, or 16 s.

#include <array>
#include <cstdint>

#include "protocol/motion/broadcast.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class ClockEstimate {
 public:
  static constexpr int kWindow = 512;
  /// For a core to which 64 bits are dear: an eighth of the time, and eight times the error where latency is
  /// what limits it.
  static constexpr int kShortWindow = 64;
  static constexpr int kMinimumSamples = 24;  ///< before that the estimate may step and is not "synchronised"

  struct Counters {
    std::uint32_t stamps_used = 0;
    std::uint32_t stamps_unmatched = 0;  ///< no arrival of that SYNC: lost, or a doubled stamp
    std::uint32_t syncs_unstamped = 0;   ///< arrivals whose stamp never came
    std::uint32_t syncs_doubled = 0;
    std::uint32_t outliers = 0;  ///< samples so far off that they count as mistakes
  };
  struct Update {
    bool used = false;  ///< a sample more
    /// to_bus() has just stepped by `epoch_shift` (a new epoch, or a gateway clock that jumped without
    /// telling): shift all that is named by bus time.
    bool epoch_joined = false;
    BusTime epoch_shift{0};
  };

  /// `window`: SYNCs of it, kShortWindow to kWindow.
  explicit ClockEstimate(int window = kWindow) : window_(window) {}

  /// `arrival`: local time of the end of the SYNC frame, as early as the receive interrupt can tell.
  void on_sync(std::uint8_t counter, LocalTime arrival);
  /// `now`: local time, at or after the arrival of the SYNC that is stamped. Cost: O(window), a few
  /// divisions.
  Update on_stamp(const SyncStamp& stamp, LocalTime now);

  /// Bus time at a local time, for any time from the last stamp on (a second back is fine too). No division.
  /// Once synchronised it is continuous and never runs back: corrections are slewed at up to kMaxSlew.
  BusTime to_bus(LocalTime local) const;
  /// Inverse of to_bus within 2 ns.
  LocalTime to_local(BusTime bus) const;

  bool synchronised() const { return synchronised_; }
  /// How far to_bus may be from what an ideal node would say (99 %): fit, correction still to be slewed, and
  /// growth since the last stamp.
  BusTime error_bound(LocalTime now) const;
  /// Local counter against bus clock, parts per thousand million; positive: the local crystal is fast.
  std::int32_t rate_ppb() const;
  std::uint8_t epoch() const { return epoch_; }
  /// Local arrival of the last SYNC with a stamp, and its stamped time: what "lost SYNC" counts from.
  LocalTime last_sync_local() const { return last_local_; }
  BusTime last_sync_bus() const { return last_bus_; }
  const Counters& counters() const { return counters_; }

  /// Forgets all but the counters.
  void reset();

  /// 100 ns in a millisecond. Crystals are within twice 100 ppm of each other.
  static constexpr std::int64_t kMaxSlewPpb = 100'000;

 private:
  // Slopes and rates: d(local - bus)/d(bus), 38 fractional bits.
  static constexpr int kRateBits = 38;

  struct Sample {
    std::int64_t bus = 0;    // ns after origin_bus_
    std::int64_t delta = 0;  // ns: local - bus, less that of the origin
  };
  struct Arrival {
    std::uint8_t counter = 0;  // 0: none
    LocalTime local{0};
  };
  // A straight piece of the answer: bus = bus0 + dl - dl * rate, with dl = local - local0.
  struct Line {
    std::int64_t local0 = 0, bus0 = 0, rate = 0;  // rate: d(local - bus)/d(local)
    std::int64_t to_bus(std::int64_t local) const;
  };
  using Hull = std::array<std::uint16_t, kWindow>;
  using Residuals = std::array<std::int32_t, kWindow>;  // ns above the line

  void add(const Sample& sample);
  void drop_old();
  const Sample& at(int i) const { return samples_[static_cast<std::size_t>((first_ + i) % kWindow)]; }
  const Sample& corner(const Hull& hull, int i) const { return at(hull[static_cast<std::size_t>(i)]); }
  void rebase();
  void fit();
  int hull(Hull& out, bool lower, const Residuals* residuals, std::int32_t residual_limit) const;
  std::int64_t support(const Hull& hull, int size, bool lower, std::int64_t slope, int& near) const;
  std::int64_t slope_between(const Sample& a, const Sample& b) const;
  std::int32_t latency_limit(const Residuals& residuals) const;
  std::int64_t residual(const Sample& s) const;
  void steer(std::int64_t now);

  int window_;
  std::array<Sample, kWindow> samples_{};
  int first_ = 0, count_ = 0;
  std::int64_t origin_bus_ = 0, origin_delta_ = 0;
  std::array<Arrival, 4> arrivals_{};
  int next_arrival_ = 0;
  std::uint8_t last_counter_ = 0;
  std::uint8_t epoch_ = 0;
  int strangers_ = 0;  // outliers one after another

  // Fit: delta = offset_ + slope_ * bus on the lower edge of a strip `spread_` wide.
  std::int64_t slope_ = 0, offset_ = 0, spread_ = 0;

  // Answer: `steered_` until `settled_local_`, then `settled_`.
  bool started_ = false, synchronised_ = false, joining_ = false;
  Line steered_{}, settled_{};
  std::int64_t settled_local_ = 0, correction_ = 0;
  LocalTime last_local_{0}, fitted_{0};
  BusTime last_bus_{0};
  Counters counters_{};
};

}  // namespace kinebus
