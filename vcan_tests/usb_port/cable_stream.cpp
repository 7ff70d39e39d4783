#include "vcan_tests/usb_port/cable_stream.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <limits>

#include "protocol/bytes.hpp"

namespace kinebus {

void CableStream::write(std::span<const std::uint8_t> bytes) {
  constexpr int kPatience_ms = 1000;
  while (!bytes.empty() && !closed()) {
    const std::size_t count = stream_.write(bytes);
    bytes = bytes.subspan(count);
    if (count != 0 || closed()) continue;
    pollfd room{stream_.fd(), POLLOUT, 0};
    if (::poll(&room, 1, kPatience_ms) == 0) trouble_ = "the cable's other end takes nothing for a second";
  }
}

void CableStream::send(Kind kind, std::uint8_t session, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> piece;
  do {
    const std::size_t size = std::min<std::size_t>(bytes.size(), std::numeric_limits<std::uint16_t>::max());
    piece.assign({static_cast<std::uint8_t>(kind), session, 0, 0});
    put_u16_le(std::span(piece).subspan(2), static_cast<std::uint16_t>(size));
    piece.insert(piece.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    write(piece);
    bytes = bytes.subspan(size);
  } while (!bytes.empty());
}

std::optional<CableStream::Piece> CableStream::receive() {
  const auto size = [this] { return kHeader + get_u16_le(std::span(in_).subspan(2)); };
  std::array<std::uint8_t, 4096> bytes{};
  while (!closed() && (in_.size() < kHeader || in_.size() < size())) {
    const std::size_t count = stream_.read(bytes);
    in_.insert(in_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    if (count == 0) break;
  }
  if (!trouble_.empty() || in_.size() < kHeader || in_.size() < size()) {
    if (stream_.closed() && !in_.empty() && trouble_.empty()) trouble_ = "the stream ended within a piece";
    return std::nullopt;
  }
  if (in_[0] > static_cast<std::uint8_t>(Kind::kData)) {
    trouble_ = "what came is no piece of a cable: expected a kind in 0 .. 4";
    return std::nullopt;
  }
  const auto end = in_.begin() + static_cast<std::ptrdiff_t>(size());
  Piece piece{static_cast<Kind>(in_[0]), in_[1], {in_.begin() + kHeader, end}};
  in_.erase(in_.begin(), end);
  return piece;
}

}  // namespace kinebus
