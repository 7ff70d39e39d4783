#include "gateway/sessions/http/slicers/login_sessions.hpp"

#include <algorithm>
#include <utility>

#include "gateway/sessions/http/gate.hpp"

namespace kinebus::http {

std::string LoginSessions::begin(LocalTime now, Visitor visitor, std::string address) {
  logins_.push_back({unguessable(), now + kFor, std::move(visitor), std::move(address)});
  if (logins_.size() > kMost) logins_.pop_front();
  return logins_.back().session;
}

std::optional<Visitor> LoginSessions::find(std::string_view session, LocalTime now) const {
  const auto found = std::find_if(logins_.begin(), logins_.end(), [&](const Login& login) {
    return now < login.until && same_key(login.session, session);
  });
  return found == logins_.end() ? std::nullopt : std::optional(found->visitor);
}

void LoginSessions::keep_if(const std::function<bool(const Login&)>& stays) {
  std::erase_if(logins_, [&](const Login& login) { return !stays(login); });
}

}  // namespace kinebus::http
