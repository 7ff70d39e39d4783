#include "gateway/fleet/wall/wall_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace kinebus::fleet {
namespace {

constexpr LocalTime kSilence = std::chrono::seconds{60};

/// A page elsewhere whose name was pointed at this computer must not read this one.
bool is_local(std::string_view host) {
  const std::size_t colon = host.rfind(':'), bracket = host.rfind(']');
  if (colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket))
    host = host.substr(0, colon);
  constexpr std::array<std::string_view, 3> kNames{"localhost", "127.0.0.1", "[::1]"};
  return std::find(kNames.begin(), kNames.end(), host) != kNames.end();
}

const char* phrase_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    default:
      return "Method Not Allowed";
  }
}

}  // namespace

void WallSession::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  silent_until_ = now + kSilence;
  in_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  work();
}

void WallSession::on_bytes_sent(std::size_t count) {
  out_.erase(0, count);
  work();
}

/// One answer at a time: who sends many requests at once has the others when it has read the first.
void WallSession::work() {
  while (!ended_ && out_.empty()) {
    const http::Reader::Taken taken = reader_.take(in_);
    in_.erase(0, taken.count);
    switch (taken.step) {
      case http::Reader::Step::kMore:
        return;
      case http::Reader::Step::kBad:
        return say(400, "text/plain", reader_.bad_why() + "\n", false);
      case http::Reader::Step::kEnd:
        answer(reader_.head());
        reader_.next();
        break;
      case http::Reader::Step::kHead:
      case http::Reader::Step::kBody:
        break;
    }
  }
}

void WallSession::on_time(LocalTime now) {
  if (now >= silent_until_) ended_ = true;
}

std::span<const std::uint8_t> WallSession::next_bytes() {
  return {reinterpret_cast<const std::uint8_t*>(out_.data()), out_.size()};
}

void WallSession::answer(const http::Head& head) {
  if (!is_local(head.field("Host")))
    return say(403, "text/plain", "this is localhost, by that name alone\n", false);
  if (head.method != "GET") return say(405, "text/plain", "only GET\n", false);
  const std::string_view path = std::string_view(head.target).substr(0, head.target.find('?'));
  if (path == "/") return say(200, "text/html; charset=utf-8", kWallPage, head.keep_alive);
  if (path == "/fleet.json") return say(200, "application/json", text_.get(), head.keep_alive);
  if (path == "/metrics")
    return say(200, "text/plain; version=0.0.4; charset=utf-8", text_.metrics(), head.keep_alive);
  say(404, "text/plain", "expected /, /fleet.json or /metrics\n", head.keep_alive);
}

void WallSession::say(int status, const char* type, const std::string& body, bool keep) {
  out_ += fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n"
      "X-Content-Type-Options: nosniff\r\nContent-Security-Policy: default-src 'self' 'unsafe-inline'; "
      "frame-ancestors 'none'\r\n{}Connection: {}\r\n\r\n{}",
      status, phrase_of(status), type, body.size(), status == 405 ? "Allow: GET\r\n" : "",
      keep ? "keep-alive" : "close", body);
  ended_ = !keep;
}

}  // namespace kinebus::fleet
