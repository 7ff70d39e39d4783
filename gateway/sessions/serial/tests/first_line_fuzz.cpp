// Any bytes, cut anywhere, as the beginning of a stream: the verdict does not depend on the cuts, and what a
// browser sends is never taken.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "gateway/sessions/serial/first_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using kinebus::serial::FirstLine;
  if (size < 1) return 0;
  std::string stream = data[0] % 2 == 0 ? std::string() : std::string("POST /x HTTP/1.1\r\n");
  stream.append(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(stream.data()),
                                            stream.size());
  const auto verdict = [&](std::size_t piece) {
    FirstLine first;
    auto found = FirstLine::Verdict::kNotYet;
    for (std::size_t i = 0; i < bytes.size() && found == FirstLine::Verdict::kNotYet; i += piece)
      found = first.take(bytes.subspan(i, std::min(piece, bytes.size() - i)));
    return found;
  };
  const auto whole = verdict(std::max<std::size_t>(bytes.size(), 1));
  if (verdict(1) != whole || verdict(13) != whole) std::abort();
  if (stream.starts_with("POST ") && whole != FirstLine::Verdict::kForeign) std::abort();
  return 0;
}
