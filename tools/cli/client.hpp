#pragma once
// One connection to the daemon's local socket.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kinebus {

/// What went wrong between CLI and daemon, in words for the user.
struct ClientError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Client {
 public:
  /// The socket named by --socket, else $KINEBUS_SOCKET, else the first of the usual places that exists.
  static std::string find_socket(const std::string& asked);

  explicit Client(const std::string& path);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Sends a request and waits for its reply; statuses and events that arrive meanwhile go to `on_news`.
  nlohmann::json ask(nlohmann::json request);
  /// As ask(), with raw bytes behind the request (upload). `on_progress(sent)` after every piece.
  nlohmann::json ask_with_bytes(nlohmann::json request, std::string_view bytes,
                                const std::function<void(std::size_t)>& on_progress);
  /// The next message of the daemon. nullopt-like null: none within `timeout_ms`.
  nlohmann::json next(int timeout_ms);

  std::function<void(const nlohmann::json&)> on_news;

 private:
  void send_all(std::string_view bytes);
  nlohmann::json reply_to(std::uint64_t id);

  int fd_ = -1;
  std::uint64_t last_id_ = 0;
  std::string in_;
};

}  // namespace kinebus
