#pragma once
// Who may ask, and for what: clients that show a key, and those of networks that need none.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/result.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::http {

/// Each may do what those before it may.
enum class Role : std::uint8_t {
  kNobody,
  kWatch,       ///< sees all, and may stop the machine in an emergency
  kOperate,     ///< jobs, moves, heat
  kAdminister,  ///< machine file, motors, what stays in the nodes
};
/// "watch"
const char* word_of(Role role);
/// nullopt: there is no such word.
std::optional<Role> role_of(std::string_view word);
/// What a request needs.
Role role_for(const joblink::ClientMessage& message);

struct Visitor {
  std::string name{};  ///< empty: the holder of the gateway's key, or a client of a trusted network
  Role role = Role::kNobody;
  bool has_key = false;  ///< else it may what its network may
};
struct User {
  Visitor visitor{};
  std::string key{};
};

struct TrustedNetwork {
  std::string text{};                      ///< "192.168.1.0/24"
  std::array<std::uint8_t, 16> address{};  ///< of IPv6, or mapped into it
  unsigned bits = 0;
  Role role = Role::kNobody;
};

class Users {
 public:
  static constexpr std::size_t kShortestKey = 16;
  static constexpr std::size_t kMost = 100;

  /// One, with the gateway's key, who administers.
  explicit Users(std::string key);
  /// And those of a file (TOML): [[user]] name, role, key; [[trusted]] network ("192.168.1.0/24"), role. The
  /// error names what is wrong and what was expected.
  static Result<Users, std::string> read(std::string key, std::string_view toml);

  const std::vector<User>& all() const { return users_; }
  const std::vector<TrustedNetwork>& networks() const { return networks_; }
  /// Who has this key, which takes as long for each; nullptr: nobody.
  const User* by_key(std::string_view key) const;
  /// Of who comes from `address` ("10.0.0.7", "fe80::1"; anything else is trusted by nobody) without a key.
  Role role_at(std::string_view address) const;
  /// `visitor`, who came in from `address` by these, would come in as the very same by `fresh`; nobody would.
  bool same_by(const Users& fresh, const Visitor& visitor, std::string_view address) const;

 private:
  const User* by_name(std::string_view name) const;

  std::vector<User> users_;
  std::vector<TrustedNetwork> networks_;
};

}  // namespace kinebus::http
