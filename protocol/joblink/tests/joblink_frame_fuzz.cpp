// Any bytes, cut anywhere, into the frame reader and into a client in the midst of its session.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

#include "protocol/joblink/client.hpp"

namespace {
class Zeros : public kinebus::joblink::UploadSource {
 public:
  std::size_t read(std::uint64_t, std::span<char> buffer) override {
    std::fill(buffer.begin(), buffer.end(), '0');
    return buffer.size();
  }
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus::joblink;
  Client client({.name = "fuzz", .version = {}, .token = {}, .session_seed = 1});
  client.on_connected(kinebus::LocalTime{0});
  client.upload({.name = "a", .size_bytes = 100'000, .hash = std::string(32, 'x')},
                std::make_unique<Zeros>());
  kinebus::LocalTime now{0};
  std::span<const std::uint8_t> rest(data, size);
  while (!rest.empty()) {
    // The first byte of a piece is its length: 255 passes time instead.
    const std::size_t piece = std::min<std::size_t>(rest.front(), rest.size() - 1);
    now += std::chrono::milliseconds{rest.front() == 255 ? 5000 : 1};
    client.on_bytes(now, rest.subspan(1, piece));
    client.on_time(now);
    client.on_bytes_sent(client.next_bytes().size() / 2);
    while (client.next_news()) {
    }
    rest = rest.subspan(1 + piece);
  }
  return 0;
}
