#include "node_firmware/usb/cdc_device.hpp"

#include <algorithm>
#include <utility>

#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

constexpr std::uint8_t kAllSlots = (1u << CdcDevice::kSlots) - 1;
constexpr std::uint8_t kIn = 0x80;
constexpr std::uint16_t kEnglish = 0x0409;

// bmRequestType in the upper byte, bRequest in the lower.
enum : std::uint16_t {
  kGetDeviceStatus = 0x8000,
  kGetInterfaceStatus = 0x8100,
  kGetEndpointStatus = 0x8200,
  kClearEndpointFeature = 0x0201,
  kSetEndpointFeature = 0x0203,
  kSetAddress = 0x0005,
  kGetDescriptor = 0x8006,
  kGetConfiguration = 0x8008,
  kSetConfiguration = 0x0009,
  kGetInterface = 0x810A,
  kSetInterface = 0x010B,
  kSetLineCoding = 0x2120,
  kGetLineCoding = 0xA121,
  kSetControlLineState = 0x2122,
};

/// kSlots: no such endpoint.
constexpr unsigned slot_of(std::uint16_t endpoint_address) {
  switch (endpoint_address) {
    case cdc::kDataOut:
      return CdcDevice::kDataOut;
    case cdc::kDataIn:
      return CdcDevice::kDataIn;
    case cdc::kNotifyIn:
      return CdcDevice::kNotifyIn;
    default:
      return CdcDevice::kSlots;
  }
}

}  // namespace

void CdcDevice::on_reset() {
  stage_ = Stage::kIdle;
  address_ = 0;
  line_coding_ = cdc::kDefaultLineCoding;
  configure(false);
}

void CdcDevice::configure(bool open) {
  open_ = notify_ = open;
  halted_ = 0;
  changed_ = kAllSlots;
  received_ = taken_ = 0;
  hung_up_ = true;
  terminal_ = false;
}

void CdcDevice::on_setup(std::span<const std::uint8_t, 8> bytes) {
  const Request request{.what = static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]),
                        .value = get_u16_le(bytes.subspan(2)),
                        .index = get_u16_le(bytes.subspan(4)),
                        .length = get_u16_le(bytes.subspan(6))};
  reply_ = {};
  stage_ = Stage::kReply;
  // What comes with data is a line coding or nothing that is known.
  const bool takes = (bytes[0] & kIn) == 0 && request.length != 0;
  if (takes != (request.what == kSetLineCoding) || !answer(request)) stage_ = Stage::kStalled;
  reply_ = reply_.first(std::min<std::size_t>(reply_.size(), request.length));
}

bool CdcDevice::answer(const Request& r) {
  switch (r.what) {
    case kGetDeviceStatus:
      short_reply(1, 2);  // self-powered
      return true;
    case kGetInterfaceStatus:
      short_reply(0, 2);
      return open_ && r.index < 2;
    case kGetEndpointStatus: {
      const unsigned slot = slot_of(r.index);
      short_reply(slot < kSlots ? halted_ >> slot & 1 : 0, 2);
      return (r.index & 0x7F) == 0 || (open_ && slot < kSlots);
    }
    case kClearEndpointFeature:
      return halt(r, false);
    case kSetEndpointFeature:
      return halt(r, true);
    case kSetAddress:
      if (r.value > 127) return false;
      address_ = static_cast<std::uint8_t>(r.value);
      return true;
    case kGetDescriptor:
      return describe(r.value);
    case kGetConfiguration:
      short_reply(open_ ? 1 : 0, 1);
      return true;
    case kSetConfiguration:
      if (r.value > 1 || address_ == 0) return false;
      configure(r.value == 1);
      return true;
    case kGetInterface:
      short_reply(0, 1);
      return open_ && r.index < 2;
    case kSetInterface:
      return open_ && r.index < 2 && r.value == 0;
    case kSetLineCoding:
      stage_ = Stage::kLineCoding;
      return r.length == line_coding_.size();
    case kGetLineCoding:
      reply_ = line_coding_;
      return true;
    case kSetControlLineState:
      hung_up_ = hung_up_ || (terminal_ && (r.value & 1) == 0);
      terminal_ = (r.value & 1) != 0;
      return true;
    default:
      return false;
  }
}

bool CdcDevice::halt(const Request& request, bool on) {
  const unsigned slot = slot_of(request.index);
  if (!open_ || slot == kSlots || request.value != 0) return false;
  const auto mask = static_cast<std::uint8_t>(1u << slot);
  halted_ = static_cast<std::uint8_t>(on ? halted_ | mask : halted_ & ~mask);
  changed_ |= mask;
  return true;
}

bool CdcDevice::describe(std::uint16_t which) {
  switch (which) {
    case cdc::kDevice << 8:
      reply_ = cdc::kDeviceDescriptor;
      return true;
    case cdc::kConfiguration << 8:
      reply_ = cdc::kConfigurationDescriptor;
      return true;
    case cdc::kString << 8 | cdc::kLanguages:
      short_reply(4 | cdc::kString << 8 | kEnglish << 16, 4);
      return true;
    case cdc::kString << 8 | cdc::kManufacturerString:
      say(cdc::kManufacturerName);
      return true;
    case cdc::kString << 8 | cdc::kProductString:
      say(cdc::kProductName);
      return true;
    case cdc::kString << 8 | cdc::kSerialString:
      serial_number();
      return true;
    default:
      return false;
  }
}

void CdcDevice::serial_number() {
  std::array<char, 24> digits{};
  for (std::size_t i = 0; i < digits.size(); ++i)
    digits[i] = "0123456789ABCDEF"[unique_id_[i / 8] >> (28 - i % 8 * 4) & 0xF];
  say({digits.data(), digits.size()});
}

// A string descriptor: UTF-16.
void CdcDevice::say(std::string_view text) {
  buffer_.fill(0);
  buffer_[0] = static_cast<std::uint8_t>(2 + 2 * text.size());
  buffer_[1] = cdc::kString;
  for (std::size_t i = 0; i < text.size(); ++i) buffer_[2 + 2 * i] = static_cast<std::uint8_t>(text[i]);
  reply_ = Packet(buffer_).first(buffer_[0]);
}
static_assert(2 + 2 * 24 < cdc::kPacketBytes, "a string is one packet");

void CdcDevice::short_reply(unsigned value, std::size_t bytes) {
  put_u32_le(buffer_, value);
  reply_ = Packet(buffer_).first(bytes);
}

void CdcDevice::on_control_data(Packet packet) {
  if (stage_ != Stage::kLineCoding) return;
  if (packet.size() != line_coding_.size()) {
    stage_ = Stage::kStalled;
    return;
  }
  std::copy(packet.begin(), packet.end(), line_coding_.begin());
  stage_ = Stage::kReply;
}

void CdcDevice::on_data(Packet packet) {
  received_ = static_cast<std::uint8_t>(std::min(packet.size(), data_.size()));
  taken_ = 0;
  std::copy_n(packet.begin(), received_, data_.begin());
}

std::optional<CdcDevice::Packet> CdcDevice::next_control_packet() {
  if (stage_ != Stage::kReply) return std::nullopt;
  const Packet packet = reply_.first(std::min(reply_.size(), cdc::kPacketBytes));
  reply_ = reply_.subspan(packet.size());
  if (reply_.empty()) stage_ = Stage::kIdle;
  return packet;
}

std::optional<CdcDevice::Packet> CdcDevice::next_notification() {
  if (!std::exchange(notify_, false)) return std::nullopt;
  return cdc::kSerialState;
}

std::uint8_t CdcDevice::take_changes() {
  return std::exchange(changed_, std::uint8_t{0});
}

std::optional<char> CdcDevice::next_char() {
  if (taken_ == received_) return std::nullopt;
  return static_cast<char>(data_[taken_++] & 0x7F);
}

bool CdcDevice::take_hang_up() {
  return std::exchange(hung_up_, false);
}

}  // namespace kinebus
