// How much of the loop's time a hub's streams have, and what they keep clear of.

#include <algorithm>
#include <ctime>
#include <utility>

#include "gateway/io/stream_hub.hpp"
#include "gateway/io/stream_pair.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {
namespace {
/// However much was used: a stop is heard soon all the same.
constexpr LocalTime kMostRest = std::chrono::milliseconds{20};
/// After what is due has come: its echo and its stamp.
constexpr LocalTime kAfterwards = std::chrono::microseconds{700};
constexpr LocalTime kHardlyAny = std::chrono::microseconds{20};

/// What the loop has had of the processor: while the host let it wait no client used it.
LocalTime thread_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
}
}  // namespace

void StreamHub::keep_clear_of(const std::function<LocalTime()>& due) {
  due_ = due;
  for (const auto& lane : lanes_)
    if (lane) lane->keep_clear_of(due);
}

WorkGate& StreamHub::gate(int fd, Side side) {
  StreamHub& home = home_of(side);
  home.doors_.push_back(fd);
  return home;
}

void StreamHub::begin_work() {
  if (!works_since_) works_since_ = counted_ = thread_time();
}

void StreamHub::end_work() {
  if (works_since_) used_ += std::max(thread_time() - *works_since_, LocalTime{1});
  works_since_.reset();
}

/// A piece of a stream's work is over.
void StreamHub::note(Pair& pair, LocalTime begin) {
  const LocalTime end = monotonic_now();
  longest_.note(begin, end);
  // Most have nothing to do: for these the kernel is not asked.
  if (end - begin < kHardlyAny) return;
  const LocalTime before = std::exchange(counted_, thread_time());
  const StreamHub* const lane = lane_of(pair);
  if (lane == nullptr) return;
  Frugality::Options frugal = lane->options_.frugal;
  // Those that are not in it, too: they would all come back together.
  const StreamHub& whole = whole_ != nullptr ? *whole_ : *this;
  const auto is = [&](const auto& other) { return other->rank == pair.rank; };
  auto all = std::ranges::count_if(whole.pairs_, is);
  for (const auto& one : whole.lanes_)
    if (one) all += std::ranges::count_if(one->pairs_, is);
  frugal.share = std::min(frugal.share, lane->options_.frugal_together / static_cast<double>(all));
  pair.frugality[pair.lane()].note(frugal, end, counted_ - before);
}

/// One at least in a turn, whatever time is left: streams that always have something would keep it out.
bool StreamHub::begins() {
  if (others_had_something()) return false;
  gate_opened_ = monotonic_now();
  static_cast<void>(time_left());
  if (in_the_way(gate_opened_)) return false;
  begin_work();
  return true;
}

void StreamHub::ends() {
  end_work();
  longest_.note(gate_opened_, monotonic_now());
}

/// The turn's time for streams begins with the first of them that needs any. It is the computer's time, not
/// the loop's.
bool StreamHub::time_left() {
  const LocalTime now = monotonic_now();
  if (work_until_ == LocalTime::max()) {
    work_until_ = now + options_.work_per_turn;
    see_what_is_due();
  }
  return now < work_until_ && !in_the_way(now);
}

void StreamHub::see_what_is_due() {
  const LocalTime due = due_ ? due_() : LocalTime::max();
  if (due == LocalTime::max()) return;
  clear_to_ = due + loop_.behind();
  clear_from_ = clear_to_ - std::min(longest_.lately(), options_.most_kept_clear);
}

/// What this turn has used, and what has come since the last one; who has used up all rests.
void StreamHub::pay(LocalTime now) {
  const auto share_of = [&](LocalTime time) {
    return LocalTime{static_cast<std::int64_t>(options_.share * static_cast<double>(time.count()))};
  };
  credit_ += share_of(now - paid_);
  if (heir_ != nullptr && credit_ > options_.burst)
    heir_->credit_ = std::min(heir_->options_.burst, heir_->credit_ + credit_ - options_.burst);
  credit_ = std::min(options_.burst, credit_);
  paid_ = now;
  owed_ += used_;
  for (const auto& lane : lanes_)
    if (lane) used_ += std::exchange(lane->owed_, LocalTime{0});
  credit_ = std::max(-options_.burst, credit_ - std::exchange(used_, LocalTime{0}));
  waited_ = false;
  if (work_until_ == LocalTime::max()) see_what_is_due();
  work_until_ = LocalTime::max();
  clears_ = in_the_way(monotonic_now());
  if (clears_) rest_until_ = clear_to_ - loop_.behind() + kAfterwards;
  if (credit_ < LocalTime{0}) {
    const LocalTime rest{static_cast<std::int64_t>(static_cast<double>(-credit_.count()) / options_.share)};
    rest_until_ = std::max(rest_until_, now + std::min(rest, kMostRest));
  }
  if (rest_until_ != LocalTime{0}) watch_all(0);
}

}  // namespace kinebus
