#pragma once
// Path time tau as a function of bus time: d tau/dt (the rate) follows straight and smooth ramps named by
// rate commands, and straight ones of stop requests. Every node and the gateway run this class; for equal
// commands they give the same tau at the same bus time to the last bit: integers only, and each command takes
// effect at the bus time that it names, whenever it arrives.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/motion/broadcast.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class PathClock {
 public:
  struct Options {
    /// A command that arrives this long after its start still ends at the tau that it would have ended at,
    /// however it gets there: see kLateRewound and kLateCaughtUp. A later stop starts at once; a later rate
    /// is void: nodes that hear it at slightly different times would each go its own way.
    BusTime rewind = std::chrono::milliseconds{12};
    /// No ramp is steeper than 0..1 in this: a command for a shorter one gets this one. 2 ms units.
    std::uint8_t least_full_ramp_2ms = 1;
    /// tau may be corrected by so much at once when a command comes late: 5 us, which no motor feels. Where
    /// no motor hangs on it (the gateway's copy) as much as it takes.
    PathTime most_step{80};
  };
  enum class Outcome : std::uint8_t {
    kScheduled,
    kLateRewound,   ///< start was just past: tau is as if it had come in time, a step of at most most_step
    kLateCaughtUp,  ///< a steeper ramp from `now` on, up to 4/3; after it, tau is as if it had come in time
    kLateStarted,   ///< a stop long past: began `now`, so other nodes may be at another tau. An alarm.
    kTooLate,       ///< refused: a rate whose start was long past. Others may have taken it: an alarm.
    kDuplicate,     ///< the last command again, one overtaken by a later one, or a stop after the one latched
    kLatched,       ///< refused: a stop is latched and comes first
    kNotAtRest,     ///< refused: kClear while moving
    kFull,          ///< refused: more changes ahead than kMaxLegs
  };

  PathClock() : PathClock(Options{}) {}
  explicit PathClock(Options options);

  void set_least_full_ramp(std::uint8_t full_ramp_2ms) { options_.least_full_ramp_2ms = full_ramp_2ms; }

  Outcome apply(const RateCommand& command, BusTime now);
  /// A stop asked for by any node (EMCY), or by this one. Earliest start wins; latched until kClear.
  Outcome stop_at(BusTime start, std::uint8_t full_ramp_2ms, BusTime now);

  /// Never decreases in `t` (a rewinding command excepted). Cost: about 10 ns; no division.
  PathTime tau(BusTime t) const;
  /// The same in 1/4096 ticks, for who differences it.
  std::int64_t fine_tau(BusTime t) const { return leg_at(t.count()).tau_at(t.count()); }
  /// 0 .. 2^32 = 0 .. 1.0.
  std::uint64_t rate_q32(BusTime t) const;
  /// Earliest bus time at which tau >= `path`; nullopt: never, as commanded so far. Cost: some 40 tau().
  std::optional<BusTime> when(PathTime path) const;

  /// The rate is 0 at `t`, and stays so as commanded so far.
  bool at_rest(BusTime t) const;
  /// A stop is commanded, even if its start is still ahead.
  bool stop_latched() const { return stop_.has_value(); }
  /// Start of the latched stop.
  std::optional<BusTime> stop_start() const;
  /// Next time after `t` at which a ramp begins or ends.
  std::optional<BusTime> next_change(BusTime t) const;

  /// Sets tau at rest (and drops what is ahead); false: not at rest.
  bool set_tau(PathTime path, BusTime now);
  /// The bus clock was set on by `shift` (a new epoch): every time that this holds moves with it.
  void shift(BusTime shift);
  /// Forgets what is older than the rewind time; to be called now and then (each SYNC will do).
  void forget_before(BusTime now);

 private:
  // tau in 1/4096 ticks: 15 ps, good for 4 years of path time.
  static constexpr int kTauBits = 12;
  static constexpr int kMaxLegs = 24;

  // From `start` on, until the next leg. Straight: tau = tau0 + (a * dt -/+ b * dt^2) / 2^50. Half of a
  // smooth ramp is cubic about the end where its slope is 0, of which rate_q32 and a are: its start, or,
  // where it lands, its end, at `length`, with dt counted back from there. c: of dt^3, / 2^86; w: of the
  // rate, / 2^64.
  struct Leg {
    std::int64_t start = 0;          // ns
    std::int64_t tau0 = 0;           // 1/4096 ticks
    std::uint64_t rate_q32 = 0;      // at the start
    std::uint64_t full_ramp_ns = 0;  // 0: constant rate, or smooth
    bool rising = false;
    bool lands = false;
    std::uint64_t a = 0, b = 0;
    std::uint64_t c = 0, w = 0;
    std::int64_t tau_end = 0;  // where it lands
    std::uint32_t length = 0;  // ns, of a smooth one

    bool smooth() const { return length != 0; }
    std::int64_t end() const { return start + length; }
    std::uint64_t to_end(std::int64_t t) const;
    std::int64_t way(std::uint64_t dt) const;
    std::int64_t tau_at(std::int64_t t) const;
    std::uint64_t rate_at(std::int64_t t) const;
  };
  struct Stop {
    std::int64_t start = 0;
    std::uint8_t full_ramp_2ms = 50;
  };

  Leg& leg(int i) { return legs_[static_cast<std::size_t>(i)]; }
  const Leg& leg(int i) const { return legs_[static_cast<std::size_t>(i)]; }
  const Leg& leg_at(std::int64_t t) const;
  /// A ramp's legs and what comes after it; a ramp that was made steeper waits before that.
  struct Change {
    std::array<Leg, 4> legs{};
    int count = 0;
    void add(const Leg& leg) { legs[static_cast<std::size_t>(count++)] = leg; }
    const Leg& after() const { return legs[static_cast<std::size_t>(count - 1)]; }
    /// nullptr: before the first of them.
    const Leg* at(std::int64_t t) const;
  };
  /// What a change is asked to be.
  struct Wanted {
    std::int64_t start = 0;
    std::uint64_t target_q32 = 0;
    std::uint8_t full_ramp_2ms = 0;
    bool smooth = false;
  };

  Change straight(const Wanted& wanted) const;
  Change smooth(const Wanted& wanted) const;
  std::optional<Change> caught_up(const Change& in_time, std::int64_t now, std::uint64_t full_ramp_ns) const;
  /// The change as it would have been in time, as far as that can still be had; nullopt: too late, nothing
  /// done.
  std::optional<Outcome> change(Wanted wanted, std::int64_t now);
  Outcome begin_stop(std::int64_t now);
  void put(const Change& change);
  void make_room(std::int64_t now);
  void drop(int old);
  static Leg make_leg(std::int64_t start, std::int64_t tau0, std::uint64_t rate_q32,
                      std::uint64_t full_ramp_ns, bool rising);
  static Leg leave(std::int64_t start, std::int64_t tau0, std::uint64_t rate_q32, std::uint32_t length,
                   std::uint64_t w, bool rising);
  static Leg land(const Leg& before, std::int64_t start, std::uint64_t rate_q32, std::uint32_t length);

  Options options_;
  std::array<Leg, kMaxLegs> legs_{};
  int count_ = 1;
  std::optional<Stop> stop_;
  std::optional<RateCommand> last_;
  std::int64_t newest_ = 0;   // start of the newest rate command
  std::int64_t cleared_ = 0;  // rate commands for before the last kClear are void
};

}  // namespace kinebus
