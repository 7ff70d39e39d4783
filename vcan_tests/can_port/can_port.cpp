#include "vcan_tests/can_port/can_port.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "protocol/host/kernel_frame.hpp"

namespace kinebus {

void CanPort::close(std::string trouble) {
  if (closed_) return;
  closed_ = true;
  trouble_ = std::move(trouble);
}

std::string InterfacePort::open(const std::string& interface) {
  interface_ = interface;
  return can_.open(interface, false);
}

bool InterfacePort::send(const CanFrame& frame) {
  const SocketCan::Sent sent = can_.send(frame);
  if (sent == SocketCan::Sent::kDown) close(interface_ + " went down");
  return sent == SocketCan::Sent::kYes;
}

std::optional<CanPort::Received> InterfacePort::receive() {
  while (const auto got = can_.receive()) {
    if (got->kind == SocketCan::Kind::kFrame) return Received{got->when, got->frame};
    if (got->kind != SocketCan::Kind::kDown) continue;
    close(interface_ + " went down");
    break;
  }
  return std::nullopt;
}

pollfd InterfacePort::waits_for(bool frames) const {
  return {can_.fd(), static_cast<short>(frames ? POLLIN : 0), 0};
}

bool StreamPort::send(const CanFrame& frame) {
  if (closed()) return false;
  if (out_.size() - out_end_ < kFrameBytes) flush();
  if (out_.size() - out_end_ < kFrameBytes) return false;
  const can_frame raw = to_kernel(frame);
  std::memcpy(out_.data() + out_end_, &raw, kFrameBytes);
  out_end_ += kFrameBytes;
  return true;
}

void StreamPort::flush() {
  while (out_begin_ < out_end_) {
    const std::size_t count = stream_.write(std::span(out_).subspan(out_begin_, out_end_ - out_begin_));
    if (count == 0) break;
    out_begin_ += count;
  }
  if (stream_.closed()) close(stream_.trouble());
  std::copy(out_.data() + out_begin_, out_.data() + out_end_, out_.data());
  out_end_ -= out_begin_;
  out_begin_ = 0;
}

/// Reads until a whole frame is there. False: not yet, or never.
bool StreamPort::fill() {
  static_assert(sizeof(can_frame) == kFrameBytes);
  std::copy(in_.data() + in_begin_, in_.data() + in_end_, in_.data());
  in_end_ -= in_begin_;
  in_begin_ = 0;
  while (!closed() && in_end_ < kFrameBytes) {
    const std::size_t count = stream_.read(std::span(in_).subspan(in_end_));
    in_end_ += count;
    if (count == 0 && !stream_.closed()) return false;
    if (stream_.closed())
      close(in_end_ == 0 || !stream_.trouble().empty() ? stream_.trouble()
                                                       : "the stream ended within a frame");
  }
  return in_end_ >= kFrameBytes;
}

std::optional<CanPort::Received> StreamPort::receive() {
  if (in_end_ - in_begin_ < kFrameBytes && !fill()) return std::nullopt;
  can_frame raw{};
  std::memcpy(&raw, in_.data() + in_begin_, kFrameBytes);
  in_begin_ += kFrameBytes;
  if (raw.can_dlc > 8 || (raw.can_id & CAN_ERR_FLAG) != 0) {
    in_begin_ = in_end_ = 0;
    close("what came is no frame: expected struct can_frame with at most 8 data bytes");
    return std::nullopt;
  }
  return Received{monotonic_now(), from_kernel(raw)};
}

pollfd StreamPort::waits_for(bool frames) const {
  const int events = (frames ? POLLIN : 0) | (out_end_ > out_begin_ ? POLLOUT : 0);
  return {stream_.fd(), static_cast<short>(events), 0};
}

std::uint64_t OneWay::pass(CanPort& from, CanPort& to) {
  std::uint64_t passed = 0;
  for (;; ++passed) {
    if (!waiting_) {
      const auto got = from.receive();
      if (!got) break;
      waiting_ = got->frame;
    }
    if (!to.send(*waiting_)) break;
    waiting_.reset();
  }
  to.flush();
  return passed;
}

}  // namespace kinebus
