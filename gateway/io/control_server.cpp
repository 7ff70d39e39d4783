#include "gateway/io/control_server.hpp"

#include <grp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "gateway/io/control_commands.hpp"
#include "gateway/io/control_text.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {
namespace {
using nlohmann::json;
constexpr std::size_t kMaxLine = 65'536;
// A watcher that does not read is cut off rather than kept in memory without bound.
constexpr std::size_t kMaxBacklog = 4'194'304;
}  // namespace

struct ControlServer::Client {
  int fd = -1;
  std::string in, out;
  std::optional<JobUpload> upload;
  json upload_reply;
  LocalTime status_period{0}, next_status{0};
  bool watches = false, dead = false;

  void say(const json& message) {
    // Text from a job may hold bytes that are no UTF-8: they are shown replaced, never thrown over.
    out += message.dump(-1, ' ', false, json::error_handler_t::replace);
    out += '\n';
    if (out.size() > kMaxBacklog) dead = true;
  }
};

ControlServer::ControlServer(EventLoop& loop, Gateway& gateway, JobFolder& jobs, Options options)
    : loop_(loop), gateway_(gateway), jobs_(jobs), options_(std::move(options)) {}

ControlServer::~ControlServer() {
  while (!clients_.empty()) close_client(clients_.begin()->first);
  if (listener_ >= 0) {
    loop_.forget(listener_);
    ::close(listener_);
    ::unlink(options_.path.c_str());
  }
}

std::string ControlServer::listen() {
  const auto because = [&](const std::string& what) {
    return options_.path + ": " + what + ": " + std::strerror(errno);
  };
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (options_.path.size() >= sizeof address.sun_path)
    return options_.path + ": longer than a socket's name may be";
  std::memcpy(address.sun_path, options_.path.c_str(), options_.path.size());
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);

  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool taken = ::connect(probe, generic, sizeof address) == 0;
  ::close(probe);
  if (taken) return options_.path + ": another daemon listens here already";
  ::unlink(options_.path.c_str());

  listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const mode_t old = ::umask(0177);
  const bool bound = ::bind(listener_, generic, sizeof address) == 0;
  ::umask(old);
  if (!bound) return because("cannot listen");
  if (!options_.group.empty()) {
    const group* entry = ::getgrnam(options_.group.c_str());
    if (entry == nullptr) return "no group \"" + options_.group + "\" on this system";
    if (::chown(options_.path.c_str(), static_cast<uid_t>(-1), entry->gr_gid) != 0 ||
        ::chmod(options_.path.c_str(), 0660) != 0)
      return because("cannot give it to the group " + options_.group);
  }
  if (::listen(listener_, 8) != 0) return because("cannot listen");
  loop_.watch(listener_, EPOLLIN, [this](std::uint32_t) { accept_client(); });
  return {};
}

void ControlServer::accept_client() {
  const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) return;
  if (static_cast<int>(clients_.size()) >= options_.max_clients) {
    ::close(fd);
    return;
  }
  auto client = std::make_unique<Client>();
  client->fd = fd;
  clients_[fd] = std::move(client);
  loop_.watch(fd, EPOLLIN, [this, fd](std::uint32_t events) {
    if (const auto found = clients_.find(fd); found != clients_.end()) serve(*found->second, events);
  });
}

void ControlServer::close_client(int fd) {
  loop_.forget(fd);
  ::close(fd);
  clients_.erase(fd);
}

namespace {

/// Sends what the socket takes now. False: the other side is gone.
bool send_pending(int fd, std::string& out) {
  while (!out.empty()) {
    const ssize_t count = ::send(fd, out.data(), out.size(), MSG_NOSIGNAL);
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    out.erase(0, static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

/// Moves bytes of the running upload to the disk. False: all that is here is taken, more has to come.
bool ControlServer::take_upload(Client& client) {
  const std::size_t take = std::min<std::uint64_t>(client.in.size(), client.upload->missing());
  std::string error = client.upload->write(std::string_view(client.in).substr(0, take));
  client.in.erase(0, take);
  if (error.empty() && client.upload->missing() > 0) return false;
  if (error.empty()) error = client.upload->finish();
  client.upload_reply["ok"] = error.empty();
  if (!error.empty()) client.upload_reply["error"] = error;
  client.say(client.upload_reply);
  // After a failed write the rest of the bytes cannot be told from commands.
  client.dead = !error.empty();
  client.upload.reset();
  return true;
}

/// Answers one line. False: no whole line is here.
bool ControlServer::take_line(Client& client) {
  const std::size_t end = client.in.find('\n');
  if (end == std::string::npos) {
    client.dead = client.in.size() > kMaxLine;
    return false;
  }
  const json request = json::parse(client.in.substr(0, end), nullptr, false);
  client.in.erase(0, end + 1);
  if (!request.is_object()) {
    client.say({{"ok", false}, {"error", "expected one JSON object a line, such as {\"do\": \"status\"}"}});
    return true;
  }
  json answer;
  if (request.value("do", json()) == "upload")
    answer = begin_upload(client, request);
  else if (request.value("do", json()) == "watch")
    answer = begin_watch(client, request);
  else
    answer = carry_out(request, gateway_, jobs_);
  if (answer.is_null()) return true;
  if (request.contains("id")) answer["id"] = request["id"];
  client.say(answer);
  return true;
}

json ControlServer::begin_upload(Client& client, const json& request) {
  if (!request.value("name", json()).is_string() || !request.value("bytes", json()).is_number_unsigned())
    return {{"ok", false}, {"error", "upload: expected \"name\" and \"bytes\", then as many bytes"}};
  auto upload =
      JobUpload::begin(jobs_, request["name"].get<std::string>(), request["bytes"].get<std::uint64_t>());
  if (!upload) return {{"ok", false}, {"error", upload.error()}};
  client.upload.emplace(std::move(*upload));
  client.upload_reply = {{"id", request.value("id", json())}};
  return nullptr;
}

json ControlServer::begin_watch(Client& client, const json& request) {
  const json rate = request.value("hz", json(10));
  if (!rate.is_number()) return {{"ok", false}, {"error", "watch: expected \"hz\" to be a number"}};
  client.watches = true;
  client.status_period =
      LocalTime{static_cast<std::int64_t>(1e9 / std::clamp(rate.get<double>(), 0.1, 50.0))};
  client.next_status = LocalTime{0};
  return {{"ok", true}};
}

void ControlServer::serve(Client& client, std::uint32_t events) {
  if ((events & (EPOLLIN | EPOLLHUP | EPOLLERR)) != 0) {
    std::array<char, 65'536> buffer;
    const ssize_t count = ::recv(client.fd, buffer.data(), buffer.size(), 0);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) return close_client(client.fd);
    if (count > 0) client.in.append(buffer.data(), static_cast<std::size_t>(count));
  }

  while (!client.dead && (client.upload ? take_upload(client) : take_line(client))) continue;

  if (!send_pending(client.fd, client.out) || client.dead) return close_client(client.fd);
  loop_.change(client.fd, client.out.empty() ? EPOLLIN : EPOLLIN | EPOLLOUT);
}

void ControlServer::on_event(const MachineEvent& event) {
  const json message{{"event", to_json(event)}};
  std::vector<int> watchers;
  for (const auto& [fd, client] : clients_)
    if (client->watches) watchers.push_back(fd);
  for (const int fd : watchers) {
    clients_[fd]->say(message);
    serve(*clients_[fd], 0);
  }
}

void ControlServer::on_time(LocalTime now) {
  json message;
  std::vector<int> due;
  for (const auto& [fd, client] : clients_)
    if (client->watches && now >= client->next_status) due.push_back(fd);
  if (!due.empty()) message = {{"status", to_json(gateway_.status())}};
  for (const int fd : due) {
    Client& client = *clients_[fd];
    client.next_status = now + client.status_period;
    // Who reads slowly gets the newest status later instead of all old ones.
    if (client.out.empty()) client.say(message);
    serve(client, 0);
  }
}

LocalTime ControlServer::next_deadline() const {
  LocalTime next = LocalTime::max();
  for (const auto& [fd, client] : clients_)
    if (client->watches) next = std::min(next, client->next_status);
  return next;
}

}  // namespace kinebus
