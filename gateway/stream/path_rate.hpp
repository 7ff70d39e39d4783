#pragma once
// The gateway's hand on path time: rate and stop broadcasts, and the same clock that the nodes run.

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/path_clock.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class PathRate {
 public:
  struct Options {
    std::chrono::milliseconds stop_ramp{100};
    /// A command names a start so far ahead, that its frame is with all nodes before: the frames already in
    /// the controller's mailboxes (3 of 135 us) and the scheduling of the sending thread. A hold answers
    /// within it.
    BusTime lead = std::chrono::milliseconds{5};
    /// Nobody waits for the start of a motion from rest, or for path time to stand behind the end of one: so
    /// far ahead also a node is in time whose program hangs as long as its watchdog allows (50 ms).
    BusTime start_lead = std::chrono::milliseconds{50};
  };
  struct Counters {
    std::uint32_t commands = 0;
    std::uint32_t late = 0;  ///< went out after the start that they name
  };

  PathRate() : PathRate(Options{}) {}
  explicit PathRate(Options options) : options_(options) {}

  PathTime tau(BusTime at) const { return clock_.tau(at); }
  double rate(BusTime at) const { return static_cast<double>(clock_.rate_q32(at)) / 4294967296.0; }
  /// The rate that was asked for last, 0..1.
  double target() const { return static_cast<double>(target_q15_) / kFullRateQ15; }
  bool at_rest(BusTime at) const { return clock_.at_rest(at); }
  bool stop_latched() const { return clock_.stop_latched(); }

  /// Goes to `rate` (0..1) with a slope of 1 in `full_ramp` (2..510 ms). Nothing happens when that is the
  /// target already, or while a stop is latched.
  /// `hurry`: false where no joint moves, and so nobody minds a start that is farther ahead.
  void request(double rate, std::chrono::milliseconds full_ramp, BusTime now, bool hurry = true);
  /// From rest, at `start` or as soon after it as a command can be in time, along the shortest ramp.
  void begin_at(double rate, BusTime start, BusTime now);
  /// How far ahead of a start all nodes have heard of it.
  BusTime start_lead() const { return options_.start_lead; }
  /// The same, along a smooth ramp that takes twice `full_ramp` whatever the change is; named twice as far
  /// ahead.
  void request_smooth(double rate, std::chrono::milliseconds full_ramp, BusTime now);
  /// The clock as it would be after that.
  PathClock with_smooth(double rate, std::chrono::milliseconds full_ramp, BusTime now) const;
  /// request() to it would do nothing.
  bool is_target(double rate) const { return q15(rate) == target_q15_; }
  /// All nodes follow smooth ramps, and the machine asks for them.
  void set_smooth(bool smooth) { smooth_ = smooth; }
  bool smooth() const { return smooth_; }
  /// Stop of all nodes, latched.
  void stop(BusTime now);
  /// A node's stop request was heard on the bus.
  void on_stop_request(const StopRequest& request, BusTime now);
  /// Lifts the latch; only at rest.
  void clear(BusTime now);
  /// Path time of the nodes, taken over at rest.
  void set_tau(PathTime tau, BusTime now) {
    clock_.set_tau(tau, now);
    unsent_.clear();
  }

  /// A stop that is sent so long after the start that it names that nodes could not catch up gets a new one:
  /// else every node would begin when it happens to hear of it.
  std::optional<CanFrame> next_frame(BusTime now);
  /// Every command goes out again kRepeats times: a receiver that has lost one frame would be the one
  /// carriage that runs while the others hold. Nodes take a doubled command as one.
  std::optional<CanFrame> next_repeat(BusTime now);
  BusTime next_deadline() const { return repeats_.empty() ? BusTime::max() : repeats_.front().due; }
  void on_frame_sent(BusTime when, const CanFrame& frame);
  /// Now and then, so that the clock forgets what is past.
  void on_time(BusTime now) { clock_.forget_before(now); }
  /// Every command was on the bus: what the nodes do is what this clock does.
  bool all_sent() const { return unsent_.empty(); }
  const Counters& counters() const { return counters_; }

 private:
  /// All of them before the start that is named. A receiver that loses one frame in five, none of which it
  /// notices, misses all eight copies twice in a million commands.
  static constexpr int kRepeats = 7;
  static constexpr BusTime kRepeatAfter = std::chrono::microseconds{600};
  struct Repeat {
    BusTime due{0};
    CanFrame frame;
  };
  static std::uint16_t q15(double rate);
  void request(RateCommand command, BusTime lead, BusTime now);
  BusTime smooth_lead(BusTime now) const;
  BusTime start(BusTime lead, BusTime now) const;
  void send(RateCommand command, BusTime now) { send(command, options_.lead, now); }
  void send(RateCommand command, BusTime lead, BusTime now);
  void put_out(const RateCommand& command, BusTime now);
  void withdraw_from(BusTime stop_start, BusTime now);

  Options options_;
  Counters counters_;
  // No motor hangs on it: news of a stop that come late, after the bus was blocked, put it where the nodes
  // are.
  PathClock clock_{{.rewind = std::chrono::seconds{2}, .most_step = PathTime::max()}};
  std::uint16_t target_q15_ = 0;
  bool smooth_ = false;
  std::uint8_t counter_ = 0;
  std::deque<CanFrame> out_;
  std::deque<CanFrame> unsent_;  // commands that were given, of which no copy was on the bus yet
  std::deque<Repeat> repeats_;   // by time
  BusTime last_start_{0};
};

}  // namespace kinebus
