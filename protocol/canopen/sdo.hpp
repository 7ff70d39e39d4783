#pragma once
// What SDO server and client share: command bytes, and how a value is reached.

#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// What an SDO server serves. Values are reached in pieces, so that one may be longer than any buffer.
class SdoObjects {
 public:
  /// Puts the bytes from `offset` on into `out` (as many as fit), and the length of the whole value into
  /// `total`.
  virtual AbortCode sdo_read(ObjectAddress address, std::uint32_t offset, std::span<std::uint8_t> out,
                             std::uint32_t& total) = 0;
  /// Pieces come in order, the first with offset 0; a value of up to 889 bytes comes in one, with `last` set.
  virtual AbortCode sdo_write(ObjectAddress address, std::uint32_t offset,
                              std::span<const std::uint8_t> bytes, bool last) = 0;
  /// Bytes that a number has: what a client means that sends up to four without saying how many.
  virtual std::size_t sdo_size(ObjectAddress) const { return 4; }

 protected:
  ~SdoObjects() = default;
};

namespace sdo {

inline constexpr std::size_t kSegmentBytes = 7;
inline constexpr std::uint8_t kMaxBlockSize = 127;
inline constexpr std::size_t kBlockBytes = kSegmentBytes * kMaxBlockSize;

// Command specifiers: bits 5-7 of byte 0.
inline constexpr std::uint8_t kDownloadSegment = 0, kInitiateDownload = 1, kInitiateUpload = 2,
                              kUploadSegment = 3, kAbort = 4, kBlockUpload = 5, kBlockDownload = 6;
// Replies of the server.
inline constexpr std::uint8_t kReplyUploadSegment = 0, kReplyDownloadSegment = 1, kReplyInitiateUpload = 2,
                              kReplyInitiateDownload = 3, kReplyBlockDownload = 5, kReplyBlockUpload = 6;

constexpr std::uint8_t specifier(const CanFrame& frame) {
  return static_cast<std::uint8_t>(frame.data[0] >> 5);
}
constexpr ObjectAddress address_in(const CanFrame& frame) {
  return {get_u16_le(std::span(frame.data).subspan(1)), frame.data[3]};
}
/// A request that begins to write: download, block download.
constexpr bool begins_to_write(const CanFrame& frame) {
  return frame.length == 8 && (specifier(frame) == kInitiateDownload ||
                               (specifier(frame) == kBlockDownload && (frame.data[0] & 1) == 0));
}
constexpr CanFrame frame_of(std::uint32_t id, unsigned command) {
  CanFrame frame{.id = id, .length = 8};
  frame.data[0] = static_cast<std::uint8_t>(command);
  return frame;
}
constexpr CanFrame frame_of(std::uint32_t id, unsigned command, ObjectAddress address,
                            std::uint32_t data = 0) {
  CanFrame frame = frame_of(id, command);
  put_u16_le(std::span(frame.data).subspan(1), address.index);
  frame.data[3] = address.subindex;
  put_u32_le(std::span(frame.data).subspan(4), data);
  return frame;
}
constexpr CanFrame abort_frame(std::uint32_t id, ObjectAddress address, AbortCode code) {
  return frame_of(id, 0x80, address, static_cast<std::uint32_t>(code));
}
constexpr AbortCode abort_code_in(const CanFrame& frame) {
  return static_cast<AbortCode>(get_u32_le(std::span(frame.data).subspan(4)));
}

}  // namespace sdo
}  // namespace kinebus
