#pragma once
// A stepper driver that is spoken to, whatever the chip and its wires: what it is told, and what it tells. A
// state machine without input or output of its own.
//
//   next() -> Exchange -> on_heard()

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/time.hpp"

namespace kinebus::step {

/// What an axis wants of its driver.
struct DriverSettings {
  std::uint16_t run_ma = 0, hold_ma = 0;  ///< amplitudes of a phase's current
  /// StealthChop below this velocity, counts/s, SpreadCycle above it. 0: always SpreadCycle.
  std::uint32_t spread_above = 0;
  /// StallGuard: load at which DIAG says stall, 1 to 255, 255 the lightest; 0: never.
  std::uint8_t stall_threshold = 0;
  std::uint32_t stall_above = 0;     ///< counts/s from which it is looked at
  bool homing = false;               ///< StallGuard is looked at then only
  std::uint16_t sense_milliohm = 0;  ///< the module's resistors; 0: as most modules of the chip have them
  friend constexpr bool operator==(const DriverSettings&, const DriverSettings&) = default;
};

enum class DriverState : std::uint8_t {
  kStandsAlone = 0,  ///< it is not to be spoken to
  kUnasked = 1,      ///< it has not answered yet, nor failed to
  kConfigured = 2,   ///< and has all that it was told
  kChanging = 3,     ///< its settings are on their way
  kSilent = 4,       ///< it does not answer, or is another chip
};

/// What a driver's status says, as bits.
namespace finding {
inline constexpr std::uint8_t kPreWarning = 1, kTooHot = 2, kShortToGround = 4, kShortToSupply = 8,
                              kOpenPhase = 16, kStandstill = 32;
}  // namespace finding

/// Where a chip has them in DRV_STATUS; 0: it does not tell.
struct StatusBits {
  std::uint32_t pre_warning = 0, too_hot = 0, short_to_ground = 0, short_to_supply = 0, open_phase = 0,
                standstill = 0;
};
constexpr std::uint8_t findings_of(std::uint32_t status, const StatusBits& bits) {
  const auto found = [status](std::uint32_t mask, std::uint8_t what) {
    return (status & mask) != 0 ? what : std::uint8_t{0};
  };
  return static_cast<std::uint8_t>(
      found(bits.pre_warning, finding::kPreWarning) | found(bits.too_hot, finding::kTooHot) |
      found(bits.short_to_ground, finding::kShortToGround) |
      found(bits.short_to_supply, finding::kShortToSupply) | found(bits.open_phase, finding::kOpenPhase) |
      found(bits.standstill, finding::kStandstill));
}

enum class DriverBus : std::uint8_t { kUart, kSpi };

/// Bytes to put out to a driver, and how many are heard until they are out and answered.
struct Exchange {
  DriverBus bus = DriverBus::kUart;
  std::array<std::uint8_t, 8> bytes{};
  std::uint8_t length = 0;
  std::uint8_t hears = 0;  ///< on the one wire of a UART the echo, too
  std::span<const std::uint8_t> said() const { return std::span(bytes).first(length); }
};
inline constexpr std::size_t kMostHeard = 16;

class StepperDriver {
 public:
  virtual void set(const DriverSettings& settings) = 0;
  /// What to say now; none: nothing is due. on_heard() follows.
  virtual std::optional<Exchange> next(LocalTime now) = 0;
  /// All of Exchange::hears, or as many as came whole.
  virtual void on_heard(std::span<const std::uint8_t> bytes) = 0;
  /// Settings are on their way: to be served before drivers that are only asked.
  virtual bool busy() const = 0;
  /// The chip's number; 0: none has answered so far.
  virtual std::uint16_t found() const = 0;

  DriverState state() const { return state_; }
  /// It has had all its settings since it got its power: they may be changing now.
  bool usable() const { return configured_ && state_ != DriverState::kSilent; }
  /// It has lost its settings since acknowledge(): its supply was gone.
  bool lost_settings() const { return lost_settings_; }
  /// It had switched itself off since acknowledge().
  bool driver_error() const { return driver_error_; }
  bool charge_pump_low() const { return charge_pump_low_; }
  /// A phase carries no current: in so many looks in slow motion, one after the other.
  bool open_load() const { return open_looks_ >= kOpenLooks; }
  void acknowledge() { lost_settings_ = driver_error_ = false, open_looks_ = 0; }
  /// The motor moves so slowly that the driver can tell an open phase.
  void set_slow_motion(bool slow) { slow_motion_ = slow; }
  /// Silent already before it is asked: one try is enough.
  void expect_nobody() { failures_ = kTries - 1; }
  /// It is silent, and not to be asked yet.
  bool rests(LocalTime now) const { return state_ == DriverState::kSilent && now < due_; }
  const DriverSettings& settings() const { return settings_; }
  /// Of finding::.
  std::uint8_t findings() const { return findings_; }
  /// DRV_STATUS, as it was seen last.
  std::uint32_t status() const { return status_; }
  /// StallGuard's result, while it is looked at.
  std::uint16_t stall_guard() const { return stall_guard_; }

 protected:
  static constexpr int kTries = 4;
  static constexpr LocalTime kLookAgain = std::chrono::milliseconds{500};  // for one that is silent
  static constexpr LocalTime kRound = std::chrono::milliseconds{40};       // looks at one that is well

  ~StepperDriver() = default;
  void look_at(std::uint32_t status, std::uint8_t findings) {
    status_ = status;
    findings_ = findings;
    const bool told = slow_motion_ && (findings & finding::kStandstill) == 0;
    if (!told || (findings & finding::kOpenPhase) == 0)
      open_looks_ = open_load() ? open_looks_ : std::uint8_t{0};
    else if (!open_load())
      ++open_looks_;
  }
  /// What it has now nobody knows.
  void forget_status() { status_ = 0, findings_ = 0; }

  DriverSettings settings_;
  DriverState state_ = DriverState::kUnasked;
  std::uint8_t failures_ = 0;
  bool configured_ = false, lost_settings_ = false, driver_error_ = false, charge_pump_low_ = false;
  LocalTime now_{0}, due_{0};
  std::uint16_t stall_guard_ = 0;

 private:
  static constexpr std::uint8_t kOpenLooks = 3;
  bool slow_motion_ = false;
  std::uint8_t open_looks_ = 0, findings_ = 0;
  std::uint32_t status_ = 0;
};

}  // namespace kinebus::step
