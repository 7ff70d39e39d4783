#include "gateway/sessions/http/gate.hpp"

#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace kinebus::http {
namespace {

std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, std::min(host.find(']'), host.size() - 1) + 1);
  return host.substr(0, host.find(':'));
}

/// "10.0.0.7" or "[fe80::1]": no name, and so no page of another server can have it.
bool is_address(std::string_view host) {
  if (host.starts_with('[')) return host.ends_with(']');
  return !host.empty() && host.find_first_not_of("0123456789.") == std::string_view::npos;
}

bool host_is_ours(std::string_view host, std::span<const std::string> names) {
  const std::string_view name = without_port(host);
  if (is_address(name) || same_word(name, "localhost")) return true;
  return std::any_of(names.begin(), names.end(), [&](const std::string& n) { return same_word(n, name); });
}

/// A page of this server: "http://HOST" or "https://HOST".
bool is_own_origin(std::string_view origin, std::string_view host) {
  if (!origin.ends_with(host)) return false;
  const std::string_view scheme = origin.substr(0, origin.size() - host.size());
  return same_word(scheme, "http://") || same_word(scheme, "https://");
}

}  // namespace

bool same_key(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string hexadecimal(std::span<const unsigned char> bytes) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) text.append(1, kDigits[byte >> 4U]).append(1, kDigits[byte & 15U]);
  return text;
}

std::string unguessable() {
  std::array<unsigned char, 16> bytes{};
  // Without randomness nobody may be let in.
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) std::abort();
  return hexadecimal(bytes);
}

bool may_be_of_other_page(const Head& head) {
  const std::string_view site = head.field("Sec-Fetch-Site");
  if (site.empty()) return head.field("User-Agent").starts_with("Mozilla/") && head.field("Origin").empty();
  return site != "same-origin" && site != "none";
}

std::string_view shown_key(const Head& head) {
  static constexpr std::string_view kBearer = "Bearer ";
  const std::string_view authorization = head.field("Authorization");
  if (const std::string_view key = head.field("X-Api-Key"); !key.empty()) return key;
  return authorization.starts_with(kBearer) ? authorization.substr(kBearer.size()) : std::string_view();
}

std::optional<GateRefusal> refusal_at_gate(const Head& head, std::span<const std::string> names) {
  static constexpr std::string_view kOtherPage = "pages of other servers may not ask this one";
  const std::string_view host = head.field("Host");
  if (head.count("Host") != 1 || host.empty()) return GateRefusal{400, "a request names one Host"};
  if (!host_is_ours(host, names))
    return GateRefusal{403, "this computer is not known by the name in Host (--http-name)"};
  const std::string_view origin = head.field("Origin");
  if (!origin.empty() && !is_own_origin(origin, host)) return GateRefusal{403, kOtherPage};
  const std::string_view site = head.field("Sec-Fetch-Site");
  // Who follows a link to the page gets the page, and nothing that needs the key.
  const bool comes_by_link = head.field("Sec-Fetch-Mode") == "navigate" && head.method == "GET";
  if (!site.empty() && site != "same-origin" && site != "none" && !comes_by_link)
    return GateRefusal{403, kOtherPage};
  const std::string_view expected = head.field("Expect");
  if (!expected.empty() && !same_word(expected, "100-continue"))
    return GateRefusal{417, "the only expectation that can be met is 100-continue"};
  return std::nullopt;
}

}  // namespace kinebus::http
