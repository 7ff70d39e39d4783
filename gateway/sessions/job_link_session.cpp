#include "gateway/sessions/job_link_session.hpp"

#include <openssl/crypto.h>

#include <algorithm>
#include <utility>

#include "gateway/sessions/job_requests.hpp"
#include "gateway/sessions/machine_requests.hpp"
#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/upload_chunk.hpp"
#include "protocol/joblink/version.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using joblink::SessionSequence;

/// A client that does not read its answers is not listened to any further.
constexpr std::size_t kMaxBacklog = 1U << 20;
constexpr int kMaxOpenRequests = 64;
/// Statuses and events are made when less than this waits to be sent: who reads slowly gets the newest.
constexpr std::size_t kNewsBacklog = 64U << 10;
constexpr LocalTime kHalfFrame = std::chrono::milliseconds{800};
constexpr LocalTime kHelloWithin = std::chrono::seconds{10};

/// Takes as long for a wrong token as for the right one.
bool same_secret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace

JobLinkSession::JobLinkSession(JobLinkServer& server, std::uint64_t id, SessionInfo info, LocalTime now)
    : server_(server), id_(id), info_(std::move(info)), last_heard_(now), now_(now) {
  server_.sessions_[id_] = this;
}

JobLinkSession::~JobLinkSession() {
  leave(now_);
  server_.sessions_.erase(id_);
}

void JobLinkSession::leave(LocalTime now) {
  if (upload_ != 0)
    server_.worker_.post([&store = server_.store_, upload = upload_] { store.abort(upload, false); }, [] {});
  upload_ = 0;
  if (client_ == 0) return;
  if (server_.control_.holder() == client_) server_.vanished_key_ = resume_key_;
  server_.control_.detach(client_);
  client_ = 0;
  next_status_ = LocalTime::max();
  watches_events_ = false;
  now_ = now;
}

void JobLinkSession::on_closed(LocalTime now, std::string_view) {
  leave(now);
  ended_ = true;
}

void JobLinkSession::superseded(LocalTime now) {
  joblink::ServerMessage message;
  message.mutable_session_end()->set_reason("this client has come back on another connection");
  send(message);
  leave(now);
  ended_ = true;
}

bool JobLinkSession::full() const {
  return out_.size() > kMaxBacklog || open_requests_ >= kMaxOpenRequests || owed_bytes_ > 2 * kUploadWindow;
}

bool JobLinkSession::wants_bytes() const {
  return !full() && !ended_;
}

void JobLinkSession::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  now_ = now;
  last_heard_ = now;
  reader_.add(bytes);
  process(now);
}

void JobLinkSession::process(LocalTime now) {
  while (!full() && !ended_) {
    const auto frame = reader_.next();
    if (!frame) return;
    take(now, *frame);
  }
}

void JobLinkSession::take(LocalTime now, const joblink::FrameView& frame) {
  switch (incoming_.take(frame)) {
    case SessionSequence::Verdict::kStale:
      return;
    case SessionSequence::Verdict::kBegins:
      return begin(now, frame);
    case SessionSequence::Verdict::kGap:
      return resynchronise(now, "a message was lost on the way");
    case SessionSequence::Verdict::kNext:
      break;
  }
  if (const auto chunk = joblink::read_chunk(frame.message)) {
    const JobLinkServer::Asker asker{id_, chunk->head.request_id};
    if (greeted(asker)) JobRequests(server_, *this, now).chunk(asker, *chunk);
    return;
  }
  ClientMessage message;
  if (!message.ParseFromArray(frame.message.data(), static_cast<int>(frame.message.size())))
    return resynchronise(now, "a message could not be read");
  request(now, message);
}

void JobLinkSession::begin(LocalTime now, const joblink::FrameView& frame) {
  ClientMessage message;
  if (!message.ParseFromArray(frame.message.data(), static_cast<int>(frame.message.size())) ||
      !message.has_hello())
    return;
  leave(now);
  session_ = frame.session;
  sequence_ = 0;
  incoming_.begin(session_, 1);
  hello(now, message);
}

void JobLinkSession::resynchronise(LocalTime now, const char* why) {
  joblink::ServerMessage message;
  message.mutable_session_end()->set_reason(why);
  message.mutable_session_end()->set_resync(true);
  send(message);
  leave(now);
  // Only a hello counts from here on.
  session_ = 0;
  incoming_.begin(0, 0);
}

void JobLinkSession::hello(LocalTime now, const ClientMessage& message) {
  const joblink::Hello& hello = message.hello();
  joblink::ServerMessage out;
  joblink::Reply& reply = *out.mutable_reply();
  reply.set_request_id(message.request_id());
  if (hello.version_major() != joblink::kVersionMajor) {
    *reply.mutable_error() =
        problem(joblink::ERROR_VERSION, "version",
                say("the gateway and the client speak different versions of the job link"),
                say("version %1", joblink::kVersionMajor));
  } else if (!info_.token.empty() && !same_secret(hello.token(), info_.token)) {
    *reply.mutable_error() = problem(joblink::ERROR_NOT_ALLOWED, "token", say("the token is wrong"),
                                     say("the token that is set on the gateway"));
    ended_ = true;
  } else {
    server_.welcome(now, *this, hello, *reply.mutable_hello());
  }
  send(out);
}

/// Counts the request, which must not be a session's first.
bool JobLinkSession::greeted(const JobLinkServer::Asker& asker) {
  ++open_requests_;
  if (client_ == 0) server_.refuse(asker, problem(joblink::ERROR_NOT_ALLOWED, {}, say("say hello first")));
  return client_ != 0;
}

void JobLinkSession::request(LocalTime now, const ClientMessage& message) {
  const JobLinkServer::Asker asker{id_, message.request_id()};
  if (!greeted(asker)) return;
  if (message.has_watch()) {
    const double hz = message.watch().status_hz();
    status_period_ =
        hz > 0 ? LocalTime{static_cast<std::int64_t>(1e9 / std::clamp(hz, 0.1, 50.0))} : LocalTime{0};
    next_status_ = hz > 0 ? now : LocalTime::max();
    if (message.watch().events() && !watches_events_) told_event_ = server_.events_.newest();
    watches_events_ = message.watch().events();
    return server_.answer(asker, {});
  }
  if (message.has_ping()) return server_.answer(asker, {});
  if (JobRequests(server_, *this, now).take(asker, message)) return;
  if (MachineRequests(server_, *this).take(asker, message)) return;
  server_.refuse(asker,
                 problem(joblink::ERROR_NOT_UNDERSTOOD, {}, say("this gateway does not know the request")));
}

void JobLinkSession::welcomed(ClientId client, std::string resume_key) {
  client_ = client;
  resume_key_ = std::move(resume_key);
}

void JobLinkSession::paid(std::size_t bytes) {
  owed_bytes_ -= bytes;
  process(now_);
}

std::string JobLinkSession::spare_buffer() {
  if (spare_buffers_.empty()) return {};
  std::string buffer = std::move(spare_buffers_.back());
  spare_buffers_.pop_back();
  return buffer;
}

void JobLinkSession::keep_buffer(std::string&& buffer) {
  if (spare_buffers_.size() < kUploadWindow / kMaxChunk) spare_buffers_.push_back(std::move(buffer));
}

void JobLinkSession::send(const joblink::ServerMessage& message) {
  write(message.SerializeAsString());
}

void JobLinkSession::write(std::string_view message) {
  out_.append(session_, sequence_, message);
  sequence_ = SessionSequence::after(sequence_);
}

void JobLinkSession::on_time(LocalTime now) {
  now_ = now;
  if (reader_.pending() > 0 && now >= last_heard_ + kHalfFrame && !full()) reader_.give_up();
  process(now);
  if (client_ != 0 && now >= last_heard_ + server_.options_.silence_limit)
    resynchronise(now, "the client has said nothing for too long");
  if (client_ == 0 && now >= last_heard_ + kHelloWithin && !info_.token.empty()) ended_ = true;
  if (now < next_status_) return;
  next_status_ = std::max(next_status_ + status_period_, now);
  // Who reads slowly gets the newest status later instead of all old ones.
  if (out_.size() < kNewsBacklog) write(server_.status_message(now));
}

LocalTime JobLinkSession::next_deadline() const {
  LocalTime next = next_status_;
  if (client_ != 0)
    next = std::min(next, last_heard_ + server_.options_.silence_limit);
  else if (!info_.token.empty() && !ended_)
    next = std::min(next, last_heard_ + kHelloWithin);
  if (reader_.pending() > 0 && !full()) next = std::min(next, std::max(last_heard_, now_) + kHalfFrame);
  return next;
}

std::span<const std::uint8_t> JobLinkSession::next_bytes() {
  while (watches_events_ && out_.size() < kNewsBacklog) {
    const joblink::Event* event = server_.events_.after(told_event_);
    if (event == nullptr) break;
    told_event_ = event->id();
    joblink::ServerMessage message;
    *message.mutable_event() = *event;
    send(message);
  }
  return out_.bytes();
}

void JobLinkSession::on_bytes_sent(std::size_t count) {
  const bool was_full = full();
  out_.sent(count);
  if (was_full && !full()) process(now_);
}

}  // namespace kinebus
