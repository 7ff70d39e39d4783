#pragma once
// The power state machine of one CiA 402 axis, pure: controlwords and events in, state and statusword out.
// The drive tells it when a stop ramp has ended and whether the power stage is on; it tells the drive which
// ramp is due.

#include <cstdint>

namespace kinebus::cia402 {

enum class Mode : std::int8_t {
  kNone = 0,
  kProfilePosition = 1,
  kProfileVelocity = 3,
  kHoming = 6,
  kInterpolatedPosition = 7,
  kCyclicSynchronousPosition = 8,
};

enum class State : std::uint8_t {
  kNotReadyToSwitchOn,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};

namespace control {
inline constexpr std::uint16_t kSwitchOn = 1 << 0, kEnableVoltage = 1 << 1, kQuickStop = 1 << 2,
                               kEnableOperation = 1 << 3, kFaultReset = 1 << 7, kHalt = 1 << 8;
inline constexpr std::uint16_t kNewSetPoint = 1 << 4, kChangeAtOnce = 1 << 5, kRelative = 1 << 6;  // mode 1
inline constexpr std::uint16_t kHomingStart = 1 << 4;                                              // mode 6
/// Mode 6, of this manufacturer: a carriage that has come to its switch stands there until the bit falls.
inline constexpr std::uint16_t kHomingStay = 1 << 11;
inline constexpr std::uint16_t kInterpolationEnable = 1 << 4;                            // mode 7
inline constexpr std::uint16_t kShutdown = 0x06, kSwitchedOn = 0x07, kOperation = 0x0F;  // the usual commands
}  // namespace control

namespace status {
inline constexpr std::uint16_t kWarning = 1 << 7, kRemote = 1 << 9, kTargetReached = 1 << 10,
                               kInternalLimit = 1 << 11;
inline constexpr std::uint16_t kSetPointAcknowledged = 1 << 12;                    // mode 1
inline constexpr std::uint16_t kStands = 1 << 12;                                  // mode 3
inline constexpr std::uint16_t kHomingAttained = 1 << 12, kHomingError = 1 << 13;  // mode 6
inline constexpr std::uint16_t kHomingWaits = 1 << 14;  // mode 6, of this manufacturer: stands on its switch
inline constexpr std::uint16_t kInterpolationActive = 1 << 12;                        // mode 7
inline constexpr std::uint16_t kFollowsCommand = 1 << 12, kFollowingError = 1 << 13;  // modes 8, 1
inline constexpr std::uint16_t kStateMask = 0x6F;
}  // namespace status

/// What the drive is to do about its motion right now.
enum class Stop : std::uint8_t {
  kNone,          ///< no stop due
  kSlowDown,      ///< on the deceleration ramp (6084h)
  kQuickStop,     ///< on the quick stop ramp (6085h)
  kCurrentLimit,  ///< as hard as current, or voltage, allows (options 3 and 4): a stepper takes the quick
                  ///< stop ramp
};

/// Options 605Ah-605Eh, as stored in the dictionary.
struct StopOptions {
  std::int16_t quick_stop = 6;
  std::int16_t shutdown = 1;
  std::int16_t disable_operation = 1;
  std::int16_t halt = 1;
  std::int16_t fault_reaction = 2;
};

class PowerStateMachine {
 public:
  /// Self test done: to "switch on disabled" (automatic transitions 0 and 1).
  void on_initialised();
  /// A controlword was written, or the options have changed. Bits of a mode are the drive's business.
  void on_controlword(std::uint16_t controlword, const StopOptions& options);
  /// The ramp asked for by stop() has ended: the axis rests.
  void on_stop_finished(const StopOptions& options);
  /// `power_lost`: the power stage is off already (short circuit, over-current): no reaction ramp is
  /// possible.
  void on_fault(const StopOptions& options, bool power_lost);
  /// The cause of the fault is still there: a fault reset does nothing.
  void set_fault_present(bool present) { fault_present_ = present; }

  State state() const { return state_; }
  Stop stop() const { return stop_; }
  bool halted() const { return state_ == State::kOperationEnabled && halt_; }
  /// Power stage on. It stays on through stop ramps, quick stop active and fault reaction.
  bool powered() const;
  /// The drive may follow set-points.
  bool moves() const { return state_ == State::kOperationEnabled && stop_ == Stop::kNone; }

  /// Bits 0-6 and 9; warning, target reached, internal limit and bits 12-13 are for the drive to add.
  /// `voltage`: supply present (bit 4).
  std::uint16_t statusword(bool voltage = true) const;

 private:
  enum class After : std::uint8_t { kNothing, kSwitchOnDisabled, kReadyToSwitchOn, kSwitchedOn, kFault };

  void begin_stop(Stop ramp, After after);
  void enter(State state);

  State state_ = State::kNotReadyToSwitchOn;
  Stop stop_ = Stop::kNone;
  After after_ = After::kNothing;
  bool halt_ = false;
  bool fault_present_ = false;
  std::uint16_t last_ = 0;  // controlword before: fault reset works on its rising edge
};

/// The state that a statusword tells; for masters.
State state_of(std::uint16_t statusword);
/// The controlword that takes a drive in `state` one step nearer to "operation enabled"; for masters.
std::uint16_t next_controlword(State state);

}  // namespace kinebus::cia402
