#pragma once
// One TMC2209 behind its wire, as a state machine without input or output of its own: finds the driver,
// writes its settings and checks by IFCNT that each arrived, then asks round and round how it is.
//
//   next() -> Datagram -> on_answer() / on_said() / on_failure()

#include <array>
#include <cstdint>
#include <optional>

#include "node_firmware/step/tmc2209_datagram.hpp"
#include "node_firmware/step/tmc2209_settings.hpp"
#include "protocol/time.hpp"

namespace kinebus::tmc2209 {

enum class State : std::uint8_t {
  kStandsAlone = 0,  ///< it is not to be spoken to
  kUnasked = 1,      ///< it has not answered yet, nor failed to
  kConfigured = 2,   ///< and has all that it was told
  kChanging = 3,     ///< its settings are on their way
  kSilent = 4,       ///< it does not answer, or is another chip
};

class Driver {
 public:
  /// Goes on with the settings until they have arrived.
  void set(const Settings& settings);
  void set_spoken_to(bool spoken_to);
  /// The motor moves so slowly that the driver can tell an open phase.
  void set_slow_motion(bool slow) { slow_motion_ = slow; }

  /// What to say now; none: nothing is due. One of the three follows.
  std::optional<Datagram> next(LocalTime now);
  void on_said();
  void on_answer(std::uint32_t value);
  /// No echo, no answer, or a garbled one.
  void on_failure();

  State state() const { return state_; }
  /// It has had all its settings since it got its power: they may be changing now.
  bool usable() const { return state_ == State::kStandsAlone || (configured_ && state_ != State::kSilent); }
  /// Settings are on their way: to be served before drivers that are only asked.
  bool busy() const { return state_ != State::kStandsAlone && state_ != State::kSilent && phase_ < kAsk; }
  /// It has lost its settings since acknowledge(): its supply was gone.
  bool lost_settings() const { return lost_settings_; }
  /// It had switched itself off since acknowledge().
  bool driver_error() const { return driver_error_; }
  bool charge_pump_low() const { return charge_pump_low_; }
  /// A phase carries no current: in so many looks in slow motion, one after the other.
  bool open_load() const { return open_looks_ >= kOpenLooks; }
  void acknowledge() { lost_settings_ = driver_error_ = false, open_looks_ = 0; }
  /// DRV_STATUS, as it was seen last.
  std::uint32_t status() const { return status_; }
  /// SG_RESULT, while StallGuard is looked at.
  std::uint16_t stall_guard() const { return stall_guard_; }

 private:
  enum Phase : std::uint8_t { kIdentify, kCount, kWriteNext, kVerify, kAsk, kAskStatus, kAskLoad };
  static constexpr int kTries = 4;
  static constexpr std::uint8_t kOpenLooks = 3;
  static constexpr LocalTime kLookAgain = std::chrono::milliseconds{500};  // for one that is silent
  static constexpr LocalTime kRound = std::chrono::milliseconds{40};       // looks at one that is well

  void begin(Phase phase) { phase_ = phase; }
  void write_all();

  Settings settings_;
  std::array<Register, kRegisters> wanted_ = registers_of({});
  std::uint32_t pending_ = (1u << kRegisters) - 1;  ///< by place in wanted_
  std::uint32_t written_ = 0;                       ///< of those, since the last count
  State state_ = State::kUnasked;
  Phase phase_ = kIdentify;
  Phase asked_ = kIdentify;  ///< by the datagram that is under way
  std::uint8_t count_ = 0, writes_ = 0, failures_ = 0, open_looks_ = 0;
  std::size_t place_ = 0;   ///< that is being written
  std::uint32_t said_ = 0;  ///< into it
  bool configured_ = false, lost_settings_ = false, driver_error_ = false, charge_pump_low_ = false;
  bool slow_motion_ = false, error_seen_ = false;
  std::uint32_t status_ = 0;
  std::uint16_t stall_guard_ = 0;
  LocalTime now_{0}, due_{0};
};

}  // namespace kinebus::tmc2209
