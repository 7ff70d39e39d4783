#pragma once
// Measures a winding while the motor rests: resistance from the voltages of two currents (what the
// half-bridges lose cancels), inductance from the slope of the current under a small square wave. Everything
// happens along the angle at which the rotor stands, so there is no torque and it stays.

#include <array>
#include <cstdint>

#include "node_firmware/motor/current_loop.hpp"

namespace kinebus::motor {

class AutoTune {
 public:
  enum class State : std::uint8_t { kIdle, kRuns, kDone, kFailed };
  struct Result {
    float resistance_ohm = 0, inductance_h = 0;
  };
  struct Wish {
    float current_a = 0;  ///< for the current loop,
    float added_v = 0;    ///< or, with `open`, a voltage along the angle instead of it
    bool open = false;
  };

  void start(float current_a);
  void stop() { state_ = State::kIdle; }
  /// Each control period: `direct_v` applied by the current loop in the last, `direct_a` measured now.
  Wish step(float direct_v, float direct_a, float supply_v);

  State state() const { return state_; }
  const Result& result() const { return result_; }

 private:
  void finish();

  State state_ = State::kIdle;
  float current_a_ = 0;
  int period_ = 0;
  float low_v_ = 0, low_a_ = 0, high_v_ = 0, high_a_ = 0;
  float last_a_ = 0, wave_v_ = 0, rise_a_ = 0;
  std::array<bool, 2> acted_up_{};  // the wave in the last two periods
  Result result_;
};

}  // namespace kinebus::motor
