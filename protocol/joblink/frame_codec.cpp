#include "protocol/joblink/frame_codec.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "protocol/bytes.hpp"

namespace kinebus::joblink {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'K', 'B', 'J', '1'};

/// CRC-32 of IEEE 802.3.
std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  return ::libdeflate_crc32(0, bytes.data(), bytes.size());
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
  FrameQueue frame;
  frame.append(session, sequence, message);
  out.append(reinterpret_cast<const char*>(frame.bytes().data()), frame.size());
}

std::span<std::uint8_t> FrameQueue::begin(std::size_t size) {
  assert(size <= kMaxMessageBytes);
  frame_ = queue_.room(kFrameHeaderBytes + size);
  return frame_.subspan(kFrameHeaderBytes);
}

void FrameQueue::finish(std::uint32_t session, std::uint32_t sequence) {
  const auto message = frame_.subspan(kFrameHeaderBytes);
  std::copy(kMagic.begin(), kMagic.end(), frame_.begin());
  put_u32_le(frame_.subspan(4), static_cast<std::uint32_t>(message.size()));
  put_u32_le(frame_.subspan(8), session);
  put_u32_le(frame_.subspan(12), sequence);
  put_u32_le(frame_.subspan(16), crc_of(message));
  put_u32_le(frame_.subspan(20), crc_of(frame_.first(20)));
  queue_.added(frame_.size());
}

void FrameQueue::append(std::uint32_t session, std::uint32_t sequence, std::string_view message) {
  std::copy(message.begin(), message.end(), begin(message.size()).begin());
  finish(session, sequence);
}

void FrameReader::add(std::span<const std::uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), buffer_.room(bytes.size()).begin());
  buffer_.added(bytes.size());
}

void FrameReader::clear() {
  buffer_.clear();
}

void FrameReader::skip(std::size_t count) {
  counters_.skipped_bytes += count;
  buffer_.drop(count);
}

void FrameReader::give_up() {
  if (pending() > 0) skip(1);
}

std::optional<FrameView> FrameReader::next() {
  for (;;) {
    const auto here = buffer_.bytes();
    const auto found = std::search(here.begin(), here.end(), kMagic.begin(), kMagic.end());
    // Up to three bytes at the end may be the front of a magic word.
    const auto in_no_frame =
        found != here.end() ? found : here.end() - std::min<std::ptrdiff_t>(3, here.end() - here.begin());
    skip(static_cast<std::size_t>(in_no_frame - here.begin()));
    const auto rest = buffer_.bytes();
    if (found == here.end() || rest.size() < kFrameHeaderBytes) return std::nullopt;
    const auto length = stated_length(rest);
    if (!length) {
      skip(1);
      continue;
    }
    if (rest.size() < kFrameHeaderBytes + *length) return std::nullopt;
    const auto message = rest.subspan(kFrameHeaderBytes, *length);
    if (get_u32_le(rest.subspan(16)) != crc_of(message)) {
      // Bytes were lost or changed in the message: a whole frame may begin within what seemed to be it.
      ++counters_.garbled_frames;
      skip(1);
      continue;
    }
    const FrameView frame{get_u32_le(rest.subspan(8)), get_u32_le(rest.subspan(12)), message};
    buffer_.drop(kFrameHeaderBytes + *length);
    ++counters_.frames;
    return frame;
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
