#pragma once
// Everything about path time on one node: the estimate of bus time, path time with its rate, the stream that
// is executed along it, and the stops that all nodes make together. A cause for a stop found here is told as
// a PathAlarm, which the node sends as EMCY; its instant is named ahead, so that all nodes begin the same
// ramp at once.

#include <cstdint>
#include <optional>

#include "node_firmware/core/segment_stream.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/bus_clock.hpp"
#include "protocol/motion/path_clock.hpp"

namespace kinebus {

struct PathAlarm {
  StopRequest stop;
  std::uint16_t emcy_code = 0;
};

class PathMotion {
 public:
  struct Options {
    std::uint8_t stop_ramp_2ms = 50;
    LocalTime sync_timeout{175'000'000};
    PathTime starvation_margin{800'000};  ///< 50 ms at full rate, on top of the stop ramp
    friend constexpr bool operator==(const Options&, const Options&) = default;
  };
  struct Counters {
    std::uint32_t sync_lost = 0, clock_out_of_bound = 0, sequence_errors = 0, overflows = 0, underruns = 0,
                  checkpoint_errors = 0, late_rates = 0, late_stops = 0, duplicates = 0, stops = 0;
  };
  /// A record that comes later than those sent after it is waited for so long. What exchanges frames on their
  /// way does so within a USB frame of 1 ms or two; the reserve of queued motion is many times longer.
  static constexpr LocalTime kOrderPatience = std::chrono::milliseconds{5};

  /// `clock`: of all nodes behind the same CAN controller.
  explicit PathMotion(BusClock& clock) : bus_clock_(clock) {}
  PathMotion(const PathMotion&) = delete;
  PathMotion& operator=(const PathMotion&) = delete;

  void set_options(const Options& options);

  void on_sync(std::uint8_t counter, LocalTime arrival);
  void on_stamp(const CanFrame& frame, LocalTime now);
  /// false: malformed, or refused (latched, not at rest).
  bool on_rate_command(const CanFrame& frame, LocalTime now, bool clear_allowed);
  /// Lifts the latch without the gateway, at rest.
  void clear_stop(LocalTime now);
  void on_peer_emcy(const CanFrame& frame, LocalTime now);
  /// What became of it; errors raise an alarm. Behind on_time(now).
  SegmentStream::Verdict on_record(std::uint64_t raw, LocalTime now);
  SegmentStream::Verdict on_checkpoint(std::uint64_t raw, LocalTime now);
  /// Drops the queue; false: path time moves while motion is queued.
  bool clear_stream(LocalTime now);
  bool set_path_time(PathTime tau, LocalTime now);

  /// Asks all nodes to stop together; latched.
  void request_stop(StopReason reason, int axis, std::uint16_t emcy_code, LocalTime now);
  /// An axis does not follow any more what is queued: the queue is worthless until cleared.
  void give_up_stream(LocalTime now);

  /// SYNC loss and starvation. `moves`: an axis moves by itself, off the path; without SYNC that ends, too.
  void on_time(LocalTime now, bool moves = false);
  /// The next on_time() finds that SYNC is missing.
  bool sync_overdue(LocalTime now) const {
    return clock_.synchronised() && !sync_lost_ && now - clock_.last_sync_local() >= options_.sync_timeout;
  }
  LocalTime next_deadline() const;
  std::optional<PathAlarm> next_alarm();

  /// Walks the stream to `at`.
  void advance_to(LocalTime at);
  PathTime tau(LocalTime at) const { return path_.tau(clock_.to_bus(at)); }
  std::uint64_t rate_q32(LocalTime at) const { return path_.rate_q32(clock_.to_bus(at)); }
  /// Path time stands still and will by itself.
  bool at_rest(LocalTime at) const { return path_.at_rest(clock_.to_bus(at)); }
  bool stop_latched() const { return path_.stop_latched(); }
  /// Local time at which the latched stop starts or started.
  std::optional<LocalTime> stop_start() const;
  /// `checked`: with a check of the stream's tail.
  StreamStatus status(LocalTime now, bool checked) const;
  /// Its flags alone: cheap enough to look at after every input.
  std::uint8_t status_flags() const;

  SegmentStream& stream() { return stream_; }
  const SegmentStream& stream() const { return stream_; }
  const ClockEstimate& clock() const { return clock_; }
  const Counters& counters() const { return counters_; }

 private:
  static constexpr int kMaxAlarms = 4;

  void raise(StopReason reason, int axis, std::uint16_t emcy_code, BusTime start, LocalTime now);
  void judge(SegmentStream::Verdict verdict, LocalTime now);
  void count_late(PathClock::Outcome outcome, std::uint32_t& counter);
  std::int64_t ticks_to_stop(std::uint64_t rate_q32) const;
  bool starved(LocalTime now) const;
  void plan_starvation_check(LocalTime now);
  void watch_sync(LocalTime now, bool moves);
  void watch_order(LocalTime now);

  Options options_;
  BusClock& bus_clock_;
  const ClockEstimate& clock_ = bus_clock_.estimate();
  PathClock path_;
  SegmentStream stream_;
  Counters counters_;
  std::array<PathAlarm, kMaxAlarms> alarms_{};
  int alarm_count_ = 0;
  std::uint8_t error_flags_ = 0;  // StreamStatus::k...Error, until cleared
  bool sync_lost_ = false;
  bool out_of_bound_ = false;
  bool given_up_ = false;
  LocalTime starvation_check_ = LocalTime::max();
  LocalTime order_deadline_ = LocalTime::max();  // max: no record is missed
  LocalTime served_ = LocalTime{0};
};

}  // namespace kinebus
