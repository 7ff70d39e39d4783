#pragma once
// The HTTP server with a simulated machine behind it and connections before it, in memory and virtual time.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "gateway/sessions/http/http_server.hpp"
#include "gateway/sessions/http/http_session.hpp"
#include "gateway/sessions/tests/link_rig.hpp"

namespace kinebus::http {

inline constexpr const char* kKey = "0123456789abcdef";

struct Response {
  int status = 0;  ///< 0: none came
  std::string head, body;
  nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
};

/// A client: what it sends, and what it has heard.
struct Connection {
  std::unique_ptr<ByteSession> session;
  std::string to_send, heard;

  /// The first response that was heard, whole, is taken out.
  Response take() {
    Response response;
    const std::size_t end = heard.find("\r\n\r\n");
    if (end == std::string::npos) return response;
    response.head = heard.substr(0, end);
    std::size_t length = 0;
    if (const std::size_t at = response.head.find("Content-Length: "); at != std::string::npos)
      length = std::stoul(response.head.substr(at + 16));
    if (heard.size() < end + 4 + length) return response;
    response.status = std::stoi(heard.substr(9, 3));
    response.body = heard.substr(end + 4, length);
    heard.erase(0, end + 4 + length);
    return response;
  }
};

class HttpRig {
 public:
  explicit HttpRig(JobStore::Options options = {}, std::size_t max_sessions = 32, Users users = Users(kKey),
                   MachineDescription machine = default_m1(), Pages pages = {})
      : link(std::move(options), {}, std::move(machine)),
        server(*link.server, *link.store, link.worker, link.control,
               {.users = std::move(users),
                .names = {"kinebus"},
                .max_sessions = max_sessions,
                .pages = std::move(pages)}) {}
  ~HttpRig() {
    connections.clear();
    link.worker.run();
  }

  Connection& connect(const std::string& peer = "tcp 10.0.0.7") {
    connections.push_back(std::make_unique<Connection>());
    connections.back()->session = server.open(link.machine.now, "http 10.0.0.7", peer, address);
    return *connections.back();
  }
  /// The other side is gone.
  void cut(Connection& connection) {
    if (connection.session) connection.session->on_closed(link.machine.now, "cut");
    connection.session.reset();
    pump();
  }

  /// Moves bytes, `piece` at a time, until nothing stirs any more.
  void pump(std::size_t piece = 4000) {
    for (bool stirred = true; stirred;) {
      stirred = false;
      for (const auto& connection : connections) stirred = serve(*connection, piece) || stirred;
      stirred = link.worker.run_one() || stirred;
      for (; told < link.machine.events.size(); ++told) server.on_event(link.machine.events[told]);
      if (link.machine.now >= server.next_deadline()) server.on_time(link.machine.now);
      link.pump();
    }
  }
  bool run_until(const std::function<bool()>& done, BusTime limit) {
    const BusTime until = link.machine.now + limit;
    while (!done()) {
      if (link.machine.now >= until) return false;
      link.machine.run_for(std::chrono::milliseconds{20});
      pump();
    }
    return true;
  }

  /// Sends `request` on `connection` and gives the response. A request that waits for the machine gets its
  /// time.
  Response ask(Connection& connection, const std::string& request, std::size_t piece = 4000) {
    connection.to_send += request;
    pump(piece);
    Response response = connection.take();
    run_until(
        [&] {
          if (response.status == 0 || response.status == 100) response = connection.take();
          return response.status != 0;
        },
        std::chrono::seconds{20});
    return response;
  }
  Response ask(const std::string& request, std::size_t piece = 4000) {
    Connection& connection = connect();
    Response response = ask(connection, request, piece);
    cut(connection);
    return response;
  }
  Response get(const std::string& path) { return ask(head("GET", path) + "\r\n"); }
  Response send(const std::string& method, const std::string& path, const std::string& json) {
    return ask(head(method, path) + "Content-Type: application/json\r\n" + with_body(json));
  }

  static std::string head(const std::string& method, const std::string& path) {
    return method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1:5000\r\nX-Api-Key: " + kKey + "\r\n";
  }
  static std::string with_body(const std::string& body) {
    return "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }

  std::string stored(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(link.folder.path() / "jobs" / name, std::ios::binary).rdbuf();
    return std::move(text).str();
  }
  /// Files of uploads that are not whole.
  int half_uploads() const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(link.folder.path() / "jobs"))
      count += entry.path().filename().string().starts_with(".upload") ? 1 : 0;
    return count;
  }

  LinkRig link;
  Server server;
  std::vector<std::unique_ptr<Connection>> connections;
  std::string address;  ///< where new connections come from; empty: not known
  std::size_t told = 0;

 private:
  bool serve(Connection& connection, std::size_t piece) {
    ByteSession* session = connection.session.get();
    if (session == nullptr) return false;
    bool stirred = false;
    if (!connection.to_send.empty() && session->wants_bytes()) {
      const std::string now = connection.to_send.substr(0, piece);
      connection.to_send.erase(0, now.size());
      session->on_bytes(link.machine.now, {reinterpret_cast<const std::uint8_t*>(now.data()), now.size()});
      stirred = true;
    }
    if (link.machine.now >= session->next_deadline()) {
      session->on_time(link.machine.now);
      stirred = session->next_deadline() <= LocalTime{0};
    }
    if (const auto bytes = session->next_bytes(); !bytes.empty()) {
      connection.heard.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      session->on_bytes_sent(bytes.size());
      stirred = true;
    }
    return stirred;
  }
};

}  // namespace kinebus::http
