#pragma once
// One thread waits here for all file descriptors and one deadline.

#include <cstdint>
#include <functional>
#include <unordered_map>

#include "gateway/io/loop_clock.hpp"

namespace kinebus {

class EventLoop {
 public:
  explicit EventLoop(LoopClock::Kind clock = LoopClock::Kind::kMonotonic);
  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// Calls `on_ready(events)` (EPOLLIN, EPOLLOUT, EPOLLHUP ... bits) whenever `fd` is ready. Does not own the
  /// fd.
  void watch(int fd, std::uint32_t events, std::function<void(std::uint32_t)> on_ready);
  void change(int fd, std::uint32_t events);
  void forget(int fd);

  /// The time of everything on this loop.
  LocalTime now() { return clock_.now(); }
  /// How far that time has fallen behind the monotonic clock.
  LocalTime behind() const { return clock_.behind(); }

  /// Waits until something is ready or `deadline` (of now()) has come, and calls what is due. False:
  /// interrupted by a signal.
  bool wait(LocalTime deadline);

 private:
  LoopClock clock_;
  int epoll_ = -1;
  int timer_ = -1;
  std::unordered_map<int, std::function<void(std::uint32_t)>> handlers_;
};

}  // namespace kinebus
