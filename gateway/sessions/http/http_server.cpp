#include "gateway/sessions/http/http_server.hpp"

#include <map>
#include <utility>

#include "gateway/sessions/http/http_session.hpp"

namespace kinebus::http {

Server::Server(JobLinkServer& link, JobStore& store, Worker& worker, Control& control, Options options)
    : link_(link), store_(store), worker_(worker), control_(control), options_(std::move(options)) {}

Server::~Server() = default;

Session* Server::find(std::uint64_t session) {
  const auto found = sessions_.find(session);
  return found != sessions_.end() ? found->second : nullptr;
}

std::unique_ptr<ByteSession> Server::open(LocalTime now, std::string transport, std::string peer) {
  const bool room = make_room(now);
  auto session = std::make_unique<Session>(*this, now, std::move(transport), std::move(peer));
  if (!room) session->turn_away();
  return session;
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
  if (event.kind == MachineEvent::Kind::kState && event.state == MachineState::kChecking) ++job_id_;
}

}  // namespace kinebus::http
