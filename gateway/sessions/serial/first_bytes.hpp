#pragma once
// A web page that a user looks at can send bytes to any port of his computer, and a browser's request holds
// lines of the page's choice. So a stream that a browser can reach begins with a line that is looked at
// first.

#include <cstdint>
#include <span>
#include <string>

namespace kinebus::serial {

class FirstLine {
 public:
  enum class Verdict : std::uint8_t { kNotYet, kHost, kForeign };

  /// Keeps what comes until its first line is whole. kHost: bytes() are to be taken, and all that follows as
  /// it comes. kForeign: HTTP, TLS, or no line within kMaxBytes: nothing of it is to be taken.
  Verdict take(std::span<const std::uint8_t> bytes);
  std::span<const std::uint8_t> bytes() const {
    return {reinterpret_cast<const std::uint8_t*>(kept_.data()), kept_.size()};
  }

 private:
  static constexpr std::size_t kMaxBytes = 1024;
  std::string kept_;
  Verdict verdict_ = Verdict::kNotYet;
};

}  // namespace kinebus::serial
