#include "protocol/motion/path_clock.hpp"

#include <algorithm>
#include <limits>

namespace kinebus {
namespace {

constexpr int kScaleBits = 50;
constexpr std::int64_t kLongAgo = std::numeric_limits<std::int64_t>::min() / 4;

// 128-bit unsigned, for processors and compilers without one: just what a leg needs.
struct U128 {
  std::uint64_t high = 0, low = 0;
};
constexpr U128 multiply(std::uint64_t x, std::uint64_t y) {
  const std::uint64_t x0 = x & 0xFFFF'FFFFu, x1 = x >> 32, y0 = y & 0xFFFF'FFFFu, y1 = y >> 32;
  const std::uint64_t low = x0 * y0;
  const std::uint64_t middle = x1 * y0 + (low >> 32);
  const std::uint64_t middle2 = x0 * y1 + (middle & 0xFFFF'FFFFu);
  return {x1 * y1 + (middle >> 32) + (middle2 >> 32), (middle2 << 32) | (low & 0xFFFF'FFFFu)};
}
constexpr U128 add(U128 x, U128 y) {
  const std::uint64_t low = x.low + y.low;
  return {x.high + y.high + (low < x.low ? 1u : 0u), low};
}
constexpr U128 subtract(U128 x, U128 y) {
  return {x.high - y.high - (x.low < y.low ? 1u : 0u), x.low - y.low};
}
constexpr std::uint64_t shift_right(U128 x, int bits) {  // 0 < bits < 64; the result fits
  return (x.high << (64 - bits)) | (x.low >> bits);
}

// 16 ticks a microsecond: 0.016 ticks for each nanosecond at rate 1, with 64 fractional bits (rounded down).
constexpr std::uint64_t kTicksPerNsQ64 = 295'147'905'179'352'825u;
constexpr std::uint64_t full_ramp_ns(std::uint8_t full_ramp_2ms) {
  return full_ramp_2ms * std::uint64_t{2'000'000};
}

}  // namespace

std::int64_t PathClock::Leg::tau_at(std::int64_t t) const {
  if (a == 0 && b == 0) return tau0;
  const auto dt = static_cast<std::uint64_t>(std::max<std::int64_t>(t - start, 0));
  U128 sum = multiply(a, dt);
  if (b != 0) {
    // A ramp lasts 510 ms at most, so dt^2 is below 2^58. One rounding, at the end: tau cannot run back.
    const U128 bend = multiply(b, dt * dt);
    sum = rising ? add(sum, bend) : subtract(sum, bend);
  }
  return tau0 + static_cast<std::int64_t>(shift_right(sum, kScaleBits));
}

std::uint64_t PathClock::Leg::rate_at(std::int64_t t) const {
  if (full_ramp_ns == 0) return rate_q32;
  const auto dt = static_cast<std::uint64_t>(std::max<std::int64_t>(t - start, 0));
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

/// A ramp to `target_q32` from `start` on, from what is in force then.
PathClock::Change PathClock::planned(std::int64_t start, std::uint64_t target_q32, std::uint64_t ramp) const {
  const Leg& base = leg_at(start);
  const std::uint64_t from_q32 = base.rate_at(start);
  const std::int64_t tau0 = base.tau_at(start);
  const bool rising = target_q32 > from_q32;
  const std::uint64_t difference = rising ? target_q32 - from_q32 : from_q32 - target_q32;
  const auto duration = static_cast<std::int64_t>((difference * ramp) >> 32);
  Change result{.ramp = make_leg(start, tau0, from_q32, ramp, rising), .middle = {}, .after = {}};
  const std::int64_t end_tau = duration > 0 ? result.ramp.tau_at(start + duration) : tau0;
  result.after = make_leg(start + duration, end_tau, target_q32, 0, false);
  return result;
}

/// A ramp from `now` on, that goes over into what comes after `in_time`. With the rates r0 now and r1 after,
/// it has to last D = 2 (after(now) - tau(now)) / (r0 - r1), where after() is carried on backwards.
std::optional<PathClock::Change> PathClock::caught_up(const Change& in_time, std::int64_t now,
                                                      std::uint64_t ramp) const {
  const Leg& base = leg_at(now);
  const std::uint64_t from = base.rate_at(now), target = in_time.after.rate_q32;
  if (from == target || in_time.after.start <= now) return std::nullopt;
  const bool rising = target > from;
  const std::uint64_t difference = rising ? target - from : from - target;
  const Leg carried = make_leg(now, 0, target, 0, false);
  const std::int64_t after_now = in_time.after.tau0 - carried.tau_at(in_time.after.start);
  const std::int64_t gap = rising ? base.tau_at(now) - after_now : after_now - base.tau_at(now);
  if (gap <= 0) return std::nullopt;
  // Ramps end after half a second: the gap is below 2^36, in 1/4096 ticks of 62.5 ns. 2 * 62.5 ns = 125 ns.
  const auto gap_ns = (static_cast<std::uint64_t>(gap) * 125) >> kTauBits;  // twice the gap
  if (gap_ns >= std::uint64_t{1} << 31) return std::nullopt;
  // 8 ns to the side on which rounding leaves tau going forward by some ns, never back.
  const std::uint64_t exact = (gap_ns << 32) / difference;
  const std::uint64_t duration = rising ? exact + 8 : exact - std::min<std::uint64_t>(exact, 8);
  const std::uint64_t steeper = (duration << 32) / std::max<std::uint64_t>(difference, 1);
  if (duration >= std::uint64_t{1} << 31 || steeper < ramp - ramp / 4 || steeper > ramp) return std::nullopt;
  const auto end = now + static_cast<std::int64_t>(duration);
  if (end > in_time.after.start) return std::nullopt;
  // Then along the line that in_time.after goes on with, to the bit from there on.
  const Leg line = make_leg(end, 0, target, 0, false);
  const std::int64_t tau_end = in_time.after.tau0 - line.tau_at(in_time.after.start);
  return Change{.ramp = make_leg(now, base.tau_at(now), from, steeper, rising),
                .middle = make_leg(end, tau_end, target, 0, false),
                .after = in_time.after};
}

/// In place of all that came after its start.
void PathClock::put(const Change& change) {
  while (count_ > 1 && leg(count_ - 1).start >= change.ramp.start) --count_;
  if (change.ramp.start < change.after.start) leg(count_++) = change.ramp;
  if (change.middle) leg(count_++) = *change.middle;
  leg(count_++) = change.after;
}

std::optional<PathClock::Outcome> PathClock::change(std::int64_t start, std::uint64_t target_q32,
                                                    std::uint8_t full_ramp_2ms, std::int64_t now) {
  const std::uint64_t ramp = full_ramp_ns(std::max(full_ramp_2ms, options_.least_full_ramp_2ms));
  const Change in_time = planned(start, target_q32, ramp);
  if (start >= now) {
    put(in_time);
    return Outcome::kScheduled;
  }
  if (now - start > options_.rewind.count() || start < legs_[0].start) return std::nullopt;
  const Leg& then = now < in_time.after.start ? in_time.ramp : in_time.after;
  const std::int64_t step = then.tau_at(now) - leg_at(now).tau_at(now);
  if ((step < 0 ? -step : step) >> kTauBits <= options_.most_step.count()) {
    put(in_time);
    return Outcome::kLateRewound;
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
    case RateCommand::Kind::kRate: {
      const bool in_time = command.start >= now - options_.rewind;
      const std::int64_t earliest = in_time ? command.start.count() : now.count();
      if (command.start.count() < cleared_ || (stop_ && earliest >= stop_->start)) return Outcome::kLatched;
      if (command.start.count() < newest_) return Outcome::kDuplicate;
      make_room(now.count());
      if (count_ + 6 > kMaxLegs) return Outcome::kFull;  // the other three are a stop's: it is never refused
      newest_ = command.start.count();
      const auto changed = change(command.start.count(), static_cast<std::uint64_t>(command.rate_q15) << 17,
                                  command.full_ramp_2ms, now.count());
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
  if (const auto changed = change(stop_->start, 0, stop_->full_ramp_2ms, now)) return *changed;
  stop_->start = now;
  static_cast<void>(change(now, 0, stop_->full_ramp_2ms, now));
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
  return !leg_at(t.count()).rising;
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
  while (count_ - old + 6 > kMaxLegs && old + 1 < count_ && leg(old + 1).start <= now) ++old;
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
