#pragma once
// The client's end of the job link, sans-IO: whoever owns it moves bytes and time, sends requests and pulls
// news.
//
//   on_connected -> hello -> Connected          (then statuses and events, as Options ask for them)
//   send(request) -> Answer with the same id    upload(...) -> UploadNews until it is stored
//   next_bytes / on_bytes_sent, on_bytes        on_time at next_deadline
//
// A link that breaks (on_disconnected, silence, a lost frame) fails the open requests with ERROR_LINK_LOST;
// uploads go on by themselves at the right byte when the link is there again. One thread.

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "protocol/joblink/frame_codec.hpp"
#include "protocol/joblink/kinebus.pb.h"
#include "protocol/joblink/version.hpp"
#include "protocol/time.hpp"

namespace kinebus::joblink {

/// Where the bytes of an upload come from: a file, a string.
class UploadSource {
 public:
  virtual ~UploadSource() = default;
  /// Fills the front of `buffer` with what is at `offset_bytes`; returns the bytes filled. Fewer than asked
  /// for before the announced size: the source has become unreadable, and the upload fails.
  virtual std::size_t read(std::uint64_t offset_bytes, std::span<char> buffer) = 0;
};

struct UploadRequest {
  std::string name;
  std::uint64_t size_bytes = 0;
  std::string hash;  ///< 32 bytes (hash.hpp)
  bool replace = true;
};
using UploadId = std::uint32_t;
using RequestId = std::uint32_t;

/// The gateway has answered the hello.
struct Connected {
  HelloReply hello;
};
/// Nothing is heard any more, in words.
struct Disconnected {
  std::string why;
};
struct Answer {
  RequestId request = 0;
  Reply reply;  ///< has error(): refused
  bool ok() const { return !reply.has_error(); }
};
struct UploadNews {
  enum class Phase : std::uint8_t {
    kSending,
    kWaiting,
    kStored,
    kFailed
  } phase{};  ///< kWaiting: for the link
  UploadId upload = 0;
  std::uint64_t received_bytes = 0;  ///< by the gateway
  std::uint64_t size_bytes = 0;
  Problem error{};  ///< kFailed
};
using News = std::variant<Connected, Disconnected, Answer, Status, Event, UploadNews>;

class Client {
 public:
  struct Options {
    std::string name = "client";  ///< shown to the other clients
    std::string version;
    std::string token;      ///< TCP
    double status_hz = 20;  ///< 0: no statuses
    bool events = true;
    std::uint32_t session_seed =
        1;  ///< random: a session's number must differ from the one before it on this pipe
    std::chrono::milliseconds ping_period{1000};  ///< when nothing else is sent
    std::chrono::milliseconds silence_limit{4000};
    /// Run so much later than it asked to be, it gives the gateway the whole limit anew.
    std::chrono::milliseconds absence{500};
  };

  explicit Client(Options options);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  // The stream and the time.
  void on_connected(LocalTime now);  ///< the stream is open: a new session begins
  void on_disconnected(LocalTime now, const std::string& why);
  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes);
  void on_time(LocalTime now);
  /// What to send now; empty: nothing. Valid until the next call of anything here.
  std::span<const std::uint8_t> next_bytes();
  void on_bytes_sent(std::size_t count);
  LocalTime next_deadline() const;

  /// Sends `request` (its request_id is filled in here). Not connected: an Answer with ERROR_LINK_LOST
  /// follows.
  RequestId send(ClientMessage request);
  /// Begins an upload; its news tell how it goes. Uploads run one after the other, beside all other requests.
  UploadId upload(UploadRequest request, std::unique_ptr<UploadSource> source);
  /// Stops an upload. The gateway keeps what it has for a later one unless `discard`.
  void abort_upload(UploadId upload, bool discard);

  std::optional<News> next_news();

  bool connected() const { return phase_ == Phase::kOpen; }
  std::uint32_t client_id() const { return hello_.client_id(); }
  const HelloReply& hello() const { return hello_; }

 private:
  enum class Phase : std::uint8_t { kClosed, kGreeting, kOpen, kWaiting };
  struct Upload;

  LocalTime next_deadline(LocalTime now) const;  ///< as it was asked for at `now`
  void begin_session(LocalTime now);
  void end_session(LocalTime now, const std::string& why, bool retry);
  void written();
  bool write_request(ClientMessage& message);
  void fail_request(RequestId request, const Problem& error);
  void take(LocalTime now, const ServerMessage& message);
  void take_reply(Reply reply);
  void take_upload_reply(const Reply& reply);
  void feed_upload();
  bool send_chunk(Upload& upload, std::size_t size);
  void begin_upload();
  void finish_upload(UploadNews::Phase phase, const Problem& error);
  void tell_upload(UploadNews::Phase phase);

  Options options_;
  Phase phase_ = Phase::kClosed;
  FrameReader reader_;
  SessionSequence incoming_;
  std::uint32_t session_ = 0;
  std::uint32_t sequence_ = 0;
  FrameQueue out_;
  RequestId last_request_ = 0;
  std::unordered_map<RequestId, bool> open_;  ///< requests without an answer; true: the owner's
  HelloReply hello_;
  std::string resume_key_;
  std::deque<std::unique_ptr<Upload>> uploads_;  ///< the first one runs
  UploadId last_upload_ = 0;
  std::deque<News> news_;
  LocalTime last_heard_{0}, last_written_{0}, retry_at_{0}, now_{0};
};

}  // namespace kinebus::joblink
