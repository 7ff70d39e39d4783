#include "protocol/joblink/frame_codec.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "protocol/bytes.hpp"

namespace kinebus::joblink {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'K', 'B', 'J', '1'};

/// CRC-32 of IEEE 802.3.
std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, bytes.data(), bytes.size()));
}

/// The length that a right header states; nullopt: no header begins here.
std::optional<std::size_t> stated_length(std::span<const std::uint8_t> header) {
  if (get_u32_le(header.subspan(20)) != crc_of(header.first(20))) return std::nullopt;
  const std::uint32_t length = get_u32_le(header.subspan(4));
  if (length > kMaxMessageBytes) return std::nullopt;
  return length;
}

}  // namespace

void append_frame(std::string& out, std::uint32_t session, std::uint32_t sequence, std::string_view message) {
  assert(message.size() <= kMaxMessageBytes);
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(message.data()),
                                            message.size());
  std::array<std::uint8_t, kFrameHeaderBytes> header{};
  const std::span<std::uint8_t> h(header);
  std::copy(kMagic.begin(), kMagic.end(), header.begin());
  put_u32_le(h.subspan(4), static_cast<std::uint32_t>(message.size()));
  put_u32_le(h.subspan(8), session);
  put_u32_le(h.subspan(12), sequence);
  put_u32_le(h.subspan(16), crc_of(bytes));
  put_u32_le(h.subspan(20), crc_of(h.first(20)));
  out.append(reinterpret_cast<const char*>(header.data()), header.size());
  out.append(message);
}

void FrameReader::add(std::span<const std::uint8_t> bytes) {
  if (taken_ > 0) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
  }
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

void FrameReader::clear() {
  buffer_.clear();
  taken_ = 0;
}

void FrameReader::give_up() {
  if (pending() == 0) return;
  ++counters_.skipped_bytes;
  ++taken_;
}

std::optional<FrameView> FrameReader::next() {
  for (;;) {
    const auto begin = buffer_.begin() + static_cast<std::ptrdiff_t>(taken_);
    const auto found = std::search(begin, buffer_.end(), kMagic.begin(), kMagic.end());
    // Up to three bytes at the end may be the front of a magic word.
    const auto skip_to =
        found != buffer_.end()
            ? found
            : std::max(begin, buffer_.end() - std::min<std::ptrdiff_t>(3, buffer_.end() - begin));
    const auto skipped = static_cast<std::size_t>(skip_to - begin);
    counters_.skipped_bytes += skipped;
    taken_ += skipped;
    const std::span<const std::uint8_t> rest = std::span(buffer_).subspan(taken_);
    if (found == buffer_.end() || rest.size() < kFrameHeaderBytes) return std::nullopt;
    const auto length = stated_length(rest);
    if (!length) {
      counters_.skipped_bytes += 1;
      taken_ += 1;
      continue;
    }
    if (rest.size() < kFrameHeaderBytes + *length) return std::nullopt;
    const auto message = rest.subspan(kFrameHeaderBytes, *length);
    if (get_u32_le(rest.subspan(16)) != crc_of(message)) {
      // Bytes were lost or changed in the message: a whole frame may begin within what seemed to be it.
      ++counters_.garbled_frames;
      counters_.skipped_bytes += 1;
      taken_ += 1;
      continue;
    }
    taken_ += kFrameHeaderBytes + *length;
    ++counters_.frames;
    return FrameView{get_u32_le(rest.subspan(8)), get_u32_le(rest.subspan(12)), message};
  }
}

SessionSequence::Verdict SessionSequence::take(const FrameView& frame) {
  if (frame.sequence == 0 && frame.session != session_) return Verdict::kBegins;
  if (frame.session != session_) return Verdict::kStale;
  if (frame.sequence != next_) return Verdict::kGap;
  next_ = after(next_);
  return Verdict::kNext;
}

}  // namespace kinebus::joblink
