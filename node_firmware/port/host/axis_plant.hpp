#pragma once
// What stands behind one axis of a simulated node: a carriage on its screw, a switch on its way, and perhaps
// a linear scale beside it. No clock and no input or output: told where the motor is, it tells when the
// switch changes, and what the scale counts.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "protocol/time.hpp"

namespace kinebus {

struct AxisPlantOptions {
  std::int64_t start_counts = 0;   ///< where the carriage stands at power-up
  int switch_input = 0;            ///< 1..7 of the node; 0: no switch
  std::int64_t switch_counts = 0;  ///< where the switch's edge is
  bool active_above = true;        ///< active at and above the edge, else at and below
  bool active_low = false;         ///< electrically
  double scale_pulses = 0;         ///< of the linear scale, a count of the motor; 0: no scale
  double screw_error = 0;          ///< ratio: how much further than it is told the carriage goes
  double play_counts = 0;          ///< between motor and carriage
};

/// A raw level of a switch input, and when it came.
struct SwitchChange {
  LocalTime at{0};
  int input = 0;  ///< 0..6
  bool level = false;
};

class AxisPlant {
 public:
  explicit AxisPlant(const AxisPlantOptions& options) : options_(options) {}

  /// The motor is at `motor` (32 fractional bits, 0 at power-up) at `now`. Gives the edge since the last
  /// call, its time interpolated between the two; the first call gives the level at power-up. Call every
  /// millisecond or so while the axis moves.
  std::optional<SwitchChange> on_position(LocalTime now, std::int64_t motor) {
    const std::int64_t before = last_;
    const LocalTime since = last_time_;
    last_ = motor;
    last_time_ = now;
    const double pulled = static_cast<double>(motor) / 4294967296.0, half = options_.play_counts / 2;
    carriage_ = std::clamp(carriage_, pulled - half, pulled + half);
    if (options_.switch_input == 0) return std::nullopt;
    const bool level = active_at(motor) != options_.active_low;
    if (known_ && level == level_) return std::nullopt;
    LocalTime at = now;
    if (known_) {
      const auto way = static_cast<double>(motor - before);
      const auto part = static_cast<double>(edge() - before);
      at = since +
           LocalTime{static_cast<std::int64_t>(part / way * static_cast<double>((now - since).count()))};
    }
    known_ = true;
    level_ = level;
    return SwitchChange{at, options_.switch_input - 1, level};
  }

  bool has_scale() const { return options_.scale_pulses > 0; }
  /// Of the carriage itself, behind the play and the screw's error; 0 at power-up.
  std::int32_t scale_counts() const {
    return static_cast<std::int32_t>(
        std::floor(carriage_ * (1 + options_.screw_error) * options_.scale_pulses));
  }
  /// Where the motor has told the carriage to be, counts.
  double carriage_counts() const {
    return static_cast<double>(options_.start_counts) + static_cast<double>(last_) / 4294967296.0;
  }

 private:
  std::int64_t edge() const {
    return (options_.switch_counts - options_.start_counts) * (std::int64_t{1} << 32);
  }
  bool active_at(std::int64_t motor) const {
    return options_.active_above ? motor >= edge() : motor <= edge();
  }

  AxisPlantOptions options_;
  std::int64_t last_ = 0;
  double carriage_ = 0;  // where it is, in counts of the motor since power-up
  LocalTime last_time_{0};
  bool level_ = false;
  bool known_ = false;
};

}  // namespace kinebus
