#pragma once
// What can be wrong with a motor or its power stage, found from the quantities that the control has anyway.
// All detectors count control periods; none looks at a clock.

#include <cmath>
#include <cstdint>

#include "node_firmware/motor/current_loop.hpp"
#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus::motor {

/// Standard EMCY codes (CiA 301, 402).
namespace fault {
inline constexpr std::uint16_t kNone = emcy::kNoError, kOverCurrent = emcy::kOverCurrent,
                               kShortCircuit = emcy::kShortCircuit, kPhaseOpen = emcy::kPhaseOpen,
                               kOverVoltage = emcy::kOverVoltage, kUnderVoltage = emcy::kUnderVoltage,
                               kTemperature = emcy::kDriveTemperature, kSoftware = emcy::kSoftware,
                               kEncoder = emcy::kIncrementalEncoder, kFollowing = emcy::kFollowingError;
}  // namespace fault

/// True after `limit` periods in a row (less one for each good one in between).
class Persistence {
 public:
  explicit constexpr Persistence(int limit) : limit_(limit) {}
  bool look(bool bad) {
    if (bad)
      count_ += count_ < limit_ ? 1 : 0;
    else if (count_ > 0)
      --count_;
    return count_ >= limit_;
  }
  void reset() { count_ = 0; }

 private:
  int limit_;
  int count_ = 0;
};

constexpr int periods(float seconds) {
  return static_cast<int>(seconds / kControlPeriodS);
}

/// Detectors that need not look in each control period look once in so many.
inline constexpr int kLookEvery = 4;
constexpr int looks(float seconds) {
  return periods(seconds) / kLookEvery;
}

/// Faults that take the power away: the code, or kNone.
class PowerFaults {
 public:
  void reset() { *this = PowerFaults{}; }

  /// Each control period. A phase current above `trip_a` twice in a row is none that the control made.
  bool over_current(const Vector& measured, float trip_a) {
    return over_.look(std::fabs(measured.x) > trip_a || std::fabs(measured.y) > trip_a);
  }
  /// Once in kLookEvery. `resistance_ohm`: of the winding, 0: not known.
  std::uint16_t look(const Vector& measured, const Vector& wanted, float amplitude_a, float direct_v,
                     float resistance_ohm, float omega_rad_per_s) {
    const bool judged = std::fabs(omega_rad_per_s) < kSlow && amplitude_a > kLeastCurrent;
    // A phase that should carry a good part of the current and carries nearly none.
    const auto open = [&](float is, float wants) {
      return judged && std::fabs(wants) > 0.3F * amplitude_a && std::fabs(is) < 0.15F * std::fabs(wants);
    };
    if (open_a_.look(open(measured.x, wanted.x)) || open_b_.look(open(measured.y, wanted.y)))
      return fault::kPhaseOpen;
    // Far less voltage than the winding's resistance needs: turns are shorted.
    const float expected = resistance_ohm * amplitude_a;
    if (short_.look(judged && expected > kLeastVolts && direct_v < 0.3F * expected))
      return fault::kShortCircuit;
    return fault::kNone;
  }

 private:
  static constexpr float kSlow = 600;  // rad/s: 2 rev/s, where no back-EMF disturbs
  static constexpr float kLeastCurrent = 0.25F;
  static constexpr float kLeastVolts = 0.5F;  // more than dead time leaves unknown
  Persistence over_{2}, open_a_{looks(4e-3F)}, open_b_{looks(4e-3F)}, short_{looks(50e-3F)};
};

/// Troubles with which an axis keeps its power, as bits; each with a way back. All nodes stop on the path
/// then, and hold. Only what burns in spite of that takes the power away.
class Surroundings {
 public:
  static constexpr std::uint8_t kUnder = 1, kOver = 2, kHot = 4, kEncoder = 8, kFollowing = 16;

  struct Limits {
    float under_v = 10.0F, over_v = 30.0F, hysteresis_v = 1.0F;
    float hot_c = 90.0F, hysteresis_c = 10.0F;
  };
  /// Beyond these nothing may stay on: above it the supply's suppressor burns, and a second later MOSFETs are
  /// at 150 C inside.
  static constexpr float kDeadlyV = 34.0F, kDeadlyC = 110.0F;
  /// No supply on which a board would run at all: what measures it is broken.
  static constexpr float kNoSupplyV = 5.0F;
  static bool is_supply(float supply_v) { return supply_v >= kNoSupplyV; }
  /// No temperature, but a sensor that is open or shorted: told as heat, and no reason to let go.
  static constexpr float kOpenC = -50.0F, kShortedC = 180.0F;
  static bool deadly_heat(float temperature_c) {
    return temperature_c > kDeadlyC && temperature_c < kShortedC;
  }

  /// Once in kLookEvery control periods.
  void look(float supply_v, float temperature_c) {
    const auto with_hysteresis = [&](std::uint8_t bit, bool bad, bool good, Persistence& slow) {
      if ((bits_ & bit) == 0 && slow.look(bad)) bits_ = static_cast<std::uint8_t>(bits_ | bit);
      if ((bits_ & bit) != 0 && good) {
        bits_ = static_cast<std::uint8_t>(bits_ & ~bit);
        slow.reset();
      }
    };
    const float warm_c = limits_.hot_c - limits_.hysteresis_c;
    with_hysteresis(kUnder, supply_v<limits_.under_v, supply_v> limits_.under_v + limits_.hysteresis_v,
                    under_);
    with_hysteresis(kOver, supply_v > limits_.over_v, supply_v < limits_.over_v - limits_.hysteresis_v,
                    over_);
    with_hysteresis(kHot, temperature_c > limits_.hot_c || temperature_c < kOpenC,
                    temperature_c < warm_c && temperature_c > kOpenC, hot_);
    deadly_ = fault::kNone;
    if (burns_.look(deadly_heat(temperature_c))) deadly_ = fault::kTemperature;
    if (breaks_.look(supply_v > kDeadlyV)) deadly_ = fault::kOverVoltage;
    if (gone_.look(!is_supply(supply_v))) deadly_ = fault::kUnderVoltage;
  }
  std::uint8_t present() const { return bits_; }
  /// The fault for which the power has to go, or kNone.
  std::uint16_t deadly() const { return deadly_; }

 private:
  Limits limits_;
  Persistence under_{looks(1e-3F)}, over_{looks(1e-3F)}, hot_{looks(100e-3F)};
  // Longer than any stop on the path takes; and than a stop's own energy lifts the supply.
  Persistence burns_{looks(2)}, breaks_{looks(10e-3F)};
  Persistence gone_{looks(2e-3F)};  // of the last that was measured, the control lives so long
  std::uint16_t deadly_ = fault::kNone;
  std::uint8_t bits_ = 0;
};

}  // namespace kinebus::motor
