#include "gateway/sessions/http/users_text.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "gateway/toml.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus::http {
namespace {

using Wrong = Error<std::string>;

std::string quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

/// Of a line that begins with 1.
std::size_t offset_of_line(std::string_view text, std::size_t line) {
  std::size_t at = 0;
  for (; line > 1 && at < text.size(); --line) at = std::min(text.find('\n', at), text.size() - 1) + 1;
  return at;
}

/// Columns count characters, not bytes.
std::size_t offset_of(std::string_view text, toml::source_position place) {
  std::size_t at = offset_of_line(text, place.line);
  for (std::size_t column = 1; column < place.column && at < text.size(); ++column) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U) ++at;
  }
  return at;
}

/// The table of a user; nullptr: there is none.
const toml::table* table_of(const toml::table& file, std::string_view name) {
  const toml::array* const list = file["user"].as_array();
  if (list == nullptr) return nullptr;
  for (const toml::node& node : *list)
    if (const toml::table* table = node.as_table())
      if ((*table)["name"].value_or(std::string()) == name) return table;
  return nullptr;
}

std::string no_user(std::string_view name) {
  return "there is no user '" + std::string(name) + "'";
}

bool same(const User& a, const User& b) {
  return a.visitor.name == b.visitor.name && a.visitor.role == b.visitor.role && a.key == b.key;
}

/// Why it cannot be written; empty: it can.
std::string unfit(std::string_view what, std::string_view text) {
  if (is_plain(text) && text.size() <= kMaxNameBytes) return {};
  return "a " + std::string(what) + " has at most 100 bytes of UTF-8, and no control characters";
}

std::vector<User>::iterator named(std::vector<User>& users, std::string_view name) {
  return std::find_if(users.begin(), users.end(),
                      [&](const User& user) { return !name.empty() && user.visitor.name == name; });
}

}  // namespace

UsersText::UsersText(std::string text, std::string gateway_key)
    : text_(std::move(text)), gateway_key_(std::move(gateway_key)) {}

/// What was changed must read as it was meant, or it is not written.
Result<std::string, std::string> UsersText::if_it_reads(std::string fresh,
                                                        const std::vector<User>& expected) const {
  const auto read = Users::read(gateway_key_, fresh);
  if (!read) return Wrong(read.error());
  if (!std::equal(read->all().begin(), read->all().end(), expected.begin(), expected.end(), same))
    return Wrong("this file is written in a way that can be changed by an editor alone");
  return fresh;
}

Result<std::string, std::string> UsersText::with(const User& user) const {
  const std::string& name = user.visitor.name;
  auto before = users();
  if (!before) return Wrong(before.error());
  if (std::string why = unfit("name", name); !why.empty()) return Wrong(why);
  if (std::string why = unfit("key", user.key); !why.empty()) return Wrong(why);
  std::vector<User> expected = before->all();
  if (named(expected, name) != expected.end()) return Wrong("there is a user '" + name + "' already");
  expected.push_back(user);
  std::string fresh = text_;
  if (!fresh.empty() && fresh.back() != '\n') fresh += '\n';
  fresh += "[[user]]\nname = " + quoted(name) + "\nrole = " + quoted(word_of(user.visitor.role)) +
           "\nkey = " + quoted(user.key) + "\n";
  return if_it_reads(std::move(fresh), expected);
}

Result<std::string, std::string> UsersText::without(std::string_view name) const {
  auto before = users();
  if (!before) return Wrong(before.error());
  std::vector<User> expected = before->all();
  const auto user = named(expected, name);
  if (user == expected.end()) return Wrong(no_user(name));
  expected.erase(user);
  const toml::parse_result parsed = toml::parse(text_);
  const toml::table* const table = table_of(parsed.table(), name);
  if (table == nullptr) return Wrong(no_user(name));
  auto last = table->source().begin.line;
  for (const auto& entry : *table) last = std::max(last, entry.second.source().end.line);
  std::string fresh = text_;
  const std::size_t from = offset_of_line(fresh, table->source().begin.line);
  fresh.erase(from, offset_of_line(fresh, last + std::size_t{1}) - from);
  return if_it_reads(std::move(fresh), expected);
}

Result<std::string, std::string> UsersText::with_role(std::string_view name, Role role) const {
  return with_value(name, "role", word_of(role));
}

Result<std::string, std::string> UsersText::with_key(std::string_view name, std::string_view key) const {
  if (std::string why = unfit("key", key); !why.empty()) return Wrong(why);
  return with_value(name, "key", key);
}

Result<std::string, std::string> UsersText::with_value(std::string_view name, const char* field,
                                                       std::string_view value) const {
  auto before = users();
  if (!before) return Wrong(before.error());
  std::vector<User> expected = before->all();
  const auto user = named(expected, name);
  if (user == expected.end()) return Wrong(no_user(name));
  if (std::string_view(field) == "key")
    user->key = value;
  else
    user->visitor.role = *role_of(value);
  const toml::parse_result parsed = toml::parse(text_);
  const toml::table* const table = table_of(parsed.table(), name);
  if (table == nullptr) return Wrong(no_user(name));
  const toml::source_region place = (*table)[field].node()->source();
  std::string fresh = text_;
  const std::size_t from = offset_of(fresh, place.begin);
  fresh.replace(from, offset_of(fresh, place.end) - from, quoted(value));
  return if_it_reads(std::move(fresh), expected);
}

}  // namespace kinebus::http
