#include "gateway/sessions/http/http_server.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "gateway/sessions/http/http_session.hpp"
#include "gateway/sessions/http/kinebus/message_json.hpp"
#include "gateway/sessions/http/moonraker/moonraker.hpp"
#include "gateway/sessions/http/wire/websocket.hpp"

namespace kinebus::http {
namespace {
constexpr LocalTime kStatusShared = std::chrono::milliseconds{20};
constexpr LocalTime kNotePeriod = std::chrono::seconds{1};

/// What libraries do once, with the first message of JSON and the first websocket: 15 million instructions,
/// which a machine that runs would have to wait for.
void warm_up() {
  joblink::ClientMessage message;
  static_cast<void>(from_json("{}", message));
  static_cast<void>(to_json(joblink::Status()));
  static_cast<void>(accept_of("AAAAAAAAAAAAAAAAAAAAAA=="));
}
}  // namespace

Server::Server(JobLinkServer& link, JobStore& store, Worker& worker, Control& control, Options options)
    : link_(link),
      store_(store),
      worker_(worker),
      control_(control),
      options_(std::move(options)),
      database_(options_.database),
      noter_(std::make_unique<Caller>(*this, LocalTime{0})) {
  noter_->become({.role = Role::kWatch});
  warm_up();
}

Server::~Server() = default;

void Server::on_time(LocalTime now) {
  if (now < next_note_) return;
  // However late: no second is noted twice to catch up.
  next_note_ += kNotePeriod;
  if (next_note_ <= now) next_note_ = now + kNotePeriod;
  note_temperatures(*noter_, temperatures_);
}

double Server::unix_s(LocalTime now) const {
  return link_.options().unix_s_at_zero + to_seconds(now);
}

void Server::note_line(LocalTime now, bool is_command, std::string_view text) {
  console_.add(is_command, unix_s(now), text);
}

bool Server::make_room_for_socket(LocalTime now) {
  std::size_t sockets = 0;
  Session* oldest = nullptr;  // of those that have not shown the key
  for (const auto& [id, session] : sessions_) {
    if (!session->is_socket() || session->ended()) continue;
    ++sockets;
    if (session->idle() && (oldest == nullptr || id < oldest->id())) oldest = session;
  }
  if (sockets < options_.max_sockets) return true;
  if (oldest == nullptr) return false;
  oldest->on_closed(now, "others wait for this place");
  return true;
}

const std::string& Server::status_json() {
  const joblink::Status& status = link_.status();
  if (status_made_ == link_.statuses_made()) return status_json_;
  status_made_ = link_.statuses_made();
  status_json_.clear();
  append_json(status_json_, status);
  return status_json_;
}

const std::string& Server::recent_status_json(LocalTime now) {
  if (!status_json_.empty() && now < status_until_) return status_json_;
  status_until_ = now + kStatusShared;
  return status_json();
}

std::unique_ptr<ByteSession> Server::open(LocalTime now, std::string transport, std::string peer,
                                          std::string_view address) {
  const bool room = make_room(now);
  auto session = std::make_unique<Session>(*this, now, std::move(transport), std::move(peer), address);
  if (!room) session->turn_away();
  return session;
}

std::size_t Server::take_users(LocalTime now, Users users) {
  const Users before = std::exchange(options_.users, std::move(users));
  const auto stays = [&](const Visitor& visitor, std::string_view address) {
    return before.same_by(options_.users, visitor, address);
  };
  logins_.keep_if([&](const Login& login) { return stays(login.visitor, login.address); });
  std::size_t put_out = 0;
  // One that is put out stays in its place until the loop takes it away.
  for (const auto& [id, session] : sessions_)
    if (!session->ended() && !stays(session->present(), session->address())) {
      session->put_out(now);
      ++put_out;
    }
  return put_out;
}

/// When all places are taken, the oldest connection that waits for nothing goes, of the peer that has most.
bool Server::make_room(LocalTime now) {
  std::size_t open = 0;
  std::map<std::string, std::pair<std::size_t, Session*>> peers;  // how many, and the oldest
  for (const auto& [id, session] : sessions_) {
    if (session->ended()) continue;
    ++open;
    if (!session->idle()) continue;
    auto& [count, oldest] = peers[session->peer()];
    ++count;
    if (oldest == nullptr || session->id() < oldest->id()) oldest = session;
  }
  if (open < options_.max_sessions) return true;
  if (peers.empty()) return false;
  std::pair<std::size_t, Session*> greediest{0, nullptr};
  for (const auto& [peer, of_peer] : peers)
    if (of_peer.first > greediest.first) greediest = of_peer;
  greediest.second->on_closed(now, "others wait for this place");
  return true;
}

void Server::on_event(const MachineEvent& event) {
  if (event.kind != MachineEvent::Kind::kState) return;
  switch (event.state) {
    case MachineState::kChecking:
      ++job_id_;
      in_job_ = true;
      ran_ = cancelled_ = false;
      break;
    case MachineState::kRunning:
      ran_ = true;
      break;
    case MachineState::kCancelling:
      cancelled_ = true;
      break;
    case MachineState::kReady:
      if (in_job_) job_end_ = cancelled_ ? "cancelled" : ran_ ? "complete" : "error";
      in_job_ = false;
      break;
    case MachineState::kStopped:
    case MachineState::kAlarm:
      if (in_job_) job_end_ = "error";
      in_job_ = false;
      break;
    default:
      break;
  }
}

}  // namespace kinebus::http
