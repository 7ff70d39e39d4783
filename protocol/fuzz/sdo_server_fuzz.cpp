// Any sequence of requests, lengths and pauses: the server answers with well-formed frames, ends every block,
// and is free again after silence.
#include <cstdlib>

#include "protocol/fuzz/dictionary_node.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  DictionaryNode node;
  FrameSource source(data, size);
  LocalTime now{0};
  std::uint8_t kind = 0;
  CanFrame frame;
  while (source.next(kind, frame)) {
    frame.id = cob_id::kSdoRequest + 1;
    if (kind >= 0xF8) frame.length = kind & 7;
    now += std::chrono::milliseconds{(kind & 7) == 7 ? 600 : 1};
    node.server.on_time(now);
    node.server.on_frame(now, frame);
    int replies = 0;
    while (const auto reply = node.server.next_frame()) {
      if (reply->id != cob_id::kSdoReply + 1 || reply->length != 8) std::abort();
      if (++replies > sdo::kMaxBlockSize + 1) std::abort();
    }
  }
  node.server.on_time(now + std::chrono::seconds{2});
  if (node.server.busy()) std::abort();
  return 0;
}
