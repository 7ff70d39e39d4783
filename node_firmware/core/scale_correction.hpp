#pragma once
// Leads a motor to where the linear scale on its carriage says that the axis is: what screw, belt and heat
// make of the way, not what happens within a motion. The command stays as it is; what is added to it for the
// motor changes slowly, and not at all while the axis is fast or nobody knows where home is.

#include <cstdint>
#include <optional>

#include "protocol/time.hpp"

namespace kinebus {

class ScaleCorrection {
 public:
  struct Settings {
    std::int32_t ratio_q16 = 0;     ///< counts of the motor for one of the scale, 16 fractional bits
    std::int64_t most_counts = 0;   ///< of the motor, either way, from home; 0: open
    std::int64_t counts_per_s = 0;  ///< the fastest that the motor is led
  };
  struct Seen {
    LocalTime now{0};
    std::int64_t command = 0;  ///< counts from the home switch's edge
    std::int64_t scale = 0;    ///< counts of the scale from there
  };
  enum class Finding : std::uint8_t {
    kGood,
    kStands,   ///< the axis moves and the scale does not count
    kFarAway,  ///< the carriage is farther from the command than may be corrected
  };

  static constexpr LocalTime kPeriod = std::chrono::milliseconds{10};

  /// Every kPeriod, with the position known. A finding stands until the axis moves no more.
  Finding look(const Settings& settings, const Seen& seen);
  /// Home is another, or not known any more: the motor stays where it is led to.
  void hold(LocalTime now);
  bool running() const { return last_.has_value(); }

  /// Added to the motor's position; 32 fractional bits. Continuous, and as slow as the settings say.
  std::int64_t at(LocalTime when) const;

 private:
  void aim(LocalTime now, std::int64_t target_q32, std::int64_t counts_per_s);

  std::int64_t from_q32_ = 0, target_q32_ = 0, slope_q32_per_us_ = 0;
  LocalTime since_{0};
  std::optional<Seen> last_, counted_;  ///< looked at last; when the scale counted last
  std::int64_t home_q32_ = 0;           ///< what was added when home was found
};

}  // namespace kinebus
