#pragma once
// Puts the HTTP server on the daemon's loop: listens, and gives every connection its session. On an address
// of this computer alone it is plain, on any other TLS with the job link's certificate.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gateway/io/daemon_part.hpp"
#include "gateway/io/listener.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/io/tls_stream.hpp"
#include "gateway/sessions/http/http_server.hpp"

namespace kinebus {

class HttpHost : public DaemonPart {
 public:
  HttpHost(EventLoop& loop, StreamHub& hub);

  /// Empty: listening. `server` must outlive the host and its sessions.
  std::string listen(const std::string& address, const std::filesystem::path& credentials,
                     http::Server& server);
  bool taken() const { return listener_.taken(); }  ///< why not: another program has the port
  int port() const { return listener_.port(); }
  bool encrypted() const { return tls_.has_value(); }

  void on_event(const MachineEvent& event) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;

 private:
  EventLoop& loop_;
  StreamHub& hub_;
  http::Server* server_ = nullptr;
  std::optional<TlsContext> tls_;
  Listener listener_;
};

/// Names by which others call this computer: its own, the same with ".local", and `more`.
std::vector<std::string> host_names(std::vector<std::string> more);

}  // namespace kinebus
