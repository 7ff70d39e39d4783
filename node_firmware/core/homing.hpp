#pragma once
// Homing of one axis (CiA 402 methods 17..22, 35, 37) for a switch that is active from its edge to the end of
// the travel. Fast to the switch, off it, and slowly over the edge, in the direction that the method's motion
// diagram shows; home is where the axis was at the edge's time stamp, whatever debouncing and stopping took.
//
//   method  switch              edge is taken
//   17      negative limit      leaving it, moving up
//   18      positive limit      leaving it, moving down
//   19      home, upper end     leaving it, moving down
//   20      home, upper end     entering it, moving up
//   21      home, lower end     leaving it, moving up
//   22      home, lower end     entering it, moving down
//   35, 37  none                here and now
//   -3      none: the stop      meeting it, moving up
//   -4      none: the stop      meeting it, moving down
//
// At a stop (the driver's load, on the home input) all is fast, as there is no load to be seen in slow
// motion. The axis first goes off by `back_off`, so that it never begins at the stop; then it meets it, goes
// off again and meets it again: at the same place, and not where it has just been free. It stops on the spot,
// not to turn the field past a motor that stands.

#include <cstdint>

#include "node_firmware/core/trapezoid.hpp"

namespace kinebus {

struct HomingConfig {
  int method = 0;
  std::uint32_t fast = 1;          ///< counts/s
  std::uint32_t slow = 1;          ///< counts/s
  std::uint32_t acceleration = 1;  ///< counts/s^2
  std::int32_t offset = 0;         ///< counts: from the edge to the new zero
  std::uint32_t travel = 0;        ///< counts: at most so far towards the switch
  std::uint32_t back_off = 0;      ///< counts: at most so far off it, and back to it
};

enum class HomingError : std::uint8_t {
  kNone,
  kMethod,    ///< not one of the table above
  kNoLoad,    ///< at a stop, and the driver tells no load
  kNoSwitch,  ///< did not come within the travel
  kStuck,     ///< did not go off within the back-off travel
  kBounced,   ///< changed where it must not: while stopping on it, or after leaving it, or where no stop is
};

/// Drives the axis' Trapezoid; the owner tells it what the switch does and when the motion may have ended.
class Homing {
 public:
  static bool supports(int method);
  /// Of the home switch, or for 17 and 18 of the limit switch, of this axis. 0: uses none.
  enum class Switch : std::uint8_t { kNone, kHome, kNegativeLimit, kPositiveLimit };
  static Switch switch_of(int method);
  static bool by_load(int method) { return method == kPositiveStop || method == kNegativeStop; }

  /// What the driver makes of the motor's load. kBusy: it is being told how. To be called before start() and
  /// on_time().
  enum class Load : std::uint8_t { kNone, kBusy, kReady };
  void set_load(Load load) { load_ = load; }

  /// Carriages leave their switches one after the other (those of a node by themselves, those of several
  /// nodes by the gateway's word): if their wires are exchanged, the one that leaves does not see its switch
  /// go off, and no position is taken from the other's. `mine`: no other one leaves its switch now. To be
  /// called before the calls below.
  void set_turn(bool mine) { my_turn_ = mine; }
  bool leaving() const {
    return phase_ == Phase::kLeave || phase_ == Phase::kStopOff || phase_ == Phase::kEnter ||
           phase_ == Phase::kStopLatched;
  }
  bool waiting() const { return phase_ == Phase::kWait; }
  /// Time alone does not end it.
  bool polls() const { return waiting() || phase_ == Phase::kDriver; }

  void start(ProfileTicks now, const HomingConfig& config, bool switch_active, Trapezoid& motion);
  /// The switch of this method changed (debounced) at a moment when the axis was at `latched`.
  void on_switch(ProfileTicks now, bool active, std::int64_t latched, Trapezoid& motion);
  /// Call at motion.end() and whenever time has passed.
  void on_time(ProfileTicks now, Trapezoid& motion);
  /// Ends it where it is; the owner stops the motion. Not an error.
  void abort();

  bool running() const { return phase_ != Phase::kIdle; }
  bool attained() const { return attained_; }
  HomingError error() const { return error_; }
  std::int64_t latched() const { return latched_; }  ///< at the edge, coordinates of before
  /// What the coordinates have to be shifted by, once, when home was found; the motion is shifted already.
  bool take_shift(std::int64_t& by);

 private:
  enum class Phase : std::uint8_t {
    kIdle,
    kSeek,
    kStopOn,
    kWait,
    kLeave,
    kStopOff,
    kEnter,
    kStopLatched,
    kSettle,
    // By load.
    kFree,
    kDriver,
    kPress,
    kStopPressed
  };
  static constexpr int kPositiveStop = -3, kNegativeStop = -4;
  void go(Phase phase, ProfileTicks now, Trapezoid& motion, int direction, std::uint32_t speed,
          std::uint32_t travel);
  void stop_into(Phase phase, ProfileTicks now, Trapezoid& motion);
  void fail(ProfileTicks now, Trapezoid& motion, HomingError error);
  void leave(ProfileTicks now, Trapezoid& motion);
  void finish(ProfileTicks now, Trapezoid& motion);
  void go_free(ProfileTicks now, Trapezoid& motion);
  void press(ProfileTicks now, Trapezoid& motion);
  void on_load(ProfileTicks now, std::int64_t latched, Trapezoid& motion);

  HomingConfig config_;
  Phase phase_ = Phase::kIdle;
  int direction_ = 1;      // towards the switch
  bool entering_ = false;  // the edge is taken on the way in
  bool my_turn_ = true;
  Load load_ = Load::kNone;
  bool active_ = false, second_ = false;  // by load: the input, and which of the two meetings
  std::int64_t pressed_from_ = 0;
  bool attained_ = false;
  bool has_shift_ = false;
  HomingError error_ = HomingError::kNone;
  std::int64_t latched_ = 0;
  std::int64_t shift_ = 0;
};

}  // namespace kinebus
