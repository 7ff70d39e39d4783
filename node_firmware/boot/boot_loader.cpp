#include "node_firmware/boot/boot_loader.hpp"

#include <algorithm>
#include <string_view>

namespace kinebus {
namespace {

constexpr std::string_view kName = "Kinebus boot loader";
constexpr std::chrono::milliseconds kHeartbeat{500};
// An erase of 256 kB takes up to 4 s, in which nothing else happens.
constexpr SdoServer::Options kSlowFlash{.timeout = std::chrono::seconds{10}};

bool is_blank(std::span<const std::uint8_t> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b == 0xFF; });
}

}  // namespace

BootLoader::BootLoader(const ImageTarget& board, const LssIdentity& identity, std::uint8_t node_id,
                       ProgramFlash& flash, LocalTime now)
    : board_(board),
      identity_(identity),
      flash_(flash),
      sdo_(*this, kSlowFlash),
      lss_(identity, node_id == 0 ? kUnconfiguredNodeId : node_id),
      now_(now) {
  look();
  set_node_id(node_id, now);
}

void BootLoader::look() {
  status_ = check_image(flash_.bytes(), board_) == ImageCheck::kGood ? ProgramStatus::kGood
                                                                     : ProgramStatus::kNoProgram;
}

void BootLoader::set_node_id(std::uint8_t node_id, LocalTime now) {
  node_id_ = node_id;
  sdo_.reset(node_id);
  heartbeat_.set_period(kHeartbeat, now);
  if (node_id != 0) boot_up_ = nmt_.boot(node_id);
}

void BootLoader::on_frame(LocalTime now, const CanFrame& frame) {
  now_ = now;
  if (lss_.on_frame(frame)) {
    if (lss_.take_store_request()) lss_.finish_store(false);  // parameters belong to the program
    if (const auto id = lss_.take_node_id()) set_node_id(*id, now);
  } else if (const auto command = nmt_.on_frame(frame)) {
    if (*command == NmtCommand::kResetNode || *command == NmtCommand::kResetCommunication) {
      lss_.activate();
      set_node_id(lss_.active_node_id() == kUnconfiguredNodeId ? std::uint8_t{0} : lss_.active_node_id(),
                  now);
    }
  } else if (node_id_ != 0) {
    // Also while NMT says stopped: what always answers can always be updated.
    sdo_.on_frame(now, frame);
  }
}

void BootLoader::on_time(LocalTime now) {
  now_ = now;
  sdo_.on_time(now);
}

std::optional<CanFrame> BootLoader::next_frame() {
  if (auto reply = lss_.next_frame()) return reply;
  if (node_id_ == 0) return std::nullopt;
  if (boot_up_) {
    const CanFrame frame = *boot_up_;
    boot_up_.reset();
    return frame;
  }
  if (auto frame = sdo_.next_frame()) return frame;
  return heartbeat_.next_frame(now_, nmt_.state(), node_id_);
}

AbortCode BootLoader::sdo_read(ObjectAddress address, std::uint32_t offset, std::span<std::uint8_t> out,
                               std::uint32_t& total) {
  std::uint32_t value = 0;
  total = 4;
  switch (static_cast<std::uint32_t>(address.index) << 8 | address.subindex) {
    case 0x1000'00:
      break;
    case 0x1001'00:
      total = 1;
      break;
    case 0x1008'00: {
      total = static_cast<std::uint32_t>(kName.size());
      const std::size_t from = std::min<std::size_t>(offset, kName.size());
      const std::size_t count = std::min(out.size(), kName.size() - from);
      std::transform(kName.begin() + static_cast<std::ptrdiff_t>(from),
                     kName.begin() + static_cast<std::ptrdiff_t>(from + count), out.begin(),
                     [](char c) { return static_cast<std::uint8_t>(c); });
      return AbortCode::kNone;
    }
    case 0x1018'00:
      value = 4;
      total = 1;
      break;
    case 0x1018'01:
    case 0x1018'02:
    case 0x1018'03:
    case 0x1018'04:
      value = identity_[address.subindex - 1u];
      break;
    case 0x1F50'00:
    case 0x1F51'00:
    case 0x1F56'00:
    case 0x1F57'00:
      value = 1;
      total = 1;
      break;
    case 0x1F50'01:
      return AbortCode::kWriteOnly;
    case 0x1F51'01:
      value = program_control::kStop;  // it does not run: this does
      total = 1;
      break;
    case 0x1F56'01:
      value = status_ == ProgramStatus::kGood ? decode_image_header(flash_.bytes()).crc : 0;
      break;
    case 0x1F57'01:
      value = static_cast<std::uint32_t>(status_) << 1;
      break;
    case 0x2122'00:
      value = flash_.unprotected();
      total = 1;
      break;
    case 0x2123'00:
      value = static_cast<std::uint32_t>(flash_.bytes().size());
      break;
    case 0x2124'00:
      value = 3;
      total = 1;
      break;
    case 0x2124'01:
    case 0x2124'02:
    case 0x2124'03: {
      const BoardRecord own = board_record::find(flash_.records()).value_or(BoardRecord{});
      value = std::array{own.hardware, own.revision, own.serial}[address.subindex - 1u];
      break;
    }
    default:
      return AbortCode::kNoObject;
  }
  std::array<std::uint8_t, 4> bytes{};
  put_u32_le(bytes, value);
  for (std::size_t i = 0; i < out.size() && offset + i < total; ++i) out[i] = bytes[offset + i];
  return AbortCode::kNone;
}

AbortCode BootLoader::sdo_write(ObjectAddress address, std::uint32_t offset,
                                std::span<const std::uint8_t> bytes, bool last) {
  if (address == ObjectAddress{0x1F50, 1}) return write_program(offset, bytes, last);
  if (address == ObjectAddress{0x1F51, 1})
    return bytes.size() == 1 && last ? control(bytes[0]) : AbortCode::kLength;
  if (address == kChipProtection) return bytes.size() == 4 && last ? protect(bytes) : AbortCode::kLength;
  if (address == kRecordedRevision)
    return bytes.size() == 4 && last ? record(get_u32_le(bytes)) : AbortCode::kLength;
  std::uint32_t total = 0;
  std::array<std::uint8_t, 4> unused{};
  return sdo_read(address, 0, unused, total) == AbortCode::kNoObject ? AbortCode::kNoObject
                                                                     : AbortCode::kReadOnly;
}

AbortCode BootLoader::protect(std::span<const std::uint8_t> signature) {
  if (get_u32_le(signature) != kProtectSignature) return AbortCode::kCannotStore;
  return flash_.protect() && flash_.unprotected() == 0 ? AbortCode::kNone : AbortCode::kHardware;
}

AbortCode BootLoader::record(std::uint32_t revision) {
  if (revision == 0 || revision > kHighestRevision) return AbortCode::kInvalidValue;
  return flash_.add_record({board_.hardware, revision, identity_[3]}) ? AbortCode::kNone
                                                                      : AbortCode::kHardware;
}

AbortCode BootLoader::control(std::uint8_t command) {
  switch (command) {
    case program_control::kStop:
      return AbortCode::kNone;
    case program_control::kStart:
    case program_control::kReset:
      look();
      if (status_ != ProgramStatus::kGood) return AbortCode::kDeviceState;
      start_requested_ = true;
      return AbortCode::kNone;
    case program_control::kClear:
      // What a cut erase has left may read as blank and not stay so: asked for, it is made.
      if (!flash_.erase()) return fail(ProgramStatus::kNotCleared, AbortCode::kHardware);
      status_ = ProgramStatus::kNoProgram;
      return AbortCode::kNone;
    default:
      return AbortCode::kInvalidValue;
  }
}

AbortCode BootLoader::fail(ProgramStatus status, AbortCode code) {
  status_ = status;
  return code;
}

AbortCode BootLoader::put(std::uint8_t byte) {
  word_[written_ % 4] = byte;
  ++written_;
  if (written_ % 4 != 0) return AbortCode::kNone;
  const bool good = flash_.program(written_ - 4, get_u32_le(word_));
  return good ? AbortCode::kNone : fail(ProgramStatus::kWriteError, AbortCode::kHardware);
}

AbortCode BootLoader::write_program(std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
  const std::size_t room = flash_.bytes().size();
  if (offset == 0) {
    // Looked at before anything is erased: an image for something else leaves the old program as it is.
    switch (check_header(bytes, room, board_)) {
      case ImageCheck::kGood:
        break;
      case ImageCheck::kLength:
        return fail(ProgramStatus::kAddressError, AbortCode::kTooLong);
      case ImageCheck::kOtherDevice:
        return fail(ProgramStatus::kFormatError, AbortCode::kCannotStore);
      case ImageCheck::kNone:
      case ImageCheck::kCrc:
        return fail(ProgramStatus::kUnknownFormat, AbortCode::kCannotStore);
    }
    if (!is_blank(flash_.bytes()) && !flash_.erase())
      return fail(ProgramStatus::kNotCleared, AbortCode::kHardware);
    written_ = 0;
    status_ = ProgramStatus::kNoProgram;
  }
  if (offset != written_) return fail(ProgramStatus::kAddressError, AbortCode::kDeviceState);
  if (offset + bytes.size() > room) return fail(ProgramStatus::kAddressError, AbortCode::kTooLong);
  for (const std::uint8_t byte : bytes)
    if (const AbortCode code = put(byte); code != AbortCode::kNone) return code;
  if (!last) return AbortCode::kNone;
  while (written_ % ProgramFlash::kUnit != 0)
    if (const AbortCode code = put(0xFF); code != AbortCode::kNone) return code;
  look();
  return status_ == ProgramStatus::kGood ? AbortCode::kNone
                                         : fail(ProgramStatus::kFormatError, AbortCode::kCrc);
}

}  // namespace kinebus
