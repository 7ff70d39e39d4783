#pragma once
// The boot loader's CANopen side, without input or output of its own: program download by CiA 302 (1F50h,
// 1F51h, 1F56h, 1F57h) with SDO block transfer, boot-up and heartbeat, LSS for a node without id. It never
// writes where it runs itself, and a program starts only when its CRC is right: whenever the power goes, what
// answers next is the old program, the new one, or this.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/boot/board_record.hpp"
#include "node_firmware/boot/image_header.hpp"
#include "protocol/canopen/heartbeat.hpp"
#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/sdo_server.hpp"

namespace kinebus {

/// The flash that holds the program: one erase for all of it. And what the chip can keep from being lost for
/// good.
class ProgramFlash {
 public:
  /// Bits of what is missing. 1: the chip's brown-out reset at the lowest supply at which it works; 2: the
  /// boot loader's own flash is write protected.
  static constexpr std::uint8_t kNoBrownOut = 1, kBootLoaderOpen = 2;
  virtual std::uint8_t unprotected() const { return 0; }
  /// Sets both, for good: the boot loader itself is not changed over CAN any more (nor ever was).
  virtual bool protect() { return true; }
  /// The board's records (board_record), and another one, which stays for good.
  virtual std::span<const std::uint8_t> records() const { return {}; }
  virtual bool add_record(const BoardRecord&) { return false; }
  virtual std::span<const std::uint8_t> bytes() const = 0;
  virtual bool erase() = 0;
  /// Words come one behind the other, and whole units of them: what some flashes program at once.
  static constexpr std::uint32_t kUnit = 8;
  virtual bool program(std::uint32_t offset, std::uint32_t word) = 0;

 protected:
  ~ProgramFlash() = default;
};

/// 1F57h, bits 1 to 7.
enum class ProgramStatus : std::uint8_t {
  kGood = 0,
  kNoProgram = 1,
  kUnknownFormat = 2,
  kFormatError = 3,
  kNotCleared = 4,
  kWriteError = 5,
  kAddressError = 6,
};

/// 2122h, chip protection: what is missing (ProgramFlash); writing the signature sets it.
inline constexpr ObjectAddress kChipProtection{0x2122, 0};
inline constexpr std::uint32_t kProtectSignature = 0x746F'7270;  // "prot"

/// 2123h, for how many bytes of program there is room. A boot loader that does not have it was built for
/// kFirstProgramRoom.
inline constexpr ObjectAddress kProgramRoom{0x2123, 0};
inline constexpr std::uint32_t kFirstProgramRoom = 0x2'0000;

/// 2124h, the board's record: 1 hardware, 2 revision, 3 serial number; all 0: it has none. Writing the
/// revision, 1 to 999 tenths, adds one with this boot loader's hardware and the chip's serial number: for
/// good.
inline constexpr ObjectAddress kRecordedHardware{0x2124, 1}, kRecordedRevision{0x2124, 2};
inline constexpr std::uint32_t kHighestRevision = 999;

/// 1F51h.
namespace program_control {
inline constexpr std::uint8_t kStop = 0, kStart = 1, kReset = 2, kClear = 3;
}

class BootLoader final : private SdoObjects {
 public:
  /// `node_id` 0: waits for LSS. Takes programs for `board` only.
  BootLoader(const ImageTarget& board, const LssIdentity& identity, std::uint8_t node_id, ProgramFlash& flash,
             LocalTime now);
  BootLoader(const BootLoader&) = delete;
  BootLoader& operator=(const BootLoader&) = delete;

  void on_frame(LocalTime now, const CanFrame& frame);
  void on_time(LocalTime now);
  std::optional<CanFrame> next_frame();

  /// The master wants the program to run, and it is good: to be asked when next_frame() is empty; reset then.
  bool start_requested() const { return start_requested_; }
  std::uint8_t node_id() const { return node_id_; }
  ProgramStatus status() const { return status_; }

 private:
  AbortCode sdo_read(ObjectAddress address, std::uint32_t offset, std::span<std::uint8_t> out,
                     std::uint32_t& total) override;
  AbortCode sdo_write(ObjectAddress address, std::uint32_t offset, std::span<const std::uint8_t> bytes,
                      bool last) override;
  AbortCode control(std::uint8_t command);
  AbortCode protect(std::span<const std::uint8_t> signature);
  AbortCode record(std::uint32_t revision);
  AbortCode write_program(std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last);
  AbortCode put(std::uint8_t byte);
  AbortCode fail(ProgramStatus status, AbortCode code);
  void set_node_id(std::uint8_t node_id, LocalTime now);
  void look();

  ImageTarget board_;
  LssIdentity identity_;
  ProgramFlash& flash_;
  SdoServer sdo_;
  NmtSlave nmt_;
  LssSlave lss_;
  HeartbeatProducer heartbeat_;
  LocalTime now_;
  std::uint8_t node_id_ = 0;
  std::optional<CanFrame> boot_up_;
  ProgramStatus status_ = ProgramStatus::kGood;
  bool start_requested_ = false;
  // Download: the word that is not whole yet, and where it goes.
  std::array<std::uint8_t, 4> word_{};
  std::uint32_t written_ = 0;
};

}  // namespace kinebus
