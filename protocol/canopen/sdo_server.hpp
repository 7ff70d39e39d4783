#pragma once
// SDO server (CiA 301): expedited, segmented and block transfer in both directions, one transfer at a time.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/canopen/crc.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {

class SdoServer {
 public:
  struct Options {
    LocalTime timeout =
        std::chrono::milliseconds{1000};           ///< of silence within a transfer; then it is aborted
    std::uint8_t block_size = sdo::kMaxBlockSize;  ///< segments a block when downloading
  };
  struct Counters {
    std::uint32_t aborts_sent = 0, aborts_received = 0, timeouts = 0, malformed = 0, transfers = 0;
  };

  explicit SdoServer(SdoObjects& objects) : SdoServer(objects, Options{}) {}
  SdoServer(SdoObjects& objects, Options options) : objects_(objects), options_(options) {}

  /// Drops any transfer. Node 0: answers nobody.
  void reset(std::uint8_t node);

  /// Frames that are not a request to this node are passed over.
  void on_frame(LocalTime now, const CanFrame& frame);
  /// Answers a request to write that is not to be obeyed now; others are passed over. A transfer that is
  /// under way goes on.
  void refuse(const CanFrame& frame);
  void on_time(LocalTime now);
  /// Pull until empty. While a block is uploaded there is always a next frame until its last segment.
  std::optional<CanFrame> next_frame();
  LocalTime next_deadline() const { return busy() ? due_ : LocalTime::max(); }

  /// Called by the objects from within sdo_write(.., last = true): the answer waits for finish(), for example
  /// until a store to memory is done. Meanwhile other requests get kDeviceState.
  void defer() { deferring_ = true; }
  void finish(AbortCode result);
  bool deferred() const { return state_ == State::kDeferred; }

  bool busy() const { return state_ != State::kIdle && state_ != State::kDeferred; }
  const Counters& counters() const { return counters_; }

 private:
  enum class State : std::uint8_t {
    kIdle,
    kDownloadSegments,
    kUploadSegments,
    kBlockDownload,
    kBlockDownloadEnd,
    kBlockUploadStart,
    kBlockUpload,
    kBlockUploadReply,
    kBlockUploadEnd,
    kDeferred,
  };

  void initiate_download(const CanFrame& request);
  void download_segment(const CanFrame& request);
  void initiate_upload(const CanFrame& request);
  void upload_segment(const CanFrame& request);
  void initiate_block_download(const CanFrame& request);
  void block_download_segment(const CanFrame& request);
  void end_block_download(const CanFrame& request);
  void initiate_block_upload(const CanFrame& request);
  void block_upload_request(const CanFrame& request);
  CanFrame block_upload_segment();

  bool begin_upload(ObjectAddress address);
  AbortCode fill(std::uint32_t offset, std::span<std::uint8_t> out);
  AbortCode flush(bool last);
  void write_done(AbortCode result, const CanFrame& reply);
  void reply(const CanFrame& frame) { reply_ = frame; }
  void reply_upload_initiate();
  void abort(AbortCode code);
  std::uint32_t reply_id() const { return cob_id::kSdoReply + node_; }

  SdoObjects& objects_;
  Options options_;
  std::uint8_t node_ = 0;
  State state_ = State::kIdle;
  LocalTime due_{0};
  ObjectAddress address_{};
  std::optional<CanFrame> reply_;
  CanFrame deferred_reply_;
  bool deferring_ = false;

  std::array<std::uint8_t, sdo::kBlockBytes + sdo::kSegmentBytes> buffer_{};
  std::size_t buffered_ = 0;  // download: bytes waiting in buffer_
  std::uint32_t offset_ = 0;  // download: bytes written before those; upload: bytes the client has
  std::uint32_t total_ = 0;   // upload: length; download: announced length
  bool size_known_ = false;
  bool snapshot_ = false;  // upload: the whole value is in buffer_
  bool toggle_ = false;
  std::uint8_t block_size_ = 0;  // of the running block
  std::uint8_t sequence_ = 0;    // download: last good segment of the block; upload: last sent
  bool last_segment_ = false;
  bool with_crc_ = false;
  Crc16 crc_;  // download: over what was flushed; upload: over what the client has
  Counters counters_;
};

}  // namespace kinebus
