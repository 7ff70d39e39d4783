#include "gateway/sessions/http/wire/authorization.hpp"

#include <algorithm>

#include "gateway/sessions/http/wire/http_reader.hpp"

namespace kinebus::http {
namespace {

constexpr std::size_t kMostParameters = 20;

void skip_blanks(std::string_view& rest) {
  while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\t')) rest.remove_prefix(1);
}

std::string small(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

/// Up to one of `ends`.
std::string_view take_until(std::string_view& rest, std::string_view ends) {
  const std::string_view taken = rest.substr(0, std::min(rest.find_first_of(ends), rest.size()));
  rest.remove_prefix(taken.size());
  return taken;
}

/// "..." with \x for x; nullopt: it does not end.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string text;
  for (std::size_t at = 1; at < rest.size(); ++at) {
    if (rest[at] == '"') {
      rest.remove_prefix(at + 1);
      return text;
    }
    if (rest[at] == '\\' && ++at == rest.size()) break;
    text.append(1, rest[at]);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::map<std::string, std::string>> authorization_parameters(std::string_view field,
                                                                           std::string_view scheme) {
  if (!same_word(take_until(field, " "), scheme)) return std::nullopt;
  std::map<std::string, std::string> parameters;
  while (skip_blanks(field), !field.empty()) {
    const std::string name = small(take_until(field, "= \t,\""));
    if (name.empty() || field.empty() || field.front() != '=') return std::nullopt;
    field.remove_prefix(1);
    std::optional<std::string> value;
    if (!field.empty() && field.front() == '"')
      value = take_quoted(field);
    else
      value = std::string(take_until(field, " \t,"));
    if (!value || !parameters.emplace(name, *value).second || parameters.size() > kMostParameters)
      return std::nullopt;
    skip_blanks(field);
    if (field.empty()) break;
    if (field.front() != ',') return std::nullopt;
    field.remove_prefix(1);
  }
  return parameters;
}

}  // namespace kinebus::http
