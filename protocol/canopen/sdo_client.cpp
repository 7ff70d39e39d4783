#include "protocol/canopen/sdo_client.hpp"

#include <algorithm>

namespace kinebus {

using sdo::kSegmentBytes;

namespace {
constexpr std::size_t kBlockWorthwhile = 64;
}

void SdoClient::begin(LocalTime now, std::uint8_t node, ObjectAddress address, State state) {
  node_ = node;
  address_ = address;
  state_ = state;
  status_ = Status::kBusy;
  abort_code_ = AbortCode::kNone;
  at_ = 0;
  toggle_ = false;
  last_segment_ = false;
  now_ = now;
  due_ = now + options_.timeout;
}

bool SdoClient::download(LocalTime now, std::uint8_t node, ObjectAddress address,
                         std::span<const std::uint8_t> bytes, Method method) {
  if (status_ == Status::kBusy || bytes.empty()) return false;
  const auto size = static_cast<std::uint32_t>(bytes.size());
  out_ = bytes;
  if (method == Method::kBlock || (method == Method::kAutomatic && size > kBlockWorthwhile)) {
    begin(now, node, address, State::kInitiateBlockDownload);
    request_ = sdo::frame_of(request_id(), 0xC6, address, size);
    return true;
  }
  begin(now, node, address, State::kInitiateDownload);
  if (size <= 4) {
    request_ = sdo::frame_of(request_id(), 0x23u | ((4u - size) << 2), address);
    std::copy_n(bytes.begin(), size, request_->data.begin() + 4);
    at_ = size;
  } else {
    request_ = sdo::frame_of(request_id(), 0x21, address, size);
  }
  return true;
}

bool SdoClient::upload(LocalTime now, std::uint8_t node, ObjectAddress address, std::span<std::uint8_t> room,
                       Method method) {
  if (status_ == Status::kBusy || room.empty()) return false;
  in_ = room;
  const bool block =
      method == Method::kBlock || (method == Method::kAutomatic && room.size() > kBlockWorthwhile);
  begin(now, node, address, block ? State::kInitiateBlockUpload : State::kInitiateUpload);
  block_size_ = options_.block_size;
  request_ = block ? sdo::frame_of(request_id(), 0xA4, address, block_size_)
                   : sdo::frame_of(request_id(), 0x40, address);
  return true;
}

void SdoClient::cancel(AbortCode code) {
  if (status_ == Status::kBusy) fail(code, true);
}

void SdoClient::done() {
  state_ = State::kIdle;
  status_ = Status::kDone;
}

void SdoClient::fail(AbortCode code, bool tell) {
  state_ = State::kIdle;
  status_ = Status::kFailed;
  abort_code_ = code;
  request_.reset();
  if (tell) request_ = sdo::abort_frame(request_id(), address_, code);
}

void SdoClient::on_time(LocalTime now) {
  now_ = now;
  if (status_ == Status::kBusy && now >= due_) fail(AbortCode::kTimeout, true);
}

std::optional<CanFrame> SdoClient::next_frame() {
  if (request_) {
    const CanFrame frame = *request_;
    request_.reset();
    return frame;
  }
  if (state_ == State::kBlockDownload) return block_segment();
  return std::nullopt;
}

void SdoClient::on_frame(LocalTime now, const CanFrame& frame) {
  if (status_ != Status::kBusy || frame.id != cob_id::kSdoReply + node_ || frame.extended || frame.remote)
    return;
  if (frame.length != 8) return;
  now_ = now;
  due_ = now + options_.timeout;
  if (state_ == State::kBlockUpload && frame.data[0] != 0x80) return on_block_upload_segment(frame);
  const std::uint8_t reply = sdo::specifier(frame);
  if (reply == sdo::kAbort) return fail(sdo::abort_code_in(frame), false);
  const bool same_object = sdo::address_in(frame) == address_;
  switch (state_) {
    case State::kInitiateDownload:
      // Answers to a transfer before this one, of which a request came twice, are nobody's.
      if (reply != sdo::kReplyInitiateDownload || !same_object) return;
      if (at_ == out_.size()) return done();
      return send_download_segment();
    case State::kDownloadSegment:
      if (reply != sdo::kReplyDownloadSegment) break;
      if (((frame.data[0] & 0x10) != 0) != toggle_) return fail(AbortCode::kToggleBit, true);
      toggle_ = !toggle_;
      at_ += std::min(kSegmentBytes, out_.size() - at_);
      if (at_ == out_.size()) return done();
      return send_download_segment();
    case State::kInitiateUpload:
      if (reply != sdo::kReplyInitiateUpload || !same_object) return;
      return on_initiate_upload(frame);
    case State::kUploadSegment:
      if (reply != sdo::kReplyUploadSegment) break;
      return on_upload_segment(frame);
    case State::kInitiateBlockDownload:
    case State::kBlockDownload:
    case State::kBlockDownloadReply:
    case State::kBlockDownloadEnd:
      if (reply != sdo::kReplyBlockDownload) break;
      return on_block_download(frame);
    case State::kInitiateBlockUpload:
      if (reply == sdo::kReplyInitiateUpload && same_object) return on_initiate_upload(frame);
      [[fallthrough]];
    case State::kBlockUploadEnd:
      if (reply != sdo::kReplyBlockUpload) break;
      return on_block_upload(frame);
    case State::kBlockUpload:
    case State::kIdle:
      return;
  }
  fail(AbortCode::kCommandSpecifier, true);
}

void SdoClient::send_download_segment() {
  const std::size_t bytes = std::min(kSegmentBytes, out_.size() - at_);
  const bool last = at_ + bytes == out_.size();
  CanFrame frame =
      sdo::frame_of(request_id(), (toggle_ ? 0x10u : 0u) |
                                      (static_cast<unsigned>(kSegmentBytes - bytes) << 1) | (last ? 1u : 0u));
  std::copy_n(out_.begin() + static_cast<std::ptrdiff_t>(at_), bytes, frame.data.begin() + 1);
  state_ = State::kDownloadSegment;
  request_ = frame;
}

void SdoClient::on_initiate_upload(const CanFrame& reply) {
  size_known_ = (reply.data[0] & 1) != 0;
  if ((reply.data[0] & 2) != 0) {
    const std::size_t bytes = size_known_ ? 4u - ((reply.data[0] >> 2) & 3u) : 4u;
    if (bytes > in_.size()) return fail(AbortCode::kOutOfMemory, false);
    std::copy_n(reply.data.begin() + 4, bytes, in_.begin());
    at_ = bytes;
    return done();
  }
  total_ = get_u32_le(std::span(reply.data).subspan(4));
  if (size_known_ && total_ > in_.size()) return fail(AbortCode::kOutOfMemory, true);
  state_ = State::kUploadSegment;
  request_ = sdo::frame_of(request_id(), 0x60);
}

void SdoClient::on_upload_segment(const CanFrame& reply) {
  if (((reply.data[0] & 0x10) != 0) != toggle_) return fail(AbortCode::kToggleBit, true);
  toggle_ = !toggle_;
  const std::size_t bytes = kSegmentBytes - ((reply.data[0] >> 1) & 7u);
  if (at_ + bytes > in_.size()) return fail(AbortCode::kOutOfMemory, true);
  std::copy_n(reply.data.begin() + 1, bytes, in_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ += bytes;
  if ((reply.data[0] & 1) == 0) {
    request_ = sdo::frame_of(request_id(), 0x60u | (toggle_ ? 0x10u : 0u));
    return;
  }
  if (size_known_ && at_ != total_) return fail(AbortCode::kLength, false);
  done();
}

CanFrame SdoClient::block_segment() {
  const std::size_t from = at_ + sequence_ * kSegmentBytes;
  const std::size_t bytes = std::min(kSegmentBytes, out_.size() - from);
  last_segment_ = from + bytes == out_.size();
  ++sequence_;
  CanFrame frame = sdo::frame_of(request_id(), sequence_ | (last_segment_ ? 0x80u : 0u));
  std::copy_n(out_.begin() + static_cast<std::ptrdiff_t>(from), bytes, frame.data.begin() + 1);
  if (last_segment_ || sequence_ == block_size_) state_ = State::kBlockDownloadReply;
  return frame;
}

void SdoClient::on_block_download(const CanFrame& reply) {
  const unsigned kind = reply.data[0] & 3u;
  if (state_ == State::kInitiateBlockDownload && kind == 0) {
    if (sdo::address_in(reply) != address_) return;
    with_crc_ = (reply.data[0] & 4) != 0;
    block_size_ = reply.data[4];
    if (block_size_ == 0 || block_size_ > sdo::kMaxBlockSize) return fail(AbortCode::kBlockSize, true);
    sequence_ = 0;
    state_ = State::kBlockDownload;
    return;
  }
  if (state_ == State::kBlockDownloadReply && kind == 2) {
    const std::uint8_t acknowledged = reply.data[1];
    block_size_ = reply.data[2];
    if (acknowledged > sequence_) return fail(AbortCode::kSequenceNumber, true);
    if (block_size_ == 0 || block_size_ > sdo::kMaxBlockSize) return fail(AbortCode::kBlockSize, true);
    const bool complete = last_segment_ && acknowledged == sequence_;
    at_ = std::min(out_.size(), at_ + acknowledged * kSegmentBytes);
    sequence_ = 0;
    if (!complete) {
      state_ = State::kBlockDownload;
      return;
    }
    const auto unused = static_cast<unsigned>((kSegmentBytes - out_.size() % kSegmentBytes) % kSegmentBytes);
    CanFrame end = sdo::frame_of(request_id(), 0xC1u | (unused << 2));
    if (with_crc_) {
      Crc16 crc;
      crc.add(out_);
      put_u16_le(std::span(end.data).subspan(1), crc.value());
    }
    state_ = State::kBlockDownloadEnd;
    request_ = end;
    return;
  }
  if (state_ == State::kBlockDownloadEnd && kind == 1) return done();
  fail(AbortCode::kCommandSpecifier, true);
}

void SdoClient::on_block_upload(const CanFrame& reply) {
  if (state_ == State::kInitiateBlockUpload && (reply.data[0] & 1) == 0) {
    if (sdo::address_in(reply) != address_) return;
    with_crc_ = (reply.data[0] & 4) != 0;
    size_known_ = (reply.data[0] & 2) != 0;
    total_ = get_u32_le(std::span(reply.data).subspan(4));
    if (size_known_ && total_ > in_.size()) return fail(AbortCode::kOutOfMemory, true);
    sequence_ = 0;
    state_ = State::kBlockUpload;
    request_ = sdo::frame_of(request_id(), 0xA3);
    return;
  }
  if (state_ != State::kBlockUploadEnd || (reply.data[0] & 3) != 1)
    return fail(AbortCode::kCommandSpecifier, true);
  const std::size_t unused = (reply.data[0] >> 2) & 7u;
  if (unused > at_) return fail(AbortCode::kCommandSpecifier, true);
  at_ -= unused;
  if (at_ > in_.size()) return fail(AbortCode::kOutOfMemory, true);
  if (size_known_ && at_ != total_) return fail(AbortCode::kLength, true);
  if (with_crc_) {
    Crc16 crc;
    crc.add(in_.first(at_));
    if (crc.value() != get_u16_le(std::span(reply.data).subspan(1))) return fail(AbortCode::kCrc, true);
  }
  request_ = sdo::frame_of(request_id(), 0xA1);
  done();
}

void SdoClient::on_block_upload_segment(const CanFrame& reply) {
  const auto sequence = static_cast<std::uint8_t>(reply.data[0] & 0x7F);
  const bool last = (reply.data[0] & 0x80) != 0;
  if (sequence == 0 || sequence > block_size_) return fail(AbortCode::kSequenceNumber, true);
  if (sequence == sequence_ + 1) {
    // The last segment may be padded: at_ counts the padding until the end frame says how much it is.
    const std::size_t room = at_ < in_.size() ? in_.size() - at_ : 0;
    if (room < kSegmentBytes && !last) return fail(AbortCode::kOutOfMemory, true);
    std::copy_n(reply.data.begin() + 1, std::min(room, kSegmentBytes),
                in_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ += kSegmentBytes;
    ++sequence_;
    last_segment_ = last;
  }
  if (!last && sequence != block_size_) return;
  CanFrame answer = sdo::frame_of(request_id(), 0xA2);
  answer.data[1] = sequence_;
  answer.data[2] = block_size_;
  if (last_segment_) state_ = State::kBlockUploadEnd;
  sequence_ = 0;
  request_ = answer;
}

}  // namespace kinebus
