#include "gateway/sessions/http/caller.hpp"

#include <cassert>

#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus::http {
namespace {
constexpr LocalTime kLookPeriod = std::chrono::milliseconds{50};
}  // namespace

Caller::Caller(Server& server, LocalTime now)
    : Requester(server.store(), server.worker()),
      server_(server),
      now_(now),
      id_(server.link().enter(*this)) {}

Caller::~Caller() {
  detach();
  server_.link().leave(id_);
}

void Caller::attach(std::string_view name, const std::string& transport) {
  const std::string client(name.empty() ? std::string_view("HTTP client") : name);
  const std::string words =
      shown(visitor_.name.empty() ? client : visitor_.name + ": " + client, kMaxNameBytes);
  client_ = server_.control().attach(words.empty() ? "HTTP client" : words, transport);
}

void Caller::detach() {
  if (client_ != 0) server_.control().detach(client_);
  client_ = 0;
}

bool Caller::is_refused(Role needed, const Then& then) const {
  if (visitor_.role >= needed) return false;
  joblink::Reply reply;
  *reply.mutable_error() =
      problem(joblink::ERROR_NOT_ALLOWED, {},
              Sentence::verbatim(std::string("this needs the role '") + word_of(needed) +
                                 "', and the key's is '" + word_of(visitor_.role) + "'"));
  then(reply);
  return true;
}

void Caller::ask(const joblink::ClientMessage& message, Then then) {
  if (is_refused(role_for(message), then)) return;
  const JobLinkServer::Asker asker{id_, expect(std::move(then))};
  server_.link().request(now_, *this, asker, message);
}

joblink::Reply Caller::ask_now(const joblink::ClientMessage& message) {
  joblink::Reply got;
  const std::uint32_t before = last_request_;
  ask(message, [&](const joblink::Reply& reply) { got = reply; });
  assert(!expected_.contains(before + 1));
  return got;
}

std::uint32_t Caller::expect(Then then) {
  expected_[++last_request_] = std::move(then);
  return last_request_;
}

void Caller::take_reply(joblink::Reply reply) {
  const auto found = expected_.find(reply.request_id());
  if (found == expected_.end()) return;
  const Then then = std::move(found->second);
  expected_.erase(found);
  then(reply);
}

ByteSession::Rank Caller::rank_of_client() const {
  if (role() == Role::kNobody) return ByteSession::Rank::kAny;
  const bool in_control = client_ != 0 && server_.control().holder() == client_;
  return in_control ? ByteSession::Rank::kInControl : ByteSession::Rank::kMayStop;
}

void Caller::wait_for(std::function<bool(LocalTime)> look) {
  looks_.push_back(std::move(look));
  next_look_ = now_;
}

void Caller::look(LocalTime now) {
  if (looks_.empty() || now < next_look_) return;
  next_look_ = now + kLookPeriod;
  // One that is answered may end all, or begin another.
  auto looks = std::move(looks_);
  looks_.clear();
  const std::weak_ptr<int> awaited = awaited_;
  for (auto& one : looks) {
    if (awaited.expired()) return;
    if (!one(now) && !awaited.expired()) looks_.push_back(std::move(one));
  }
}

void Caller::forget_asked() {
  expected_.clear();
  looks_.clear();
  awaited_ = std::make_shared<int>(0);
}

}  // namespace kinebus::http
