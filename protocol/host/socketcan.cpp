#include "protocol/host/socketcan.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "protocol/host/can_interface.hpp"
#include "protocol/host/kernel_frame.hpp"

namespace kinebus {
namespace {

LocalTime duration_of(const timespec& t) {
  return LocalTime{t.tv_sec * 1'000'000'000LL + t.tv_nsec};
}

LocalTime clock_now(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return duration_of(t);
}

/// The kernel stamps with the wall clock, which may be stepped. Only a frame's age, measured now, is used; an
/// age that cannot be true (clock stepped in between) counts as zero.
LocalTime to_monotonic(const timespec& wall) {
  const LocalTime age = clock_now(CLOCK_REALTIME) - duration_of(wall);
  const LocalTime now = clock_now(CLOCK_MONOTONIC);
  constexpr LocalTime kOldest = std::chrono::seconds{1};
  return age < LocalTime{0} || age > kOldest ? now : now - age;
}

}  // namespace

LocalTime monotonic_now() {
  return clock_now(CLOCK_MONOTONIC);
}

SocketCan::SocketCan(SocketCan&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      interface_(std::move(other.interface_)),
      index_(other.index_),
      hardware_(other.hardware_),
      counters_(other.counters_) {}

SocketCan& SocketCan::operator=(SocketCan&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(interface_, other.interface_);
  std::swap(index_, other.index_);
  std::swap(hardware_, other.hardware_);
  std::swap(counters_, other.counters_);
  return *this;
}

SocketCan::~SocketCan() {
  if (fd_ >= 0) ::close(fd_);
}

std::string SocketCan::open(const std::string& interface, bool own_frames) {
  const auto because = [&](const char* what) {
    return "CAN interface " + interface + ": " + what + ": " + std::strerror(errno);
  };
  if (interface.empty() || interface.size() >= IFNAMSIZ)
    return "CAN interface name \"" + interface + "\": expected 1 to 15 characters, such as can0";
  fd_ = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd_ < 0) return because("this kernel offers no CAN sockets (module can_raw)");

  const unsigned index = if_nametoindex(interface.c_str());
  if (index == 0) return because("no such interface; for a virtual one: ip link add dev vcan0 type vcan");
  if (const auto asked = ask_kernel(interface))
    if (std::string words = obstacle(interface, *asked); !words.empty()) return words;
  const int on = 1;
  const int own = own_frames ? 1 : 0;
  const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_CRTL | CAN_ERR_RESTARTED;
  const int receive_bytes = 1 << 20;
  if (::setsockopt(fd_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0) return because("time stamps");
  // Who has none, adapter or kernel, is as good as before.
  const int stamps = SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE;
  ::setsockopt(fd_, SOL_SOCKET, SO_TIMESTAMPING, &stamps, sizeof stamps);
  if (::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &own, sizeof own) != 0)
    return because("own frames");
  if (::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) != 0)
    return because("error filter");
  ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
  ::setsockopt(fd_, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);

  interface_ = interface;
  if (!take_place(index)) return because("is it up? (ip link set up)");
  return {};
}

bool SocketCan::take_place(unsigned index) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return false;
  index_ = index;
  return true;
}

bool SocketCan::rejoin() {
  const unsigned index = if_nametoindex(interface_.c_str());
  if (index == 0 || index == index_) return false;
  // The kernel has dropped the filters with the interface, and without any nothing comes.
  const can_filter all{};
  return ::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, &all, sizeof all) == 0 && take_place(index);
}

void SocketCan::accept(std::span<const Accept> filters) {
  std::array<can_filter, 32> kernel{};
  std::size_t count = 0;
  for (const Accept& filter : filters.first(std::min(filters.size(), kernel.size())))
    kernel[count++] = {filter.value | (filter.remote ? CAN_RTR_FLAG : 0u),
                       filter.mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
  ::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, kernel.data(),
               static_cast<socklen_t>(count * sizeof kernel[0]));
}

SocketCan::Sent SocketCan::send(const CanFrame& frame) {
  const can_frame raw = to_kernel(frame);
  if (::write(fd_, &raw, sizeof raw) == sizeof raw) return Sent::kYes;
  if (errno == ENOBUFS || errno == EAGAIN || errno == EINTR) {
    ++counters_.tx_full;
    return Sent::kFull;
  }
  return Sent::kDown;
}

std::string SocketCan::send_patiently(const CanFrame& frame, LocalTime patience) {
  const LocalTime end = monotonic_now() + patience;
  for (Sent sent = send(frame); sent != Sent::kYes; sent = send(frame)) {
    if (sent == Sent::kDown) return "the CAN interface went down";
    if (monotonic_now() > end)
      return "nobody on the bus takes what is sent: are the nodes powered, the bus connected and terminated, "
             "all at the same bit rate?";
    ::usleep(200);
  }
  return {};
}

std::optional<SocketCan::Received> SocketCan::receive() {
  can_frame raw{};
  iovec data{&raw, sizeof raw};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t count = ::recvmsg(fd_, &message, 0);
  if (count < 0) {
    if (errno != ENETDOWN && errno != ENODEV && errno != ENXIO) return std::nullopt;
    hardware_ = {};
    return Received{.kind = Kind::kDown, .when = monotonic_now()};
  }
  if (count != sizeof raw) return std::nullopt;

  Received received{.kind = (message.msg_flags & MSG_CONFIRM) != 0 ? Kind::kOwn : Kind::kFrame};
  received.when = monotonic_now();
  LocalTime hardware{0};
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      received.when = to_monotonic(stamp);
    } else if (c->cmsg_type == SCM_TIMESTAMPING) {
      scm_timestamping stamps{};
      std::memcpy(&stamps, CMSG_DATA(c), sizeof stamps);
      hardware = duration_of(stamps.ts[2]);
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&counters_.rx_overflow, CMSG_DATA(c), sizeof counters_.rx_overflow);
    }
  }
  if (hardware != LocalTime{0}) received.when = hardware_.at(hardware, received.when);
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    received.kind = Kind::kBusError;
    received.error = raw.can_id & CAN_ERR_MASK;
    return received;
  }
  received.frame = from_kernel(raw);
  return received;
}

}  // namespace kinebus
