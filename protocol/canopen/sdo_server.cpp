#include "protocol/canopen/sdo_server.hpp"

#include <algorithm>

namespace kinebus {

using sdo::kSegmentBytes;

void SdoServer::reset(std::uint8_t node) {
  node_ = node;
  state_ = State::kIdle;
  reply_.reset();
  deferring_ = false;
}

void SdoServer::on_frame(LocalTime now, const CanFrame& frame) {
  if (node_ == 0 || frame.id != cob_id::kSdoRequest + node_ || frame.extended || frame.remote) return;
  if (frame.length != 8) {
    ++counters_.malformed;
    return;
  }
  due_ = now + options_.timeout;
  // Segments of a block have no command specifier; only an abort, 80h, cannot be one (its sequence would be
  // 0).
  if (state_ == State::kBlockDownload && frame.data[0] != 0x80) return block_download_segment(frame);
  const std::uint8_t command = sdo::specifier(frame);
  if (command == sdo::kAbort) {
    if (busy()) ++counters_.aborts_received;
    if (busy()) state_ = State::kIdle;
    reply_.reset();
    return;
  }
  if (state_ == State::kDeferred) {
    reply(sdo::abort_frame(reply_id(), sdo::address_in(frame), AbortCode::kDeviceState));
    return;
  }
  switch (command) {
    case sdo::kInitiateDownload:
      return initiate_download(frame);
    case sdo::kDownloadSegment:
      return download_segment(frame);
    case sdo::kInitiateUpload:
      return initiate_upload(frame);
    case sdo::kUploadSegment:
      return upload_segment(frame);
    case sdo::kBlockDownload:
      return (frame.data[0] & 1) == 0 ? initiate_block_download(frame) : end_block_download(frame);
    case sdo::kBlockUpload:
      return (frame.data[0] & 3) == 0 ? initiate_block_upload(frame) : block_upload_request(frame);
    default:
      address_ = sdo::address_in(frame);
      return abort(AbortCode::kCommandSpecifier);
  }
}

void SdoServer::refuse(const CanFrame& frame) {
  if (node_ == 0 || frame.id != cob_id::kSdoRequest + node_ || !sdo::begins_to_write(frame)) return;
  ++counters_.aborts_sent;
  reply(sdo::abort_frame(reply_id(), sdo::address_in(frame), AbortCode::kDeviceState));
}

void SdoServer::on_time(LocalTime now) {
  if (!busy() || now < due_) return;
  ++counters_.timeouts;
  abort(AbortCode::kTimeout);
}

std::optional<CanFrame> SdoServer::next_frame() {
  if (reply_) {
    const CanFrame frame = *reply_;
    reply_.reset();
    return frame;
  }
  if (state_ == State::kBlockUpload) return block_upload_segment();
  return std::nullopt;
}

void SdoServer::finish(AbortCode result) {
  if (state_ != State::kDeferred) return;
  state_ = State::kIdle;
  if (result != AbortCode::kNone) return abort(result);
  ++counters_.transfers;
  reply(deferred_reply_);
}

void SdoServer::abort(AbortCode code) {
  state_ = State::kIdle;
  ++counters_.aborts_sent;
  reply(sdo::abort_frame(reply_id(), address_, code));
}

/// Passes what is buffered on to the objects.
AbortCode SdoServer::flush(bool last) {
  const auto bytes = std::span(buffer_).first(buffered_);
  crc_.add(bytes);
  deferring_ = false;
  const AbortCode result = objects_.sdo_write(address_, offset_, bytes, last);
  offset_ += static_cast<std::uint32_t>(buffered_);
  buffered_ = 0;
  return result;
}

void SdoServer::write_done(AbortCode result, const CanFrame& answer) {
  if (result != AbortCode::kNone) return abort(result);
  if (deferring_) {
    deferring_ = false;
    deferred_reply_ = answer;
    state_ = State::kDeferred;
    return;
  }
  state_ = State::kIdle;
  ++counters_.transfers;
  reply(answer);
}

void SdoServer::initiate_download(const CanFrame& request) {
  address_ = sdo::address_in(request);
  state_ = State::kIdle;
  offset_ = 0;
  buffered_ = 0;
  size_known_ = (request.data[0] & 1) != 0;
  const CanFrame answer = sdo::frame_of(reply_id(), 0x60, address_);
  if ((request.data[0] & 2) != 0) {
    buffered_ = size_known_ ? 4 - ((request.data[0] >> 2) & 3u)
                            : std::min<std::size_t>(objects_.sdo_size(address_), 4);
    std::copy_n(request.data.begin() + 4, buffered_, buffer_.begin());
    return write_done(flush(true), answer);
  }
  total_ = get_u32_le(std::span(request.data).subspan(4));
  toggle_ = false;
  state_ = State::kDownloadSegments;
  reply(answer);
}

void SdoServer::download_segment(const CanFrame& request) {
  if (state_ != State::kDownloadSegments) return abort(AbortCode::kCommandSpecifier);
  const bool toggle = (request.data[0] & 0x10) != 0;
  if (toggle != toggle_) return abort(AbortCode::kToggleBit);
  const std::size_t bytes = kSegmentBytes - ((request.data[0] >> 1) & 7u);
  const bool last = (request.data[0] & 1) != 0;
  std::copy_n(request.data.begin() + 1, bytes, buffer_.begin() + static_cast<std::ptrdiff_t>(buffered_));
  buffered_ += bytes;
  const std::uint64_t got = std::uint64_t{offset_} + buffered_;
  if (size_known_ && got > total_) return abort(AbortCode::kTooLong);
  if (size_known_ && last && got < total_) return abort(AbortCode::kTooShort);
  toggle_ = !toggle_;
  const CanFrame answer = sdo::frame_of(reply_id(), 0x20u | (toggle ? 0x10u : 0u));
  if (last) return write_done(flush(true), answer);
  // At least one byte stays back for the last piece.
  if (buffered_ + kSegmentBytes > buffer_.size())
    if (const AbortCode refused = flush(false); refused != AbortCode::kNone) return abort(refused);
  reply(answer);
}

/// Reads the start of the value; a value that fits the buffer is kept as one, so that it cannot change
/// midway.
bool SdoServer::begin_upload(ObjectAddress address) {
  address_ = address;
  state_ = State::kIdle;
  offset_ = 0;
  const AbortCode refused = objects_.sdo_read(address_, 0, buffer_, total_);
  if (refused != AbortCode::kNone) {
    abort(refused);
    return false;
  }
  snapshot_ = total_ <= buffer_.size();
  return true;
}

AbortCode SdoServer::fill(std::uint32_t offset, std::span<std::uint8_t> out) {
  if (snapshot_) {
    std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
    return AbortCode::kNone;
  }
  std::uint32_t total = 0;
  return objects_.sdo_read(address_, offset, out, total);
}

void SdoServer::reply_upload_initiate() {
  if (total_ <= 4 && total_ > 0) {
    CanFrame answer = sdo::frame_of(reply_id(), 0x43u | ((4u - total_) << 2), address_);
    std::copy_n(buffer_.begin(), total_, answer.data.begin() + 4);
    ++counters_.transfers;
    return reply(answer);
  }
  toggle_ = false;
  state_ = State::kUploadSegments;
  reply(sdo::frame_of(reply_id(), 0x41, address_, total_));
}

void SdoServer::initiate_upload(const CanFrame& request) {
  if (begin_upload(sdo::address_in(request))) reply_upload_initiate();
}

void SdoServer::upload_segment(const CanFrame& request) {
  if (state_ != State::kUploadSegments) return abort(AbortCode::kCommandSpecifier);
  const bool toggle = (request.data[0] & 0x10) != 0;
  if (toggle != toggle_) return abort(AbortCode::kToggleBit);
  toggle_ = !toggle_;
  const std::uint32_t bytes = std::min<std::uint32_t>(kSegmentBytes, total_ - offset_);
  const bool last = offset_ + bytes == total_;
  CanFrame answer =
      sdo::frame_of(reply_id(), (toggle ? 0x10u : 0u) |
                                    ((static_cast<unsigned>(kSegmentBytes) - bytes) << 1) | (last ? 1u : 0u));
  if (const AbortCode refused = fill(offset_, std::span(answer.data).subspan(1, bytes));
      refused != AbortCode::kNone)
    return abort(refused);
  offset_ += bytes;
  if (last) {
    state_ = State::kIdle;
    ++counters_.transfers;
  }
  reply(answer);
}

void SdoServer::initiate_block_download(const CanFrame& request) {
  address_ = sdo::address_in(request);
  with_crc_ = (request.data[0] & 4) != 0;
  size_known_ = (request.data[0] & 2) != 0;
  total_ = get_u32_le(std::span(request.data).subspan(4));
  offset_ = 0;
  buffered_ = 0;
  crc_ = {};
  sequence_ = 0;
  last_segment_ = false;
  block_size_ = options_.block_size;
  state_ = State::kBlockDownload;
  reply(sdo::frame_of(reply_id(), 0xA4, address_, block_size_));
}

void SdoServer::block_download_segment(const CanFrame& request) {
  const auto sequence = static_cast<std::uint8_t>(request.data[0] & 0x7F);
  const bool last = (request.data[0] & 0x80) != 0;
  if (sequence == 0 || sequence > block_size_) return abort(AbortCode::kSequenceNumber);
  // After a gap the rest of the block is passed over; the answer says from where to send again.
  if (sequence == sequence_ + 1 && !last_segment_) {
    std::copy_n(request.data.begin() + 1, kSegmentBytes,
                buffer_.begin() + static_cast<std::ptrdiff_t>(buffered_));
    buffered_ += kSegmentBytes;
    ++sequence_;
    last_segment_ = last;
  }
  if (sequence != block_size_ && !last) return;
  CanFrame answer = sdo::frame_of(reply_id(), 0xA2);
  answer.data[1] = sequence_;
  sequence_ = 0;
  if (last_segment_) {
    state_ = State::kBlockDownloadEnd;
  } else {
    // The last segment stays back: it might turn out to be the end's, with bytes to cut off, only if marked
    // so; but one piece must be left for `last`.
    if (buffered_ > kSegmentBytes) {
      std::array<std::uint8_t, kSegmentBytes> tail;
      std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(buffered_ - kSegmentBytes), kSegmentBytes,
                  tail.begin());
      buffered_ -= kSegmentBytes;
      if (const AbortCode refused = flush(false); refused != AbortCode::kNone) return abort(refused);
      std::copy(tail.begin(), tail.end(), buffer_.begin());
      buffered_ = kSegmentBytes;
    }
    const std::size_t room = (buffer_.size() - buffered_) / kSegmentBytes;
    block_size_ = static_cast<std::uint8_t>(std::min<std::size_t>(options_.block_size, room));
  }
  answer.data[2] = block_size_;
  reply(answer);
}

void SdoServer::end_block_download(const CanFrame& request) {
  if (state_ != State::kBlockDownloadEnd) return abort(AbortCode::kCommandSpecifier);
  const std::size_t unused = (request.data[0] >> 2) & 7u;
  if (unused > buffered_) return abort(AbortCode::kCommandSpecifier);
  buffered_ -= unused;
  const std::uint64_t got = std::uint64_t{offset_} + buffered_;
  if (size_known_ && got > total_) return abort(AbortCode::kTooLong);
  if (size_known_ && got < total_) return abort(AbortCode::kTooShort);
  if (with_crc_) {
    Crc16 crc = crc_;
    crc.add(std::span(buffer_).first(buffered_));
    if (crc.value() != get_u16_le(std::span(request.data).subspan(1))) return abort(AbortCode::kCrc);
  }
  write_done(flush(true), sdo::frame_of(reply_id(), 0xA1));
}

void SdoServer::initiate_block_upload(const CanFrame& request) {
  if (!begin_upload(sdo::address_in(request))) return;
  block_size_ = request.data[4];
  if (block_size_ == 0 || block_size_ > sdo::kMaxBlockSize) return abort(AbortCode::kBlockSize);
  const std::uint8_t switch_threshold = request.data[5];
  if (switch_threshold != 0 && total_ <= switch_threshold) return reply_upload_initiate();
  with_crc_ = (request.data[0] & 4) != 0;
  crc_ = {};
  state_ = State::kBlockUploadStart;
  reply(sdo::frame_of(reply_id(), 0xC6, address_, total_));
}

CanFrame SdoServer::block_upload_segment() {
  const std::uint32_t at = offset_ + sequence_ * static_cast<std::uint32_t>(kSegmentBytes);
  const std::uint32_t bytes = std::min<std::uint32_t>(kSegmentBytes, total_ - at);
  last_segment_ = at + bytes == total_;
  ++sequence_;
  CanFrame frame = sdo::frame_of(reply_id(), sequence_ | (last_segment_ ? 0x80u : 0u));
  if (const AbortCode refused = fill(at, std::span(frame.data).subspan(1, bytes));
      refused != AbortCode::kNone) {
    abort(refused);
    const CanFrame answer = *reply_;
    reply_.reset();
    return answer;
  }
  if (last_segment_ || sequence_ == block_size_) state_ = State::kBlockUploadReply;
  return frame;
}

void SdoServer::block_upload_request(const CanFrame& request) {
  const unsigned kind = request.data[0] & 3u;
  if (kind == 3 && state_ == State::kBlockUploadStart) {  // start
    state_ = State::kBlockUpload;
    sequence_ = 0;
    return;
  }
  if (kind == 1 && state_ == State::kBlockUploadEnd) {  // end confirmed
    state_ = State::kIdle;
    ++counters_.transfers;
    return;
  }
  if (kind != 2 || state_ != State::kBlockUploadReply) return abort(AbortCode::kCommandSpecifier);
  const std::uint8_t acknowledged = request.data[1];
  const std::uint8_t next_size = request.data[2];
  if (acknowledged > sequence_) return abort(AbortCode::kSequenceNumber);
  if (next_size == 0 || next_size > sdo::kMaxBlockSize) return abort(AbortCode::kBlockSize);
  const bool complete = last_segment_ && acknowledged == sequence_;
  const std::uint32_t end =
      std::min(total_, offset_ + acknowledged * static_cast<std::uint32_t>(kSegmentBytes));
  while (offset_ < end) {
    std::array<std::uint8_t, kSegmentBytes> piece{};
    const std::uint32_t bytes = std::min<std::uint32_t>(kSegmentBytes, end - offset_);
    if (with_crc_) {
      if (const AbortCode refused = fill(offset_, std::span(piece).first(bytes)); refused != AbortCode::kNone)
        return abort(refused);
      crc_.add(std::span(piece).first(bytes));
    }
    offset_ += bytes;
  }
  block_size_ = next_size;
  sequence_ = 0;
  if (!complete) {
    state_ = State::kBlockUpload;
    return;
  }
  const auto unused = static_cast<unsigned>((kSegmentBytes - total_ % kSegmentBytes) % kSegmentBytes);
  CanFrame end_frame = sdo::frame_of(reply_id(), 0xC1u | ((total_ == 0 ? 7u : unused) << 2));
  if (with_crc_) put_u16_le(std::span(end_frame.data).subspan(1), crc_.value());
  state_ = State::kBlockUploadEnd;
  reply(end_frame);
}

}  // namespace kinebus
