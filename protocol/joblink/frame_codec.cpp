#include "protocol/joblink/frame_codec.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>

#include "protocol/bytes.hpp"

namespace kinebus::joblink {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'K', 'B', 'J', '1'};

/// CRC-32 of IEEE 802.3.
std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  return ::libdeflate_crc32(0, bytes.data(), bytes.size());
}

/// The length that a right header states; nullopt: no header begins here.
std::optional<std::size_t> stated_length(std::span<const std::uint8_t> header, std::size_t limit) {
  const std::uint32_t length = get_u32_le(header.subspan(4));
  if (length > limit || get_u32_le(header.subspan(20)) != crc_of(header.first(20))) return std::nullopt;
  return length;
}

}  // namespace

bool append_frame(std::string& out, std::uint32_t session, std::uint32_t sequence, std::string_view message) {
  FrameQueue frame;
  if (!frame.append(session, sequence, message)) return false;
  out.append(reinterpret_cast<const char*>(frame.bytes().data()), frame.size());
  return true;
}

std::optional<std::span<std::uint8_t>> FrameQueue::begin(std::size_t size) {
  if (size > kMaxMessageBytes) return std::nullopt;
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

bool FrameQueue::append(std::uint32_t session, std::uint32_t sequence, std::string_view message) {
  const auto room = begin(message.size());
  if (!room) return false;
  std::copy(message.begin(), message.end(), room->begin());
  finish(session, sequence);
  return true;
}

void FrameReader::add(std::span<const std::uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), buffer_.room(bytes.size()).begin());
  buffer_.added(bytes.size());
}

void FrameReader::clear() {
  buffer_.clear();
  given_up_ = debt_ = 0;
}

/// At the front of `bytes`; its message may be wrong.
std::optional<FrameView> FrameReader::whole_frame(std::span<const std::uint8_t> bytes) const {
  if (bytes.size() < kFrameHeaderBytes || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    return std::nullopt;
  const auto length = stated_length(bytes, limit_);
  if (!length || bytes.size() < kFrameHeaderBytes + *length) return std::nullopt;
  return FrameView{get_u32_le(bytes.subspan(8)), get_u32_le(bytes.subspan(12)),
                   bytes.subspan(kFrameHeaderBytes, *length)};
}

void FrameReader::taken(std::size_t count) {
  buffer_.drop(count);
  given_up_ -= std::min(given_up_, count);
}

void FrameReader::skip(std::size_t count) {
  counters_.skipped_bytes += count;
  debt_ -= std::min(debt_, count);
  taken(count);
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
    if (found == here.end()) return std::nullopt;
    const bool whole_header = rest.size() >= kFrameHeaderBytes;
    if (!whole_header && given_up_ == 0) return std::nullopt;
    const auto length = whole_header ? stated_length(rest, limit_) : std::nullopt;
    if (!length) {
      skip(1);
      continue;
    }
    if (rest.size() < kFrameHeaderBytes + *length) {
      if (given_up_ == 0) return std::nullopt;
      skip(1);
      continue;
    }
    // Headers within each other would cost a whole message each.
    const bool short_one = *length <= FrameReader::kAlwaysChecked;
    if (!short_one && debt_ + *length > kMaxDebt) {
      skip(1);
      continue;
    }
    const auto message = rest.subspan(kFrameHeaderBytes, *length);
    counters_.checked_bytes += *length;
    if (get_u32_le(rest.subspan(16)) != crc_of(message)) {
      // Bytes were lost or changed in the message: a whole frame may begin within what seemed to be it.
      ++counters_.garbled_frames;
      if (!short_one) debt_ += *length;
      skip(1);
      continue;
    }
    const FrameView frame{get_u32_le(rest.subspan(8)), get_u32_le(rest.subspan(12)), message};
    taken(kFrameHeaderBytes + *length);
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
