#pragma once
// Requests of HTTP/1.1 (RFC 9112) out of bytes, sans-IO: head, body in pieces, end. Who reads gives the bytes
// that wait, and removes what was taken. The work is done by Boost.Beast's parser, which is strict: a request
// that could be read in two ways (two lengths, a length and chunks) is refused.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinebus::http {

struct Head {
  std::string method;
  std::string target;
  std::vector<std::pair<std::string, std::string>> fields;
  bool keep_alive = false;
  bool chunked = false;
  std::optional<std::uint64_t> content_length;

  /// Of the first field of this name, in any case; empty: there is none.
  std::string_view field(std::string_view name) const;
  std::size_t count(std::string_view name) const;
  bool has_body() const { return chunked || content_length.value_or(0) > 0; }
};

/// "Content-Type" and "content-type" are one.
bool same_word(std::string_view a, std::string_view b);

class Reader {
 public:
  static constexpr std::size_t kMaxHeadBytes = 16U << 10;
  enum class Step : std::uint8_t {
    kMore,  ///< more bytes are needed
    kHead,  ///< head() is there
    kBody,  ///< body() is there, until the next call
    kEnd,   ///< the request is whole
    kBad,   ///< bad_status(), bad_why(); nothing can be read after it
  };
  struct Taken {
    Step step{};
    std::size_t count = 0;  ///< bytes of the front that are done with
  };

  Reader();
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  Taken take(std::string_view bytes);
  /// After kEnd: another request follows.
  void next();

  const Head& head() const;
  std::string_view body() const;
  int bad_status() const { return bad_status_; }
  const std::string& bad_why() const { return bad_why_; }
  /// Nothing of a request has come yet.
  bool idle() const;

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
  bool head_told_ = false;
  int bad_status_ = 0;
  std::string bad_why_;
};

}  // namespace kinebus::http
