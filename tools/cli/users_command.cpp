#include "tools/cli/users_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "gateway/sessions/http/gate.hpp"
#include "gateway/sessions/http/users_text.hpp"
#include "tools/cli/secret_file.hpp"

namespace kinebus {
namespace {

using nlohmann::json;
constexpr const char* kPackagesFile = "/var/lib/kinebus/jobs/.tls/http-users.toml";

struct Asked {
  std::string file = kPackagesFile;
  std::string name{}, role{};
  bool own_key = false;
};
using Shared = std::shared_ptr<Asked>;
using Text = Result<std::string, std::string>;

/// No user may have the same; where it cannot be read here, kinebusd looks.
std::string gateway_key(const std::filesystem::path& users) {
  std::string key;
  std::ifstream(users.parent_path() / "http-key") >> key;
  return key.empty() ? http::unguessable() : key;
}

template <typename T>
T must(const Asked& asked, Result<T, std::string> result) {
  if (!result) throw std::runtime_error(fmt::format("{}: {}", asked.file, result.error()));
  return std::move(*result);
}

/// Reads the file, and puts in its place what `edit` makes of it.
void change(const Asked& asked, const std::function<Text(const http::UsersText&)>& edit) {
  const SecretFile file(asked.file);
  file.write(must(asked, edit(http::UsersText(file.read(), gateway_key(asked.file)))));
}

std::string new_key(const Asked& asked) {
  return asked.own_key ? read_secret("key (not shown): ") : http::unguessable();
}

/// A key that was made is shown this once, alone on standard output.
void tell_key(const Asked& asked, const std::string& key, json said, const bool& as_json) {
  if (!asked.own_key) said["key"] = key;
  if (as_json) return fmt::print("{}\n", said.dump());
  if (asked.own_key) return fmt::print("'{}' has the key that was given\n", asked.name);
  fmt::print(stderr, "the key of '{}', for X-Api-Key or as password; it is not shown again:\n", asked.name);
  fmt::print("{}\n", key);
}

void list(const Asked& asked, const bool& as_json) {
  const auto users =
      must(asked, http::UsersText(SecretFile(asked.file).read(), gateway_key(asked.file)).users());
  json all{{"users", json::array()}, {"trusted", json::array()}};
  for (const http::User& user : users.all()) {
    const auto& [name, role, has_key] = user.visitor;
    if (name.empty()) continue;  // the gateway's own
    all["users"].push_back({{"name", name}, {"role", word_of(role)}});
    if (!as_json) fmt::print("{:<11} {}\n", word_of(role), name);
  }
  for (const http::TrustedNetwork& network : users.networks()) {
    all["trusted"].push_back({{"network", network.text}, {"role", word_of(network.role)}});
    if (!as_json) fmt::print("{:<11} whoever comes from {}\n", word_of(network.role), network.text);
  }
  if (as_json) return fmt::print("{}\n", all.dump());
  fmt::print("{:<11} whoever has the gateway's own key\n", word_of(http::Role::kAdminister));
}

CLI::App* add(CLI::App& users, const Shared& asked, const char* name, const char* help) {
  auto* command = users.add_subcommand(name, help);
  command->add_option("name", asked->name, "The user")->required();
  return command;
}

CLI::Option* role_option(CLI::Option* option) {
  return option->required()->check(CLI::IsMember({"watch", "operate", "administer"}));
}

void own_key_flag(CLI::App* command, const Shared& asked) {
  command->add_flag(
      "--own-key", asked->own_key,
      "Read the key (16 characters or more) from standard input, where a terminal does not show it, "
      "instead of making one");
}

void add_changes(CLI::App& users, const Shared& asked, const bool& as_json) {
  auto* come = add(users, asked, "add", "A new user; its key is made, and shown this once");
  role_option(come->add_option("--role", asked->role, "watch, operate or administer"));
  own_key_flag(come, asked);
  come->callback([asked, &as_json] {
    const http::User user{.visitor = {asked->name, *http::role_of(asked->role), true},
                          .key = new_key(*asked)};
    change(*asked, [&](const http::UsersText& text) { return text.with(user); });
    tell_key(*asked, user.key, {{"name", asked->name}, {"role", asked->role}}, as_json);
  });
  auto* go = add(users, asked, "remove", "No user any more: what it has open is closed");
  go->callback([asked, &as_json] {
    change(*asked, [&](const http::UsersText& text) { return text.without(asked->name); });
    if (as_json) return fmt::print("{}\n", json{{"name", asked->name}}.dump());
    fmt::print("'{}' is no user any more\n", asked->name);
  });
  auto* role = add(users, asked, "role", "Gives a user another role");
  role_option(role->add_option("role", asked->role, "watch, operate or administer"));
  role->callback([asked, &as_json] {
    change(*asked, [&](const http::UsersText& text) {
      return text.with_role(asked->name, *http::role_of(asked->role));
    });
    if (as_json) return fmt::print("{}\n", json{{"name", asked->name}, {"role", asked->role}}.dump());
    fmt::print("'{}' may {}\n", asked->name, asked->role);
  });
  auto* key = add(users, asked, "key", "Gives a user another key; it is made, and shown this once");
  own_key_flag(key, asked);
  key->callback([asked, &as_json] {
    const std::string fresh = new_key(*asked);
    change(*asked, [&](const http::UsersText& text) { return text.with_key(asked->name, fresh); });
    tell_key(*asked, fresh, {{"name", asked->name}}, as_json);
  });
}

}  // namespace

void add_users_command(CLI::App& app, const bool& json) {
  const auto asked = std::make_shared<Asked>();
  auto* users =
      app.add_subcommand("users", "Who may ask by HTTP, with which role; kinebusd takes changes up at once");
  users->require_subcommand(1);
  users->fallthrough();
  users->add_option("--file", asked->file, "The file of kinebusd's --http-users")->capture_default_str();
  users->add_subcommand("list", "Users and trusted networks with their roles")->callback([asked, &json] {
    list(*asked, json);
  });
  add_changes(*users, asked, json);
}

}  // namespace kinebus
