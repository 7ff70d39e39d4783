#pragma once
// What a request is about: the path in its target, decoded, piece by piece.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinebus::http {

struct Target {
  /// "/api/files/local/a%20b.gcode?x=1": "api", "files", "local", "a b.gcode". No piece is empty, "." or ".."
  std::vector<std::string> path;
  std::string query;  ///< as it came
};

/// nullopt: no path of this server ("http://...", "*", a broken %, a NUL, a step upwards).
std::optional<Target> parse_target(std::string_view target);

/// "a=1&b=x%20y": names and values, decoded; '+' is a space. nullopt: a broken %, or a NUL.
std::optional<std::vector<std::pair<std::string, std::string>>> query_fields(std::string_view query);
/// "a%20b": "a b". nullopt: a % without two digits, or a NUL.
std::optional<std::string> percent_decoded(std::string_view text);
/// A piece of a path: what is not a letter, a digit or one of -._~ as %XX.
std::string percent_encoded(std::string_view text);

}  // namespace kinebus::http
