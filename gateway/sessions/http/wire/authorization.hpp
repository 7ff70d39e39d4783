#pragma once
// The field Authorization with parameters (RFC 9110, 11.4): Digest username="maker", nc=00000001.

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kinebus::http {

/// Parameters by their names in small letters, values without quotes. nullopt: not of this scheme, or
/// malformed, or one is there twice.
std::optional<std::map<std::string, std::string>> authorization_parameters(std::string_view field,
                                                                           std::string_view scheme);

}  // namespace kinebus::http
