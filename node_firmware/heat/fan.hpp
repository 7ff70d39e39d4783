#pragma once
// One fan: starts with a kick, does not creep below what turns it, and is heard turning when it has a tacho.

#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus::heat {

enum class FanFunction : std::uint8_t {
  kFree = 0,    ///< by its command alone
  kHotEnd = 1,  ///< full on while its heater is warmer than kHotEndFanFrom, and at a fault
};

struct FanSettings {
  FanFunction function = FanFunction::kFree;
  std::uint8_t heater = 0;           ///< 1..: of kHotEnd
  std::uint16_t kick_ms = 200;       ///< full power so long when it starts; 0: none
  std::uint8_t least_duty = 15;      ///< per cent: below, it would stand
  std::uint8_t pulses_per_turn = 0;  ///< of the tacho; 0: has none
};

inline constexpr std::uint16_t kFullFan = 32'767;  // 6411h
/// mC. The sensor shows less than the block while it warms: 50 C is early enough for PTFE and heat creep.
inline constexpr std::int32_t kHotEndFanFrom = 50'000;
/// Off again only when it is clearly cooler.
inline constexpr std::int32_t kHotEndFanTo = 45'000;

class Fan {
 public:
  /// A fan that is on and gives no pulse for so long stands.
  static constexpr LocalTime kStallTime = std::chrono::seconds{2};

  void configure(const FanSettings& settings) { settings_ = settings; }
  const FanSettings& settings() const { return settings_; }
  /// 0..kFullFan; negative is 0.
  void set_command(std::int32_t command);
  std::int32_t command() const { return command_; }
  /// Edges of the tacho since the last call.
  void on_pulses(std::uint32_t pulses) { pulses_ += pulses; }
  /// Once a tick (kControlTick). `hot_end_mc`: of its heater; `fault`: that heater's, or its sensor is not
  /// believed.
  void step(LocalTime now, std::int32_t hot_end_mc, bool fault);

  std::uint16_t output() const { return output_; }
  std::uint16_t turns_per_minute() const { return rpm_; }
  bool stalled() const { return stalled_; }
  void clear_stall(LocalTime now) {
    stalled_ = false;
    turned_at_ = now;
  }

 private:
  static constexpr std::uint32_t kRpmTicks = 10;

  FanSettings settings_{};
  std::int32_t command_ = 0;
  std::uint16_t output_ = 0, rpm_ = 0;
  bool hot_ = false, stalled_ = false;
  std::uint32_t pulses_ = 0, counted_ = 0, ticks_ = 0;
  LocalTime kick_until_{0}, turned_at_{0};
};

}  // namespace kinebus::heat
