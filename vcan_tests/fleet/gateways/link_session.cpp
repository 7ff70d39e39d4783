#include "vcan_tests/fleet/gateways/link_session.hpp"

#include <utility>

#include "protocol/joblink/upload_chunk.hpp"
#include "protocol/joblink/version.hpp"

namespace kinebus::fleet {
namespace {
constexpr std::uint32_t kChunkBytes = 256U << 10;
}  // namespace

void LinkSession::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  reader_.add(bytes);
  while (const auto frame = reader_.next()) take(now, *frame);
}

void LinkSession::send(joblink::Reply reply, std::uint32_t request) {
  joblink::ServerMessage message;
  *message.mutable_reply() = std::move(reply);
  message.mutable_reply()->set_request_id(request);
  out_.append(session_, sequence_, message.SerializeAsString());
  sequence_ = joblink::SessionSequence::after(sequence_);
}

void LinkSession::take(LocalTime now, const joblink::FrameView& frame) {
  if (const auto chunk = joblink::read_chunk(frame.message)) {
    joblink::Reply reply;
    reply.mutable_upload()->set_upload_id(chunk->head.upload_id);
    reply.mutable_upload()->set_received_bytes(chunk->head.offset_bytes + chunk->data.size());
    return send(std::move(reply), chunk->head.request_id);
  }
  joblink::ClientMessage message;
  if (!message.ParseFromArray(frame.message.data(), static_cast<int>(frame.message.size()))) return;
  if (!message.has_hello()) return send(gateway_.answer(now, message), message.request_id());
  session_ = frame.session;
  sequence_ = 0;
  joblink::Reply reply;
  joblink::HelloReply& hello = *reply.mutable_hello();
  hello.set_version_major(joblink::kVersionMajor);
  hello.set_client_id(1);
  hello.set_max_chunk_bytes(kChunkBytes);
  hello.set_upload_window_bytes(4 * kChunkBytes);
  send(std::move(reply), message.request_id());
}

}  // namespace kinebus::fleet
