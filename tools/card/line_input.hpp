#pragma once
// Lines of a pipe, waited for no longer than is asked.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <string>

#include "protocol/host/socketcan.hpp"

namespace kinebus {

class LineInput {
 public:
  explicit LineInput(int fd) : fd_(fd) {}

  std::optional<std::string> next(LocalTime until) {
    for (;;) {
      if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
        std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return line;
      }
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - monotonic_now()).count();
      if (closed_ || !readable(static_cast<int>(std::clamp<std::int64_t>(left, 0, 1000))))
        return std::nullopt;
      read_more();
    }
  }
  /// The other end is closed, and every line has been taken.
  bool ended() const { return closed_ && text_.find('\n') == std::string::npos; }

 private:
  /// No command is as long.
  static constexpr std::size_t kLongest = 4096;

  bool readable(int wait_ms) const {
    pollfd wait{.fd = fd_, .events = POLLIN, .revents = 0};
    return ::poll(&wait, 1, wait_ms) > 0;
  }
  void read_more() {
    std::array<char, 512> room{};
    const ssize_t length = ::read(fd_, room.data(), room.size());
    if (length == 0 || (length < 0 && errno != EINTR && errno != EAGAIN)) closed_ = true;
    if (length > 0) text_.append(room.data(), static_cast<std::size_t>(length));
    if (text_.size() > kLongest && text_.find('\n') == std::string::npos) text_.clear();
  }

  int fd_;
  std::string text_;
  bool closed_ = false;
};

}  // namespace kinebus
