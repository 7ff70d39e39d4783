#include "gateway/sessions/http/socket.hpp"

#include <algorithm>
#include <utility>

namespace kinebus::http {
namespace {
/// Carried out in one turn of the loop, so that others have theirs.
constexpr int kMessagesPerTurn = 4;
constexpr std::size_t kEnoughUnread = 64U << 10;
}  // namespace

Socket::Socket(Server& server, LocalTime now, std::string transport, std::string agent)
    : Caller(server, now),
      transport_(std::move(transport)),
      agent_(std::move(agent)),
      since_(now),
      heard_(now),
      moved_(now) {}

Socket::~Socket() {
  forget_asked();
  set_uploads_aside();
}

void Socket::let_in(const Visitor& visitor, std::string_view name) {
  if (visitor.role > role()) become(visitor);
  if (!is_in_) attach(name.empty() ? std::string_view(agent_) : name, transport_);
  is_in_ = true;
}

void Socket::say(std::string_view text) {
  if (!ended_) out_ += frame(Opcode::kText, text);
}

void Socket::end(CloseCode code, std::string_view why) {
  if (ended_) return;
  out_ += close_frame(code, why);
  ended_ = true;
  forget_asked();
  set_uploads_aside();
  detach();
}

void Socket::on_closed(LocalTime now, std::string_view) {
  now_ = now;
  ended_ = true;
  out_.clear();
  sent_ = 0;
  forget_asked();
  set_uploads_aside();
  detach();
}

void Socket::command(const joblink::ClientMessage& message, Then then) {
  ++open_requests_;
  ask(message, [this, takes = message.has_take_control(), gives = message.has_release_control(),
                then = std::move(then)](const joblink::Reply& reply) {
    --open_requests_;
    if (takes && !reply.has_error()) keeps_control = true;
    if (gives) keeps_control = false;
    if (!keeps_control) server().control().release(client());
    then(reply);
  });
}

void Socket::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  now_ = heard_ = now;
  pinged_ = false;
  if (ended_) return;
  in_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  starved_ = false;
  work();
}

bool Socket::wants_bytes() const {
  return !ended_ && !full() && in_.size() - at_ < kEnoughUnread;
}

bool Socket::work_waits() const {
  return !starved_ && !ended_ && !full();
}

void Socket::work() {
  for (int messages = 0; messages < kMessagesPerTurn && work_waits();) {
    const FrameReader::Taken taken = reader_.take(std::string_view(in_).substr(at_));
    at_ += taken.count;
    switch (taken.step) {
      case FrameReader::Step::kMore:
        starved_ = at_ == in_.size();
        break;
      case FrameReader::Step::kText:
        messages = kMessagesPerTurn;  // what it asks for may take the turn's time
        dialect_->on_text(reader_.payload());
        break;
      case FrameReader::Step::kPing:
        ++messages;
        out_ += frame(Opcode::kPong, reader_.payload());
        break;
      case FrameReader::Step::kPong:
        break;
      case FrameReader::Step::kClose:
        end(reader_.code() == CloseCode::kNone ? CloseCode::kNormal : reader_.code(), {});
        break;
      case FrameReader::Step::kBad:
        end(reader_.code(), reader_.why());
        break;
    }
  }
  if (at_ < in_.size() && at_ <= kEnoughUnread) return;
  in_.erase(0, at_);
  at_ = 0;
}

void Socket::on_time(LocalTime now) {
  now_ = now;
  if (ended_) return;
  look(now);
  if (sent_some_ || out_.empty()) moved_ = now;
  sent_some_ = false;
  work();
  if (ended_) return;
  if (!is_in_ && now >= since_ + kLetInWithin)
    return end(CloseCode::kPolicy, "the key was not shown in time");
  if (now >= heard_ + kGoneAfter || now >= moved_ + kStall)
    return on_closed(now, "the client does not hear or answer");
  if (!pinged_ && now >= heard_ + kPingAfter) {
    pinged_ = true;
    out_ += frame(Opcode::kPing, {});
  }
  if (is_in_ && has_room() && now >= dialect_->next_news()) dialect_->on_room(now);
}

void Socket::on_absence(LocalTime now) {
  since_ = heard_ = moved_ = now;
}

LocalTime Socket::next_deadline() const {
  if (ended_) return LocalTime::max();
  if (work_waits()) return LocalTime{0};
  LocalTime next = std::min(next_look(), heard_ + (pinged_ ? kGoneAfter : kPingAfter));
  if (!is_in_) next = std::min(next, since_ + kLetInWithin);
  if (!out_.empty()) next = std::min(next, moved_ + kStall);
  if (is_in_ && has_room()) next = std::min(next, dialect_->next_news());
  return next;
}

std::span<const std::uint8_t> Socket::next_bytes() {
  const std::string_view rest = std::string_view(out_).substr(sent_);
  return {reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()};
}

void Socket::on_bytes_sent(std::size_t count) {
  sent_ += count;
  sent_some_ = sent_some_ || count > 0;
  if (sent_ < out_.size() && sent_ < kNewsBacklog) return;
  out_.erase(0, sent_);
  sent_ = 0;
}

}  // namespace kinebus::http
