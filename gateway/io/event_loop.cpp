#include "gateway/io/event_loop.hpp"

#include <sys/epoll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace kinebus {

EventLoop::EventLoop(LoopClock::Kind clock)
    : clock_(clock),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)),
      timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)) {
  if (epoll_ < 0 || timer_ < 0) throw std::system_error(errno, std::generic_category(), "event loop");
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = timer_;
  ::epoll_ctl(epoll_, EPOLL_CTL_ADD, timer_, &event);
}

EventLoop::~EventLoop() {
  ::close(timer_);
  ::close(epoll_);
}

void EventLoop::watch(int fd, std::uint32_t events, std::function<void(std::uint32_t)> on_ready) {
  epoll_event event{};
  event.events = events;
  event.data.fd = fd;
  if (::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) != 0)
    throw std::system_error(errno, std::generic_category(), "watching a file descriptor");
  handlers_[fd] = std::move(on_ready);
}

void EventLoop::change(int fd, std::uint32_t events) {
  epoll_event event{};
  event.events = events;
  event.data.fd = fd;
  ::epoll_ctl(epoll_, EPOLL_CTL_MOD, fd, &event);
}

void EventLoop::forget(int fd) {
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
  handlers_.erase(fd);
}

bool EventLoop::wait(LocalTime deadline) {
  // A deadline of zero would disarm the timer: the earliest time is 1 ns.
  const std::int64_t ns = std::max<std::int64_t>(clock_.monotonic_at(deadline).count(), 1);
  itimerspec when{};
  when.it_value.tv_sec = ns / 1'000'000'000;
  when.it_value.tv_nsec = ns % 1'000'000'000;
  ::timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr);

  const LocalTime from = clock_.now();
  std::array<epoll_event, 16> ready{};
  const int count = ::epoll_wait(epoll_, ready.data(), static_cast<int>(ready.size()), -1);
  const bool interrupted = count < 0 && errno == EINTR;
  clock_.woken(from, deadline);
  if (count < 0) return !interrupted;
  for (int i = 0; i < count; ++i) {
    const int fd = ready[static_cast<std::size_t>(i)].data.fd;
    if (fd == timer_) {
      std::uint64_t expirations = 0;
      [[maybe_unused]] const ssize_t size = ::read(timer_, &expirations, sizeof expirations);
      continue;
    }
    // A handler may forget any fd, its own included: look it up anew and keep it alive while it runs.
    if (const auto found = handlers_.find(fd); found != handlers_.end()) {
      const auto handler = found->second;
      handler(ready[static_cast<std::size_t>(i)].events);
    }
  }
  return true;
}

}  // namespace kinebus
