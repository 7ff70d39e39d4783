#include "gateway/sessions/http/users.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <utility>

#include "gateway/near_word.hpp"
#include "gateway/sessions/http/gate.hpp"
#include "gateway/toml.hpp"

namespace kinebus::http {
namespace {

using Wrong = Error<std::string>;
constexpr unsigned kMappedBits = 96;
/// Wider ones hold strangers.
constexpr unsigned kFewestBits4 = 8, kFewestBits6 = 7;

struct Address {
  std::array<std::uint8_t, 16> bytes{};
  bool is_v4 = false;
};

std::optional<Address> address_of(std::string_view text) {
  const std::string word(text);
  Address address;
  if (::inet_pton(AF_INET, word.c_str(), address.bytes.data() + 12) == 1) {
    address.bytes[10] = address.bytes[11] = 0xFF;
    address.is_v4 = true;
    return address;
  }
  if (::inet_pton(AF_INET6, word.c_str(), address.bytes.data()) == 1) return address;
  return std::nullopt;
}

bool is_in(const std::array<std::uint8_t, 16>& address, const std::array<std::uint8_t, 16>& network,
           unsigned bits) {
  if (!std::equal(address.begin(), address.begin() + bits / 8, network.begin())) return false;
  if (bits % 8 == 0) return true;
  const unsigned mask = 0xFF00U >> (bits % 8);
  return ((address[bits / 8] ^ network[bits / 8]) & mask & 0xFFU) == 0;
}

/// "line 3: "
std::string place(const toml::node& node) {
  return "line " + std::to_string(node.source().begin.line) + ": ";
}

/// Why `table` has not just these keys, all of them texts; empty: it has.
std::string keys_wrong(const toml::table& table, std::initializer_list<const char*> keys) {
  for (const auto& entry : table) {
    const std::string_view name = entry.first.str();
    if (std::any_of(keys.begin(), keys.end(), [&](const char* known) { return name == known; })) continue;
    std::string expected;
    for (const char* known : keys) expected.append(expected.empty() ? "" : ", ").append(known);
    return "there is no key '" + std::string(name) + "' here (" + expected + ")";
  }
  for (const char* key : keys)
    if (!table[key].is_string()) return std::string("'") + key + "' is missing, or no text";
  return {};
}

std::string no_role(const std::string& word) {
  return "there is no role '" + word + "' (watch, operate, administer)";
}

std::string text_of(const toml::table& table, const char* key) {
  return table[key].value_or(std::string());
}

/// Why not; empty: added.
std::string add_user(const toml::table& table, std::vector<User>& users) {
  if (std::string wrong = keys_wrong(table, {"name", "role", "key"}); !wrong.empty()) return wrong;
  const std::string word = text_of(table, "role");
  const auto role = role_of(word);
  if (!role) return no_role(word);
  User user{.visitor = {text_of(table, "name"), *role, true}, .key = text_of(table, "key")};
  const std::string& name = user.visitor.name;
  if (name.empty()) return "a user has a name";
  if (user.key.size() < Users::kShortestKey)
    return "the key of '" + name +
           "' is too short (16 characters or more, such as of 'openssl rand -hex 16')";
  for (const User& other : users)
    if (other.key == user.key || other.visitor.name == name)
      return "'" + name + "' has the name or the key of another";
  users.push_back(std::move(user));
  return {};
}

/// The same.
std::string add_network(const toml::table& table, std::vector<TrustedNetwork>& networks) {
  if (std::string wrong = keys_wrong(table, {"network", "role"}); !wrong.empty()) return wrong;
  const std::string word = text_of(table, "role"), text = text_of(table, "network");
  const auto role = role_of(word);
  if (!role) return no_role(word);
  const std::string_view network = text;
  const std::size_t slash = std::min(network.find('/'), network.size());
  const std::string_view digits = network.substr(std::min(slash + 1, network.size()));
  const auto address = address_of(network.substr(0, slash));
  unsigned bits = 0;
  const auto number = std::from_chars(digits.data(), digits.data() + digits.size(), bits);
  const bool reads = address && !digits.empty() && number.ec == std::errc() &&
                     number.ptr == digits.data() + digits.size() && bits <= (address->is_v4 ? 32U : 128U);
  if (!reads) return "'" + text + "' is no network (such as 192.168.1.0/24 or fd00::/8)";
  if (bits < (address->is_v4 ? kFewestBits4 : kFewestBits6))
    return "'" + text + "' is too wide to be trusted (/8 or narrower)";
  if (*role == Role::kAdminister) return "who administers shows a key (watch, operate)";
  networks.push_back({text, address->bytes, bits + (address->is_v4 ? kMappedBits : 0U), *role});
  return {};
}

}  // namespace

const char* word_of(Role role) {
  switch (role) {
    case Role::kWatch:
      return "watch";
    case Role::kOperate:
      return "operate";
    case Role::kAdminister:
      return "administer";
    case Role::kNobody:
      break;
  }
  return "nobody";
}

std::optional<Role> role_of(std::string_view word) {
  for (const Role role : {Role::kWatch, Role::kOperate, Role::kAdminister})
    if (word == word_of(role)) return role;
  return std::nullopt;
}

Role role_for(const joblink::ClientMessage& message) {
  using Message = joblink::ClientMessage;
  switch (message.request_case()) {
    case Message::kHello:
    case Message::kPing:
    case Message::kWatch:
    case Message::kGetStatus:
    case Message::kListJobs:
    case Message::kReadJob:
    case Message::kGetHistory:
    case Message::kGetMachine:
    case Message::kGetEvents:
    case Message::kGetHeatCourse:
    case Message::kReadMachineFile:
    case Message::kStop:  // whoever sees that it must
    case Message::kReleaseControl:
      return Role::kWatch;
    case Message::kWriteMachineFile:
    case Message::kRestartGateway:
    case Message::kSetMotorCurrents:
    case Message::kTuneMotor:
    case Message::kJogMotor:
    case Message::kTuneHeater:
      return Role::kAdminister;
    default:
      return Role::kOperate;
  }
}

Users::Users(std::string key)
    : users_{{.visitor = {.role = Role::kAdminister, .has_key = true}, .key = std::move(key)}} {}

Result<Users, std::string> Users::read(std::string key, std::string_view toml) {
  const toml::parse_result parsed = toml::parse(toml);
  if (!parsed)
    return Wrong("line " + std::to_string(parsed.error().source().begin.line) + ": " +
                 std::string(parsed.error().description()));
  Users users(std::move(key));
  for (const auto& entry : parsed.table()) {
    const std::string name(entry.first.str());
    if (name != "user" && name != "trusted")
      return Wrong(place(entry.second) + "there is no '" + name + "' in such a file ([[user]], [[trusted]])");
    const toml::array* list = entry.second.as_array();
    if (list == nullptr || !list->is_homogeneous<toml::table>())
      return Wrong(place(entry.second) + "expected [[" + name + "]]");
    if (list->size() > kMost) return Wrong(place(entry.second) + "at most 100 of a kind");
    for (const toml::node& node : *list) {
      std::string wrong = name == "user" ? add_user(*node.as_table(), users.users_)
                                         : add_network(*node.as_table(), users.networks_);
      if (!wrong.empty()) return Wrong(place(node) + wrong);
    }
  }
  return users;
}

const User* Users::by_key(std::string_view key) const {
  const User* found = nullptr;
  for (const User& user : users_)
    if (same_key(key, user.key)) found = &user;
  return found;
}

Role Users::role_at(std::string_view address) const {
  const auto from = address_of(address);
  Role role = Role::kNobody;
  if (!from) return role;
  for (const TrustedNetwork& network : networks_)
    if (is_in(from->bytes, network.address, network.bits)) role = std::max(role, network.role);
  return role;
}

const User* Users::by_name(std::string_view name) const {
  const auto found =
      std::find_if(users_.begin(), users_.end(), [&](const User& user) { return user.visitor.name == name; });
  return found == users_.end() ? nullptr : &*found;
}

bool Users::same_by(const Users& fresh, const Visitor& visitor, std::string_view address) const {
  if (visitor.role == Role::kNobody) return true;
  if (!visitor.has_key) {
    const Role role = fresh.role_at(address);
    return role == role_at(address) && visitor.role <= role;
  }
  const User* const before = by_name(visitor.name);
  const User* const after = fresh.by_name(visitor.name);
  return before != nullptr && after != nullptr && same_key(before->key, after->key) &&
         before->visitor.role == after->visitor.role;
}

}  // namespace kinebus::http
