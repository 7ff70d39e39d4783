#pragma once
// From a target and the sensor to a share of full power, once a tick: PID, or by the model.

#include <cstdint>

#include "node_firmware/heat/thermal_model.hpp"

namespace kinebus::heat {

/// The words of CiA 404: proportional band, integral and derivative time.
struct PidParameters {
  std::uint32_t band_mc = 30'000;       ///< Xp: error that asks for full power
  std::uint32_t integral_ms = 40'000;   ///< Tn; 0: none
  std::uint32_t derivative_ms = 4'000;  ///< Tv
  bool operator==(const PidParameters&) const = default;
};

/// For what gains less than a kelvin a second with full power, beds and chambers: an integral that is faster
/// than the band would carry them far beyond their target.
inline constexpr PidParameters kSlowPid{.band_mc = 10'000, .integral_ms = 100'000, .derivative_ms = 6'000};

class PidControl {
 public:
  /// `hold_ppm_per_k`: a share of full power that a kelvin above the room is thought to take. The integral
  /// then has the difference alone to find.
  void configure(const PidParameters& parameters, std::uint32_t hold_ppm_per_k = 0);
  void start(std::int32_t measured);
  /// Parts of kFullPower. `most`: what the output is limited to; the integral waits while it is.
  std::uint32_t step(std::int32_t target, std::int32_t measured, std::uint32_t most);

 private:
  std::int64_t proportional_ = 0;     // kFullPower a mC, 16 fractional bits
  std::int64_t integral_gain_ = 0;    // a tick, 32 fractional bits of the proportional part
  std::int64_t derivative_gain_ = 0;  // ticks, 8 fractional bits
  std::int64_t look_ = 0;             // ticks
  std::int64_t hold_ = 0;             // kFullPower a mC, 16 fractional bits
  std::int64_t sum_ = 0;              // 16 fractional bits
  std::int64_t slope_ = 0;            // mC a tick, smoothed, 8 fractional bits
  std::int32_t last_ = 0;
};

/// Looks a dead time ahead, where power still changes something, and asks for the power that takes the block
/// from there to its target: all of it until the last moment, then what holds it.
class ModelControl {
 public:
  void configure(const ModelParameters& parameters);
  std::uint32_t step(std::int32_t target, const ThermalModel& model, std::int32_t feed_forward,
                     std::uint32_t most) const;

 private:
  std::int32_t gain_ = 0;
};

/// Rules for the chain that the model describes (Skogestad's for an integrating process with dead time).
PidParameters pid_for(const ModelParameters& model);

}  // namespace kinebus::heat
