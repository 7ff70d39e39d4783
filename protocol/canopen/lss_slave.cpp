#include "protocol/bytes.hpp"
#include "protocol/canopen/lss.hpp"

namespace kinebus {

void LssSlave::reply(std::uint8_t command, std::uint32_t data) {
  CanFrame frame{.id = cob_id::kLssReply, .length = 8};
  frame.data[0] = command;
  put_u32_le(std::span(frame.data).subspan(1), data);
  reply_ = frame;
}

std::optional<CanFrame> LssSlave::next_frame() {
  const auto frame = reply_;
  reply_.reset();
  return frame;
}

std::optional<std::uint8_t> LssSlave::take_node_id() {
  if (!boot_due_) return std::nullopt;
  boot_due_ = false;
  return active_;
}

bool LssSlave::take_store_request() {
  const bool due = store_due_;
  store_due_ = false;
  return due;
}

void LssSlave::finish_store(bool good) {
  reply(lss::kStore, good ? 0 : 2);
}  // 2: storage media access error

void LssSlave::refuse_store() {
  reply(lss::kStore, 0x01FF);
}

void LssSlave::set_configuring(bool configuring) {
  // CiA 305: an unconfigured node that was given an id starts with it on its way back to waiting.
  if (configuring_ && !configuring && active_ == kUnconfiguredNodeId && pending_ != kUnconfiguredNodeId) {
    active_ = pending_;
    boot_due_ = true;
  }
  configuring_ = configuring;
  selected_ = 0;
}

bool LssSlave::on_frame(const CanFrame& frame) {
  if (frame.id != cob_id::kLssRequest || frame.extended || frame.remote) return false;
  if (frame.length != 8) return true;
  const std::uint8_t command = frame.data[0];
  const std::uint32_t value = get_u32_le(std::span(frame.data).subspan(1));
  if (command == lss::kSwitchGlobal) {
    if (frame.data[1] <= 1) set_configuring(frame.data[1] == 1);
    return true;
  }
  if (command >= lss::kSelectVendor && command <= lss::kSelectSerial) {
    const auto part = static_cast<std::uint8_t>(command - lss::kSelectVendor);
    if (part == 0) selected_ = 0;
    selected_ =
        part == selected_ && value == identity_[part] ? static_cast<std::uint8_t>(part + 1) : std::uint8_t{0};
    if (selected_ == 4) {
      set_configuring(true);
      reply(lss::kSelected);
    }
    return true;
  }
  if (command >= lss::kIdentifyVendor && command <= lss::kIdentifySerialHigh) {
    on_identify(command, value);
    return true;
  }
  if (command == lss::kIdentifyUnconfigured) {
    if (active_ == kUnconfiguredNodeId && pending_ == kUnconfiguredNodeId)
      reply(lss::kIdentifiedUnconfigured);
    return true;
  }
  if (command == lss::kFastscan) {
    on_fastscan(frame);
    return true;
  }
  if (!configuring_) return true;
  switch (command) {
    case lss::kConfigureNodeId: {
      const std::uint8_t id = frame.data[1];
      const bool good = (id >= 1 && id <= highest_) || id == kUnconfiguredNodeId;
      if (good) pending_ = id;
      reply(command, good ? 0 : 1);
      break;
    }
    case lss::kConfigureBitTiming:
      // Table 0, entry 0 is 1 Mbit/s, the only rate of this bus.
      reply(command, frame.data[1] == 0 && frame.data[2] == 0 ? 0 : 1);
      break;
    case lss::kStore:
      store_due_ = true;
      break;
    case lss::kInquireNodeId:
      reply(command, active_);
      break;
    default:
      if (command >= lss::kInquireVendor && command < lss::kInquireNodeId)
        reply(command, identity_[command - lss::kInquireVendor]);
  }
  return true;
}

/// Vendor and product must match; revision and serial lie in ranges. Six frames in order.
void LssSlave::on_identify(std::uint8_t command, std::uint32_t value) {
  const auto step = static_cast<std::uint8_t>(command - lss::kIdentifyVendor);
  if (step == 0) identified_ = 0;
  bool match = step == identified_;
  switch (command) {
    case lss::kIdentifyVendor:
      match = match && value == identity_[0];
      break;
    case lss::kIdentifyProduct:
      match = match && value == identity_[1];
      break;
    case lss::kIdentifyRevisionLow:
      match = match && identity_[2] >= value;
      break;
    case lss::kIdentifyRevisionHigh:
      match = match && identity_[2] <= value;
      break;
    case lss::kIdentifySerialLow:
      match = match && identity_[3] >= value;
      break;
    default:
      match = match && identity_[3] <= value;
      break;
  }
  identified_ = match ? static_cast<std::uint8_t>(step + 1) : std::uint8_t{0};
  if (identified_ != 6) return;
  identified_ = 0;
  reply(lss::kIdentified);
}

void LssSlave::on_fastscan(const CanFrame& frame) {
  if (configuring_ || active_ != kUnconfiguredNodeId || pending_ != kUnconfiguredNodeId) return;
  const std::uint32_t value = get_u32_le(std::span(frame.data).subspan(1));
  const std::uint8_t bit = frame.data[5], part = frame.data[6], next = frame.data[7];
  if (bit == 128) {
    scan_position_ = 0;
    reply(lss::kIdentified);
    return;
  }
  if (bit > 31 || part > 3 || next > 3 || part != scan_position_) return;
  const std::uint32_t mask = ~std::uint32_t{0} << bit;
  if (((identity_[part] ^ value) & mask) != 0) return;
  if (bit == 0) {
    scan_position_ = next;
    if (next < part) set_configuring(true);
  }
  reply(lss::kIdentified);
}

}  // namespace kinebus
