#include "node_firmware/port/host/virtual_node.hpp"

#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace kinebus {
namespace {

// Motors are looked at so often while one moves: the switch's edge is interpolated in between.
constexpr LocalTime kLook = std::chrono::milliseconds{1};
constexpr LocalTime kLookAtRest = std::chrono::milliseconds{20};
constexpr LocalTime kSendAgain = std::chrono::microseconds{500};

}  // namespace

VirtualNodeProcess::VirtualNodeProcess(const VirtualNodeProcessOptions& options)
    : options_(options),
      image_(options.image_path),
      plant_{AxisPlant(options.plant[0]), AxisPlant(options.plant[1])} {}

VirtualNodeProcess::~VirtualNodeProcess() {
  for (const int fd : {epoll_, timer_, signals_})
    if (fd >= 0) ::close(fd);
}

std::string VirtualNodeProcess::open() {
  if (std::string error = can_.open(options_.interface, false); !error.empty()) return error;
  sigset_t mask;
  sigemptyset(&mask);
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) sigaddset(&mask, signal);
  sigprocmask(SIG_BLOCK, &mask, nullptr);
  signals_ = ::signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
  timer_ = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  epoll_ = ::epoll_create1(EPOLL_CLOEXEC);
  for (const int fd : {can_.fd(), timer_, signals_}) {
    epoll_event event{.events = EPOLLIN, .data = {.fd = fd}};
    if (fd < 0 || ::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) != 0)
      return std::string("event loop: ") + std::strerror(errno);
  }
  if (!trace_.open(options_.trace_path)) return "trace " + options_.trace_path + ": " + std::strerror(errno);
  const std::vector<std::uint8_t> stored = image_.read();
  node_.emplace(options_.node, monotonic_now(), stored);
  filter();
  return {};
}

std::string VirtualNodeProcess::run() {
  std::array<epoll_event, 4> events{};
  for (;;) {
    const LocalTime now = monotonic_now();
    trace_.sample(*node_, now);
    if (now >= node_->next_deadline()) node_->on_time(now);
    if (now >= next_look_) look_at_switches(now);
    send();
    store();
    if (node_->take_reset_request()) std::fprintf(stderr, "reset by NMT\n");
    if (bus_down_) return "CAN interface " + options_.interface + " went down";
    arm_timer();
    const int count = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), -1);
    if (count < 0 && errno != EINTR) return std::string("event loop: ") + std::strerror(errno);
    for (int i = 0; i < count; ++i) {
      const int fd = events[static_cast<std::size_t>(i)].data.fd;
      if (fd == can_.fd()) receive();
      if (fd == signals_ && on_signal()) return {};
      std::uint64_t expirations = 0;
      if (fd == timer_ && ::read(timer_, &expirations, sizeof expirations) < 0 && errno != EAGAIN)
        return std::string("timer: ") + std::strerror(errno);
    }
  }
}

void VirtualNodeProcess::receive() {
  while (const auto got = can_.receive()) {
    trace_.sample(*node_, got->when);
    if (got->kind == SocketCan::Kind::kFrame) {
      node_->on_frame(got->when, got->frame);
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
void VirtualNodeProcess::filter() {
  std::array<SocketCan::Accept, 16> wanted{};
  std::size_t count = 0;
  const auto add = [&](std::uint32_t value, std::uint16_t mask = 0x7FF) {
    if (count < wanted.size()) wanted[count++] = {static_cast<std::uint16_t>(value), mask};
  };
  add(cob_id::kNmt);
  add(cob_id::kSync, 0x780);  // and the EMCYs of others: stop requests
  add(cob_id::kLssRequest);
  if (node_->node_id() != 0) {
    add(cob_id::kSdoRequest + node_->node_id());
    for (const std::uint8_t id : node_->watched_nodes())
      if (id != 0) add(cob_id::kHeartbeat + id);
    for (const std::uint16_t id : node_->rpdo_cob_ids())
      if (id != 0) add(id);
  }
  if (wanted == filters_) return;
  filters_ = wanted;
  can_.accept(std::span(wanted).first(count));
}

void VirtualNodeProcess::send() {
  for (;;) {
    if (!unsent_) unsent_ = node_->next_frame();
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

void VirtualNodeProcess::look_at_switches(LocalTime now) {
  for (int axis = 0; axis < 2; ++axis) {
    const auto edge = plant_[static_cast<std::size_t>(axis)].on_position(now, node_->position(now, axis));
    if (edge) node_->on_switch(edge->at, edge->input, edge->level);
  }
  next_look_ = now + (node_->moving(now) ? kLook : kLookAtRest);
}

void VirtualNodeProcess::store() {
  const auto image = node_->image_to_store();
  if (!image.empty()) node_->on_image_stored(image_.replace(image));
}

void VirtualNodeProcess::arm_timer() {
  LocalTime next = std::min(node_->next_deadline(), next_look_);
  if (unsent_) next = std::min(next, monotonic_now() + kSendAgain);
  // 0 would switch the timer off.
  const std::int64_t ns = std::max<std::int64_t>(next.count(), 1);
  itimerspec when{};
  when.it_value = {ns / 1'000'000'000, ns % 1'000'000'000};
  ::timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr);
}

bool VirtualNodeProcess::on_signal() {
  signalfd_siginfo info{};
  while (::read(signals_, &info, sizeof info) == sizeof info) {
    if (info.ssi_signo != SIGUSR1) return true;
    emergency_ = !emergency_;
    std::fprintf(stderr, "E-stop button %s\n", emergency_ ? "pressed" : "released");
    node_->on_switch(monotonic_now(), options_.emergency_input - 1, emergency_);
  }
  return false;
}

}  // namespace kinebus
