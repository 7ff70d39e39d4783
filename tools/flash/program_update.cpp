#include "tools/flash/program_update.hpp"

#include <array>
#include <utility>

#include "node_firmware/boot/boot_loader.hpp"
#include "protocol/canopen/boards/all.hpp"
#include "protocol/canopen/heartbeat.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

constexpr ObjectAddress kProgramData{0x1F50, 1}, kProgramControl{0x1F51, 1}, kProgramId{0x1F56, 1},
    kFlashStatus{0x1F57, 1}, kProduct{0x1018, 2};

std::string device_with(std::uint32_t product_code) {
  for (const BoardDescription& board : kBoards)
    if (board.facts.product_code == product_code) return "a " + std::string(board.facts.device_name);
  return "a device with product code " + std::to_string(product_code);
}

std::string board_with(std::uint32_t hardware) {
  for (const BoardDescription& board : kBoards)
    if (board.facts.hardware == hardware) return std::string(board.facts.hardware_version);
  return "a board with number " + std::to_string(hardware);
}

std::string mismatch(std::uint32_t found, std::uint32_t wanted) {
  return "it is " + device_with(found) + ", and the image is for " + device_with(wanted) +
         " (1018h:2): nothing was written";
}

}  // namespace

CanFrame end_of_transfer(std::uint8_t node) {
  return sdo::abort_frame(cob_id::kSdoRequest + node, kProgramData, AbortCode::kGeneral);
}

std::string what_is_wrong(ImageCheck check) {
  switch (check) {
    case ImageCheck::kNone:
      return "the file is no node image: give kinebus-node.bin";
    case ImageCheck::kOtherDevice:
      return "the image is for another device or board";
    case ImageCheck::kLength:
      return "the image's length is wrong: the file may be cut off";
    case ImageCheck::kCrc:
      return "the image's CRC is wrong: the file is damaged";
    case ImageCheck::kGood:
      break;
  }
  return {};
}

ImageCheck check_any_image(std::span<const std::uint8_t> image) {
  ImageCheck best = ImageCheck::kNone;
  for (const BoardDescription& board : kBoards) {
    best = check_image(image, image_target(board.facts));
    if (best != ImageCheck::kOtherDevice) break;
  }
  return best;
}

ProgramUpdate::ProgramUpdate(std::uint8_t node, std::span<const std::uint8_t> image, LocalTime now,
                             const Options& options)
    : options_(options),
      node_(node),
      image_(image),
      client_(SdoClient::Options{.timeout = options.answer}),
      attempts_left_(options.attempts) {
  if (const ImageCheck check = check_any_image(image); check != ImageCheck::kGood) {
    fail(what_is_wrong(check));
    return;
  }
  image_ = image.first(decode_image_header(image).length);
  crc_ = decode_image_header(image).crc;
  go(now, Step::kReadControl);
}

void ProgramUpdate::fail(std::string message) {
  status_ = Status::kFailed;
  message_ = std::move(message);
}

void ProgramUpdate::upload(LocalTime now, ObjectAddress address) {
  value_ = {};
  client_.upload(now, node_, address, value_);
}

void ProgramUpdate::download(LocalTime now, ObjectAddress address, std::span<const std::uint8_t> bytes) {
  client_.download(now, node_, address, bytes);
}

void ProgramUpdate::go(LocalTime now, Step step) {
  step_ = step;
  const auto control = [&](std::uint8_t command) {
    command_ = {command};
    download(now, kProgramControl, command_);
  };
  switch (step) {
    case Step::kReadControl:
      message_ = "asking";
      before_ = end_of_transfer(node_);
      return upload(now, kProgramControl);
    case Step::kReadIdentity:
    case Step::kReadBoard:
      return upload(now, kProduct);
    case Step::kReadProgram:
      return upload(now, kProgramId);
    case Step::kStop:
      message_ = "stopping the program";
      before_ = nmt_frame(NmtCommand::kEnterPreOperational, node_);
      return control(program_control::kStop);
    case Step::kAwaitBootLoader:
    case Step::kAwaitProgram:
      boot_due_ = now + options_.boot;
      return;
    case Step::kReadRecord:
      return upload(now, kRecordedHardware);
    case Step::kReadRevision:
      return upload(now, kRecordedRevision);
    case Step::kRecord:
      message_ = "recording";
      put_u32_le(revision_, options_.record_revision);
      return download(now, kRecordedRevision, revision_);
    case Step::kReadRoom:
      return upload(now, kProgramRoom);
    case Step::kClear:
      message_ = "erasing";
      return control(program_control::kClear);
    case Step::kDownload:
      message_ = "writing";
      client_.download(now, node_, kProgramData, image_, SdoClient::Method::kBlock);
      return;
    case Step::kReadStatus:
      message_ = "checking";
      return upload(now, kFlashStatus);
    case Step::kReadProtection:
      return upload(now, kChipProtection);
    case Step::kProtect:
      message_ = "protecting";
      put_u32_le(signature_, kProtectSignature);
      return download(now, kChipProtection, signature_);
    case Step::kStart:
      message_ = "starting";
      return control(program_control::kStart);
    case Step::kVerify:
      return upload(now, kProgramId);
  }
}

void ProgramUpdate::on_transfer(LocalTime now) {
  switch (step_) {
    case Step::kReadControl:
      in_boot_loader_ = value_[0] == program_control::kStop;
      return go(now, Step::kReadIdentity);
    case Step::kReadIdentity:
      return on_identity(now, get_u32_le(value_));
    case Step::kReadProgram:
      same_ = get_u32_le(value_) == crc_ && !options_.even_if_same;
      if (same_ && !options_.protect && options_.record_revision == 0) {
        status_ = Status::kDone;
        message_ = "runs this program already";
        return;
      }
      return go(now, Step::kStop);
    case Step::kStop:
      return go(now, Step::kAwaitBootLoader);
    case Step::kReadBoard:
      if (get_u32_le(value_) == decode_image_header(image_).product_code) return go(now, Step::kReadRecord);
      refused_ = mismatch(get_u32_le(value_), decode_image_header(image_).product_code);
      return go(now, Step::kStart);
    case Step::kReadRecord:
      return on_record(now, get_u32_le(value_));
    case Step::kReadRevision:
      if (get_u32_le(value_) == options_.record_revision) return on_boot_loader(now);
      return go(now, Step::kRecord);
    case Step::kRecord:
      return on_boot_loader(now);
    case Step::kReadRoom:
      return on_room(now, get_u32_le(value_));
    case Step::kClear:
      return go(now, Step::kDownload);
    case Step::kDownload:
      return go(now, Step::kReadStatus);
    case Step::kReadStatus:
      if (value_[0] != 0) return fail("the node refuses the program: 1F57h = " + std::to_string(value_[0]));
      return go(now, Step::kReadProtection);
    case Step::kReadProtection:
      unprotected_ = value_[0];
      return go(now, unprotected_ != 0 && options_.protect ? Step::kProtect : Step::kStart);
    case Step::kProtect:
      unprotected_ = 0;
      return go(now, Step::kStart);
    case Step::kStart:
      return go(now, Step::kAwaitProgram);
    case Step::kVerify:
      if (!refused_.empty()) return fail(refused_);
      if (get_u32_le(value_) != crc_) return fail("another program came up than was written");
      status_ = Status::kDone;
      message_ = !same_ ? "updated" : options_.protect ? "protected" : "recorded";
      return;
    case Step::kAwaitBootLoader:
    case Step::kAwaitProgram:
      return;
  }
}

// What a node is does not say which board it is on where several kinds of boards carry such nodes: then the
// boot loader is asked, before anything is erased.
void ProgramUpdate::on_identity(LocalTime now, std::uint32_t product_code) {
  const ImageHeader header = decode_image_header(image_);
  const std::uint32_t wanted = in_boot_loader_ ? header.product_code : header.node_product_code();
  known_board_ = product_code == header.product_code;
  const bool other_node =
      options_.other_kind && (known_board_ || product_code == HeatBoard::kFacts.product_code);
  if (product_code != wanted && !other_node) return fail(mismatch(product_code, wanted));
  go(now, in_boot_loader_ ? Step::kReadRecord : Step::kReadProgram);
}

void ProgramUpdate::on_boot_loader(LocalTime now) {
  go(now, same_ ? Step::kReadProtection : Step::kReadRoom);
}

// What a board says of itself counts for more than the boot loader that was written to it.
void ProgramUpdate::on_record(LocalTime now, std::uint32_t hardware) {
  const std::uint32_t wanted = decode_image_header(image_).hardware;
  if (options_.record_revision != 0) return go(now, hardware == wanted ? Step::kReadRevision : Step::kRecord);
  if (hardware == 0 || hardware == wanted) return on_boot_loader(now);
  refused_ = "the board is recorded as " + board_with(hardware) + ", and the image is for " +
             board_with(wanted) + " (2124h): nothing was written";
  go(now, Step::kStart);
}

// Before anything is erased: what does not fit leaves the node with the program that it has.
void ProgramUpdate::on_room(LocalTime now, std::uint32_t bytes) {
  if (image_.size() <= bytes) return go(now, Step::kClear);
  refused_ = "its boot loader has room for programs of " + std::to_string(bytes) +
             " bytes and this one has " + std::to_string(image_.size()) +
             ": write kinebus-boot.hex of the same release by SWD or DFU first; nothing was written";
  go(now, Step::kStart);
}

void ProgramUpdate::on_failed_transfer(LocalTime now) {
  const AbortCode code = client_.abort_code();
  const std::string reason(text(code));
  if (step_ == Step::kDownload && code == AbortCode::kCannotStore)
    return fail("its boot loader refuses the image: it is for another board or chip");
  const bool written = step_ == Step::kClear || step_ == Step::kDownload || step_ == Step::kReadStatus;
  // After a timeout an answer may come late, to a question that was asked since.
  const bool asked_again = step_ == Step::kReadControl && attempts_left_ < options_.attempts;
  if ((written || asked_again) && attempts_left_ > 1) {
    --attempts_left_;
    return go(now, Step::kReadControl);
  }
  // A boot loader of before 2124h.
  if (step_ == Step::kReadRecord && code == AbortCode::kNoObject)
    return options_.record_revision != 0
               ? fail("its boot loader keeps no record of the board: write a new one by SWD or DFU")
               : on_boot_loader(now);
  if (step_ == Step::kReadRoom && code == AbortCode::kNoObject) return on_room(now, kFirstProgramRoom);
  // The program that was there cannot be started either: there was none.
  if (!refused_.empty()) return fail(refused_);
  // A boot loader of before protection: nothing is known of the chip.
  if (step_ == Step::kReadProtection && code == AbortCode::kNoObject)
    return options_.protect ? fail("its boot loader cannot protect the chip: write a new one by SWD or DFU")
                            : go(now, Step::kStart);
  if (step_ == Step::kStop && code == AbortCode::kDeviceState)
    return fail(
        "its motors have power, it heats, or no boot loader started it: switch drives and heaters off, or "
        "flash by SWD");
  if (step_ == Step::kReadControl && code == AbortCode::kTimeout) return fail("does not answer");
  fail(message_ + ": " + reason);
}

void ProgramUpdate::on_frame(LocalTime now, const CanFrame& frame) {
  if (status_ != Status::kBusy) return;
  client_.on_frame(now, frame);
  const auto heartbeat = decode_heartbeat(frame);
  if (heartbeat && heartbeat->node == node_ && heartbeat->state == NmtState::kInitialising &&
      boot_due_ != LocalTime::max()) {
    boot_due_ = LocalTime::max();
    go(now, step_ == Step::kAwaitProgram ? Step::kVerify
            : known_board_               ? Step::kReadRecord
                                         : Step::kReadBoard);
  }
  on_time(now);
}

void ProgramUpdate::on_time(LocalTime now) {
  if (status_ != Status::kBusy) return;
  client_.on_time(now);
  if (now >= boot_due_) {
    boot_due_ = LocalTime::max();
    // The boot-up message may have been lost: whoever answers now says what it is.
    if (--attempts_left_ <= 0) return fail("did not come back after its reset");
    return go(now, step_ == Step::kAwaitProgram ? Step::kVerify : Step::kReadControl);
  }
  if (boot_due_ != LocalTime::max()) return;
  if (client_.status() == SdoClient::Status::kDone)
    on_transfer(now);
  else if (client_.status() == SdoClient::Status::kFailed)
    on_failed_transfer(now);
}

std::optional<CanFrame> ProgramUpdate::next_frame() {
  if (status_ != Status::kBusy) return std::nullopt;
  if (before_) return std::exchange(before_, std::nullopt);
  return client_.next_frame();
}

LocalTime ProgramUpdate::next_deadline() const {
  return status_ == Status::kBusy ? std::min(client_.next_deadline(), boot_due_) : LocalTime::max();
}

int ProgramUpdate::percent() const {
  if (step_ < Step::kDownload) return 0;
  if (step_ > Step::kDownload || image_.empty()) return 100;
  return static_cast<int>(100 * client_.received() / image_.size());
}

}  // namespace kinebus
