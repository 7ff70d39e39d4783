// Who is heard before a hub's other streams.

#include <sys/epoll.h>

#include <memory>
#include <utility>

#include "gateway/io/stream_hub.hpp"
#include "gateway/io/stream_pair.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {
namespace {
/// Each look asks the kernel.
constexpr LocalTime kBetweenLooks = std::chrono::microseconds{200};
}  // namespace

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

}  // namespace kinebus
