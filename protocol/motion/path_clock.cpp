#include "protocol/motion/path_clock.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "protocol/motion/wide_integer.hpp"

namespace kinebus {
namespace {

constexpr int kScaleBits = 50;
// Legs for a rate's change, four at most, and three of a stop's: that is never refused.
constexpr int kRoom = 4 + 3;
constexpr std::int64_t kLongAgo = std::numeric_limits<std::int64_t>::min() / 4;

// 16 ticks a microsecond: 0.016 ticks for each nanosecond at rate 1, with 64 fractional bits (rounded down).
constexpr std::uint64_t kTicksPerNsQ64 = 295'147'905'179'352'825u;
constexpr std::uint64_t full_ramp_ns(std::uint8_t full_ramp_2ms) {
  return full_ramp_2ms * std::uint64_t{2'000'000};
}

// Of a cubic: c / 2^86 * dt^3 is the way of w / 2^96 * dt^2, so c = w * 0.016 * 2^12 / (3 * 2^10).
constexpr int kCubicBits = 86;
constexpr std::uint64_t kCubicOfSquare = kTicksPerNsQ64 / 3 * 4;
// w of a change by 2^-32 in two halves of 2 ms: 2^63 / (2 ms in ns)^2, with 8 more bits.
constexpr std::uint64_t kSquareBits = 8, kSquareOfChange = 590'295'810u;

}  // namespace

/// From `t` to the end.
std::uint64_t PathClock::Leg::to_end(std::int64_t t) const {
  return static_cast<std::uint64_t>(std::clamp<std::int64_t>(end() - t, 0, length));
}

/// In `dt` from `start`, or to the end where it lands.
std::int64_t PathClock::Leg::way(std::uint64_t dt) const {
  U128 sum = multiply(a, dt);
  // A leg that bends lasts 510 ms at most, so dt^2 is below 2^58. One rounding, at the end: tau cannot run
  // back.
  if (smooth()) {
    U128 bend = multiply(multiply(c, dt * dt), dt);
    constexpr int kMore = kCubicBits - kScaleBits;
    bend = {bend.high >> kMore, shift_right(bend, kMore)};
    sum = rising != lands ? add(sum, bend) : subtract(sum, bend);
  } else if (b != 0) {
    const U128 bend = multiply(b, dt * dt);
    sum = rising ? add(sum, bend) : subtract(sum, bend);
  }
  return static_cast<std::int64_t>(shift_right(sum, kScaleBits));
}

std::int64_t PathClock::Leg::tau_at(std::int64_t t) const {
  if (lands) return tau_end - way(to_end(t));
  if (a == 0 && b == 0 && c == 0) return tau0;
  return tau0 + way(static_cast<std::uint64_t>(std::max<std::int64_t>(t - start, 0)));
}

std::uint64_t PathClock::Leg::rate_at(std::int64_t t) const {
  const auto dt = static_cast<std::uint64_t>(std::max<std::int64_t>(t - start, 0));
  if (smooth()) {
    const std::uint64_t from_still = lands ? to_end(t) : dt;
    const std::uint64_t change = multiply(w, from_still * from_still).high;
    return rising != lands ? rate_q32 + change : rate_q32 - std::min(rate_q32, change);
  }
  if (full_ramp_ns == 0) return rate_q32;
  const std::uint64_t change = (dt << 32) / full_ramp_ns;
  return rising ? rate_q32 + change : rate_q32 - std::min(rate_q32, change);
}

PathClock::PathClock(Options options) : options_(options) {
  legs_[0].start = kLongAgo;
}

const PathClock::Leg& PathClock::leg_at(std::int64_t t) const {
  int i = count_ - 1;
  while (i > 0 && t < leg(i).start) --i;
  return leg(i);
}

PathTime PathClock::tau(BusTime t) const {
  return PathTime{leg_at(t.count()).tau_at(t.count()) >> kTauBits};
}

std::uint64_t PathClock::rate_q32(BusTime t) const {
  return leg_at(t.count()).rate_at(t.count());
}

PathClock::Leg PathClock::make_leg(std::int64_t start, std::int64_t tau0, std::uint64_t rate_q32,
                                   std::uint64_t full_ramp, bool rising) {
  Leg fresh{.start = start, .tau0 = tau0, .rate_q32 = rate_q32, .full_ramp_ns = full_ramp, .rising = rising};
  // a = rate * 0.016 * 2^(12+50), b = 0.016 * 2^(12+50) / (2 * ramp); both rounded down, so a falling ramp's
  // parabola never passes its vertex within the ramp.
  fresh.a = shift_right(multiply(rate_q32, kTicksPerNsQ64), 64 + 32 - kTauBits - kScaleBits);
  if (full_ramp != 0) fresh.b = (kTicksPerNsQ64 >> (64 - kTauBits - kScaleBits + 1)) / full_ramp;
  return fresh;
}

/// A smooth ramp's first half, from where its slope is 0.
PathClock::Leg PathClock::leave(std::int64_t start, std::int64_t tau0, std::uint64_t rate_q32,
                                std::uint32_t length, std::uint64_t w, bool rising) {
  Leg fresh = make_leg(start, tau0, rate_q32, 0, rising);
  fresh.length = length;
  fresh.w = w;
  fresh.c = multiply(w, kCubicOfSquare).high;
  return fresh;
}

/// The half that brings the slope of `before`, which it is bent as, to 0 at rate_q32.
PathClock::Leg PathClock::land(const Leg& before, std::int64_t start, std::uint64_t rate_q32,
                               std::uint32_t length) {
  Leg fresh = leave(start, before.tau_at(start), rate_q32, length, before.w, before.rising);
  fresh.lands = true;
  fresh.tau_end = fresh.tau0 + fresh.way(length);
  return fresh;
}

const PathClock::Leg* PathClock::Change::at(std::int64_t t) const {
  const Leg* found = nullptr;
  for (int i = 0; i < count; ++i)
    if (const Leg& leg = legs[static_cast<std::size_t>(i)]; leg.start <= t) found = &leg;
  return found;
}

/// A ramp from `start` on, from what is in force then.
PathClock::Change PathClock::straight(const Wanted& wanted) const {
  const std::int64_t start = wanted.start;
  const std::uint64_t ramp = full_ramp_ns(wanted.full_ramp_2ms);
  const Leg& base = leg_at(start);
  const std::uint64_t from_q32 = base.rate_at(start);
  const std::int64_t tau0 = base.tau_at(start);
  const bool rising = wanted.target_q32 > from_q32;
  const std::uint64_t difference = rising ? wanted.target_q32 - from_q32 : from_q32 - wanted.target_q32;
  const auto duration = static_cast<std::int64_t>((difference * ramp) >> 32);
  Change result;
  std::int64_t end_tau = tau0;
  if (duration > 0) {
    result.add(make_leg(start, tau0, from_q32, ramp, rising));
    end_tau = result.after().tau_at(start + duration);
  }
  result.add(make_leg(start + duration, end_tau, wanted.target_q32, 0, false));
  return result;
}

/// The same, smooth: in two halves, after what brings a smooth ramp that is under way to a slope of 0.
PathClock::Change PathClock::smooth(const Wanted& wanted) const {
  const Leg& base = leg_at(wanted.start);
  Change result;
  std::int64_t at = wanted.start, tau0 = base.tau_at(at);
  std::uint64_t from_q32 = base.rate_at(at);
  if (base.smooth() && base.lands && base.end() > at) {
    at = base.end();
    tau0 = base.tau_end;
    from_q32 = base.rate_q32;
  } else if (base.smooth() && !base.lands && at > base.start) {
    const auto gone = static_cast<std::uint32_t>(std::min(at, base.end()) - base.start);
    const std::uint64_t change = multiply(base.w, std::uint64_t{gone} * gone).high * 2;
    from_q32 = base.rising ? base.rate_q32 + change : base.rate_q32 - std::min(base.rate_q32, change);
    result.add(land(base, at, from_q32, gone));
    at = result.after().end();
    tau0 = result.after().tau_end;
  }
  const bool rising = wanted.target_q32 > from_q32;
  const std::uint64_t difference = rising ? wanted.target_q32 - from_q32 : from_q32 - wanted.target_q32;
  if (difference != 0) {
    const std::uint32_t n = wanted.full_ramp_2ms, half = n * 2'000'000u, square = n * n;
    const std::uint64_t w = (difference * kSquareOfChange / square) >> kSquareBits;
    result.add(leave(at, tau0, from_q32, half, w, rising));
    result.add(land(result.after(), at + half, wanted.target_q32, half));
    at = result.after().end();
    tau0 = result.after().tau_end;
  }
  result.add(make_leg(at, tau0, wanted.target_q32, 0, false));
  return result;
}

/// A ramp from `now` on, that goes over into what comes after `in_time`. With the rates r0 now and r1 after,
/// it has to last D = 2 (after(now) - tau(now)) / (r0 - r1), where after() is carried on backwards.
std::optional<PathClock::Change> PathClock::caught_up(const Change& in_time, std::int64_t now,
                                                      std::uint64_t ramp) const {
  const Leg& base = leg_at(now);
  const std::uint64_t from = base.rate_at(now), target = in_time.after().rate_q32;
  if (from == target || in_time.after().start <= now) return std::nullopt;
  const bool rising = target > from;
  const std::uint64_t difference = rising ? target - from : from - target;
  const Leg carried = make_leg(now, 0, target, 0, false);
  const std::int64_t after_now = in_time.after().tau0 - carried.tau_at(in_time.after().start);
  const std::int64_t gap = rising ? base.tau_at(now) - after_now : after_now - base.tau_at(now);
  if (gap <= 0) return std::nullopt;
  // Ramps end after 1.53 s: the gap is below 2^36, in 1/4096 ticks of 62.5 ns. 2 * 62.5 ns = 125 ns.
  const auto gap_ns = (static_cast<std::uint64_t>(gap) * 125) >> kTauBits;  // twice the gap
  if (gap_ns >= std::uint64_t{1} << 31) return std::nullopt;
  // 8 ns to the side on which rounding leaves tau going forward by some ns, never back.
  const std::uint64_t exact = (gap_ns << 32) / difference;
  const std::uint64_t duration = rising ? exact + 8 : exact - std::min<std::uint64_t>(exact, 8);
  const std::uint64_t steeper = (duration << 32) / std::max<std::uint64_t>(difference, 1);
  if (duration >= std::uint64_t{1} << 31 || steeper < ramp - ramp / 4 || steeper > ramp) return std::nullopt;
  const auto end = now + static_cast<std::int64_t>(duration);
  if (end > in_time.after().start) return std::nullopt;
  // Then along the line that in_time.after goes on with, to the bit from there on.
  const Leg line = make_leg(end, 0, target, 0, false);
  const std::int64_t tau_end = in_time.after().tau0 - line.tau_at(in_time.after().start);
  Change result;
  result.add(make_leg(now, base.tau_at(now), from, steeper, rising));
  result.add(make_leg(end, tau_end, target, 0, false));
  result.add(in_time.after());
  return result;
}

/// In place of all that came after its start. A leg is whole before it counts: who stops the program at any
/// instruction and asks for path time, a debugger or a test, gets what is in force.
void PathClock::put(const Change& change) {
  while (count_ > 1 && leg(count_ - 1).start >= change.legs[0].start) --count_;
  for (int i = 0; i < change.count; ++i) {
    leg(count_) = change.legs[static_cast<std::size_t>(i)];
    std::atomic_signal_fence(std::memory_order_seq_cst);
    ++count_;
  }
}

std::optional<PathClock::Outcome> PathClock::change(Wanted wanted, std::int64_t now) {
  wanted.full_ramp_2ms = std::max(wanted.full_ramp_2ms, options_.least_full_ramp_2ms);
  const std::int64_t start = wanted.start;
  const Change in_time = wanted.smooth ? smooth(wanted) : straight(wanted);
  if (start >= now) {
    put(in_time);
    return Outcome::kScheduled;
  }
  if (now - start > options_.rewind.count() || start < legs_[0].start) return std::nullopt;
  const Leg& present = leg_at(now);
  const Leg* const then = in_time.at(now);
  const std::int64_t step = then == nullptr ? 0 : then->tau_at(now) - present.tau_at(now);
  if ((step < 0 ? -step : step) >> kTauBits <= options_.most_step.count()) {
    put(in_time);
    return Outcome::kLateRewound;
  }
  std::uint64_t ramp = full_ramp_ns(wanted.full_ramp_2ms);
  if (wanted.smooth) {
    // As steep as a smooth one is in the mean.
    const std::uint64_t from = leg_at(start).rate_at(start), target = wanted.target_q32;
    const auto lasts = static_cast<std::uint64_t>(in_time.after().start - start);
    ramp = (lasts << 32) / std::max<std::uint64_t>(from > target ? from - target : target - from, 1);
  }
  const auto catching = caught_up(in_time, now, ramp);
  if (!catching) return std::nullopt;
  put(*catching);
  return Outcome::kLateCaughtUp;
}

PathClock::Outcome PathClock::apply(const RateCommand& command, BusTime now) {
  if (last_ == command) return Outcome::kDuplicate;
  forget_before(now);
  Outcome outcome = Outcome::kScheduled;
  switch (command.kind) {
    case RateCommand::Kind::kStop:
      outcome = stop_at(command.start, command.full_ramp_2ms, now);
      break;
    case RateCommand::Kind::kClear:
      if (!at_rest(std::max(now, command.start))) return Outcome::kNotAtRest;
      stop_.reset();
      cleared_ = command.start.count();
      newest_ = kLongAgo;
      break;
    case RateCommand::Kind::kRate:
    case RateCommand::Kind::kSmooth: {
      const bool in_time = command.start >= now - options_.rewind;
      const std::int64_t earliest = in_time ? command.start.count() : now.count();
      if (command.start.count() < cleared_ || (stop_ && earliest >= stop_->start)) return Outcome::kLatched;
      if (command.start.count() < newest_) return Outcome::kDuplicate;
      make_room(now.count());
      if (count_ + kRoom > kMaxLegs) return Outcome::kFull;
      newest_ = command.start.count();
      const auto changed = change({.start = command.start.count(),
                                   .target_q32 = static_cast<std::uint64_t>(command.rate_q15) << 17,
                                   .full_ramp_2ms = command.full_ramp_2ms,
                                   .smooth = command.kind == RateCommand::Kind::kSmooth},
                                  now.count());
      outcome = changed.value_or(Outcome::kTooLate);
      if (changed && stop_) begin_stop(now.count());
      break;
    }
  }
  last_ = command;
  return outcome;
}

PathClock::Outcome PathClock::stop_at(BusTime start, std::uint8_t full_ramp_2ms, BusTime now) {
  const bool in_time = start >= now - options_.rewind;
  if (stop_ && (in_time ? start : now).count() >= stop_->start) return Outcome::kDuplicate;
  stop_ = Stop{start.count(), full_ramp_2ms};
  return begin_stop(now.count());
}

/// A stop is never refused: too late for the common ramp, it begins now.
PathClock::Outcome PathClock::begin_stop(std::int64_t now) {
  if (const auto changed = change({.start = stop_->start, .full_ramp_2ms = stop_->full_ramp_2ms}, now))
    return *changed;
  stop_->start = now;
  static_cast<void>(change({.start = now, .full_ramp_2ms = stop_->full_ramp_2ms}, now));
  return Outcome::kLateStarted;
}

std::optional<BusTime> PathClock::when(PathTime path) const {
  const std::int64_t wanted = path.count() << kTauBits;
  if (wanted <= legs_[0].tau0) return BusTime{legs_[0].start};
  for (int i = 0; i < count_; ++i) {
    const Leg& here = leg(i);
    const bool last = i + 1 == count_;
    std::int64_t low = here.start;  // tau(low) < wanted
    std::int64_t high;
    if (!last) {
      high = leg(i + 1).start;
      if (leg(i + 1).tau0 < wanted) continue;
    } else {
      if (here.rate_q32 == 0) return std::nullopt;
      // At rate 1, 62.5 ns a tick: a first guess that is never too late.
      std::int64_t step = std::max<std::int64_t>(((wanted - here.tau0) >> kTauBits) * 62, 64);
      high = low + step;
      while (here.tau_at(high) < wanted) low = high, step *= 2, high = low + step;
    }
    while (high - low > 1) {
      const std::int64_t middle = low + (high - low) / 2;
      (here.tau_at(middle) < wanted ? low : high) = middle;
    }
    return BusTime{high};
  }
  return std::nullopt;
}

bool PathClock::at_rest(BusTime t) const {
  if (rate_q32(t) != 0) return false;
  for (int i = 0; i < count_; ++i) {
    const Leg& here = leg(i);
    if (here.start > t.count() && (here.rate_q32 != 0 || here.rising)) return false;
  }
  return !leg_at(t.count()).rising && !leg_at(t.count()).smooth();
}

std::optional<BusTime> PathClock::stop_start() const {
  if (!stop_) return std::nullopt;
  return BusTime{stop_->start};
}

std::optional<BusTime> PathClock::next_change(BusTime t) const {
  for (int i = 0; i < count_; ++i)
    if (leg(i).start > t.count()) return BusTime{leg(i).start};
  return std::nullopt;
}

bool PathClock::set_tau(PathTime path, BusTime now) {
  if (!at_rest(now)) return false;
  legs_[0] = make_leg(kLongAgo, path.count() << kTauBits, 0, 0, false);
  count_ = 1;
  return true;
}

void PathClock::shift(BusTime by) {
  for (int i = 0; i < count_; ++i) {
    std::int64_t& start = leg(i).start;
    if (start != kLongAgo) start += by.count();
  }
  if (stop_) stop_->start += by.count();
  cleared_ += by.count();
  newest_ = kLongAgo;
  last_.reset();
}

/// Rather the oldest of what could be rewound than a change that all others make.
void PathClock::make_room(std::int64_t now) {
  int old = 0;
  while (count_ - old + kRoom > kMaxLegs && old + 1 < count_ && leg(old + 1).start <= now) ++old;
  drop(old);
}

void PathClock::forget_before(BusTime now) {
  const std::int64_t kept = (now - options_.rewind).count();
  int old = 0;
  while (old + 1 < count_ && leg(old + 1).start <= kept) ++old;
  drop(old);
}

void PathClock::drop(int old) {
  if (old == 0) return;
  std::move(legs_.begin() + old, legs_.begin() + count_, legs_.begin());
  count_ -= old;
}

}  // namespace kinebus
