// Any message, read as an upload's chunk: what is found is what the library finds.

#include <cstdint>
#include <cstdlib>
#include <span>

#include "protocol/joblink/kinebus.pb.h"
#include "protocol/joblink/upload_chunk.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus::joblink;
  const auto chunk = read_chunk(std::span(data, size));
  if (!chunk) return 0;
  ClientMessage message;
  if (!message.ParseFromArray(data, static_cast<int>(size)) || !message.has_upload_chunk() ||
      message.request_id() != chunk->head.request_id ||
      message.upload_chunk().upload_id() != chunk->head.upload_id ||
      message.upload_chunk().offset_bytes() != chunk->head.offset_bytes ||
      message.upload_chunk().data() != chunk->data)
    std::abort();
  return 0;
}
