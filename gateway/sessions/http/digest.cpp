#include "gateway/sessions/http/digest.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>

#include "gateway/sessions/http/gate.hpp"
#include "gateway/sessions/http/wire/authorization.hpp"

namespace kinebus::http {
namespace {

constexpr const char* kRealm = "Printer API";

/// In hexadecimal digits.
std::string md5(const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), bytes.data(), &size, EVP_md5(), nullptr) != 1) std::abort();
  return hexadecimal({bytes.data(), size});
}

}  // namespace

Digest::Verdict Digest::look(const Head& head, const Users& users, LocalTime now) {
  const auto found = authorization_parameters(head.field("Authorization"), "Digest");
  if (!found) return {};
  const auto of = [&](const char* name) {
    const auto parameter = found->find(name);
    return parameter == found->end() ? std::string() : parameter->second;
  };
  const std::string algorithm = of("algorithm"), count = of("nc");
  std::uint32_t number = 0;
  const auto read = std::from_chars(count.data(), count.data() + count.size(), number, 16);
  if (of("realm") != kRealm || of("qop") != "auth" || (!algorithm.empty() && !same_word(algorithm, "MD5")) ||
      of("uri") != head.target || count.size() != 8 || read.ec != std::errc() ||
      read.ptr != count.data() + count.size())
    return {.shown = Shown::kWrong};
  std::string rest = ":" + of("nonce");
  rest.append(":").append(count).append(":").append(of("cnonce")).append(":auth:");
  rest += md5(head.method + ":" + head.target);
  const std::string named = of("username") + ":" + kRealm + ":", response = of("response");
  const User* who = nullptr;
  for (const User& user : users.all())
    if (std::string proof = md5(std::string(named).append(user.key));
        same_key(md5(proof.append(rest)), response))
      who = &user;
  if (who == nullptr) return {.shown = Shown::kWrong};
  const auto nonce = std::find_if(nonces_.begin(), nonces_.end(),
                                  [text = of("nonce")](const Nonce& one) { return one.text == text; });
  if (nonce == nonces_.end() || now >= nonce->until || number <= nonce->count)
    return {.shown = Shown::kStale};
  nonce->count = number;
  return {.shown = Shown::kKey, .user = who};
}

std::string Digest::challenge(LocalTime now, bool stale) {
  nonces_.push_back({unguessable(), now + kNonceFor});
  if (nonces_.size() > kMostNonces) nonces_.pop_front();
  return "Digest realm=\"" + std::string(kRealm) + "\", qop=\"auth\", algorithm=MD5, nonce=\"" +
         nonces_.back().text + (stale ? "\", stale=true" : "\"");
}

}  // namespace kinebus::http
