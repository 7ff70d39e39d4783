#include "gateway/io/job_link_host.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "gateway/io/socket_stream.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

/// What a person chose may be shorter than what is made here, but must not be guessed.
constexpr std::size_t kShortestToken = 16;

}  // namespace

double unix_s_at_zero() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count() -
         to_seconds(monotonic_now());
}

std::string random_bytes(std::size_t size) {
  std::string bytes(size, '\0');
  if (::getrandom(bytes.data(), size, 0) != static_cast<ssize_t>(size))
    throw std::runtime_error("the system gives no random numbers");
  return bytes;
}

Result<std::string, std::string> token_of(const std::filesystem::path& path, std::size_t new_bytes) {
  std::string token;
  if (std::ifstream in(path); in >> token) {
    if (std::string loose = loose_secret(path); !loose.empty()) return Error<std::string>(std::move(loose));
    if (token.size() < kShortestToken)
      return Error<std::string>(path.string() +
                                ": expected a token of at least 16 characters; without the file a new one "
                                "is made");
    return token;
  }
  token = joblink::to_hex(random_bytes(new_bytes));
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const std::string line = token + "\n";
  const bool written = fd >= 0 && ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const std::string reason = std::strerror(errno);
  if (fd >= 0) ::close(fd);
  if (!written) return Error<std::string>(path.string() + ": " + reason);
  return token;
}

JobLinkHost::JobLinkHost(EventLoop& loop, StreamHub& near, StreamHub& far, JobLinkServer& server)
    : loop_(loop),
      near_(near),
      far_(far),
      server_(server),
      local_(loop,
             [this](int fd, std::string who) {
               std::string peer = peer_of(fd);
               near_.add(std::make_unique<SocketStream>(fd),
                         server_.open(loop_.now(),
                                      {.transport = std::move(who), .token = {}, .peer = std::move(peer)}));
             }),
      tcp_(loop, [this](int fd, std::string who) {
        std::string peer = peer_of(fd);
        far_.add(tls_->open(fd),
                 server_.open(
                     loop_.now(),
                     {.transport = std::move(who), .token = token_, .peer = std::move(peer), .remote = true}),
                 StreamHub::Side::kApart);
      }) {}

std::string JobLinkHost::listen_local(const std::string& path, const std::string& group) {
  return local_.listen_local(path, group);
}

std::string JobLinkHost::listen_tcp(const std::string& address, const std::filesystem::path& credentials) {
  auto tls = TlsContext::server(credentials);
  if (!tls) return tls.error();
  tls_.emplace(std::move(*tls));
  const auto token = token_of(credentials / "token");
  if (!token) return token.error();
  token_ = *token;
  std::string wrong = tcp_.listen_tcp(address);
  if (wrong.empty()) tcp_.pass(far_.gate(tcp_.fd(), StreamHub::Side::kApart));
  return wrong;
}

void JobLinkHost::on_time(LocalTime now) {
  server_.wall_clock(unix_s_at_zero() + to_seconds(loop_.behind()));
  server_.on_time(now);
}

void JobLinkHost::on_event(const MachineEvent& event) {
  server_.on_event(loop_.now(), event);
}

}  // namespace kinebus
