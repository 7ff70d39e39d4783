#include "gateway/io/stream_hub.hpp"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <string>
#include <system_error>
#include <utility>

#include "gateway/io/stream_pair.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {
namespace {
/// Of the streams that are ready, in one turn.
constexpr int kMostReady = 16;
}  // namespace

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

bool StreamHub::add(std::unique_ptr<ByteStream> stream, std::unique_ptr<ByteSession> session, Side side) {
  if (!lanes_[kSide]) side = Side::kCommon;
  StreamHub& home = home_of(side);
  if (streams_of(side) >= home.options_.max_streams) return false;
  auto pair = std::make_unique<Pair>();
  pair->stream = std::move(stream);
  pair->session = std::move(session);
  pair->side = side;
  pair->interest = pair->stream->interest(false);
  Pair& kept = *pair;
  home.pairs_.push_back(std::move(pair));
  set_interest(home.epoll_, EPOLL_CTL_ADD, kept.stream->fd(), kept.interest, &kept);
  home.send(kept);
  return true;
}

void StreamHub::close(Pair& pair, const char* why) {
  pair.closed = true;
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, pair.stream->fd(), nullptr);
  const std::string reason = pair.stream->closed_reason();
  pair.session->on_closed(loop_.now(), reason.empty() ? why : reason);
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
