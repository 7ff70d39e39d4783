#include "tools/flash/console_request.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace kinebus {
namespace {

constexpr std::string_view kRequest = "DFU";

struct File {
  int fd = -1;
  explicit File(int opened) : fd(opened) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

std::string request_system_boot(const std::string& port, std::chrono::milliseconds patience) {
  const File file(::open(port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  const auto error = [&] { return port + ": " + std::strerror(errno); };
  if (file.fd < 0) return error();
  termios line{};
  if (::tcgetattr(file.fd, &line) != 0) return error();
  ::cfmakeraw(&line);
  ::cfsetspeed(&line, B115200);
  line.c_cflag |= CLOCAL;
  if (::tcsetattr(file.fd, TCSANOW, &line) != 0) return error();
  ::tcflush(file.fd, TCIOFLUSH);
  if (::write(file.fd, kRequest.data(), kRequest.size()) != static_cast<ssize_t>(kRequest.size()))
    return error();
  const auto end = std::chrono::steady_clock::now() + patience;
  std::string heard;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd wait{.fd = file.fd, .events = POLLIN, .revents = 0};
    if (left.count() <= 0 || ::poll(&wait, 1, static_cast<int>(left.count())) == 0) return {};
    std::array<char, 256> bytes{};
    const ssize_t count = ::read(file.fd, bytes.data(), bytes.size());
    if (count <= 0) return {};  // the port has gone: the node has
    heard.append(bytes.data(), static_cast<std::size_t>(count));
    if (const auto from = heard.find("refused"), to = heard.find('\n', from);
        from != std::string::npos && to != std::string::npos)
      return "the node " + heard.substr(from, heard.find_first_of("\r\n", from) - from);
  }
}

}  // namespace kinebus
