#include "tools/cli/client.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace kinebus {

using nlohmann::json;

std::string Client::find_socket(const std::string& asked) {
  if (!asked.empty()) return asked;
  if (const char* named = std::getenv("KINEBUS_SOCKET")) return named;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const std::string own = runtime != nullptr ? std::string(runtime) + "/kinebus.sock" : "/tmp/kinebus.sock";
  const std::string system = "/run/kinebus/kinebus.sock";
  std::error_code error;
  return std::filesystem::exists(system, error) ? system : own;
}

Client::Client(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    throw ClientError(path + ": longer than a socket's name may be");
  std::memcpy(address.sun_path, path.c_str(), path.size());
  fd_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw ClientError("no daemon answers at " + path + " (" + std::strerror(errno) +
                      "); start one, for example: kinebusd --bus inproc");
}

Client::~Client() {
  if (fd_ >= 0) ::close(fd_);
}

void Client::send_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw ClientError(std::string("the daemon is gone: ") + std::strerror(errno));
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

json Client::next(int timeout_ms) {
  for (;;) {
    if (const std::size_t end = in_.find('\n'); end != std::string::npos) {
      json message = json::parse(in_.substr(0, end), nullptr, false);
      in_.erase(0, end + 1);
      if (message.is_discarded()) throw ClientError("the daemon sent a line that is no JSON");
      return message;
    }
    pollfd waiting{fd_, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, timeout_ms);
    if (ready < 0 && errno == EINTR) return nullptr;
    if (ready == 0) return nullptr;
    std::array<char, 65536> buffer;
    const ssize_t count = ::recv(fd_, buffer.data(), buffer.size(), 0);
    if (count <= 0) throw ClientError("the daemon closed the connection");
    in_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

json Client::reply_to(std::uint64_t id) {
  for (;;) {
    json message = next(30'000);
    if (message.is_null()) throw ClientError("the daemon does not answer");
    if (message.value("id", std::uint64_t{0}) == id) return message;
    if (on_news) on_news(message);
  }
}

json Client::ask(json request) {
  request["id"] = ++last_id_;
  send_all(request.dump() + "\n");
  return reply_to(last_id_);
}

json Client::ask_with_bytes(json request, std::string_view bytes,
                            const std::function<void(std::size_t)>& on_progress) {
  request["id"] = ++last_id_;
  request["bytes"] = bytes.size();
  send_all(request.dump() + "\n");
  constexpr std::size_t kPiece = 65'536;
  for (std::size_t sent = 0; sent < bytes.size(); sent += kPiece) {
    send_all(bytes.substr(sent, kPiece));
    if (on_progress) on_progress(std::min(bytes.size(), sent + kPiece));
  }
  return reply_to(last_id_);
}

}  // namespace kinebus
