#pragma once
// One temperature input: oversampled, smoothed, and not believed when it cannot be true. A sample that is
// suspect takes the heater's power at once; only when it goes on for kPatience is it a fault, which stays.

#include <array>
#include <cstdint>

#include "node_firmware/heat/thermometry.hpp"
#include "protocol/time.hpp"

namespace kinebus::heat {

enum class SensorFault : std::uint8_t {
  kNone,
  kOpen,    ///< the ratio is at the converter's end: no current flows
  kShort,   ///< or no resistance
  kJump,    ///< faster than anything warms: a loose contact
  kSilent,  ///< no samples, or the MAX31865 says a fault
};

class SensorInput {
 public:
  /// A port brings a sample so often, itself the sum of several conversions.
  static constexpr LocalTime kSamplePeriod = std::chrono::milliseconds{10};
  /// So long may samples be suspect, or missing, before it is a fault.
  static constexpr LocalTime kPatience = std::chrono::milliseconds{100};
  /// 8 samples: 35 ms behind, a third of the noise.
  static constexpr int kMeanBits = 3;
  /// A single sample so far from the mean is suspect. 80 W on 8 J/K are 10 K/s: 0.4 K against the mean.
  static constexpr std::int32_t kJump = 8'000;

  /// A converter that says the same to the last bit for so long repeats itself: noise moves a sum of several
  /// conversions all the time.
  static constexpr LocalTime kFrozen = std::chrono::seconds{5};

  SetupError configure(const SensorSetup& setup, LocalTime now);
  /// Configured so already, or refused.
  bool is(const SensorSetup& setup) const { return setup_ == setup; }
  const SensorSetup& setup() const { return setup_; }
  bool configured() const { return table_.kind() != SensorKind::kNone; }

  /// `ratio`: see Linearisation. `broken`: the converter itself says so.
  void on_sample(LocalTime now, std::uint32_t ratio, bool broken = false);
  /// Looks for samples that stay away.
  void on_time(LocalTime now);
  /// The fault is forgotten; the next samples tell anew.
  void clear(LocalTime now);

  /// Mean of the last good samples, mC.
  std::int32_t temperature() const { return mean_; }
  std::uint32_t ratio() const { return ratio_; }
  /// True: the temperature is what the sensor says now. A heater has power only then.
  bool good() const { return good_ && fault_ == SensorFault::kNone; }
  SensorFault fault() const { return fault_; }
  /// A MAX31865 has no sum to move, and 15 bits: it may say the same for long, and its part knows by itself
  /// how old that is.
  bool frozen() const { return setup_.path == SensorPath::kDivider && same_ >= kFrozen / kSamplePeriod; }

 private:
  SensorFault judge(std::uint32_t ratio, std::int32_t mc, bool broken) const;
  void start_over(LocalTime now);

  Linearisation table_;
  SensorSetup setup_;
  std::array<std::int32_t, 1 << kMeanBits> window_{};
  std::uint8_t filled_ = 0, at_ = 0;
  std::int32_t sum_ = 0, mean_ = 0;
  std::uint32_t ratio_ = 0;
  std::uint32_t same_ = 0;  // samples in a row that were as the one before
  bool good_ = false;
  SensorFault fault_ = SensorFault::kNone;
  LocalTime good_at_{0};  // last good sample
  LocalTime heard_at_{0};
};

}  // namespace kinebus::heat
