#pragma once
// Who has shown the key once shows instead, over a websocket, the session that it was given for it.

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/sessions/http/users.hpp"
#include "protocol/time.hpp"

namespace kinebus::http {

struct Login {
  std::string session;
  LocalTime until;
  Visitor visitor;
  std::string address;  ///< where it came from
};

class LoginSessions {
 public:
  static constexpr LocalTime kFor = std::chrono::hours{24};
  static constexpr std::size_t kMost = 200;  ///< the oldest goes for a new one

  /// A new one, that nobody can guess.
  std::string begin(LocalTime now, Visitor visitor, std::string address);
  /// nullopt: there is none, or its time is over.
  std::optional<Visitor> find(std::string_view session, LocalTime now) const;
  void keep_if(const std::function<bool(const Login&)>& stays);

 private:
  std::deque<Login> logins_;
};

}  // namespace kinebus::http
