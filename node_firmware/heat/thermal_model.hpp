#pragma once
// What a heater's block is thought to be: two lumps and a dead time, measured by HeatTuning, followed tick by
// tick by an observer.
//
//   block   dTb/dt = rate * u(t - dead) - loss * (Tb - ambient) + disturbance
//   sensor  dTs/dt = (Tb - Ts) / lag
//
// u is the share of full power at the nominal supply. The disturbance is what the model does not know: fan,
// filament, a chamber; and, when it is large, a fault. Integers only; temperatures mC with 16 fractional
// bits.

#include <array>
#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus::heat {

/// All of control goes by this step. Ten half waves of 50 Hz mains, twelve of 60 Hz.
inline constexpr LocalTime kControlTick = std::chrono::milliseconds{100};
inline constexpr std::int64_t kTickMs = kControlTick.count() / 1'000'000;
inline constexpr std::uint32_t kFullPower = 1u << 16;
inline constexpr std::int32_t kRoom = 25'000;  // mC

struct ModelParameters {
  std::uint32_t rate_mc_per_s = 0;  ///< at full power and nominal supply; 0: never measured
  std::uint32_t loss_ppm_per_s = 0;
  std::uint32_t lag_ms = 0;
  std::uint32_t dead_ms = 0;

  /// Within what the observer's numbers hold.
  constexpr bool usable() const {
    return rate_mc_per_s >= 20 && rate_mc_per_s <= 50'000 && loss_ppm_per_s <= 100'000 && lag_ms >= 100 &&
           lag_ms <= 60'000 && dead_ms <= kMostDead;
  }
  static constexpr std::uint32_t kMostDead = 12'000;
};

class ThermalModel {
 public:
  /// Needs usable().
  void configure(const ModelParameters& parameters);
  const ModelParameters& parameters() const { return parameters_; }

  /// The block is as warm as the sensor says, and no heat is on its way.
  void start(std::int32_t measured);
  /// One tick: `power` (parts of kFullPower, at nominal supply) was on since the last one, less what is known
  /// to have been taken.
  void step(std::int32_t power, std::int32_t measured);
  /// The same without a measurement: the sensor is not believed now.
  void step_blind(std::int32_t power);

  std::int32_t block() const { return static_cast<std::int32_t>(block_ >> 16); }
  /// The block a dead time ahead, when what is on its way has come. What power can still change begins there.
  std::int32_t block_ahead() const;
  /// Parts of kFullPower (signed): so much more heat comes than the model knows; negative: is missing.
  std::int32_t disturbance() const;
  /// What the block should have gained in the last tick by what is known alone, without the disturbance: mC
  /// with 8 fractional bits.
  std::int32_t expected_gain() const { return static_cast<std::int32_t>(known_ >> 8); }
  /// The power that has come through the dead time now: parts of kFullPower.
  std::int32_t arriving_power() const { return delayed(); }
  /// A rise of so much a tick (mC with 8 fractional bits) as parts of kFullPower, signed.
  std::int32_t share_of_rise(std::int64_t rise) const {
    return static_cast<std::int32_t>(share_of(rise * 256));
  }
  /// Power that keeps the block at `mc`, and moves it there from `block_ahead` with `gain` (16 fractional
  /// bits) a tick. Signed and unlimited: 0 and full power are the caller's.
  std::int32_t power_for(std::int32_t mc, std::int32_t ahead, std::int32_t gain) const;
  /// Power that keeps the block at `mc` without any disturbance.
  std::int32_t holding_power(std::int32_t mc) const;
  /// Ticks after which a change of power has shown at the sensor for the most part.
  std::uint32_t response_ticks() const;

 private:
  static constexpr std::size_t kHistory = 128;  // > kMostDead / kControlTick
  std::int64_t heat_of(std::int32_t power) const { return (heat_ * power) >> 16; }
  std::int64_t lost_at(std::int64_t block) const;
  std::int32_t power_before(std::size_t ticks) const { return history_[(at_ - ticks) & (kHistory - 1)]; }
  std::int32_t delayed() const;
  std::int64_t share_of(std::int64_t heat) const;

  ModelParameters parameters_{};
  std::int64_t heat_ = 0;            // of full power a tick, mC with 16 fractional bits
  std::int64_t reciprocal_ = 0;      // 2^48 / heat_
  std::int64_t loss_ = 0, lag_ = 0;  // a tick, 32 fractional bits
  std::int64_t gain_sensor_ = 0, gain_block_ = 0, gain_disturbance_ = 0;  // 16 fractional bits
  std::uint32_t dead_ = 0;                                                // ticks
  std::int32_t dead_part_ = 0;                                            // 1/256 of one

  std::int64_t block_ = 0, sensor_ = 0, disturbance_ = 0, known_ = 0;
  std::array<std::int32_t, kHistory> history_{};
  std::size_t at_ = 0;  // of the newest
};

}  // namespace kinebus::heat
