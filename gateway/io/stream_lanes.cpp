// Who is heard before a hub's other streams.

#include <sys/epoll.h>

#include <algorithm>
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
  lane->whole_ = this;
  comes_after(*lane);
}

void StreamHub::add_side(const Options& options) {
  auto& side = lanes_[kSide];
  side = std::make_unique<StreamHub>(loop_, options);
  side->whole_ = this;
  side->before_ = before_;
  before_.push_back(side.get());
}

void StreamHub::comes_after(StreamHub& other) {
  StreamHub* const side = lanes_[kSide].get();
  if (side != nullptr) side->before_.push_back(&other);
  before_.insert(before_.end() - (side != nullptr ? 1 : 0), &other);
}

StreamHub& StreamHub::home_of(Side side) {
  const auto& lane = lanes_[kSide];
  return side == Side::kApart && lane ? *lane : *this;
}

std::size_t StreamHub::streams() const {
  std::size_t count = pairs_.size();
  for (const auto& lane : lanes_)
    if (lane) count += lane->pairs_.size();
  return count;
}

std::size_t StreamHub::streams_of(Side side) const {
  const auto is = [side](const auto& pair) { return pair->side == side; };
  auto count = std::ranges::count_if(pairs_, is);
  for (const auto& lane : lanes_)
    if (lane) count += std::ranges::count_if(lane->pairs_, is);
  return static_cast<std::size_t>(count);
}

std::size_t StreamHub::streams_first() const {
  const auto& side = lanes_[kSide];
  return streams() - pairs_.size() - (side ? side->pairs_.size() : 0);
}

/// nullptr: it has none.
StreamHub* StreamHub::lane_of(const Pair& pair) const {
  return (whole_ != nullptr ? *whole_ : *this).lanes_[pair.lane()].get();
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
      const bool frugal = lane != nullptr && pair.frugality[pair.lane()].holds(lane->options_.frugal, now);
      StreamHub& to = frugal ? *lane : home_of(pair.side);
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
  // One of them may have looked at another.
  const auto used_by_all = [this] {
    LocalTime sum{0};
    for (const StreamHub* const other : before_) sum += other->used_;
    return sum;
  };
  const LocalTime before = used_by_all();
  bool had = false;
  for (StreamHub* const other : before_) had = other->looked_at() || had;
  if (!had || !works_since_) return had;
  const LocalTime used = used_by_all() - before;
  *works_since_ += used;
  counted_ += used;
  return true;
}

}  // namespace kinebus
