#pragma once
// The text of a file of users (Users::read) with one of them changed: all else in it, comments too, stays as
// it is. Errors name what is wrong, in words; a file that is written in a way that cannot be changed so is
// left to an editor.

#include <string>
#include <string_view>
#include <vector>

#include "gateway/result.hpp"
#include "gateway/sessions/http/users.hpp"

namespace kinebus::http {

class UsersText {
 public:
  /// `gateway_key`: no user may have the same.
  UsersText(std::string text, std::string gateway_key);

  Result<std::string, std::string> with(const User& user) const;
  Result<std::string, std::string> without(std::string_view name) const;
  Result<std::string, std::string> with_role(std::string_view name, Role role) const;
  Result<std::string, std::string> with_key(std::string_view name, std::string_view key) const;
  Result<Users, std::string> users() const { return Users::read(gateway_key_, text_); }

 private:
  Result<std::string, std::string> with_value(std::string_view name, const char* field,
                                              std::string_view value) const;
  Result<std::string, std::string> if_it_reads(std::string fresh, const std::vector<User>& expected) const;

  std::string text_, gateway_key_;
};

}  // namespace kinebus::http
