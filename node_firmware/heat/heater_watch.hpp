#pragma once
// Whether a heater does what it is told, apart from how it is controlled. The model's disturbance is the
// measure: heat that is missing or comes unasked, as a share of full power. A heater that was never measured
// is watched by plain rules until it is.

#include <array>
#include <cstdint>

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
  /// Without a model: at full power it must gain 2 K in so long, and must not leave its target by 15 K.
  std::uint16_t rise_s = 20;
};

class HeaterWatch {
 public:
  void configure(const WatchSettings& settings) { settings_ = settings; }
  void start();
  /// Measurements are missing: what was seen before and what comes after are no rise.
  void interrupt() { seen_ = 0; }
  /// Once a tick. `power`: given since the last one. `target`: 0, off. `model`: nullptr, not measured.
  /// `taken`: parts of kFullPower that the model was told are taken; they may be not, without a fault.
  HeaterFault step(std::int32_t measured, std::uint32_t power, std::int32_t target, const ThermalModel* model,
                   std::int32_t taken = 0);

 private:
  HeaterFault by_model(std::int32_t measured, const ThermalModel& model, std::int32_t taken);
  std::int32_t rise_unexplained(std::int32_t measured, const ThermalModel& model);
  HeaterFault by_rules(std::int32_t measured, std::uint32_t power, std::int32_t target);

  WatchSettings settings_{};
  std::uint32_t hot_ = 0, missing_ = 0, unasked_ = 0;  // ticks in which it was so, or mC s
  std::int32_t rise_from_ = 0, lowest_off_ = 0;
  std::int32_t taken_ = 0;  // the most of late
  std::uint32_t rise_ticks_ = 0, away_ticks_ = 0, off_ticks_ = 0;
  bool reached_ = false;

  /// The sensor's rise over so many ticks is held against the expected one: long against noise, short against
  /// any lag.
  static constexpr std::size_t kRiseTicks = 16;
  std::array<std::int32_t, kRiseTicks> measured_{}, expected_{};
  std::int64_t expected_sum_ = 0;
  std::size_t at_ = 0;
  std::uint32_t seen_ = 0, known_ = 0, rising_less_ = 0;
  std::int32_t last_target_ = 0;
};

}  // namespace kinebus::heat
