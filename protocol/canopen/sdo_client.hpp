#pragma once
// SDO client (CiA 301): one transfer at a time with one server. The caller's memory holds the data and must
// stay valid until the transfer is no longer busy.

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/canopen/crc.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {

class SdoClient {
 public:
  enum class Method : std::uint8_t {
    kAutomatic,  ///< expedited up to 4 bytes, segmented up to 64, else block
    kSegmented,  ///< expedited up to 4 bytes, else segmented
    kBlock,
  };
  enum class Status : std::uint8_t { kIdle, kBusy, kDone, kFailed };
  struct Options {
    LocalTime timeout = std::chrono::milliseconds{500};
    std::uint8_t block_size = sdo::kMaxBlockSize;
  };

  SdoClient() = default;
  explicit SdoClient(Options options) : options_(options) {}

  /// False: busy, or nothing to send. Either begins a transfer with `node`.
  bool download(LocalTime now, std::uint8_t node, ObjectAddress address, std::span<const std::uint8_t> bytes,
                Method method = Method::kAutomatic);
  bool upload(LocalTime now, std::uint8_t node, ObjectAddress address, std::span<std::uint8_t> room,
              Method method = Method::kSegmented);
  /// Ends a transfer from this side; the server is told.
  void cancel(AbortCode code = AbortCode::kGeneral);

  /// Frames of other servers are passed over.
  void on_frame(LocalTime now, const CanFrame& frame);
  void on_time(LocalTime now);
  std::optional<CanFrame> next_frame();
  LocalTime next_deadline() const { return status_ == Status::kBusy ? due_ : LocalTime::max(); }

  Status status() const { return status_; }
  /// Why it failed: from the server, or kTimeout, kCrc, ... found here.
  AbortCode abort_code() const { return abort_code_; }
  /// Uploaded so far; after kDone the length of the value.
  std::size_t received() const { return at_; }
  std::uint8_t node() const { return node_; }
  ObjectAddress address() const { return address_; }

 private:
  enum class State : std::uint8_t {
    kIdle,
    kInitiateDownload,
    kDownloadSegment,
    kInitiateUpload,
    kUploadSegment,
    kInitiateBlockDownload,
    kBlockDownload,
    kBlockDownloadReply,
    kBlockDownloadEnd,
    kInitiateBlockUpload,
    kBlockUpload,
    kBlockUploadEnd,
  };

  void begin(LocalTime now, std::uint8_t node, ObjectAddress address, State state);
  void done();
  void fail(AbortCode code, bool tell);
  void send_download_segment();
  CanFrame block_segment();
  void on_initiate_upload(const CanFrame& reply);
  void on_upload_segment(const CanFrame& reply);
  void on_block_download(const CanFrame& reply);
  void on_block_upload(const CanFrame& reply);
  void on_block_upload_segment(const CanFrame& reply);
  std::uint32_t request_id() const { return cob_id::kSdoRequest + node_; }

  Options options_{};
  Status status_ = Status::kIdle;
  State state_ = State::kIdle;
  AbortCode abort_code_ = AbortCode::kNone;
  std::uint8_t node_ = 0;
  ObjectAddress address_{};
  LocalTime due_{0}, now_{0};
  std::optional<CanFrame> request_;
  std::span<const std::uint8_t> out_{};
  std::span<std::uint8_t> in_{};
  std::size_t at_ = 0;       // bytes confirmed (download) or kept (upload)
  std::uint32_t total_ = 0;  // announced by the server
  bool size_known_ = false;
  bool toggle_ = false;
  std::uint8_t block_size_ = 0, sequence_ = 0;
  bool last_segment_ = false;
  bool with_crc_ = false;
};

}  // namespace kinebus
