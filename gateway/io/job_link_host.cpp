#include "gateway/io/job_link_host.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "gateway/io/socket_stream.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kTokenBytes = 24;

/// The token of the folder; a new one where there is none. Only the owner may read it.
Result<std::string, std::string> token_of(const std::filesystem::path& path) {
  std::string token;
  if (std::ifstream in(path); in >> token) return token;
  token = joblink::to_hex(random_bytes(kTokenBytes));
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const std::string line = token + "\n";
  const bool written = fd >= 0 && ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const std::string reason = std::strerror(errno);
  if (fd >= 0) ::close(fd);
  if (!written) return Error<std::string>(path.string() + ": " + reason);
  return token;
}

}  // namespace

std::string random_bytes(std::size_t size) {
  std::string bytes(size, '\0');
  if (::getrandom(bytes.data(), size, 0) != static_cast<ssize_t>(size))
    throw std::runtime_error("the system gives no random numbers");
  return bytes;
}

JobLinkHost::JobLinkHost(EventLoop& loop, StreamHub& hub, JobLinkServer& server)
    : hub_(hub),
      server_(server),
      local_(loop,
             [this](int fd, std::string who) {
               add(std::make_unique<SocketStream>(fd), {.transport = std::move(who), .token = {}});
             }),
      tcp_(loop, [this](int fd, std::string who) {
        add(tls_->open(fd), {.transport = std::move(who), .token = token_});
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
  return tcp_.listen_tcp(address);
}

void JobLinkHost::on_event(const MachineEvent& event) {
  server_.on_event(monotonic_now(), event);
}

void JobLinkHost::add(std::unique_ptr<ByteStream> stream, SessionInfo info) {
  if (auto session = server_.open(monotonic_now(), std::move(info)))
    hub_.add(std::move(stream), std::move(session));
}

}  // namespace kinebus
