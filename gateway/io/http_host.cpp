#include "gateway/io/http_host.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <utility>

#include "gateway/io/job_link_host.hpp"
#include "gateway/io/socket_stream.hpp"

namespace kinebus {
namespace {
/// 32 characters: OctoPrint's clients take 32 to 43.
constexpr std::size_t kHttpKeyBytes = 16;
}  // namespace

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

Result<http::Users, std::string> http_users(const std::filesystem::path& key_file,
                                            const std::filesystem::path& users_file, bool must_be_there) {
  auto key = token_of(key_file, kHttpKeyBytes);
  if (!key) return Error<std::string>(key.error());
  std::error_code unreadable;
  if (!must_be_there && !std::filesystem::exists(users_file, unreadable)) return http::Users(std::move(*key));
  if (std::string loose = loose_secret(users_file); !loose.empty())
    return Error<std::string>(std::move(loose));
  std::ifstream in(users_file);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Error<std::string>(users_file.string() + " cannot be read");
  auto users = http::Users::read(std::move(*key), text.str());
  if (!users) return Error<std::string>(users_file.string() + ", " + users.error());
  return users;
}

std::vector<std::string> host_names(std::vector<std::string> more) {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return more;
  more.emplace_back(name.data());
  more.push_back(more.back() + ".local");
  return more;
}

}  // namespace kinebus
