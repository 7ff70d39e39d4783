#include "gateway/sessions/http/slicers/login_sessions.hpp"

#include <algorithm>

#include "gateway/sessions/http/gate.hpp"

namespace kinebus::http {

std::string LoginSessions::begin(LocalTime now) {
  logins_.push_back({unguessable(), now + kFor});
  if (logins_.size() > kMost) logins_.pop_front();
  return logins_.back().session;
}

bool LoginSessions::knows(std::string_view session, LocalTime now) const {
  return std::any_of(logins_.begin(), logins_.end(), [&](const Login& login) {
    return now < login.until && same_key(login.session, session);
  });
}

}  // namespace kinebus::http
