#include "tools/cli/client.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <utility>

#include "gateway/io/socket_stream.hpp"
#include "gateway/io/tls_stream.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/joblink/job_hash.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using std::chrono::milliseconds;
constexpr auto kAnswerWithin = std::chrono::seconds{30};
/// A busy computer may take that long over a piece of a job: a daemon that has ended closes the link.
constexpr auto kPieceWithin = std::chrono::seconds{120};

std::string find_socket(const std::string& asked) {
  if (!asked.empty()) return asked;
  if (const char* named = std::getenv("KINEBUS_SOCKET")) return named;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const std::string own = runtime != nullptr ? std::string(runtime) + "/kinebus.sock" : "/tmp/kinebus.sock";
  const std::string system = "/run/kinebus/kinebus.sock";
  std::error_code error;
  return std::filesystem::exists(system, error) ? system : own;
}

std::unique_ptr<ByteStream> open_stream(const Reach& reach) {
  if (reach.tcp.empty()) {
    const std::string path = find_socket(reach.socket);
    auto stream = connect_local(path);
    if (!stream)
      throw ClientError("no daemon answers at " + path + " (" + stream.error() +
                        "); start one, for example: kinebusd --bus inproc");
    return std::move(*stream);
  }
  const std::size_t colon = reach.tcp.rfind(':');
  if (colon == std::string::npos) throw ClientError("--tcp: expected HOST:PORT");
  const auto tls = TlsContext::client(reach.fingerprint);
  if (!tls) throw ClientError("--fingerprint: " + tls.error());
  const auto fd = connect_tcp(reach.tcp.substr(0, colon), reach.tcp.substr(colon + 1));
  if (!fd) throw ClientError(fd.error());
  return tls->open(*fd);
}

std::string token_of(const Reach& reach) {
  std::string token;
  if (reach.token_file.empty()) return token;
  std::ifstream in(reach.token_file);
  if (!(in >> token)) throw ClientError(reach.token_file + ": holds no token");
  return token;
}

class FileBytes : public joblink::UploadSource {
 public:
  explicit FileBytes(const std::string& path) : in_(path, std::ios::binary) {}
  std::size_t read(std::uint64_t offset_bytes, std::span<char> buffer) override {
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(offset_bytes));
    in_.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    return static_cast<std::size_t>(in_.gcount());
  }

 private:
  std::ifstream in_;
};

/// `breathe` is called between pieces: a long file must not look like a client that has vanished.
joblink::UploadRequest describe(const std::string& file, const std::string& name,
                                const std::function<void()>& breathe) {
  std::ifstream in(file, std::ios::binary);
  joblink::JobHash sum;
  joblink::UploadRequest request{.name = name, .size_bytes = 0, .hash = {}};
  std::string piece(1U << 20, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
    sum.add(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
    request.size_bytes += static_cast<std::uint64_t>(in.gcount());
    breathe();
  }
  if (!in.eof()) throw ClientError(file + ": cannot be read");
  request.hash = sum.finish();
  return request;
}

}  // namespace

std::string to_words(const joblink::Problem& problem) {
  std::string words = problem.place().empty() ? problem.rule() : problem.place() + ": " + problem.rule();
  if (!problem.expected().empty()) words += "; expected: " + problem.expected();
  return words;
}

Client::Client(const Reach& reach, double status_hz, bool events)
    : stream_(open_stream(reach)),
      link_({.name = reach.client,
             .version = KINEBUS_VERSION,
             .token = token_of(reach),
             .status_hz = status_hz,
             .events = events,
             .session_seed = std::random_device()()}) {
  link_.on_connected(monotonic_now());
  wait_until_connected();
  welcome_ = true;
}

/// At the start, and when a lost message has made the link begin anew.
void Client::wait_until_connected() {
  const LocalTime deadline = monotonic_now() + LocalTime{kAnswerWithin};
  while (!link_.connected()) {
    turn(milliseconds{1000});
    if (monotonic_now() > deadline) throw ClientError("the daemon does not answer");
  }
}

Client::~Client() = default;

void Client::move_output() {
  for (;;) {
    const auto bytes = link_.next_bytes();
    if (bytes.empty()) return;
    const ByteStream::Moved moved = stream_->write(bytes);
    if (moved.closed) throw ClientError("the daemon is gone: " + stream_->closed_reason());
    link_.on_bytes_sent(moved.count);
    if (moved.count < bytes.size()) return;
  }
}

/// Moves what can be moved; waits at most `timeout` for something to come.
void Client::turn(milliseconds timeout) {
  move_output();
  const auto until_deadline = std::chrono::ceil<milliseconds>(link_.next_deadline() - monotonic_now());
  const auto wait = std::clamp(until_deadline, milliseconds{0}, timeout);
  const std::uint32_t interest = stream_->interest(!link_.next_bytes().empty());
  pollfd waiting{stream_->fd(),
                 static_cast<short>((interest & EPOLLIN ? POLLIN : 0) | (interest & EPOLLOUT ? POLLOUT : 0)),
                 0};
  if (stream_->buffered() || ::poll(&waiting, 1, static_cast<int>(wait.count())) > 0) {
    std::array<std::uint8_t, 65'536> buffer;
    const ByteStream::Moved moved = stream_->read(buffer);
    if (moved.count > 0) link_.on_bytes(monotonic_now(), std::span(buffer).first(moved.count));
    closed_ = moved.closed;
    if (moved.closed) {
      const std::string why =
          stream_->closed_reason().empty() ? "the daemon closed the connection" : stream_->closed_reason();
      link_.on_disconnected(monotonic_now(), why);
      // Before the hello was answered nobody else tells it; a stream that has ended is readable for ever.
      failure_ = why;
    }
  }
  link_.on_time(monotonic_now());
  take_news();
  if (!failure_.empty()) throw ClientError(failure_);
  move_output();
}

void Client::take_news() {
  while (auto news = link_.next_news()) {
    if (auto* answer = std::get_if<joblink::Answer>(&*news)) {
      // Statuses from before a command must not be taken for what came of it.
      std::erase_if(reports_, [](const Report& r) { return std::holds_alternative<joblink::Status>(r); });
      answers_.push_back(std::move(*answer));
    } else if (auto* status = std::get_if<joblink::Status>(&*news))
      reports_.emplace_back(std::move(*status));
    else if (auto* event = std::get_if<joblink::Event>(&*news))
      reports_.emplace_back(std::move(*event));
    else if (auto* upload = std::get_if<joblink::UploadNews>(&*news))
      upload_ = std::move(*upload);
    else if (auto* lost = std::get_if<joblink::Disconnected>(&*news);
             lost != nullptr && (closed_ || !welcome_))
      failure_ = lost->why;
  }
}

joblink::Reply Client::try_ask(ClientMessage request) {
  wait_until_connected();
  const joblink::RequestId id = link_.send(std::move(request));
  const LocalTime deadline = monotonic_now() + LocalTime{kAnswerWithin};
  for (;;) {
    turn(milliseconds{1000});
    for (auto& answer : answers_)
      if (answer.request == id) {
        joblink::Reply reply = std::move(answer.reply);
        answers_.clear();
        return reply;
      }
    if (monotonic_now() > deadline) throw ClientError("the daemon does not answer");
  }
}

joblink::Reply Client::ask(ClientMessage request) {
  joblink::Reply reply = try_ask(std::move(request));
  if (!reply.has_error()) return reply;
  const bool by_force = reply.error().code() == joblink::ERROR_NO_CONTROL;
  throw ClientError(to_words(reply.error()) + (by_force ? " (kinebus --force)" : ""));
}

std::optional<Client::Report> Client::next(milliseconds timeout) {
  const LocalTime deadline = monotonic_now() + LocalTime{timeout};
  while (reports_.empty()) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - monotonic_now());
    if (left <= milliseconds{0}) return std::nullopt;
    turn(left);
  }
  Report report = std::move(reports_.front());
  reports_.pop_front();
  return report;
}

joblink::Status Client::status() {
  ClientMessage request;
  request.mutable_get_status();
  return ask(std::move(request)).status();
}

void Client::release_control() {
  ClientMessage request;
  request.mutable_release_control();
  ask(std::move(request));
}

void Client::upload(const std::string& file, const std::string& name,
                    const std::function<void(std::uint64_t, std::uint64_t)>& on_progress) {
  link_.upload(describe(file, name, [this] { turn(milliseconds{0}); }), std::make_unique<FileBytes>(file));
  LocalTime moved_at = monotonic_now();
  std::uint64_t received = 0;
  for (;;) {
    turn(milliseconds{1000});
    if (upload_) {
      using Phase = joblink::UploadNews::Phase;
      const joblink::UploadNews news = *std::exchange(upload_, std::nullopt);
      if (news.phase == Phase::kFailed) throw ClientError("upload: " + to_words(news.error));
      on_progress(news.received_bytes, news.size_bytes);
      if (news.phase == Phase::kStored) return;
      if (news.received_bytes != received) moved_at = monotonic_now();
      received = news.received_bytes;
    }
    if (monotonic_now() > moved_at + LocalTime{kPieceWithin})
      throw ClientError("upload: the daemon takes no more");
  }
}

}  // namespace kinebus
