#include "gateway/io/socket_stream.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace kinebus {

SocketStream::~SocketStream() {
  ::close(fd_);
}

ByteStream::Moved SocketStream::failed() {
  if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return {};
  reason_ = std::strerror(errno);
  return {0, true};
}

ByteStream::Moved SocketStream::read(std::span<std::uint8_t> buffer) {
  const ssize_t count = ::recv(fd_, buffer.data(), buffer.size(), 0);
  if (count < 0) return failed();
  return {static_cast<std::size_t>(count), count == 0};
}

ByteStream::Moved SocketStream::write(std::span<const std::uint8_t> bytes) {
  const ssize_t count = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (count < 0) return failed();
  return {static_cast<std::size_t>(count), false};
}

Result<std::unique_ptr<ByteStream>, std::string> connect_local(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    return Error<std::string>(path + ": longer than a socket's name may be");
  std::memcpy(address.sun_path, path.c_str(), path.size());
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0 || ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string reason = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    return Error<std::string>(reason);
  }
  ::fcntl(fd, F_SETFL, O_NONBLOCK);
  return std::make_unique<SocketStream>(fd);
}

Result<int, std::string> connect_tcp(const std::string& host, const std::string& port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found); error != 0)
    return Error<std::string>(host + ": " + ::gai_strerror(error));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, &::freeaddrinfo);
  std::string reason = "no address";
  for (const addrinfo* a = found; a != nullptr; a = a->ai_next) {
    const int fd = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (fd < 0) continue;
    if (::connect(fd, a->ai_addr, a->ai_addrlen) == 0) {
      const int on = 1;
      ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      ::fcntl(fd, F_SETFL, O_NONBLOCK);
      return fd;
    }
    reason = std::strerror(errno);
    ::close(fd);
  }
  return Error<std::string>(host + ":" + port + ": " + reason);
}

}  // namespace kinebus
