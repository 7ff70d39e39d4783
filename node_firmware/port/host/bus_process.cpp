#include "node_firmware/port/host/bus_process.hpp"

#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <vector>

#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus {
namespace {

constexpr LocalTime kSendAgain = std::chrono::microseconds{500};
constexpr std::size_t kLongestLine = 200;

}  // namespace

BusProcess::BusProcess(std::string interface, std::string image_path)
    : interface_(std::move(interface)), image_(std::move(image_path)) {}

BusProcess::~BusProcess() {
  for (const int fd : {epoll_, timer_, signals_})
    if (fd >= 0) ::close(fd);
}

std::string BusProcess::watch(int fd) {
  epoll_event event{.events = EPOLLIN, .data = {.fd = fd}};
  if (fd >= 0 && ::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) == 0) return {};
  return std::string("event loop: ") + std::strerror(errno);
}

std::string BusProcess::open() {
  if (std::string error = can_.open(interface_, false); !error.empty()) return error;
  sigset_t mask;
  sigemptyset(&mask);
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) sigaddset(&mask, signal);
  sigprocmask(SIG_BLOCK, &mask, nullptr);
  signals_ = ::signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
  timer_ = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  epoll_ = ::epoll_create1(EPOLL_CLOEXEC);
  for (const int fd : {can_.fd(), timer_, signals_})
    if (std::string error = watch(fd); !error.empty()) return error;
  const std::vector<std::uint8_t> stored = image_.read();
  if (std::string error = start(monotonic_now(), stored); !error.empty()) return error;
  // A file as standard input cannot be waited for: then there are no commands.
  if (listening_) listening_ = watch(STDIN_FILENO).empty();
  filter();
  return {};
}

std::string BusProcess::run() {
  std::array<epoll_event, 4> events{};
  for (;;) {
    on_time(monotonic_now());
    send();
    store();
    if (take_reset_request()) std::fprintf(stderr, "reset by NMT\n");
    if (bus_down_) return "CAN interface " + interface_ + " went down";
    arm_timer();
    const int count = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), -1);
    if (count < 0 && errno != EINTR) return std::string("event loop: ") + std::strerror(errno);
    for (int i = 0; i < count; ++i) {
      const int fd = events[static_cast<std::size_t>(i)].data.fd;
      if (fd == can_.fd()) receive();
      if (fd == signals_ && on_signal()) return {};
      if (fd == STDIN_FILENO) read_lines();
      std::uint64_t expirations = 0;
      if (fd == timer_ && ::read(timer_, &expirations, sizeof expirations) < 0 && errno != EAGAIN)
        return std::string("timer: ") + std::strerror(errno);
    }
  }
}

void BusProcess::receive() {
  while (const auto got = can_.receive()) {
    if (got->kind == SocketCan::Kind::kFrame) {
      on_frame(got->when, got->frame);
      if (got->frame.id == cob_id::kNmt || got->frame.id >= cob_id::kSdoReply) filter();
    }
    if (got->kind == SocketCan::Kind::kDown) {
      bus_down_ = true;
      return;
    }
  }
}

// What the board's controller passes on, too: requests and PDOs of this node, what all hear, and the
// heartbeats that it watches. NMT, SDO and LSS may change it.
void BusProcess::filter() {
  std::array<SocketCan::Accept, 16> filters{};
  std::size_t count = 0;
  const auto add = [&](const SocketCan::Accept& accept) {
    if (count < filters.size()) filters[count++] = accept;
  };
  add({.value = cob_id::kNmt});
  add({.value = cob_id::kSync, .mask = 0x780});  // and the EMCYs of others: stop requests
  add({.value = cob_id::kLssRequest});
  add({.value = kVoucherCobId});
  add({.value = kSyncStampCobId});  // by its vouchers the number of a session is followed
  for (const SocketCan::Accept& accept : wanted())
    if (accept.value != 0) add(accept);
  if (filters == filters_) return;
  filters_ = filters;
  can_.accept(std::span(filters).first(count));
}

void BusProcess::send() {
  for (;;) {
    if (!unsent_) unsent_ = next_frame();
    if (!unsent_) return;
    switch (can_.send(*unsent_)) {
      case SocketCan::Sent::kYes:
        unsent_.reset();
        break;
      case SocketCan::Sent::kFull:
        return;
      case SocketCan::Sent::kDown:
        bus_down_ = true;
        return;
    }
  }
}

void BusProcess::store() {
  const auto image = image_to_store();
  if (!image.empty()) on_image_stored(image_.replace(image));
}

void BusProcess::arm_timer() {
  LocalTime next = next_deadline();
  if (unsent_) next = std::min(next, monotonic_now() + kSendAgain);
  // 0 would switch the timer off.
  const std::int64_t ns = std::max<std::int64_t>(next.count(), 1);
  itimerspec when{};
  when.it_value = {ns / 1'000'000'000, ns % 1'000'000'000};
  ::timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr);
}

void BusProcess::read_lines() {
  std::array<char, 256> bytes{};
  const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count <= 0) {  // its other end is gone
    ::epoll_ctl(epoll_, EPOLL_CTL_DEL, STDIN_FILENO, nullptr);
    return;
  }
  for (const char c : std::span(bytes).first(static_cast<std::size_t>(count))) {
    if (c != '\n') {
      if (line_.size() < kLongestLine) line_ += c;
      continue;
    }
    on_line(line_);
    line_.clear();
  }
}

bool BusProcess::on_signal() {
  signalfd_siginfo info{};
  while (::read(signals_, &info, sizeof info) == sizeof info) {
    if (info.ssi_signo != SIGUSR1) return true;
    on_user_signal();
  }
  return false;
}

}  // namespace kinebus
