#pragma once
// What tells that a heater is at fault when nobody has measured it. A healthy one that fan and filament have
// drawn some kelvin below its target holds there by much power until its control has found the rest; that is
// no fault, and a block that gets no heat looks like it at first: it goes on falling.

#include <cstdint>

#include "node_firmware/heat/heating_pace.hpp"

namespace kinebus::heat {

class PlainWatch {
 public:
  enum class Found : std::uint8_t { kNothing, kMissing, kUnasked };
  /// mC, parts of kFullPower, ticks. What is told of filament and fans is all 0 when it is not.
  struct Tick {
    std::int32_t measured = 0;
    std::uint32_t power = 0;  ///< given since the last one
    std::int32_t target = 0;  ///< 0, off
    std::int32_t taken = 0;   ///< by filament, the most of late, and what it may be wrong by
    std::uint32_t quiet = 0;  ///< so long fans have been as they were, and filament has flown as it was told
  };

  /// `rise_s`: WatchSettings'.
  void configure(std::uint16_t rise_s);
  /// Nothing is known of what was before.
  void start();
  /// Measurements are missing.
  void interrupt() { pace_.start(); }
  Found step(const Tick& tick);

 private:
  bool rises_not(const Tick& tick);
  bool goes_on_falling(const Tick& tick);
  bool takes_more(const Tick& tick);
  bool is_away(const Tick& tick);
  bool warms_by_itself(const Tick& tick);

  std::uint32_t rise_ticks_ = 200;
  HeatingPace pace_;
  std::int32_t last_target_ = 0;
  bool reached_ = false;
  std::int32_t rise_from_ = 0;
  std::uint32_t risen_not_ = 0;
  std::int32_t half_from_ = 0, fell_ = 0;
  std::uint32_t half_ = 0;
  std::int32_t usual_ = 0, more_from_ = 0;
  std::uint32_t held_ = 0, more_ = 0;
  std::uint32_t away_ = 0, far_away_ = 0;
  std::int32_t lowest_off_ = 0;
  std::uint32_t off_ = 0;
};

}  // namespace kinebus::heat
