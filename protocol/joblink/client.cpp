#include "protocol/joblink/client.hpp"

#include <algorithm>
#include <utility>

#include "protocol/joblink/upload_chunk.hpp"

namespace kinebus::joblink {
namespace {

constexpr LocalTime kHelloAgain = std::chrono::seconds{1};
/// Chunks are made when less than this waits to be sent, so that a hold never queues behind a whole job.
constexpr std::size_t kOutputWanted = 64U << 10;
/// News that nobody pulls: the oldest status goes first.
constexpr std::size_t kMaxNews = 4096;

Problem lost(const std::string& why) {
  Problem problem;
  problem.set_rule("the link to the gateway is broken: " + why);
  problem.set_code(ERROR_LINK_LOST);
  return problem;
}

Problem too_long() {
  Problem problem;
  problem.set_rule("the request is longer than the 1 MiB that one message may have");
  problem.set_code(ERROR_BAD_VALUE);
  return problem;
}

std::uint32_t next_session(std::uint32_t session) {
  // A step that visits every number: sessions of one client never repeat in practice; 0 is no session.
  session = session * 747'796'405U + 2'891'336'453U;
  return session == 0 ? 1 : session;
}

}  // namespace

struct Client::Upload {
  UploadId id = 0;
  UploadRequest request;
  std::unique_ptr<UploadSource> source;
  enum class Step : std::uint8_t { kIdle, kBegun, kSending, kCommitted } step = Step::kIdle;
  std::uint32_t gateway_id = 0;
  std::uint64_t sent_bytes = 0;
  std::uint64_t received_bytes = 0;
  std::unordered_map<RequestId, bool> open;  ///< its own requests without an answer
};

Client::Client(Options options) : options_(std::move(options)), session_(options_.session_seed) {}
Client::~Client() = default;

void Client::on_connected(LocalTime now) {
  now_ = now;
  if (phase_ != Phase::kClosed) end_session(now, "the stream was opened anew", false);
  reader_.clear();
  out_.clear();
  begin_session(now);
}

void Client::on_disconnected(LocalTime now, const std::string& why) {
  now_ = now;
  if (phase_ == Phase::kClosed) return;
  end_session(now, why, false);
  phase_ = Phase::kClosed;
  out_.clear();
}

void Client::begin_session(LocalTime now) {
  session_ = next_session(session_);
  sequence_ = 0;
  incoming_.begin(session_, 0);
  phase_ = Phase::kGreeting;
  last_heard_ = now;
  retry_at_ = now + options_.silence_limit;
  ClientMessage message;
  Hello& hello = *message.mutable_hello();
  hello.set_version_major(kVersionMajor);
  hello.set_version_minor(kVersionMinor);
  hello.set_client_name(options_.name);
  hello.set_client_version(options_.version);
  hello.set_token(options_.token);
  hello.set_resume_key(resume_key_);
  if (write_request(message)) {
    open_[last_request_] = false;
    return;
  }
  end_session(now, {}, false);
  news_.emplace_back(Disconnected{too_long().rule()});
}

void Client::end_session(LocalTime now, const std::string& why, bool retry) {
  const bool was_open = phase_ == Phase::kOpen;
  phase_ = Phase::kWaiting;
  retry_at_ = retry ? now + kHelloAgain : LocalTime::max();
  std::vector<RequestId> unanswered;
  for (const auto& [id, own] : open_)
    if (own) unanswered.push_back(id);
  std::sort(unanswered.begin(), unanswered.end());
  open_.clear();
  for (const RequestId id : unanswered) fail_request(id, lost(why));
  if (!uploads_.empty()) {
    Upload& upload = *uploads_.front();
    upload.open.clear();
    upload.step = Upload::Step::kIdle;
    tell_upload(UploadNews::Phase::kWaiting);
  }
  if (was_open) news_.emplace_back(Disconnected{why});
}

/// The frame that was just finished is the session's latest.
void Client::written() {
  sequence_ = SessionSequence::after(sequence_);
  last_written_ = now_;
}

/// False: no frame can carry it.
bool Client::write_request(ClientMessage& message) {
  message.set_request_id(++last_request_);
  const auto room = out_.begin(message.ByteSizeLong());
  if (!room) return false;
  message.SerializeWithCachedSizesToArray(room->data());
  out_.finish(session_, sequence_);
  written();
  return true;
}

void Client::fail_request(RequestId request, const Problem& error) {
  Reply reply;
  reply.set_request_id(request);
  *reply.mutable_error() = error;
  news_.emplace_back(Answer{request, std::move(reply)});
}

RequestId Client::send(ClientMessage request) {
  if (phase_ != Phase::kOpen)
    fail_request(++last_request_, lost("not connected"));
  else if (write_request(request))
    open_[last_request_] = true;
  else
    fail_request(last_request_, too_long());
  return last_request_;
}

UploadId Client::upload(UploadRequest request, std::unique_ptr<UploadSource> source) {
  auto upload = std::make_unique<Upload>();
  upload->id = ++last_upload_;
  upload->request = std::move(request);
  upload->source = std::move(source);
  uploads_.push_back(std::move(upload));
  if (uploads_.size() == 1) begin_upload();
  return last_upload_;
}

void Client::abort_upload(UploadId upload, bool discard) {
  const auto found =
      std::find_if(uploads_.begin(), uploads_.end(), [&](const auto& u) { return u->id == upload; });
  if (found == uploads_.end()) return;
  Problem aborted;
  aborted.set_rule("the upload was stopped by its owner");
  if (found != uploads_.begin()) {
    news_.emplace_back(
        UploadNews{UploadNews::Phase::kFailed, upload, 0, (*found)->request.size_bytes, aborted});
    uploads_.erase(found);
    return;
  }
  if (phase_ == Phase::kOpen && (*found)->step == Upload::Step::kSending) {
    ClientMessage message;
    message.mutable_upload_abort()->set_upload_id((*found)->gateway_id);
    message.mutable_upload_abort()->set_discard(discard);
    if (write_request(message)) open_[last_request_] = false;
  }
  finish_upload(UploadNews::Phase::kFailed, aborted);
}

void Client::begin_upload() {
  if (phase_ != Phase::kOpen || uploads_.empty()) return;
  Upload& upload = *uploads_.front();
  if (upload.step != Upload::Step::kIdle) return;
  ClientMessage message;
  UploadBegin& begin = *message.mutable_upload_begin();
  begin.set_name(upload.request.name);
  begin.set_size_bytes(upload.request.size_bytes);
  begin.set_hash(upload.request.hash);
  begin.set_replace(upload.request.replace);
  if (!write_request(message)) return finish_upload(UploadNews::Phase::kFailed, too_long());
  upload.open[last_request_] = true;
  upload.step = Upload::Step::kBegun;
}

void Client::tell_upload(UploadNews::Phase phase) {
  const Upload& upload = *uploads_.front();
  news_.emplace_back(UploadNews{phase, upload.id, upload.received_bytes, upload.request.size_bytes, {}});
}

void Client::finish_upload(UploadNews::Phase phase, const Problem& error) {
  const Upload& upload = *uploads_.front();
  news_.emplace_back(UploadNews{phase, upload.id, upload.received_bytes, upload.request.size_bytes, error});
  uploads_.pop_front();
  begin_upload();
}

void Client::feed_upload() {
  if (phase_ != Phase::kOpen || uploads_.empty()) return;
  Upload& upload = *uploads_.front();
  if (upload.step != Upload::Step::kSending) return;
  const std::size_t chunk_bytes =
      std::clamp<std::size_t>(hello_.max_chunk_bytes(), 1024, kMaxMessageBytes - 1024);
  const std::uint64_t window = std::max<std::uint64_t>(hello_.upload_window_bytes(), chunk_bytes);
  while (out_.size() < kOutputWanted && upload.sent_bytes < upload.request.size_bytes &&
         upload.sent_bytes - upload.received_bytes + chunk_bytes <= window) {
    const auto size = static_cast<std::size_t>(
        std::min<std::uint64_t>(chunk_bytes, upload.request.size_bytes - upload.sent_bytes));
    if (!send_chunk(upload, size)) {
      Problem problem;
      problem.set_place(upload.request.name);
      problem.set_rule("the file cannot be read any more, or has become shorter");
      return finish_upload(UploadNews::Phase::kFailed, problem);
    }
  }
  if (upload.received_bytes == upload.request.size_bytes) {
    ClientMessage message;
    message.mutable_upload_commit()->set_upload_id(upload.gateway_id);
    if (write_request(message)) upload.open[last_request_] = true;
    upload.step = Upload::Step::kCommitted;
  }
}

/// The bytes go from their source into the frame, and nowhere else on the way.
bool Client::send_chunk(Upload& upload, std::size_t size) {
  const ChunkHead head{last_request_ + 1, upload.gateway_id, upload.sent_bytes};
  const auto room = out_.begin(chunk_message_bytes(head, size));
  if (!room) return false;
  const auto data = write_chunk(head, size, *room);
  if (upload.source->read(upload.sent_bytes, {reinterpret_cast<char*>(data.data()), size}) != size)
    return false;
  out_.finish(session_, sequence_);
  written();
  upload.open[++last_request_] = true;
  upload.sent_bytes += size;
  return true;
}

std::span<const std::uint8_t> Client::next_bytes() {
  feed_upload();
  return out_.bytes();
}

void Client::on_bytes_sent(std::size_t count) {
  out_.sent(count);
}

void Client::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  now_ = now;
  if (phase_ == Phase::kClosed) return;
  reader_.add(bytes);
  while (const auto frame = reader_.next()) {
    switch (incoming_.take(*frame)) {
      case SessionSequence::Verdict::kBegins:
      case SessionSequence::Verdict::kStale:
        continue;
      case SessionSequence::Verdict::kGap:
        if (phase_ == Phase::kWaiting) continue;
        end_session(now, "a message was lost on the way", true);
        continue;
      case SessionSequence::Verdict::kNext:
        break;
    }
    if (phase_ == Phase::kWaiting) continue;
    last_heard_ = now;
    ServerMessage message;
    if (message.ParseFromArray(frame->message.data(), static_cast<int>(frame->message.size())))
      take(now, message);
    else
      end_session(now, "a message could not be understood", true);
  }
}

void Client::take(LocalTime now, const ServerMessage& message) {
  switch (message.message_case()) {
    case ServerMessage::kReply:
      take_reply(message.reply());
      break;
    case ServerMessage::kStatus:
      // Who does not keep up gets the newest status, not all old ones.
      if (news_.size() >= kMaxNews || (!news_.empty() && std::holds_alternative<Status>(news_.back())))
        std::erase_if(news_, [](const News& n) { return std::holds_alternative<Status>(n); });
      news_.emplace_back(message.status());
      break;
    case ServerMessage::kEvent:
      if (news_.size() < kMaxNews) news_.emplace_back(message.event());
      break;
    case ServerMessage::kSessionEnd:
      end_session(now, message.session_end().reason(), message.session_end().resync());
      break;
    case ServerMessage::MESSAGE_NOT_SET:
      break;  // of a newer minor version
  }
}

void Client::take_reply(Reply reply) {
  if (!uploads_.empty() && uploads_.front()->open.erase(reply.request_id()) != 0) {
    take_upload_reply(reply);
    return;
  }
  const auto found = open_.find(reply.request_id());
  if (found == open_.end()) return;
  const bool own = found->second;
  open_.erase(found);
  if (own) {
    const RequestId id = reply.request_id();
    news_.emplace_back(Answer{id, std::move(reply)});
    return;
  }
  if (phase_ != Phase::kGreeting) return;
  if (reply.has_error()) {
    phase_ = Phase::kWaiting;
    retry_at_ = LocalTime::max();
    news_.emplace_back(Disconnected{reply.error().rule()});
    return;
  }
  if (!reply.has_hello()) return;
  hello_ = reply.hello();
  resume_key_ = hello_.resume_key();
  phase_ = Phase::kOpen;
  ClientMessage watch;
  watch.mutable_watch()->set_status_hz(options_.status_hz);
  watch.mutable_watch()->set_events(options_.events);
  if (write_request(watch)) open_[last_request_] = false;
  news_.emplace_back(Connected{hello_});
  begin_upload();
}

void Client::take_upload_reply(const Reply& reply) {
  Upload& upload = *uploads_.front();
  if (reply.has_error()) return finish_upload(UploadNews::Phase::kFailed, reply.error());
  const UploadState& state = reply.upload();
  upload.received_bytes = std::min(state.received_bytes(), upload.request.size_bytes);
  if (state.stored()) return finish_upload(UploadNews::Phase::kStored, {});
  if (upload.step == Upload::Step::kBegun) {
    upload.step = Upload::Step::kSending;
    upload.gateway_id = state.upload_id();
    upload.sent_bytes = upload.received_bytes;
  }
  tell_upload(UploadNews::Phase::kSending);
}

void Client::on_time(LocalTime now) {
  const LocalTime before = std::exchange(now_, now);
  switch (phase_) {
    case Phase::kClosed:
      return;
    case Phase::kWaiting:
    case Phase::kGreeting:
      if (now >= retry_at_) begin_session(now);
      return;
    case Phase::kOpen:
      break;
  }
  // Who was away cannot tell whether the gateway was silent.
  if (now >= std::max(next_deadline(before), before) + options_.absence) last_heard_ = now;
  if (now >= last_heard_ + options_.silence_limit) {
    end_session(now, "the gateway has gone silent", true);
    return;
  }
  if (now >= last_written_ + options_.ping_period && out_.empty()) {
    ClientMessage ping;
    ping.mutable_ping();
    if (write_request(ping)) open_[last_request_] = false;
  }
}

LocalTime Client::next_deadline() const {
  return next_deadline(now_);
}

LocalTime Client::next_deadline(LocalTime now) const {
  switch (phase_) {
    case Phase::kClosed:
      return LocalTime::max();
    case Phase::kWaiting:
    case Phase::kGreeting:
      return retry_at_;
    case Phase::kOpen:
      break;
  }
  // With output waiting the stream is slow: a ping behind it would tell nothing.
  const LocalTime ping = (out_.empty() ? last_written_ : now) + options_.ping_period;
  return std::min(last_heard_ + options_.silence_limit, ping);
}

std::optional<News> Client::next_news() {
  if (news_.empty()) return std::nullopt;
  News news = std::move(news_.front());
  news_.pop_front();
  return news;
}

}  // namespace kinebus::joblink
