#include "gateway/io/http_host.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/io/job_link_host.hpp"
#include "gateway/io/socket_stream.hpp"

namespace kinebus {
HttpHost::HttpHost(EventLoop& loop, StreamHub& hub)
    : loop_(loop), hub_(hub), listener_(loop, [this](int fd, std::string who) {
        std::string peer = peer_of(fd);
        std::unique_ptr<ByteStream> stream =
            tls_ ? tls_->open(fd) : std::unique_ptr<ByteStream>(std::make_unique<SocketStream>(fd));
        // "tcp 10.0.0.7"
        if (who.starts_with("tcp")) who.replace(0, 3, "http");
        const std::string address = who.substr(std::min(who.find(' '), who.size() - 1) + 1);
        hub_.add(std::move(stream), server_->open(loop_.now(), std::move(who), std::move(peer), address));
      }) {}

std::string HttpHost::listen(const std::string& address, const std::filesystem::path& credentials,
                             http::Server& server) {
  server_ = &server;
  if (std::string wrong = listener_.listen_tcp(address); !wrong.empty()) return wrong;
  listener_.pass(hub_.gate(listener_.fd()));
  if (listener_.loopback()) return {};
  auto tls = TlsContext::server(credentials);
  if (!tls) return tls.error();
  tls_.emplace(std::move(*tls));
  return {};
}

void HttpHost::on_event(const MachineEvent& event) {
  if (server_ != nullptr) server_->on_event(event);
}

void HttpHost::on_time(LocalTime now) {
  if (server_ != nullptr) server_->on_time(now);
}

LocalTime HttpHost::next_deadline() const {
  return server_ != nullptr ? server_->next_deadline() : LocalTime::max();
}

std::vector<std::string> host_names(std::vector<std::string> more) {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return more;
  more.emplace_back(name.data());
  more.push_back(more.back() + ".local");
  return more;
}

}  // namespace kinebus
