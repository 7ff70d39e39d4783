#include "gateway/io/socketcan_bus.hpp"

#include <linux/can/error.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "protocol/host/can_interface.hpp"

namespace kinebus {
namespace {

// Frames that may wait in kernel and controller, where an urgent one can no longer overtake: 4 * 135 us at 1
// Mbit/s.
constexpr int kMaxInFlight = 4;
// A frame that nobody acknowledges would keep us waiting for ever: after this time it counts as gone.
constexpr LocalTime kLostAfter = std::chrono::milliseconds{50};
constexpr LocalTime kFullPause = std::chrono::microseconds{300};
constexpr LocalTime kNever = LocalTime::max();
// A USB adapter whose cable was pulled is another interface when it is back.
constexpr LocalTime kLook = std::chrono::milliseconds{200};

}  // namespace

Result<std::unique_ptr<SocketCanBus>, std::string> SocketCanBus::open(const std::string& interface) {
  auto bus = std::make_unique<SocketCanBus>();
  if (std::string error = bus->socket_.open(interface, true); !error.empty())
    return Error<std::string>(error);
  bus->interface_ = interface;
  bus->tell_what_is_wrong();
  return bus;
}

void SocketCanBus::tell_what_is_wrong() const {
  if (const auto interface = ask_kernel(interface_))
    for (const std::string& words : advice(interface_, *interface)) spdlog::warn("{}", words);
}

LocalTime SocketCanBus::next_deadline() const {
  const LocalTime look = looks_at_.value_or(kNever);
  if (refused_) return std::min(look, full_until_);
  return std::min(look, in_flight_ > 0 ? last_sent_ + kLostAfter : kNever);
}

bool SocketCanBus::can_send(LocalTime now) {
  if (in_flight_ > 0 && now - last_sent_ > kLostAfter) in_flight_ = 0;
  if (refused_ && now >= full_until_) {
    const CanFrame again = *refused_;
    refused_.reset();
    send(now, again);
  }
  return !refused_ && in_flight_ < kMaxInFlight;
}

void SocketCanBus::send(LocalTime now, const CanFrame& frame) {
  if (socket_.send(frame) == SocketCan::Sent::kFull) {
    refused_ = frame;
    full_until_ = now + kFullPause;
    return;
  }
  ++in_flight_;
  last_sent_ = now;
}

std::optional<BusPort::Received> SocketCanBus::receive(LocalTime now) {
  if (looks_at_ && now >= *looks_at_) {
    looks_at_ = now + kLook;
    // Whatever comes meanwhile: it may have lain in the socket when the interface went.
    if (socket_.rejoin()) {
      looks_at_.reset();
      tell_what_is_wrong();  // it comes without bit rate, and down
    }
  }
  while (auto got = socket_.receive()) {
    switch (got->kind) {
      case SocketCan::Kind::kFrame:
        down_told_ = false;
        return Received{Received::Kind::kFrame, got->when, got->frame, {}};
      case SocketCan::Kind::kOwn:
        down_told_ = false;
        in_flight_ = std::max(0, in_flight_ - 1);
        return Received{Received::Kind::kSent, got->when, got->frame, {}};
      case SocketCan::Kind::kDown:
        looks_at_ = now + kLook;
        // One that is taken away goes down first: the kernel says both.
        if (std::exchange(down_told_, true)) break;
        return Received{Received::Kind::kFailure, got->when, {}, "the CAN interface went down"};
      case SocketCan::Kind::kBusError:
        if ((got->error & CAN_ERR_BUSOFF) != 0)
          return Received{Received::Kind::kFailure, got->when, {}, "the CAN controller is bus-off"};
        break;
    }
  }
  return std::nullopt;
}

}  // namespace kinebus
