#include "gateway/fleet/gateways_file.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "gateway/toml.hpp"

namespace kinebus::fleet {
namespace {

using Wrong = Error<std::string>;

std::string place(const toml::node& node) {
  return "line " + std::to_string(node.source().begin.line) + ": ";
}

/// Empty: every key is known and of its type.
std::string keys_wrong(const toml::table& table) {
  static constexpr std::initializer_list<const char*> kTexts{"name",       "socket", "tcp",     "fingerprint",
                                                             "token_file", "kind",   "material"};
  for (const auto& [key, value] : table) {
    const std::string name(key.str());
    if (name == "nozzle_mm") {
      if (!value.is_number() || value.value<double>().value_or(-1) <= 0)
        return place(value) + "nozzle_mm: expected a number above 0";
      continue;
    }
    if (std::find(kTexts.begin(), kTexts.end(), name) == kTexts.end())
      return place(value) + "there is no '" + name +
             "' of a gateway; expected name, socket, tcp, fingerprint, token_file, kind, material, nozzle_mm";
    if (!value.is_string() || value.value<std::string>().value_or("").empty())
      return place(value) + name + ": expected a text in quotes";
  }
  return {};
}

ServedGateway gateway_of(const toml::table& table) {
  const auto text = [&](const char* key) { return table[key].value_or(std::string()); };
  return {.machine = {.name = text("name"),
                      .kind = text("kind"),
                      .material = text("material"),
                      .nozzle_mm = table["nozzle_mm"].value_or(0.0)},
          .reach = {.client = "kinebus-fleet",
                    .socket = text("socket"),
                    .tcp = text("tcp"),
                    .fingerprint = text("fingerprint"),
                    .token_file = text("token_file")}};
}

std::string gateway_wrong(const ServedGateway& gateway, const std::vector<ServedGateway>& before) {
  if (gateway.machine.name.empty()) return "a gateway has a name";
  if (!is_name(gateway.machine.name)) return "name: expected " + std::string(kNameRule);
  if (gateway.reach.socket.empty() == gateway.reach.tcp.empty()) return "expected socket or tcp, one of them";
  for (const ServedGateway& other : before)
    if (other.machine.name == gateway.machine.name)
      return "the name '" + gateway.machine.name + "' is there twice";
  return {};
}

}  // namespace

bool is_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

kinebus::Result<std::vector<ServedGateway>, std::string> read_gateways(std::string_view toml) {
  const toml::parse_result parsed = toml::parse(toml);
  if (!parsed)
    return Wrong("line " + std::to_string(parsed.error().source().begin.line) + ": " +
                 std::string(parsed.error().description()));
  for (const auto& [key, value] : parsed.table())
    if (key.str() != "gateway")
      return Wrong(place(value) + "there is no '" + std::string(key.str()) +
                   "' in such a file; expected [[gateway]]");
  const toml::array* list = parsed.table()["gateway"].as_array();
  if (list == nullptr || list->empty() || !list->is_homogeneous<toml::table>())
    return Wrong("line 1: expected [[gateway]], one for each machine");
  std::vector<ServedGateway> gateways;
  for (const toml::node& node : *list) {
    const toml::table& table = *node.as_table();
    if (std::string wrong = keys_wrong(table); !wrong.empty()) return Wrong(std::move(wrong));
    ServedGateway gateway = gateway_of(table);
    if (const std::string wrong = gateway_wrong(gateway, gateways); !wrong.empty())
      return Wrong(place(node) + wrong);
    gateways.push_back(std::move(gateway));
  }
  return gateways;
}

}  // namespace kinebus::fleet
