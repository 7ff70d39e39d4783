#pragma once
// HTTP Digest (RFC 7616) with MD5 and qop=auth, as PrusaLink's clients have it: a user's key is the password
// of whatever name, and does not go over the wire.

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "gateway/sessions/http/users.hpp"
#include "gateway/sessions/http/wire/http_reader.hpp"
#include "protocol/time.hpp"

namespace kinebus::http {

class Digest {
 public:
  static constexpr LocalTime kNonceFor = std::chrono::minutes{5};
  static constexpr std::size_t kMostNonces = 200;  ///< the oldest goes for a new one

  enum class Shown : std::uint8_t { kNothing, kKey, kWrong, kStale };
  struct Verdict {
    Shown shown = Shown::kNothing;
    const User* user = nullptr;  ///< whose key it is
  };
  /// What a request with this head shows. kStale: right, but for its nonce, which is too old or was used
  /// already.
  Verdict look(const Head& head, const Users& users, LocalTime now);
  /// The value of WWW-Authenticate.
  std::string challenge(LocalTime now, bool stale);

 private:
  struct Nonce {
    std::string text;
    LocalTime until;
    std::uint32_t count = 0;  ///< of the last request with it
  };
  std::deque<Nonce> nonces_;
};

}  // namespace kinebus::http
