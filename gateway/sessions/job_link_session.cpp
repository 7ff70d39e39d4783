#include "gateway/sessions/job_link_session.hpp"

#include <openssl/crypto.h>

#include <algorithm>
#include <utility>

#include "gateway/sessions/job_requests.hpp"
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

/// Carried out in one turn of the loop, so that others have theirs.
constexpr int kFramesPerTurn = 4;
constexpr std::size_t kEnoughUnread = 64U << 10;
/// A stop as it is written: at most a number of six bytes, then field 44, empty.
constexpr std::string_view kStopEnd("\xE2\x02\x00", 3);
constexpr std::size_t kStopBytes = 9;
/// What may come before a client has been let in: a hello.
constexpr std::size_t kMaxHello = 4096;

/// Takes as long for a wrong token as for the right one.
bool same_secret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace

JobLinkSession::JobLinkSession(JobLinkServer& server, std::uint64_t id, SessionInfo info, LocalTime now)
    : Requester(server.store_, server.worker_),
      server_(server),
      id_(id),
      info_(std::move(info)),
      last_heard_(now),
      now_(now),
      since_(now) {
  reader_.limit(kMaxHello);
  server_.sessions_[id_] = this;
  server_.requesters_[id_] = this;
}

JobLinkSession::~JobLinkSession() {
  leave(now_);
  server_.sessions_.erase(id_);
  server_.requesters_.erase(id_);
}

void JobLinkSession::leave(LocalTime now) {
  set_uploads_aside();
  if (client_ == 0) return;
  if (server_.control_.holder() == client_) server_.vanished_key_ = resume_key_;
  server_.control_.detach(client_);
  client_ = 0;
  visitor_ = false;
  since_ = now;
  next_status_ = LocalTime::max();
  watches_events_ = false;
  now_ = now;
}

void JobLinkSession::on_closed(LocalTime now, std::string_view) {
  leave(now);
  ended_ = true;
}

void JobLinkSession::end(LocalTime now, const char* why) {
  if (client_ != 0) {
    joblink::ServerMessage message;
    message.mutable_session_end()->set_reason(why);
    send(message);
  }
  leave(now);
  ended_ = true;
}

bool JobLinkSession::full() const {
  return out_.size() > kMaxBacklog || open_requests_ >= kMaxOpenRequests || owed_bytes() > 2 * kUploadWindow;
}

bool JobLinkSession::wants_bytes() const {
  // What is here is worked off before more is read.
  return !full() && !ended_ && !(unread_ && reader_.pending() > kEnoughUnread);
}

ByteSession::Rank JobLinkSession::rank() const {
  if (client_ == 0 || ended_ || info_.token.empty()) return Rank::kAny;
  return server_.control_.holder() == client_ ? Rank::kInControl : Rank::kMayStop;
}

void JobLinkSession::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  now_ = now;
  last_heard_ = now;
  reader_.add(bytes);
  unread_ = true;
  see_stop();
}

/// A stop does not wait behind what came before it. It is answered in its turn, and does no harm twice.
void JobLinkSession::see_stop() {
  if (client_ == 0) return;
  reader_.look_ahead([&](const joblink::FrameView& frame) {
    const std::string_view text(reinterpret_cast<const char*>(frame.message.data()), frame.message.size());
    if (frame.session != session_ || text.size() > kStopBytes || !text.ends_with(kStopEnd)) return;
    ClientMessage message;
    if (message.ParseFromArray(text.data(), static_cast<int>(text.size())) && message.has_stop())
      static_cast<void>(server_.gateway_.carry_out(command::Stop{}));
  });
}

void JobLinkSession::work(LocalTime now) {
  for (int i = 0; i < kFramesPerTurn && work_waits(); ++i) {
    const auto frame = reader_.next();
    unread_ = frame.has_value();
    if (frame) take(now, *frame);
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
    if (!greeted(asker)) return;
    if (visitor_) return refuse_visitor(asker);
    return JobRequests(server_, *this, now).chunk(asker, *chunk);
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

void JobLinkSession::refuse_visitor(const JobLinkServer::Asker& asker) {
  server_.refuse(
      asker,
      problem(joblink::ERROR_BUSY, {},
              say("all places for clients are taken: only stop and questions about the state are answered")));
}

void JobLinkSession::request(LocalTime now, const ClientMessage& message) {
  const JobLinkServer::Asker asker{id_, message.request_id()};
  if (!greeted(asker)) return;
  const bool for_visitors =
      message.has_stop() || message.has_get_status() || message.has_watch() || message.has_ping();
  if (visitor_ && !for_visitors) return refuse_visitor(asker);
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
  server_.request(now, *this, asker, message);
}

void JobLinkSession::welcomed(LocalTime now, ClientId client, std::string resume_key, bool visitor) {
  client_ = client;
  visitor_ = visitor;
  awaited_ = !visitor && !info_.remote;
  since_ = now;
  resume_key_ = std::move(resume_key);
  reader_.limit(joblink::kMaxMessageBytes);
}

void JobLinkSession::take_reply(joblink::Reply reply) {
  --open_requests_;
  joblink::ServerMessage message;
  *message.mutable_reply() = std::move(reply);
  send(message);
}

void JobLinkSession::send(const joblink::ServerMessage& message) {
  if (write(message.SerializeAsString()) || !message.has_reply()) return;
  // Lists are bounded where they are made. What still does not fit is an answer all the same.
  joblink::ServerMessage instead;
  instead.mutable_reply()->set_request_id(message.reply().request_id());
  *instead.mutable_reply()->mutable_error() =
      problem(joblink::ERROR_BAD_VALUE, {}, say("the answer is longer than one message may be"));
  write(instead.SerializeAsString());
}

/// False: no frame can carry it; nothing is written.
bool JobLinkSession::write(std::string_view message) {
  if (!out_.append(session_, sequence_, message)) return false;
  sequence_ = SessionSequence::after(sequence_);
  return true;
}

void JobLinkSession::on_time(LocalTime now) {
  now_ = now;
  if (reader_.pending() > 0 && !unread_ && now >= last_heard_ + kHalfFrame && !full()) {
    reader_.give_up();
    unread_ = true;
  }
  work(now);
  if (client_ != 0 && now >= last_heard_ + server_.options_.silence_limit)
    resynchronise(now, "the client has said nothing for too long");
  if (leaves_soon() && now >= since_ + server_.options_.hello_within)
    end(now, "the visit is over: all places for clients were taken");
  if (now < next_status_) return;
  next_status_ = std::max(next_status_ + status_period_, now);
  // Who reads slowly gets the newest status later instead of all old ones.
  if (out_.size() < kNewsBacklog) write(server_.status_message());
}

LocalTime JobLinkSession::next_deadline() const {
  if (work_waits()) return LocalTime{0};
  LocalTime next = next_status_;
  if (client_ != 0) next = std::min(next, last_heard_ + server_.options_.silence_limit);
  if (leaves_soon()) next = std::min(next, since_ + server_.options_.hello_within);
  if (reader_.pending() > 0 && !full()) next = std::min(next, std::max(last_heard_, now_) + kHalfFrame);
  return next;
}

void JobLinkSession::on_absence(LocalTime now) {
  last_heard_ = since_ = now;
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
  out_.sent(count);
}

}  // namespace kinebus
