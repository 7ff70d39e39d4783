#pragma once
// Frames for programs that speak to one node at a time and may wait.

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "protocol/host/socketcan.hpp"

namespace kinebus {

/// The next frame until `until`; nullopt: none came. Throws std::runtime_error when the interface goes down.
inline std::optional<CanFrame> receive_until(SocketCan& can, LocalTime until) {
  for (;;) {
    while (const auto got = can.receive()) {
      if (got->kind == SocketCan::Kind::kDown) throw std::runtime_error("the CAN interface went down");
      if (got->kind == SocketCan::Kind::kFrame) return got->frame;
    }
    const LocalTime left = until - monotonic_now();
    if (left <= LocalTime{0}) return std::nullopt;
    pollfd wait{.fd = can.fd(), .events = POLLIN, .revents = 0};
    const auto left_ms = std::chrono::ceil<std::chrono::milliseconds>(left).count();
    ::poll(&wait, 1, static_cast<int>(std::min<std::int64_t>(left_ms, 100)));
  }
}

/// Waits for room. Throws std::runtime_error when the interface does not take it.
inline void send_or_throw(SocketCan& can, const CanFrame& frame) {
  if (const std::string error = can.send_patiently(frame); !error.empty()) throw std::runtime_error(error);
}

}  // namespace kinebus
