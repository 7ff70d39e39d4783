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
/// The request was made by a page of another server, or may have been: of browsers that do not say it, all
/// are taken for such.
bool may_be_of_other_page(const Head& head);
/// What X-Api-Key or Authorization: Bearer says; empty: neither is there.
std::string_view shown_key(const Head& head);
/// Takes as long for a wrong key as for the right one.
bool same_key(std::string_view a, std::string_view b);
std::string hexadecimal(std::span<const unsigned char> bytes);
/// 128 random bits, in hexadecimal digits.
std::string unguessable();

}  // namespace kinebus::http
