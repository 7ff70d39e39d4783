#pragma once
// Puts the job link's server on the daemon's loop: listens, lets clients in, and gives every stream its
// session.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "gateway/io/daemon_part.hpp"
#include "gateway/io/listener.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/io/tls_stream.hpp"
#include "gateway/sessions/job_link_server.hpp"

namespace kinebus {

class JobLinkHost : public DaemonPart {
 public:
  /// `near`: of who is at this computer; `far`: of who comes by the network.
  JobLinkHost(EventLoop& loop, StreamHub& near, StreamHub& far, JobLinkServer& server);

  /// Empty: listening.
  std::string listen_local(const std::string& path, const std::string& group);
  /// TLS with the identity and the token kept in `credentials` (made when they are not there). Empty:
  /// listening.
  std::string listen_tcp(const std::string& address, const std::filesystem::path& credentials);
  std::string tls_fingerprint() const { return tls_ ? tls_->fingerprint() : std::string(); }
  int tcp_port() const { return tcp_.port(); }

  void on_event(const MachineEvent& event) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override { return server_.next_deadline(); }

 private:
  EventLoop& loop_;
  StreamHub &near_, &far_;
  JobLinkServer& server_;
  std::optional<TlsContext> tls_;
  std::string token_;
  Listener local_, tcp_;
};

inline constexpr std::size_t kTokenBytes = 24;
/// The token in the file; a new one of so many bytes, as hexadecimal digits, where there is none. Only the
/// owner may read it. Error: in words.
Result<std::string, std::string> token_of(const std::filesystem::path& path,
                                          std::size_t new_bytes = kTokenBytes);

/// Seconds since 1970 at time 0 of the monotonic clock, by the wall clock as it is now.
double unix_s_at_zero();

/// `size` random bytes of the system.
std::string random_bytes(std::size_t size);

}  // namespace kinebus
