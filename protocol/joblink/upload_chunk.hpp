#pragma once
// A ClientMessage with an UploadChunk, written and read where it lies: nearly all bytes of a link are in such
// messages, and the library would copy each of them three times more.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace kinebus::joblink {

struct ChunkHead {
  std::uint32_t request_id = 0;
  std::uint32_t upload_id = 0;
  std::uint64_t offset_bytes = 0;
};

/// What the message takes that carries `data_bytes` of the upload.
std::size_t chunk_message_bytes(const ChunkHead& head, std::size_t data_bytes);
/// Writes the message but for the data; returns the room for them, which is the end of `message`, a span of
/// chunk_message_bytes().
std::span<std::uint8_t> write_chunk(const ChunkHead& head, std::size_t data_bytes,
                                    std::span<std::uint8_t> message);

struct ChunkView {
  ChunkHead head;
  std::string_view data;  ///< within the message
};
/// nullopt: another message, or one that only the library reads (fields of a later version among them).
std::optional<ChunkView> read_chunk(std::span<const std::uint8_t> message);

}  // namespace kinebus::joblink
