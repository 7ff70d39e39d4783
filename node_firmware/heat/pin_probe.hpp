#pragma once
// A probe with a pin that a servo's signal puts out and draws in (BLTouch): pulses of 50 Hz whose width is
// the command, and one line back that is read. It has no other voice, so both of its answers are asked for
// after every command: without a touch the line is high in an alarm only; in touch mode it is high exactly as
// long as the pin is in. A bed holds a pin in that it has pushed in, whatever the pin's magnet does: so
// before it is told to come out it is asked whether it has stayed in.

#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus::heat {

/// The values are those of 2261h.
enum class PinCommand : std::uint8_t { kNone, kDeploy, kStow, kSelfTest, kReset };
/// The values are those of 2262h.
enum class PinState : std::uint8_t {
  kUnknown,  ///< nothing was asked of it since the start
  kStowed,
  kDeployed,  ///< touch mode: a touch makes the line high
  kMoves,
  kNotOut,    ///< told to deploy, the pin has stayed in
  kNotIn,     ///< told to stow, the pin hangs out
  kAlarm,     ///< it says itself that it is out of order, after a reset, too
  kSelfTest,  ///< in and out by itself, until the next command
};

class PinProbe {
 public:
  // The maker's angles at 10, 60, 90, 120 and 160 degrees, us.
  static constexpr std::uint16_t kDownPulse = 650, kTouchPulse = 1165, kUpPulse = 1475, kSelfTestPulse = 1780,
                                 kResetPulse = 2190;
  /// Of pulses, one every so long.
  static constexpr LocalTime kPeriod = std::chrono::milliseconds{20};
  /// The pin's way, with room; a mode is taken within five pulses.
  static constexpr LocalTime kWay = std::chrono::milliseconds{700}, kMode = std::chrono::milliseconds{200};

  void fit(bool fitted);
  bool fitted() const { return fitted_; }
  /// False: there is none, or the command is not known.
  bool command(LocalTime now, PinCommand command);
  /// What the signal is to be whatever the pin does then; 0: none.
  void set_pulse(std::uint16_t us);
  /// Every SensorInput::kSamplePeriod, with the level of its line.
  void on_sample(LocalTime now, bool level);

  PinState state() const { return state_; }
  bool level() const { return level_; }
  /// 0: no pulses.
  std::uint16_t pulse() const { return pulse_; }

 private:
  enum class Step : std::uint8_t { kIdle, kCheck, kReset, kMove, kLook, kSettle };
  void begin(LocalTime now, Step step);
  void wrong(LocalTime now, PinState as);

  bool fitted_ = false, level_ = false, again_ = false;
  PinCommand command_ = PinCommand::kNone;
  PinState state_ = PinState::kUnknown;
  Step step_ = Step::kIdle;
  LocalTime until_{0};
  std::uint16_t pulse_ = 0;
};

}  // namespace kinebus::heat
