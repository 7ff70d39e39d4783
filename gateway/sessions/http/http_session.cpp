#include "gateway/sessions/http/http_session.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/gate.hpp"
#include "gateway/sessions/http/routes.hpp"
#include "protocol/joblink/upload_chunk.hpp"

namespace kinebus::http {
namespace {

/// Waits unread at most; more is not read from the stream.
constexpr std::size_t kMaxUnread = 64U << 10;
/// Of a body in one turn of the loop.
constexpr std::size_t kBytesPerTurn = 64U << 10;
constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

}  // namespace

Session::Session(Server& server, LocalTime now, std::string transport, std::string peer,
                 std::string_view address)
    : Caller(server, now),
      transport_(std::move(transport)),
      peer_(std::move(peer)),
      address_(address),
      since_(now),
      moved_(now) {
  server_.sessions_[id()] = this;
}

Session::~Session() {
  end_exchange();
  server_.sessions_.erase(id());
}

void Session::on_closed(LocalTime now, std::string_view why) {
  now_ = now;
  if (socket_) return socket_->on_closed(now, why);
  ended_ = true;
  out_.clear();
  sent_ = 0;
  end_exchange();
}

Visitor Session::present() const {
  if (socket_) return socket_->visitor();
  return task_ != nullptr ? visitor() : Visitor();
}

void Session::put_out(LocalTime now) {
  if (socket_) return socket_->end(CloseCode::kPolicy, "who this is may not ask for the same any more");
  on_closed(now, "its user has changed");
}

void Session::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  now_ = moved_ = now;
  if (socket_) return socket_->on_bytes(now, bytes);
  if (lingers_ || ended_) return;
  // A head counts from its first byte.
  if (task_ == nullptr && in_.size() == at_) since_ = now;
  in_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  starved_ = false;
  work();
}

bool Session::wants_bytes() const {
  if (socket_) return socket_->wants_bytes();
  if (ended_) return false;
  if (lingers_) return true;
  return in_.size() - at_ < kMaxUnread && (task_ == nullptr || (!whole_ && task_->takes_body()));
}

bool Session::work_waits() const {
  return !socket_ && !starved_ && !ended_ && !lingers_ && !answered_ &&
         (task_ == nullptr || (!whole_ && task_->takes_body()));
}

void Session::work() {
  done_task_.reset();
  std::size_t budget = kBytesPerTurn;
  while (work_waits() && budget > 0) {
    const std::string_view given = input().substr(0, budget);
    const Reader::Taken taken = reader_.take(given);
    starved_ = taken.step == Reader::Step::kMore && given.size() == input().size();
    at_ += taken.count;
    budget -= taken.count;
    if (taken.step == Reader::Step::kMore) break;
    if (taken.step == Reader::Step::kBad) {
      refuse(reader_.bad_status(), reader_.bad_why());
    } else if (taken.step == Reader::Step::kHead) {
      begin_request();
      if (whole_ && task_ != nullptr && !answered_) task_->on_end();
    } else if (taken.step == Reader::Step::kBody) {
      task_->on_body(reader_.body());
    } else {
      whole_ = true;
      task_->on_end();
    }
  }
  if (socket_) {
    // What the client has sent without waiting for the answer.
    const std::string_view rest = input();
    socket_->on_bytes(now_, {reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()});
    at_ = in_.size();
  }
  if (at_ == in_.size() || at_ > kMaxUnread) {
    in_.erase(0, at_);
    at_ = 0;
  }
}

void Session::begin_request() {
  no_body_ = head().method == "HEAD";
  keep_alive_ = head().keep_alive;
  whole_ = !head().has_body();
  if (const auto no = refusal_at_gate(head(), server_.options().names)) return refuse(no->status, no->why);
  auto target = parse_target(head().target);
  if (!target) return refuse(400, "the target is no path of this server");
  target_ = std::move(*target);
  const Found found = find_route(no_body_ ? "GET" : head().method, target_.path);
  recognise();
  if ((found.route == nullptr || !found.route->open) && role() == Role::kNobody) return refuse_stranger();
  if (found.allowed.empty()) return refuse(404, "there is nothing under this path");
  if (found.route == nullptr) {
    const nlohmann::json body{{"error", "this path does not take the method " + head().method}};
    return answer({.status = 405, .body = body.dump(), .fields = {{"Allow", found.allowed}}});
  }
  if (found.route->speak != nullptr) return become_socket(*found.route);
  if ((head().method != "GET" && !no_body_) || found.route->commands) attach(agent(), transport_);
  task_ = make_task(*found.route, *this);
  task_->begin();
  if (task_ != nullptr && !answered_ && !task_->holds_body()) let_body_come();
}

/// By what the request shows, or by where it comes from.
void Session::recognise() {
  Digest::Verdict verdict{.user = server_.users().by_key(shown_key(head()))};
  if (verdict.user == nullptr) verdict = server_.digest().look(head(), server_.users(), now_);
  shown_ = verdict.shown;
  // A link on another server's page commands nothing, wherever its reader sits.
  const bool page_is_open = head().method == "GET" && may_be_of_other_page(head());
  const Role of_network = server_.users().role_at(address_);
  const Role here = page_is_open ? std::min(of_network, Role::kWatch) : of_network;
  const bool by_network = verdict.user == nullptr || verdict.user->visitor.role < here;
  become(by_network ? Visitor{.role = here} : verdict.user->visitor);
}

bool Session::of_prusalink() const {
  return shown_key(head()).empty();
}

/// "PrusaSlicer/2.9.4" of what a client calls itself.
std::string_view Session::agent() const {
  const std::string_view words = head().field("User-Agent");
  return words.substr(0, words.find(' '));
}

void Session::become_socket(const Route& route) {
  if (!same_word(head().field("Upgrade"), "websocket") || head().field("Sec-WebSocket-Version") != "13")
    return answer({.status = 426,
                   .body = R"({"error":"under this path is a websocket of version 13"})",
                   .fields = {{"Upgrade", "websocket"}, {"Sec-WebSocket-Version", "13"}}});
  const std::string accepted = accept_of(head().field("Sec-WebSocket-Key"));
  if (accepted.empty()) return refuse(400, "Sec-WebSocket-Key is 16 bytes in base64");
  if (!server_.make_room_for_socket(now_)) return refuse(503, "all places for websockets are taken");
  out_ += "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n";
  out_ += "Sec-WebSocket-Accept: " + accepted + "\r\n\r\n";
  auto socket = std::make_unique<Socket>(server_, now_, transport_, std::string(agent()));
  socket->speak(route.speak(*socket));
  if (role() != Role::kNobody) socket->let_in(visitor(), {});
  socket_ = std::move(socket);
}

void Session::let_body_come() {
  if (head().has_body() && !head().field("Expect").empty()) out_ += kContinue;
}

void Session::begin_open_ended(const std::string& name, std::uint64_t expected_bytes, bool replace,
                               Then then) {
  if (is_refused(Role::kOperate, then)) return;
  JobRequests(server_.link(), *this, now_)
      .begin_open_ended({id(), expect(std::move(then))}, name, expected_bytes, replace);
}

void Session::send_chunk(std::uint32_t upload, std::uint64_t offset_bytes, std::string_view data, Then then) {
  const std::uint32_t request = expect(std::move(then));
  JobRequests(server_.link(), *this, now_)
      .chunk(
          {id(), request},
          {.head = {.request_id = request, .upload_id = upload, .offset_bytes = offset_bytes}, .data = data});
}

void Session::finish() {
  answered_ = true;
  end_exchange();
  lingers_ = !whole_;
  if (!lingers_) return;
  in_.clear();
  at_ = 0;
}

/// Of the request that is answered, or never will be. The task may be the caller.
void Session::end_exchange() {
  forget_asked();
  set_uploads_aside();
  detach();
  if (task_ != nullptr) done_task_ = std::move(task_);
}

/// The answer is on its way: the next request may be there already.
void Session::next_request() {
  reader_.next();
  whole_ = answered_ = starved_ = no_body_ = false;
  target_ = {};
  since_ = now_;
}

void Session::on_time(LocalTime now) {
  now_ = now;
  if (socket_) return socket_->on_time(now);
  if (ended_) return;
  look(now);
  if (sent_some_) moved_ = now;
  sent_some_ = false;
  if (answered_ && whole_ && out_.empty()) next_request();
  work();
  done_task_.reset();
  if (lingers_) {
    if (linger_until_ == LocalTime::max()) linger_until_ = now + kLinger;
    ended_ = now >= linger_until_;
  } else if (!out_.empty() && now >= moved_ + kStall) {
    on_closed(now, "the client does not take its answer");
  } else if (task_ != nullptr) {
    if (!whole_ && !answered_ && task_->takes_body() && now >= moved_ + kStall)
      refuse(408, "the rest of the request did not come");
  } else if (!reader_.idle() || in_.size() > at_) {
    if (!answered_ && now >= since_ + kHeadWithin)
      refuse(408, "the head of the request did not come in time");
  } else if (out_.empty() && now >= since_ + kIdle) {
    on_closed(now, "nothing was asked for");
  }
}

void Session::on_absence(LocalTime now) {
  if (socket_) return socket_->on_absence(now);
  since_ = moved_ = now;
}

LocalTime Session::next_deadline() const {
  if (socket_) return socket_->next_deadline();
  if (ended_) return LocalTime::max();
  if (lingers_) return linger_until_ == LocalTime::max() ? LocalTime{0} : linger_until_;
  if (work_waits() || (answered_ && out_.empty())) return LocalTime{0};
  LocalTime next = next_look();
  if (!out_.empty()) next = std::min(next, moved_ + kStall);
  // As in on_time: a time at which nothing is done would be due again in each turn of the loop.
  if (task_ != nullptr) {
    if (!whole_ && !answered_ && task_->takes_body()) next = std::min(next, moved_ + kStall);
  } else if (!reader_.idle() || in_.size() > at_) {
    if (!answered_) next = std::min(next, since_ + kHeadWithin);
  } else if (out_.empty()) {
    next = std::min(next, since_ + kIdle);
  }
  return next;
}

std::span<const std::uint8_t> Session::next_bytes() {
  if (socket_ && out_.empty()) return socket_->next_bytes();
  if (out_.empty() && task_ != nullptr) task_->on_written();
  const std::string_view rest = std::string_view(out_).substr(sent_);
  return {reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()};
}

void Session::on_bytes_sent(std::size_t count) {
  if (socket_ && out_.empty()) return socket_->on_bytes_sent(count);
  sent_ += count;
  sent_some_ = sent_some_ || count > 0;
  if (sent_ < out_.size()) return;
  out_.clear();
  sent_ = 0;
  ended_ = ended_ || (answered_ && whole_ && !keep_alive_);
}

}  // namespace kinebus::http
