#include "gateway/io/usb/serial_ports.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "gateway/io/usb/fd_stream.hpp"
#include "gateway/sessions/serial/first_bytes.hpp"

namespace kinebus {
namespace {

constexpr LocalTime kDeviceRetry = std::chrono::milliseconds{500};

std::string because(const std::string& what) {
  return what + ": " + std::strerror(errno);
}

/// No echo, no line discipline: bytes as they are.
void make_raw(int fd) {
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  ::tcsetattr(fd, TCSANOW, &settings);
}

}  // namespace

// Ports
// --------------------------------------------------------------------------------------------------------

/// A session that the ports tell the machine's news while it lives.
class SerialPorts::Session : public MarlinSession {
 public:
  Session(SerialPorts& ports, Options options)
      : MarlinSession(ports.gateway_, ports.files_, std::move(options)), ports_(ports) {
    ports_.sessions_.push_back(this);
  }
  ~Session() override { std::erase(ports_.sessions_, this); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  SerialPorts& ports_;
};

/// Of a TCP port: whatever a browser sends there ends it before a line is taken.
class SerialPorts::TcpSession : public Session {
 public:
  using Session::Session;
  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override {
    using Verdict = serial::FirstLine::Verdict;
    if (let_in_) return Session::on_bytes(now, bytes);
    const Verdict verdict = first_line_.take(bytes);
    if (verdict == Verdict::kForeign && !ended_)
      spdlog::warn(
          "serial TCP: something that is no print host (a web page?) has spoken to it and was cut off");
    ended_ = verdict == Verdict::kForeign;
    let_in_ = verdict == Verdict::kHost;
    if (let_in_) Session::on_bytes(now, first_line_.bytes());
  }
  bool wants_bytes() const override { return !ended_ && Session::wants_bytes(); }
  bool ended() const override { return ended_; }

 private:
  serial::FirstLine first_line_;
  bool let_in_ = false, ended_ = false;
};

SerialPorts::SerialPorts(EventLoop& loop, Gateway& gateway, SerialFiles& files, Control& control,
                         Options options)
    : loop_(loop),
      gateway_(gateway),
      files_(files),
      control_(control),
      options_(std::move(options)),
      hub_(std::make_unique<StreamHub>(loop)) {}

SerialPorts::~SerialPorts() {
  hub_.reset();
  if (listener_ >= 0) {
    loop_.forget(listener_);
    ::close(listener_);
  }
  if (pty_slave_ >= 0) {
    ::close(pty_slave_);
    ::unlink(options_.pty.c_str());
  }
}

template <typename Kind>
std::unique_ptr<ByteSession> SerialPorts::new_session(const char* name) {
  MarlinSession::Options options;
  options.name = name;
  options.control = &control_;
  return std::make_unique<Kind>(*this, std::move(options));
}

std::string SerialPorts::open() {
  if (!options_.pty.empty())
    if (std::string error = open_pty(); !error.empty()) return error;
  if (!options_.tcp.empty())
    if (std::string error = listen_tcp(); !error.empty()) return error;
  return {};
}

std::string SerialPorts::open_pty() {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master < 0) return because("pty");
  std::array<char, 128> name{};
  if (::grantpt(master) != 0 || ::unlockpt(master) != 0 ||
      ::ptsname_r(master, name.data(), name.size()) != 0) {
    std::string error = because("pty");
    ::close(master);
    return error;
  }
  // Held open by the daemon itself: hosts come and go (some open a port twice to set it up), the pty stays.
  pty_slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  make_raw(pty_slave_);
  std::string error;
  const std::string fresh = options_.pty + ".new";
  ::unlink(fresh.c_str());
  if (::symlink(name.data(), fresh.c_str()) != 0 || ::rename(fresh.c_str(), options_.pty.c_str()) != 0)
    error = because(options_.pty);
  hub_->add(std::make_unique<FdStream>(master), new_session<Session>("serial pty"));
  return error;
}

std::string SerialPorts::listen_tcp() {
  const std::size_t colon = options_.tcp.rfind(':');
  if (colon == std::string::npos) return options_.tcp + ": expected address:port, such as 127.0.0.1:2323";
  std::uint16_t port = 0;
  const char* begin = options_.tcp.data() + colon + 1;
  const char* end = options_.tcp.data() + options_.tcp.size();
  sockaddr_in address{};
  address.sin_family = AF_INET;
  if (std::from_chars(begin, end, port).ptr != end ||
      ::inet_pton(AF_INET, options_.tcp.substr(0, colon).c_str(), &address.sin_addr) != 1)
    return options_.tcp + ": expected address:port, such as 127.0.0.1:2323";
  address.sin_port = htons(port);
  // The dialect knows no password: whoever reaches the port moves and heats the machine.
  if ((ntohl(address.sin_addr.s_addr) >> 24) != IN_LOOPBACKNET)
    return options_.tcp +
           ": expected an address of this computer alone, such as 127.0.0.1:2323: a print host on another "
           "computer "
           "comes through a tunnel (ssh -L), since the serial line has no password";
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener_, 4) != 0) {
    std::string error = because(options_.tcp);
    ::close(std::exchange(listener_, -1));
    return error;
  }
  spdlog::warn(
      "serial TCP on {}: every program of this computer may move and heat the machine, without a password",
      options_.tcp);
  loop_.watch(listener_, EPOLLIN, [this](std::uint32_t) { accept_tcp(); });
  return {};
}

void SerialPorts::accept_tcp() {
  const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (fd < 0) return;
  const int on = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  hub_->add(std::make_unique<FdStream>(fd), new_session<TcpSession>("serial TCP"));
}

/// The gadget's tty comes and goes with the gadget, and hangs up when the cable is pulled.
void SerialPorts::try_device() {
  const int fd = ::open(options_.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return;
  make_raw(fd);
  device_open_ = true;
  hub_->add(std::make_unique<FdStream>(fd, [this] { device_open_ = false; }),
            new_session<Session>("serial USB"));
}

void SerialPorts::on_event(const MachineEvent& event) {
  for (MarlinSession* session : sessions_) session->on_event(event);
}

void SerialPorts::on_time(LocalTime now) {
  if (!options_.device.empty() && !device_open_ && now >= next_device_) {
    next_device_ = now + kDeviceRetry;
    try_device();
  }
  hub_->on_time(now);
}

LocalTime SerialPorts::next_deadline() const {
  const LocalTime next = hub_->next_deadline();
  return options_.device.empty() || device_open_ ? next : std::min(next, next_device_);
}

}  // namespace kinebus
