// What is answered, and how a refusal reads.

#include "gateway/sessions/http/http_session.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace kinebus::http {
namespace {

std::string_view reason_of(int status) {
  static constexpr std::pair<int, std::string_view> kReasons[] = {
      {101, "Switching Protocols"},
      {200, "OK"},
      {201, "Created"},
      {204, "No Content"},
      {206, "Partial Content"},
      {304, "Not Modified"},
      {400, "Bad Request"},
      {401, "Unauthorized"},
      {403, "Forbidden"},
      {404, "Not Found"},
      {405, "Method Not Allowed"},
      {408, "Request Timeout"},
      {409, "Conflict"},
      {411, "Length Required"},
      {413, "Content Too Large"},
      {415, "Unsupported Media Type"},
      {416, "Range Not Satisfiable"},
      {417, "Expectation Failed"},
      {426, "Upgrade Required"},
      {431, "Request Header Fields Too Large"},
      {500, "Internal Server Error"},
      {503, "Service Unavailable"},
      {505, "HTTP Version Not Supported"},
      {507, "Insufficient Storage"},
  };
  for (const auto& [number, reason] : kReasons)
    if (number == status) return reason;
  return "Error";
}

int status_of(joblink::ErrorCode code) {
  switch (code) {
    case joblink::ERROR_NO_CONTROL:
    case joblink::ERROR_MACHINE_STATE:
    case joblink::ERROR_JOB_IN_USE:
    case joblink::ERROR_CONFLICT:
      return 409;
    case joblink::ERROR_NOT_ALLOWED:
      return 403;
    case joblink::ERROR_NO_SUCH_JOB:
      return 404;
    case joblink::ERROR_QUOTA:
      return 507;
    case joblink::ERROR_BUSY:
      return 503;
    case joblink::ERROR_STORAGE:
      return 500;
    default:
      return 400;
  }
}

/// Under Moonraker's paths an error is an object, whose code its pages look at.
Answer refusal_of(int status, std::string_view why, const Target& of) {
  static constexpr std::array<std::string_view, 4> kMoonraker{"access", "machine", "printer", "server"};
  const bool moonraker =
      !of.path.empty() && std::find(kMoonraker.begin(), kMoonraker.end(), of.path[0]) != kMoonraker.end();
  nlohmann::json error = why;
  if (moonraker) error = {{"code", status}, {"message", why}};
  return {.status = status,
          .body = nlohmann::json{{"error", std::move(error)}}.dump(-1, ' ', false,
                                                                   nlohmann::json::error_handler_t::replace)};
}

}  // namespace

void Session::put_head(const Answer& answer, std::uint64_t length) {
  // Who has not sent all of its request would send it to nobody.
  if (!whole_) keep_alive_ = false;
  out_ += "HTTP/1.1 " + std::to_string(answer.status) + " " + std::string(reason_of(answer.status)) + "\r\n";
  if (answer.status != 204 && answer.status != 304) {
    out_ += "Content-Type: " + answer.type + "\r\n";
    out_ += "Content-Length: " + std::to_string(length) + "\r\n";
  }
  for (const auto& [name, value] : answer.fields) out_.append(name).append(": ").append(value).append("\r\n");
  out_ += answer.may_be_kept ? "Cache-Control: no-cache\r\n" : "Cache-Control: no-store\r\n";
  out_ += "X-Content-Type-Options: nosniff\r\nX-Robots-Tag: noindex\r\n";
  out_ += keep_alive_ ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n";
}

void Session::answer(const Answer& answer) {
  if (answered_ || ended_) return;
  put_head(answer, answer.body.size());
  if (!no_body_ && answer.status != 204 && answer.status != 304) out_ += answer.body;
  finish();
}

void Session::answer_head(const Answer& head, std::uint64_t length) {
  put_head(head, length);
}

void Session::write(std::string_view bytes) {
  if (!no_body_) out_ += bytes;
}

void Session::break_off() {
  keep_alive_ = false;
  finish();
}

void Session::refuse(int status, std::string_view why) {
  answer(refusal_of(status, why, target_));
}

void Session::refuse_stranger() {
  Answer refusal =
      refusal_of(401, "X-Api-Key must be a key of this gateway, or the password of HTTP Digest", target_);
  // A browser would ask its user for a name and a password, where the page asks for the key.
  if (head().field("Sec-Fetch-Mode").empty())
    refusal.fields.emplace_back("WWW-Authenticate",
                                server_.digest().challenge(now_, shown_ == Digest::Shown::kStale));
  refusal.fields.emplace_back("WWW-Authenticate", "Bearer realm=\"kinebus\"");
  answer(refusal);
}

void Session::refuse(const joblink::Problem& problem, int status) {
  refuse(status != 0 ? status : status_of(problem.code()), words_of(problem));
}

}  // namespace kinebus::http
