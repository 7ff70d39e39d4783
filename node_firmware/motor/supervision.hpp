#pragma once
// What can be wrong with a motor or its power stage, found from the quantities that the control has anyway.
// All detectors count control periods; none looks at a clock.

#include <cmath>
#include <cstdint>

#include "node_firmware/motor/current_loop.hpp"

namespace kinebus::motor {

/// Standard EMCY codes (CiA 301, 402).
namespace fault {
inline constexpr std::uint16_t kNone = 0, kOverCurrent = 0x2310, kShortCircuit = 0x2320, kPhaseOpen = 0x3130,
                               kOverVoltage = 0x3210, kUnderVoltage = 0x3220, kTemperature = 0x4310,
                               kSoftware = 0x6100, kEncoder = 0x7305, kFollowing = 0x8611;
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

/// Faults that take the power away: the code, or kNone.
class PowerFaults {
 public:
  void reset() { *this = PowerFaults{}; }

  /// `trip_a`: a phase current above it twice in a row is none that the control made.
  /// `resistance_ohm`: of the winding, 0: not known.
  std::uint16_t look(const Vector& measured, const Vector& wanted, float amplitude_a, float direct_v,
                     float resistance_ohm, float omega_rad_per_s, float trip_a) {
    const float a = std::fabs(measured.x), b = std::fabs(measured.y);
    if (over_.look(a > trip_a || b > trip_a)) return fault::kOverCurrent;
    const bool slow = std::fabs(omega_rad_per_s) < kSlow;
    const bool loaded = amplitude_a > kLeastCurrent;
    // A phase that should carry a good part of the current and carries nearly none.
    const auto open = [&](float is, float wants) {
      return slow && loaded && std::fabs(wants) > 0.3F * amplitude_a && is < 0.15F * std::fabs(wants);
    };
    if (open_a_.look(open(a, wanted.x)) || open_b_.look(open(b, wanted.y))) return fault::kPhaseOpen;
    // Far less voltage than the winding's resistance needs: turns are shorted.
    const float expected = resistance_ohm * amplitude_a;
    const bool shorted = slow && loaded && expected > kLeastVolts && direct_v < 0.3F * expected;
    if (short_.look(shorted)) return fault::kShortCircuit;
    return fault::kNone;
  }

 private:
  static constexpr float kSlow = 600;  // rad/s: 2 rev/s, where no back-EMF disturbs
  static constexpr float kLeastCurrent = 0.25F;
  static constexpr float kLeastVolts = 0.5F;  // more than dead time leaves unknown
  Persistence over_{2}, open_a_{periods(4e-3F)}, open_b_{periods(4e-3F)}, short_{periods(50e-3F)};
};

/// Troubles with which an axis keeps its power, as bits; each with a way back.
class Surroundings {
 public:
  static constexpr std::uint8_t kUnder = 1, kOver = 2, kHot = 4, kEncoder = 8, kFollowing = 16;

  struct Limits {
    float under_v = 10.0F, over_v = 30.0F, hysteresis_v = 1.0F;
    float hot_c = 90.0F, hysteresis_c = 10.0F;
  };
  /// Beyond these nothing may stay on: the supply's capacitors and the MOSFETs.
  static constexpr float kDeadlyV = 34.0F, kDeadlyC = 110.0F;

  std::uint8_t look(float supply_v, float temperature_c) {
    const auto with_hysteresis = [&](std::uint8_t bit, bool bad, bool good, Persistence& slow) {
      if ((bits_ & bit) == 0 && slow.look(bad)) bits_ = static_cast<std::uint8_t>(bits_ | bit);
      if ((bits_ & bit) != 0 && good) {
        bits_ = static_cast<std::uint8_t>(bits_ & ~bit);
        slow.reset();
      }
    };
    with_hysteresis(kUnder, supply_v<limits_.under_v, supply_v> limits_.under_v + limits_.hysteresis_v,
                    under_);
    with_hysteresis(kOver, supply_v > limits_.over_v, supply_v < limits_.over_v - limits_.hysteresis_v,
                    over_);
    with_hysteresis(kHot, temperature_c > limits_.hot_c, temperature_c < limits_.hot_c - limits_.hysteresis_c,
                    hot_);
    return bits_;
  }

 private:
  Limits limits_;
  Persistence under_{periods(1e-3F)}, over_{periods(1e-3F)}, hot_{periods(100e-3F)};
  std::uint8_t bits_ = 0;
};

}  // namespace kinebus::motor
