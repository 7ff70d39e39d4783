#pragma once
// Who may ask: a client with the key, by a name of this computer, and no page of another server.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gateway/sessions/http/http_reader.hpp"

namespace kinebus::http {

struct GateRefusal {
  int status;
  std::string_view why;
};

/// Why a request with this head is not carried out; nullopt: it may come in. `names`: Server::Options::names.
std::optional<GateRefusal> refusal_at_gate(const Head& head, std::string_view key,
                                           std::span<const std::string> names);

}  // namespace kinebus::http
