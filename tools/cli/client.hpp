#pragma once
// One connection to the daemon by the job link, with waiting: what a command line needs.

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

#include "gateway/io/byte_stream.hpp"
#include "protocol/joblink/client.hpp"

namespace kinebus {

/// What went wrong between CLI and daemon, in words for the user.
struct ClientError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How to reach a daemon.
struct Reach {
  std::string client = "kinebus command line";  ///< what the others see
  std::string socket{};  ///< local; empty: $KINEBUS_SOCKET, else the first of the usual places that exists
  std::string tcp{};     ///< HOST:PORT instead of the local socket
  std::string fingerprint{};  ///< of the gateway's certificate (TCP)
  std::string token_file{};   ///< TCP
};

class Client {
 public:
  using Report = std::variant<joblink::Status, joblink::Event>;

  /// Says hello; with `watch` statuses (at `status_hz`) and events come by next().
  explicit Client(const Reach& reach, double status_hz = 0, bool events = false);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Sends a request and waits for its reply; an error in it is thrown as ClientError. What arrives meanwhile
  /// is kept for next().
  joblink::Reply ask(joblink::ClientMessage request);
  /// The same; an error stays in the reply.
  joblink::Reply try_ask(joblink::ClientMessage request);
  /// The next status or event; nullopt: none within `timeout`.
  std::optional<Report> next(std::chrono::milliseconds timeout);
  joblink::Status status();
  /// Sends a file's bytes as a job, from where an earlier attempt ended. `on_progress(bytes received, bytes
  /// of all)`.
  void upload(const std::string& file, const std::string& name,
              const std::function<void(std::uint64_t, std::uint64_t)>& on_progress);
  /// Gives control away: others may command the machine while this client only watches.
  void release_control();

 private:
  void turn(std::chrono::milliseconds timeout);
  void take_news();
  void wait_until_connected();
  void move_output();

  std::unique_ptr<ByteStream> stream_;
  joblink::Client link_;
  std::deque<Report> reports_;
  std::deque<joblink::Answer> answers_;
  std::optional<joblink::UploadNews> upload_;
  std::string failure_;
  bool welcome_ = false;  ///< the daemon has answered the hello once
  bool closed_ = false;   ///< the stream
};

/// "rule: expected": what a person is told of a refused request.
std::string to_words(const joblink::Problem& problem);

}  // namespace kinebus
