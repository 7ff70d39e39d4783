#pragma once
// Whether a heater does what it is told, apart from how it is controlled. The model's disturbance is the
// measure: heat that is missing or comes unasked, as a share of full power. A heater that was never measured
// is watched by plain rules until it is.

#include <cstdint>

#include "node_firmware/heat/heat_balance.hpp"
#include "node_firmware/heat/plain_watch.hpp"
#include "node_firmware/heat/thermal_model.hpp"

namespace kinebus::heat {

enum class HeaterFault : std::uint8_t {
  kNone,
  kSensorOpen,
  kSensorShort,
  kSensorJump,
  kSensorSilent,
  kTooHot,       ///< above the limit
  kHeatMissing,  ///< heater or sensor loose, or the wrong ones
  kHeatUnasked,  ///< the switch does not open: only the contactor takes this heat away
  kFan,          ///< the hot end's fan stands
  kLast = kFan,
};

struct WatchSettings {
  std::int32_t limit_mc = 280'000;
  /// The most that fan and filament may take, and the most that may come from elsewhere: per cent of full
  /// power.
  std::uint8_t most_missing = 50, most_unasked = 25;
  /// Without a model: far below its target it must gain 2 K in so long, and half as long it may be 15 K
  /// below one that it had reached. Longer than dead time and lag.
  std::uint16_t rise_s = 20;
};

class HeaterWatch {
 public:
  /// `model`: nullptr, not measured.
  void configure(const WatchSettings& settings, const ThermalModel* model);
  void start();
  /// Measurements are missing: what was seen before and what comes after are no rise.
  void interrupt() {
    balance_.start();
    plain_.interrupt();
  }
  /// Once a tick. `power`: given since the last one. `target`: 0, off. `model`: nullptr, not measured.
  /// `taken`: parts of kFullPower that the model was told are taken; they may be not, without a fault.
  /// `quiet`: fans are as they were, and filament flows as it was told: what goes missing then is the
  /// heater's.
  HeaterFault step(std::int32_t measured, std::uint32_t power, std::int32_t target, const ThermalModel* model,
                   std::int32_t taken = 0, bool quiet = false);

 private:
  HeaterFault by_model(std::int32_t measured, const ThermalModel& model);
  HeaterFault by_balance(const HeatBalance::Share& share, std::uint32_t response);

  WatchSettings settings_{};
  std::uint32_t hot_ = 0, missing_ = 0, unasked_ = 0;  // ticks in which it was so, or mC s
  std::int32_t taken_ = 0;                             // the most of late
  std::int32_t usual_ = 0,
               doubt_ = 0;   // of what is taken: its mean with 8 fractional bits, what it may be wrong by
  std::uint32_t quiet_ = 0;  // ticks

  HeatBalance balance_;
  PlainWatch plain_;
  std::uint32_t known_ = 0;            // ticks
  std::uint32_t less_ = 0, more_ = 0;  // of the balance's steps in a row
};

}  // namespace kinebus::heat
