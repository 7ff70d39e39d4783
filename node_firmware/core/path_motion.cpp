#include "node_firmware/core/path_motion.hpp"

#include <algorithm>

#include "node_firmware/core/emergency_codes.hpp"

namespace kinebus {
namespace {

using Verdict = SegmentStream::Verdict;

// Half of the 2 us that two nodes may differ, and as much again for what a bound is above an error.
constexpr BusTime kClockAlarm = std::chrono::microseconds{4};
// Shortest pause between two looks at the queue's end while the rate is low.
constexpr LocalTime kLook = std::chrono::microseconds{200};

}  // namespace

void PathMotion::set_options(const Options& options) {
  options_ = options;
}

void PathMotion::on_sync(std::uint8_t counter, LocalTime arrival) {
  bus_clock_.on_sync(counter, arrival);
}

void PathMotion::on_stamp(const CanFrame& frame, LocalTime now) {
  const auto update = bus_clock_.on_stamp(frame, now);
  if (update.epoch_joined) path_.shift(update.epoch_shift);
  if (update.used) sync_lost_ = false;
  path_.forget_before(clock_.to_bus(now));
  const bool out = clock_.synchronised() && clock_.error_bound(now) > kClockAlarm;
  if (out && !out_of_bound_) ++counters_.clock_out_of_bound;
  out_of_bound_ = out;
}

bool PathMotion::on_rate_command(const CanFrame& frame, LocalTime now, bool clear_allowed) {
  const BusTime bus_now = clock_.to_bus(now);
  const auto command = decode_rate_command(frame, bus_now);
  if (!command) return false;
  using Kind = RateCommand::Kind;
  if (command->kind == Kind::kClear && !clear_allowed) return false;
  const bool starts = command->sets_rate() && command->rate_q15 != 0;
  // All nodes run or none: one that cannot says so, and the stop comes before the start that was named.
  // Without bus time it must not move either: the estimate still steps.
  if (starts && !clock_.synchronised()) {
    request_stop(StopReason::kSyncLost, 0, emcy::kSyncController, now);
    return false;
  }
  const auto outcome = path_.apply(*command, bus_now);
  using Outcome = PathClock::Outcome;
  if (outcome == Outcome::kDuplicate) ++counters_.duplicates;
  count_late(outcome, command->kind == Kind::kStop ? counters_.late_stops : counters_.late_rates);
  const bool taken = outcome == Outcome::kScheduled || outcome == Outcome::kLateRewound ||
                     outcome == Outcome::kLateCaughtUp || outcome == Outcome::kLateStarted;
  const bool refused = outcome == Outcome::kTooLate || (outcome == Outcome::kLatched && starts);
  if (taken && command->kind == Kind::kStop) ++counters_.stops;
  if (taken && command->kind == Kind::kClear) error_flags_ = 0;
  // Too late for the others' path time, or held back by a stop that the others may not have heard of: either
  // way this node's carriages are not where theirs are.
  if (refused) request_stop(StopReason::kCommand, 0, node_emcy::kCommand, now);
  if (taken && starts && (given_up_ || stream_.underrun()))
    request_stop(StopReason::kStreamError, 0, node_emcy::kStream, now);
  plan_starvation_check(now);
  return taken || outcome == Outcome::kDuplicate;
}

void PathMotion::clear_stop(LocalTime now) {
  if (!path_.stop_latched()) return;
  const RateCommand clear{.kind = RateCommand::Kind::kClear, .full_ramp_2ms = 1, .start = clock_.to_bus(now)};
  if (path_.apply(clear, clock_.to_bus(now)) == PathClock::Outcome::kScheduled) error_flags_ = 0;
}

void PathMotion::count_late(PathClock::Outcome outcome, std::uint32_t& counter) {
  using Outcome = PathClock::Outcome;
  if (outcome == Outcome::kLateRewound || outcome == Outcome::kLateCaughtUp ||
      outcome == Outcome::kLateStarted || outcome == Outcome::kTooLate)
    ++counter;
}

void PathMotion::on_peer_emcy(const CanFrame& frame, LocalTime now) {
  const BusTime bus_now = clock_.to_bus(now);
  const auto request = decode_stop_request(frame, bus_now);
  if (!request) return;
  const BusTime start = clock_.synchronised() ? stop_instant(*request, bus_now) : bus_now;
  const auto outcome = path_.stop_at(start, options_.stop_ramp_2ms, bus_now);
  count_late(outcome, counters_.late_stops);
  if (outcome != PathClock::Outcome::kDuplicate) ++counters_.stops;
}

SegmentStream::Verdict PathMotion::on_record(std::uint64_t raw, LocalTime now) {
  const Verdict verdict = stream_.push(raw, tau(now));
  judge(verdict, now);
  if (!stream_.waits_for_order())
    order_deadline_ = LocalTime::max();
  else if (verdict == Verdict::kAccepted || order_deadline_ == LocalTime::max())
    order_deadline_ = now + kOrderPatience;
  if (starvation_check_ == LocalTime::max()) plan_starvation_check(now);
  return verdict;
}

SegmentStream::Verdict PathMotion::on_checkpoint(std::uint64_t raw, LocalTime now) {
  const Verdict verdict = stream_.check(raw);
  if (verdict != Verdict::kStaleCheckpoint) judge(verdict, now);
  return verdict;
}

void PathMotion::judge(Verdict verdict, LocalTime now) {
  const auto stop_once = [&](std::uint8_t flag, StopReason reason, std::uint16_t code) {
    const bool known = (error_flags_ & flag) != 0;
    error_flags_ = static_cast<std::uint8_t>(error_flags_ | flag);
    if (!known) request_stop(reason, 0, code, now);
  };
  switch (verdict) {
    case Verdict::kAccepted:
    case Verdict::kEarly:
    case Verdict::kStaleCheckpoint:
      return;
    case Verdict::kDuplicate:
      ++counters_.duplicates;
      return;
    case Verdict::kSequence:
      ++counters_.sequence_errors;
      return stop_once(StreamStatus::kSequenceError, StopReason::kSequenceError, node_emcy::kSequence);
    case Verdict::kOverflow:
      ++counters_.overflows;
      return stop_once(StreamStatus::kSequenceError, StopReason::kSequenceError, node_emcy::kSequence);
    case Verdict::kCheckpoint:
      ++counters_.checkpoint_errors;
      return stop_once(StreamStatus::kCheckpointError, StopReason::kCheckpointError, node_emcy::kCheckpoint);
    case Verdict::kUnknown:
    case Verdict::kLateStart:
    case Verdict::kStartInMotion:
    case Verdict::kNotStarted:
    case Verdict::kEndInMotion:
    case Verdict::kNotFollowing:
    case Verdict::kOutOfLimits:
      ++counters_.sequence_errors;
      return stop_once(StreamStatus::kSequenceError, StopReason::kStreamError, node_emcy::kStream);
  }
}

bool PathMotion::clear_stream(LocalTime now) {
  if (!at_rest(now) && !stream_.idle()) return false;
  stream_.clear(tau(now));
  order_deadline_ = LocalTime::max();
  error_flags_ = 0;
  given_up_ = false;
  starvation_check_ = LocalTime::max();
  return true;
}

bool PathMotion::set_path_time(PathTime tau_wanted, LocalTime now) {
  // With motion queued, another path time would be another position.
  return stream_.idle() && path_.set_tau(tau_wanted, clock_.to_bus(now));
}

void PathMotion::request_stop(StopReason reason, int axis, std::uint16_t emcy_code, LocalTime now) {
  const BusTime ahead = clock_.to_bus(now) + kStopMargin;
  // The wire carries whole microseconds: this node must use what the others read.
  raise(reason, axis, emcy_code, BusTime{ahead.count() / 1000 * 1000}, now);
}

void PathMotion::raise(StopReason reason, int axis, std::uint16_t emcy_code, BusTime start, LocalTime now) {
  const auto outcome = path_.stop_at(start, options_.stop_ramp_2ms, clock_.to_bus(now));
  if (outcome != PathClock::Outcome::kDuplicate) ++counters_.stops;
  count_late(outcome, counters_.late_stops);
  if (alarm_count_ < kMaxAlarms)
    alarms_[static_cast<std::size_t>(alarm_count_++)] = {{reason, static_cast<std::uint8_t>(axis), start},
                                                         emcy_code};
}

void PathMotion::give_up_stream(LocalTime now) {
  if (stream_.idle() || given_up_) return;
  given_up_ = true;
  if (!at_rest(now)) request_stop(StopReason::kCommand, 0, node_emcy::kStream, now);
}

void PathMotion::advance_to(LocalTime at) {
  const bool ran = stream_.underrun();
  if (stream_.advance_to(tau(at)) || ran) return;
  // The ramp should have come first; there is no path left to stop on.
  ++counters_.underruns;
  error_flags_ |= StreamStatus::kUnderrun;
  request_stop(StopReason::kStarved, 0, node_emcy::kStarved, at);
}

// Path time that a stop takes from now: the way of the ramp, and what passes until all nodes have heard of
// it.
std::int64_t PathMotion::ticks_to_stop(std::uint64_t rate_q32) const {
  const std::uint64_t rate_q16 = rate_q32 >> 16;
  const std::uint64_t square_q16 = (rate_q16 * rate_q16) >> 16;
  const auto ramp_ticks = static_cast<std::uint64_t>(options_.stop_ramp_2ms) * 32'000;
  // kStopMargin, and once more for this node's own delay.
  constexpr std::uint64_t kMarginTicks = std::uint64_t{2} * 1500 * 16;
  const std::uint64_t margin = kMarginTicks + static_cast<std::uint64_t>(options_.starvation_margin.count());
  return static_cast<std::int64_t>(((square_q16 * ramp_ticks) >> 17) + ((rate_q16 * margin) >> 16));
}

bool PathMotion::starved(LocalTime now) const {
  const std::int64_t stop_tau = tau(now).count() + ticks_to_stop(rate_q32(now));
  return stream_.open() && stop_tau > stream_.horizon().count();
}

// A lower bound of when starved() may turn true: path time passes at most as fast as time.
void PathMotion::plan_starvation_check(LocalTime now) {
  starvation_check_ = LocalTime::max();
  if (!stream_.open() || at_rest(now) || path_.stop_latched()) return;
  const std::int64_t slack =
      stream_.horizon().count() - tau(now).count() - ticks_to_stop(std::uint64_t{1} << 32);
  // 62 ns a tick of 62.5: also for a crystal that is fast by 8000 ppm.
  starvation_check_ = now + std::max(kLook, LocalTime{slack * 62});
}

void PathMotion::watch_sync(LocalTime now, bool moves) {
  if (!sync_overdue(now)) return;
  sync_lost_ = true;
  ++counters_.sync_lost;
  if (at_rest(now) && !moves) return;
  // The same instant on every node that heard the same SYNCs.
  const BusTime start = clock_.last_sync_bus() + options_.sync_timeout;
  raise(StopReason::kSyncLost, 0, emcy::kSyncController, BusTime{start.count() / 1000 * 1000}, now);
}

// A record did not come after all.
void PathMotion::watch_order(LocalTime now) {
  if (now < order_deadline_) return;
  order_deadline_ = LocalTime::max();
  stream_.forget_early();
  judge(Verdict::kSequence, now);
}

void PathMotion::on_time(LocalTime now, bool moves) {
  advance_to(now);
  served_ = now;
  watch_sync(now, moves);
  watch_order(now);
  if (now < starvation_check_) return;
  if (!path_.stop_latched() && starved(now)) {
    ++counters_.underruns;
    error_flags_ |= StreamStatus::kUnderrun;
    request_stop(StopReason::kStarved, 0, node_emcy::kStarved, now);
  }
  plan_starvation_check(now);
}

LocalTime PathMotion::next_deadline() const {
  LocalTime deadline = std::min(starvation_check_, order_deadline_);
  if (const auto change = path_.next_change(clock_.to_bus(served_)))
    deadline = std::min(deadline, clock_.to_local(*change) + LocalTime{1'000});
  if (const auto start = stop_start(); start && *start > served_) deadline = std::min(deadline, *start);
  if (clock_.synchronised() && !sync_lost_)
    deadline = std::min(deadline, clock_.last_sync_local() + options_.sync_timeout);
  return deadline;
}

std::optional<PathAlarm> PathMotion::next_alarm() {
  if (alarm_count_ == 0) return std::nullopt;
  const PathAlarm alarm = alarms_[0];
  std::move(alarms_.begin() + 1, alarms_.begin() + alarm_count_, alarms_.begin());
  --alarm_count_;
  return alarm;
}

std::optional<LocalTime> PathMotion::stop_start() const {
  const auto start = path_.stop_start();
  if (!start) return std::nullopt;
  return clock_.to_local(*start);
}

std::uint8_t PathMotion::status_flags() const {
  unsigned flags = error_flags_;
  if (stream_.moving()) flags |= StreamStatus::kRunning;
  if (stream_.resting()) flags |= StreamStatus::kAtRest;
  if (path_.stop_latched()) flags |= StreamStatus::kStopped;
  if (clock_.synchronised() && !sync_lost_) flags |= StreamStatus::kSynchronised;
  if (stream_.reordered() != 0) flags |= StreamStatus::kReordered;
  return static_cast<std::uint8_t>(flags);
}

StreamStatus PathMotion::status(LocalTime now, bool checked) const {
  StreamStatus status;
  status.next_sequence = stream_.next_sequence();
  status.free_records = static_cast<std::uint8_t>(stream_.free_records());
  status.flags = status_flags();
  const std::int64_t error_us = clock_.error_bound(now).count() / 1000;
  status.sync_error_us = static_cast<std::uint8_t>(std::clamp<std::int64_t>(error_us, 0, 255));
  const std::int64_t units = tau(now).count() / kPathTicksPerUnit;
  status.path_units = static_cast<std::uint32_t>(units);
  if (checked) status.tail_check = stream_.tail_check(units);
  return status;
}

}  // namespace kinebus
