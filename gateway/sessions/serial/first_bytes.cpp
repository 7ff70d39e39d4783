#include "gateway/sessions/serial/first_bytes.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace kinebus::serial {
namespace {

constexpr std::array<std::string_view, 10> kMethods{"GET ",    "POST ",  "PUT ",     "HEAD ",  "OPTIONS ",
                                                    "DELETE ", "PATCH ", "CONNECT ", "TRACE ", "PRI "};

/// A method of the page's own choice may be a code of the machine's; the version at the line's end is not its
/// choice.
bool looks_like_http(std::string_view line) {
  return line.find("HTTP/") != std::string_view::npos ||
         std::any_of(kMethods.begin(), kMethods.end(),
                     [&](std::string_view method) { return line.starts_with(method); });
}

/// The first record of a TLS hand-shake.
bool looks_like_tls(std::string_view line) {
  return line.size() >= 2 && line[0] == 0x16 && line[1] == 0x03;
}

}  // namespace

FirstLine::Verdict FirstLine::take(std::span<const std::uint8_t> bytes) {
  if (verdict_ != Verdict::kNotYet) return verdict_;
  kept_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t end = std::min(kept_.find_first_of("\r\n"), kept_.size());
  const std::string_view line = std::string_view(kept_).substr(0, end);
  if (looks_like_http(line) || looks_like_tls(line) || end > kMaxBytes)
    verdict_ = Verdict::kForeign;
  else if (end < kept_.size())
    verdict_ = Verdict::kHost;
  return verdict_;
}

}  // namespace kinebus::serial
