#include "gateway/io/stream_hub.hpp"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <ctime>
#include <string>
#include <system_error>
#include <utility>

#include "protocol/host/socketcan.hpp"

namespace kinebus {
namespace {
/// However much was used: a stop is heard soon all the same.
constexpr LocalTime kMostRest = std::chrono::milliseconds{20};
/// After what is due has come: its echo and its stamp.
constexpr LocalTime kAfterwards = std::chrono::microseconds{700};
/// Each look asks the kernel.
constexpr LocalTime kBetweenLooks = std::chrono::microseconds{200};
constexpr LocalTime kHardlyAny = std::chrono::microseconds{20};
/// Of the streams that are ready, in one turn.
constexpr int kMostReady = 16;

/// What the loop has had of the processor: while the host let it wait no client used it.
LocalTime thread_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
}

void set_interest(int epoll, int how, int fd, std::uint32_t events, void* who) {
  epoll_event event{};
  event.events = events;
  event.data.ptr = who;
  if (::epoll_ctl(epoll, how, fd, &event) != 0)
    throw std::system_error(errno, std::generic_category(), "watching a stream");
}
}  // namespace

struct StreamHub::Pair {
  std::unique_ptr<ByteStream> stream;
  std::unique_ptr<ByteSession> session;
  std::uint32_t interest = 0;
  bool full = false;  ///< the stream took less than there was: the kernel tells when it takes more
  bool closed = false;
  LocalTime close_at = LocalTime::max();  ///< its session has ended
  ByteSession::Rank rank = ByteSession::Rank::kAny;
  std::array<Frugality, kRanks> frugality{};  ///< in each rank

  std::size_t lane() const { return static_cast<std::size_t>(rank); }
};

StreamHub::StreamHub(EventLoop& loop) : StreamHub(loop, Options()) {}

StreamHub::StreamHub(EventLoop& loop, Options options)
    : loop_(loop),
      options_(options),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)),
      glance_(::epoll_create1(EPOLL_CLOEXEC)),
      credit_(options.burst) {
  if (epoll_ < 0 || glance_ < 0) throw std::system_error(errno, std::generic_category(), "streams");
  set_interest(glance_, EPOLL_CTL_ADD, epoll_, EPOLLIN, nullptr);
  loop_.watch(epoll_, EPOLLIN, [this](std::uint32_t) { on_some_ready(); });
}

StreamHub::~StreamHub() {
  for (const auto& pair : pairs_)
    if (!pair->closed) close(*pair, "the gateway ends");
  loop_.forget(epoll_);
  ::close(glance_);
  ::close(epoll_);
}

void StreamHub::keep_clear_of(const std::function<LocalTime()>& due) {
  due_ = due;
  for (const auto& lane : lanes_)
    if (lane) lane->keep_clear_of(due);
}

void StreamHub::add_lane(ByteSession::Rank rank, const Options& options) {
  auto& lane = lanes_[static_cast<std::size_t>(rank)];
  lane = std::make_unique<StreamHub>(loop_, options);
  comes_after(*lane);
}

std::size_t StreamHub::streams() const {
  std::size_t count = pairs_.size();
  for (const auto& lane : lanes_)
    if (lane) count += lane->pairs_.size();
  return count;
}

bool StreamHub::add(std::unique_ptr<ByteStream> stream, std::unique_ptr<ByteSession> session) {
  if (streams() >= options_.max_streams) return false;
  auto pair = std::make_unique<Pair>();
  pair->stream = std::move(stream);
  pair->session = std::move(session);
  pair->interest = pair->stream->interest(false);
  Pair& kept = *pair;
  pairs_.push_back(std::move(pair));
  set_interest(epoll_, EPOLL_CTL_ADD, kept.stream->fd(), kept.interest, &kept);
  send(kept);
  return true;
}

WorkGate& StreamHub::gate(int fd) {
  doors_.push_back(fd);
  return *this;
}

/// nullptr: it has none.
StreamHub* StreamHub::lane_of(const Pair& pair) const {
  return lanes_[pair.lane()].get();
}

void StreamHub::hand_over(std::size_t index, StreamHub& to) {
  std::unique_ptr<Pair> pair = std::move(pairs_[index]);
  pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(index));
  if (index < first_) --first_;
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, pair->stream->fd(), nullptr);
  set_interest(to.epoll_, EPOLL_CTL_ADD, pair->stream->fd(), pair->interest, pair.get());
  to.pairs_.push_back(std::move(pair));
}

/// Once a turn, when nothing is told of any of them.
void StreamHub::sort_into_lanes() {
  const LocalTime now = monotonic_now();
  const auto sort = [&](StreamHub& from) {
    for (std::size_t i = 0; i < from.pairs_.size();) {
      Pair& pair = *from.pairs_[i];
      pair.rank = pair.session->rank();
      StreamHub* const lane = lane_of(pair);
      StreamHub& to =
          lane != nullptr && pair.frugality[pair.lane()].holds(lane->options_.frugal, now) ? *lane : *this;
      if (pair.closed || &to == &from)
        ++i;
      else
        from.hand_over(i, to);
    }
  };
  for (const auto& lane : lanes_)
    if (lane) sort(*lane);
  sort(*this);
}

/// True: it had something to do. Until then its turn has not begun.
bool StreamHub::looked_at() {
  epoll_event event{};
  if (rest_until_ != LocalTime{0} || ::epoll_wait(glance_, &event, 1, 0) < 1) return false;
  const LocalTime used = used_;
  on_some_ready();
  return used_ != used;
}

/// True: the bus waits for what they asked for. They do not keep this one from its work for long: they have
/// their shares.
bool StreamHub::others_had_something() {
  const LocalTime now = monotonic_now();
  if (before_.empty() || now < looks_at_) return false;
  looks_at_ = now + kBetweenLooks;
  bool had = false;
  for (StreamHub* const other : before_) {
    const LocalTime used = other->used_;
    if (!other->looked_at()) continue;
    had = true;
    if (!works_since_) continue;
    *works_since_ += other->used_ - used;
    counted_ += other->used_ - used;
  }
  return had;
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
  pair.frugality[pair.lane()].note((lane != nullptr ? *lane : *this).options_.frugal, end, counted_ - before);
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

void StreamHub::close(Pair& pair, const char* why) {
  pair.closed = true;
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, pair.stream->fd(), nullptr);
  const std::string reason = pair.stream->closed_reason();
  pair.session->on_closed(loop_.now(), reason.empty() ? why : reason);
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

/// Of the streams that are ready, 16 a turn. One is asked for at a time: the kernel puts who was told behind
/// all others, and who is told when the turn's time is up would go there without having been served, again
/// and again. None is destroyed before on_time.
void StreamHub::on_some_ready() {
  // Behind a rest one is served, whatever others have.
  for (int i = 0; i < kMostReady && ((i == 0 && waited_) || !others_had_something()) && time_left(); ++i) {
    epoll_event event{};
    if (::epoll_wait(epoll_, &event, 1, 0) < 1) break;
    begin_work();
    Pair& pair = *static_cast<Pair*>(event.data.ptr);
    const LocalTime begin = monotonic_now();
    on_ready(pair, event.events);
    note(pair, begin);
  }
  end_work();
}

void StreamHub::on_ready(Pair& pair, std::uint32_t events) {
  if (pair.closed) return;
  // A stream that is not read now would report its end again and again.
  if ((events & (EPOLLHUP | EPOLLERR)) != 0 && !pair.session->wants_bytes())
    return close(pair, "the other side ended the connection");
  std::array<std::uint8_t, 65'536> buffer;
  std::size_t taken = 0;
  // Bytes may come in morsels, each a record of its own: those of a turn are bounded by its time, too.
  while (taken < options_.bytes_per_turn && pair.session->wants_bytes() && (taken == 0 || time_left())) {
    const ByteStream::Moved moved = pair.stream->read(buffer);
    if (moved.count > 0) pair.session->on_bytes(loop_.now(), std::span(buffer).first(moved.count));
    if (moved.closed) {
      // What came with the end is still carried out.
      pair.session->on_time(loop_.now());
      return close(pair, "the other side ended the connection");
    }
    if (moved.count == 0) break;
    taken += moved.count;
  }
  if (options_.at_once && loop_.now() >= pair.session->next_deadline()) pair.session->on_time(loop_.now());
  send(pair);
}

void StreamHub::send(Pair& pair) {
  std::size_t sent = 0;
  pair.full = false;
  while (!pair.full && sent < options_.bytes_per_turn) {
    const auto bytes = pair.session->next_bytes();
    if (bytes.empty()) break;
    const ByteStream::Moved moved = pair.stream->write(bytes);
    if (moved.closed) return close(pair, "the other side ended the connection");
    pair.session->on_bytes_sent(moved.count);
    sent += moved.count;
    pair.full = moved.count < bytes.size();
  }
  if (!pair.full && pair.session->ended() && pair.session->next_bytes().empty())
    return close(pair, "the session has ended");
  watch(pair, pair.full || sent >= options_.bytes_per_turn);
}

/// The kernel tells of the stream what its session can do something with.
void StreamHub::watch(Pair& pair, bool has_output) {
  std::uint32_t interest = pair.stream->interest(has_output);
  if (!pair.session->wants_bytes()) interest &= ~std::uint32_t{EPOLLIN};
  if (interest != pair.interest) set_interest(epoll_, EPOLL_CTL_MOD, pair.stream->fd(), interest, &pair);
  pair.interest = interest;
}

/// What this turn has used, and what has come since the last one; who has used up all rests.
void StreamHub::pay(LocalTime now) {
  const auto share_of = [&](LocalTime time) {
    return LocalTime{static_cast<std::int64_t>(options_.share * static_cast<double>(time.count()))};
  };
  credit_ = std::min(options_.burst, credit_ + share_of(now - paid_));
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

void StreamHub::watch_all(std::uint32_t events) {
  loop_.change(epoll_, events);
  for (const int door : doors_) loop_.change(door, events);
}

void StreamHub::on_time(LocalTime now) {
  if (has_lanes()) sort_into_lanes();
  for (const auto& lane : lanes_)
    if (lane) lane->on_time(now);
  if (now < rest_until_) return;
  if (rest_until_ != LocalTime{0}) {
    watch_all(EPOLLIN);
    rest_until_ = LocalTime{0};
    waited_ = clears_;
    // What is served below may use up all again: who has come since, and what they said, is heard before.
    return;
  }
  // Sessions may make new streams' sessions speak, and close each other: the list is walked by index.
  const std::size_t count = pairs_.size();
  std::size_t served = 0;
  if (count > 0) begin_work();
  for (; served < count && !others_had_something(); ++served) {
    Pair& pair = *pairs_[(first_ + served) % count];
    if (pair.closed) continue;
    const LocalTime begin = monotonic_now();
    if (!time_left() && (served > 0 || in_the_way(begin))) break;
    serve(pair, now);
    note(pair, begin);
  }
  end_work();
  first_ = count > 0 ? (first_ + served) % count : 0;
  pay(now);
  const auto gone = [](const auto& pair) { return pair->closed; };
  // Who is next stays next when others before it go.
  const auto next = pairs_.begin() + static_cast<std::ptrdiff_t>(first_);
  first_ -= static_cast<std::size_t>(std::count_if(pairs_.begin(), next, gone));
  std::erase_if(pairs_, gone);
}

void StreamHub::on_stall(LocalTime now, LocalTime length) {
  for (const auto& lane : lanes_)
    if (lane) lane->on_stall(now, length);
  if (length < options_.absence) return;
  for (const auto& pair : pairs_)
    if (!pair->closed) pair->session->on_absence(now);
}

void StreamHub::serve(Pair& pair, LocalTime now) {
  if (now >= pair.session->next_deadline()) pair.session->on_time(now);
  if (pair.session->ended() && pair.close_at == LocalTime::max()) pair.close_at = now + options_.farewell;
  if (now >= pair.close_at) return close(pair, "the session has ended");
  if (pair.stream->buffered() && pair.session->wants_bytes())
    on_ready(pair, EPOLLIN);
  else if (pair.full && (pair.interest & EPOLLOUT) != 0)
    watch(pair, true);  // the kernel is not asked each turn whether a deaf one hears
  else
    send(pair);
}

LocalTime StreamHub::next_deadline() const {
  LocalTime next = LocalTime::max();
  for (const auto& lane : lanes_)
    if (lane) next = std::min(next, lane->next_deadline());
  if (rest_until_ != LocalTime{0}) return std::min(next, rest_until_);
  for (const auto& pair : pairs_) {
    if (pair->stream->buffered() && pair->session->wants_bytes()) return LocalTime{0};
    if (pair->session->ended())
      next = std::min(next, pair->close_at == LocalTime::max() ? LocalTime{0} : pair->close_at);
    else
      next = std::min(next, pair->session->next_deadline());
  }
  return next;
}

}  // namespace kinebus
