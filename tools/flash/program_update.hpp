#pragma once
// One node gets a new program over CAN, by CiA 302: the running program is stopped, the flash cleared, the
// image downloaded in blocks, checked and started. No input or output of its own; whatever was cut off
// before, it begins anew.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "node_firmware/boot/image_header.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/sdo_client.hpp"

namespace kinebus {

/// Ends a transfer that an update left open when it was cut off: within a block, a node takes any question
/// for a piece of it.
CanFrame end_of_transfer(std::uint8_t node);

/// Whether it is a whole image, for one of the boards that there are.
ImageCheck check_any_image(std::span<const std::uint8_t> image);
/// In words for the user; empty: nothing.
std::string what_is_wrong(ImageCheck check);

class ProgramUpdate {
 public:
  enum class Status : std::uint8_t { kBusy, kDone, kFailed };
  struct Options {
    /// An erase of 256 kB takes up to 4 s, in which a node says nothing.
    LocalTime answer = std::chrono::seconds{6};
    LocalTime boot = std::chrono::seconds{3};  ///< from a reset to the boot-up message
    int attempts = 3;  ///< downloads that fail by a timeout or a wrong CRC are repeated
    bool even_if_same = false;
    bool other_kind = false;  ///< the board may become another kind of node: of an axis, of heat
    bool protect = false;     ///< set what the boot loader finds unprotected (2122h)
    /// The board is recorded (2124h) as the one that the image is for, of this revision in tenths; 0: its
    /// record is only compared.
    std::uint32_t record_revision = 0;
  };

  /// `image`: as kinebus-node.bin; must stay. Failed at once when it is no image for a board.
  ProgramUpdate(std::uint8_t node, std::span<const std::uint8_t> image, LocalTime now,
                const Options& options);

  void on_frame(LocalTime now, const CanFrame& frame);
  void on_time(LocalTime now);
  std::optional<CanFrame> next_frame();
  LocalTime next_deadline() const;

  Status status() const { return status_; }
  /// What is done now, what went wrong, or that there was nothing to do.
  const std::string& message() const { return message_; }
  /// What the boot loader finds unprotected (ProgramFlash), when it was asked; one of before 2122h says
  /// nothing.
  std::uint8_t unprotected() const { return unprotected_; }
  /// Of the download, 0..100.
  int percent() const;
  std::uint8_t node() const { return node_; }

 private:
  enum class Step : std::uint8_t {
    kReadControl,
    kReadIdentity,
    kReadProgram,
    kStop,
    kAwaitBootLoader,
    kReadBoard,
    kReadRecord,
    kReadRevision,
    kRecord,
    kReadRoom,
    kClear,
    kDownload,
    kReadStatus,
    kReadProtection,
    kProtect,
    kStart,
    kAwaitProgram,
    kVerify,
  };

  void go(LocalTime now, Step step);
  void upload(LocalTime now, ObjectAddress address);
  void download(LocalTime now, ObjectAddress address, std::span<const std::uint8_t> bytes);
  void on_transfer(LocalTime now);
  void on_failed_transfer(LocalTime now);
  void on_identity(LocalTime now, std::uint32_t product_code);
  void on_boot_loader(LocalTime now);
  void on_record(LocalTime now, std::uint32_t hardware);
  void on_room(LocalTime now, std::uint32_t bytes);
  void fail(std::string message);

  Options options_;
  std::uint8_t node_;
  std::span<const std::uint8_t> image_;
  std::uint32_t crc_ = 0;
  SdoClient client_;
  Step step_ = Step::kReadControl;
  Status status_ = Status::kBusy;
  std::string message_;
  std::string refused_;  ///< why nothing is written: the program that was there runs on
  std::array<std::uint8_t, 8> value_{};
  std::array<std::uint8_t, 1> command_{};
  std::optional<CanFrame> before_;  ///< goes ahead of the transfer that was begun
  LocalTime boot_due_ = LocalTime::max();
  bool in_boot_loader_ = false;
  bool known_board_ = false;  ///< 1018h:2 was the board's, not that of a node that may be on any
  bool same_ = false;         ///< the program is there: only protection is wanted
  std::uint8_t unprotected_ = 0;
  std::array<std::uint8_t, 4> signature_{}, revision_{};
  int attempts_left_;
};

}  // namespace kinebus
