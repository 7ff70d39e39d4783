#include "gateway/io/listener.hpp"

#include <arpa/inet.h>
#include <grp.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace kinebus {
namespace {

std::string name_of(const sockaddr_storage& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.ss_family == AF_INET)
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in&>(address).sin_addr, text.data(), text.size());
  else if (address.ss_family == AF_INET6)
    ::inet_ntop(AF_INET6, &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, text.data(),
                text.size());
  else
    return "local";
  return std::string("tcp ") + text.data();
}

/// So many knock before they are let in; a local client that finds no room here would wait for ever.
constexpr int kBacklog = 128;

}  // namespace

std::string peer_of(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getpeername(fd, reinterpret_cast<sockaddr*>(&address), &size);
  if (address.ss_family == AF_UNIX) {
    ucred who{};
    size = sizeof who;
    ::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &size);
    return "local uid " + std::to_string(who.uid);
  }
  if (address.ss_family == AF_INET6) {
    in6_addr& net = reinterpret_cast<sockaddr_in6&>(address).sin6_addr;
    if (!IN6_IS_ADDR_V4MAPPED(&net)) {
      std::memset(net.s6_addr + 8, 0, 8);
      return name_of(address) + "/64";
    }
  }
  return name_of(address);
}

Listener::~Listener() {
  if (fd_ < 0) return;
  loop_.forget(fd_);
  ::close(fd_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

std::string Listener::listen_local(const std::string& path, const std::string& group) {
  const auto because = [&](const std::string& what) {
    return path + ": " + what + ": " + std::strerror(errno);
  };
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return path + ": longer than a socket's name may be";
  std::memcpy(address.sun_path, path.c_str(), path.size());
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);

  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool taken = ::connect(probe, generic, sizeof address) == 0;
  ::close(probe);
  if (taken) return path + ": another daemon listens here already";
  // A socket that a dead daemon left goes; a file under this name is somebody's, and stays.
  if (struct stat there{}; ::lstat(path.c_str(), &there) == 0) {
    if (!S_ISSOCK(there.st_mode))
      return path + ": a file that is no socket has this name: it is left as it is";
    ::unlink(path.c_str());
  }

  fd_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd_ < 0) return because("cannot listen");
  const mode_t old = ::umask(0177);
  const bool bound = ::bind(fd_, generic, sizeof address) == 0;
  ::umask(old);
  if (!bound) return because("cannot listen");
  path_ = path;
  if (!group.empty()) {
    const ::group* entry = ::getgrnam(group.c_str());
    if (entry == nullptr) return "no group \"" + group + "\" on this system";
    if (::chown(path.c_str(), static_cast<uid_t>(-1), entry->gr_gid) != 0 || ::chmod(path.c_str(), 0660) != 0)
      return because("cannot give it to the group " + group);
  }
  if (::listen(fd_, kBacklog) != 0) return because("cannot listen");
  loop_.watch(fd_, EPOLLIN, [this](std::uint32_t) { on_knock(); });
  return {};
}

std::string Listener::listen_tcp(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos) return address + ": expected ADDRESS:PORT";
  std::string host = address.substr(0, colon);
  if (host.size() > 1 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  const std::string port = address.substr(colon + 1);
  if (const int error = ::getaddrinfo(host.empty() ? nullptr : host.c_str(), port.c_str(), &hints, &found);
      error != 0)
    return address + ": " + ::gai_strerror(error);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, &::freeaddrinfo);
  fd_ = ::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int on = 1;
  if (fd_ >= 0) ::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (fd_ < 0 || ::bind(fd_, found->ai_addr, found->ai_addrlen) != 0 || ::listen(fd_, kBacklog) != 0) {
    taken_ = errno == EADDRINUSE;
    return address + ": cannot listen: " + std::strerror(errno);
  }
  loop_.watch(fd_, EPOLLIN, [this](std::uint32_t) { on_knock(); });
  return {};
}

int Listener::port() const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
  return address.ss_family == AF_INET6 ? ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port)
                                       : ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

bool Listener::loopback() const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
  if (address.ss_family == AF_INET6)
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
  const std::uint32_t host = ntohl(reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr);
  return address.ss_family == AF_INET && (host >> 24U) == IN_LOOPBACKNET;
}

void Listener::on_knock() {
  if (gate_ != nullptr && !gate_->begins()) return;
  accept_client();
  if (gate_ != nullptr) gate_->ends();
}

void Listener::accept_client() {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  const int fd = ::accept4(fd_, reinterpret_cast<sockaddr*>(&address), &size, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) return;
  if (address.ss_family != AF_UNIX) {
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  on_client_(fd, name_of(address));
}

}  // namespace kinebus
