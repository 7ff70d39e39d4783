#pragma once
// Who may ask: a client with the key, by a name of this computer, and no page of another server.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gateway/sessions/http/wire/http_reader.hpp"

namespace kinebus::http {

struct GateRefusal {
  int status;
  std::string_view why;
};

/// Why a request with this head is not carried out, whoever sends it; nullopt: it may come in. `names`:
/// Server::Options::names.
std::optional<GateRefusal> refusal_at_gate(const Head& head, std::span<const std::string> names);
/// X-Api-Key, or Authorization: Bearer.
bool shows_key(const Head& head, std::string_view key);
/// Takes as long for a wrong key as for the right one.
bool same_key(std::string_view a, std::string_view b);
std::string hexadecimal(std::span<const unsigned char> bytes);
/// 128 random bits, in hexadecimal digits.
std::string unguessable();

}  // namespace kinebus::http
