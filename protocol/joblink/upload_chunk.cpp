#include "protocol/joblink/upload_chunk.hpp"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>

#include <cassert>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::joblink {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;
using google::protobuf::io::CodedOutputStream;

constexpr std::uint32_t tag(int field, WireFormatLite::WireType type) {
  return static_cast<std::uint32_t>(field) << 3U | static_cast<std::uint32_t>(type);
}
constexpr std::uint32_t kRequestId =
    tag(ClientMessage::kRequestIdFieldNumber, WireFormatLite::WIRETYPE_VARINT);
constexpr std::uint32_t kChunk =
    tag(ClientMessage::kUploadChunkFieldNumber, WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
constexpr std::uint32_t kUploadId = tag(UploadChunk::kUploadIdFieldNumber, WireFormatLite::WIRETYPE_VARINT);
constexpr std::uint32_t kOffset = tag(UploadChunk::kOffsetBytesFieldNumber, WireFormatLite::WIRETYPE_VARINT);
constexpr std::uint32_t kData = tag(UploadChunk::kDataFieldNumber, WireFormatLite::WIRETYPE_LENGTH_DELIMITED);

std::size_t chunk_bytes(const ChunkHead& head, std::size_t data_bytes) {
  return CodedOutputStream::VarintSize32(kUploadId) + CodedOutputStream::VarintSize32(head.upload_id) +
         CodedOutputStream::VarintSize32(kOffset) + CodedOutputStream::VarintSize64(head.offset_bytes) +
         CodedOutputStream::VarintSize32(kData) + CodedOutputStream::VarintSize64(data_bytes) + data_bytes;
}

/// A length, by the library's rule: at most five bytes, and below 2^31.
bool read_length(CodedInputStream& in, std::uint32_t& length) {
  const int begin = in.CurrentPosition();
  std::uint64_t value = 0;
  if (!in.ReadVarint64(&value) || in.CurrentPosition() - begin > 5 || value > 0x7FFF'FFFF) return false;
  length = static_cast<std::uint32_t>(value);
  return true;
}

/// The fields of the chunk itself, which are all that is left in `in`.
bool read_fields(CodedInputStream& in, std::span<const std::uint8_t> message, ChunkView& view) {
  while (const std::uint32_t field = in.ReadTag()) {
    if (field == kUploadId) {
      if (!in.ReadVarint32(&view.head.upload_id)) return false;
    } else if (field == kOffset) {
      if (!in.ReadVarint64(&view.head.offset_bytes)) return false;
    } else if (field == kData) {
      std::uint32_t size = 0;
      if (!read_length(in, size)) return false;
      const auto begin = static_cast<std::size_t>(in.CurrentPosition());
      if (size > message.size() - begin || !in.Skip(static_cast<int>(size))) return false;
      view.data = {reinterpret_cast<const char*>(message.data()) + begin, size};
    } else {
      return false;
    }
  }
  return in.ConsumedEntireMessage();
}

}  // namespace

std::size_t chunk_message_bytes(const ChunkHead& head, std::size_t data_bytes) {
  const std::size_t chunk = chunk_bytes(head, data_bytes);
  return CodedOutputStream::VarintSize32(kRequestId) + CodedOutputStream::VarintSize32(head.request_id) +
         CodedOutputStream::VarintSize32(kChunk) + CodedOutputStream::VarintSize64(chunk) + chunk;
}

std::span<std::uint8_t> write_chunk(const ChunkHead& head, std::size_t data_bytes,
                                    std::span<std::uint8_t> message) {
  assert(message.size() == chunk_message_bytes(head, data_bytes));
  std::uint8_t* at = message.data();
  at = CodedOutputStream::WriteVarint32ToArray(kRequestId, at);
  at = CodedOutputStream::WriteVarint32ToArray(head.request_id, at);
  at = CodedOutputStream::WriteVarint32ToArray(kChunk, at);
  at = CodedOutputStream::WriteVarint64ToArray(chunk_bytes(head, data_bytes), at);
  at = CodedOutputStream::WriteVarint32ToArray(kUploadId, at);
  at = CodedOutputStream::WriteVarint32ToArray(head.upload_id, at);
  at = CodedOutputStream::WriteVarint32ToArray(kOffset, at);
  at = CodedOutputStream::WriteVarint64ToArray(head.offset_bytes, at);
  at = CodedOutputStream::WriteVarint32ToArray(kData, at);
  at = CodedOutputStream::WriteVarint64ToArray(data_bytes, at);
  assert(at + data_bytes == message.data() + message.size());
  return {at, data_bytes};
}

std::optional<ChunkView> read_chunk(std::span<const std::uint8_t> message) {
  CodedInputStream in(message.data(), static_cast<int>(message.size()));
  ChunkView view;
  bool found = false;
  while (const std::uint32_t field = in.ReadTag()) {
    if (field == kRequestId) {
      if (!in.ReadVarint32(&view.head.request_id)) return std::nullopt;
    } else if (field == kChunk && !found) {
      std::uint32_t size = 0;
      if (!read_length(in, size)) return std::nullopt;
      if (size > message.size() - static_cast<std::size_t>(in.CurrentPosition())) return std::nullopt;
      const auto outer = in.PushLimit(static_cast<int>(size));
      if (!read_fields(in, message, view)) return std::nullopt;
      in.PopLimit(outer);
      found = true;
    } else {
      return std::nullopt;
    }
  }
  if (!found || !in.ConsumedEntireMessage()) return std::nullopt;
  return view;
}

}  // namespace kinebus::joblink
