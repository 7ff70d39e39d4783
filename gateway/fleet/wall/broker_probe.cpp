#include "gateway/fleet/wall/broker_probe.hpp"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <memory>
#include <utility>

namespace kinebus::fleet {
namespace {

constexpr int kWithinMs = 2000;
constexpr auto kPeriod = std::chrono::seconds{5};
constexpr auto kTurn = std::chrono::milliseconds{100};

bool takes(const addrinfo& address) {
  const int fd =
      ::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, address.ai_protocol);
  if (fd < 0) return false;
  int error = 0;
  if (::connect(fd, address.ai_addr, address.ai_addrlen) != 0) error = errno;
  if (error == EINPROGRESS) {
    pollfd waits{.fd = fd, .events = POLLOUT, .revents = 0};
    socklen_t size = sizeof error;
    if (::poll(&waits, 1, kWithinMs) == 1) ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  }
  ::close(fd);
  return error == 0;
}

bool is_reached(const std::string& host, const std::string& port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return false;
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, &::freeaddrinfo);
  for (const addrinfo* a = found; a != nullptr; a = a->ai_next)
    if (takes(*a)) return true;
  return false;
}

}  // namespace

BrokerProbe::BrokerProbe(std::string host, int port) : host_(std::move(host)), port_(std::to_string(port)) {
  if (!host_.empty()) thread_ = std::thread([this] { run(); });
}

BrokerProbe::~BrokerProbe() {
  quit_ = true;
  if (thread_.joinable()) thread_.join();
}

std::optional<bool> BrokerProbe::reached() const {
  const int reached = reached_;
  return reached < 0 ? std::nullopt : std::optional(reached == 1);
}

void BrokerProbe::run() {
  while (!quit_) {
    reached_ = is_reached(host_, port_) ? 1 : 0;
    const auto next = std::chrono::steady_clock::now() + kPeriod;
    while (!quit_ && std::chrono::steady_clock::now() < next) std::this_thread::sleep_for(kTurn);
  }
}

}  // namespace kinebus::fleet
