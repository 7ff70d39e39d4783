#pragma once
// A stream of a hub with its session: of the hub's own files alone.

#include <sys/epoll.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <system_error>

#include "gateway/io/byte_stream.hpp"
#include "gateway/io/frugality.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/sessions/byte_session.hpp"

namespace kinebus {

inline void set_interest(int epoll, int how, int fd, std::uint32_t events, void* who) {
  epoll_event event{};
  event.events = events;
  event.data.ptr = who;
  if (::epoll_ctl(epoll, how, fd, &event) != 0)
    throw std::system_error(errno, std::generic_category(), "watching a stream");
}

struct StreamHub::Pair {
  std::unique_ptr<ByteStream> stream;
  std::unique_ptr<ByteSession> session;
  Side side = Side::kCommon;
  std::uint32_t interest = 0;
  bool full = false;  ///< the stream took less than there was: the kernel tells when it takes more
  bool closed = false;
  LocalTime close_at = LocalTime::max();  ///< its session has ended
  ByteSession::Rank rank = ByteSession::Rank::kAny;
  std::array<Frugality, kRanks> frugality{};  ///< in each rank

  std::size_t lane() const { return static_cast<std::size_t>(rank); }
};

}  // namespace kinebus
