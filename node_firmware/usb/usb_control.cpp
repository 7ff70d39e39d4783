#include "node_firmware/usb/usb_control.hpp"

#include <algorithm>
#include <utility>

#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

constexpr std::uint16_t kEnglish = 0x0409;

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
};

}  // namespace

void UsbControl::on_reset() {
  stage_ = Stage::kIdle;
  address_ = 0;
  configure(false);
}

void UsbControl::configure(bool open) {
  open_ = open;
  configured_ = true;
  halted_ = 0;
  changed_ = static_cast<std::uint8_t>((1u << facts_.endpoints.size()) - 1);
}

std::optional<usb::Request> UsbControl::on_setup(std::span<const std::uint8_t, 8> bytes) {
  const usb::Request request{.what = static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]),
                             .value = get_u16_le(bytes.subspan(2)),
                             .index = get_u16_le(bytes.subspan(4)),
                             .length = get_u16_le(bytes.subspan(6))};
  reply_ = {};
  length_ = request.length;
  stage_ = Stage::kReply;
  bool known = true;
  const bool good = answer(request, known);
  // Of these none comes with data.
  if (!good || (!request.to_host() && request.length != 0)) stage_ = Stage::kStalled;
  reply_ = reply_.first(std::min<std::size_t>(reply_.size(), length_));
  return known ? std::nullopt : std::optional(request);
}

bool UsbControl::answer(const usb::Request& r, bool& known) {
  switch (r.what) {
    case kGetDeviceStatus:
      reply(1, 2);  // self-powered
      return true;
    case kGetInterfaceStatus:
      reply(0, 2);
      return open_ && r.index < facts_.interfaces;
    case kGetEndpointStatus: {
      const auto slot = slot_of(r.index);
      reply(slot ? halted_ >> *slot & 1 : 0, 2);
      return (r.index & 0x7F) == 0 || (open_ && slot);
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
      reply(open_ ? 1 : 0, 1);
      return true;
    case kSetConfiguration:
      if (r.value > 1 || address_ == 0) return false;
      configure(r.value == 1);
      return true;
    case kGetInterface:
      reply(0, 1);
      return open_ && r.index < facts_.interfaces;
    case kSetInterface:
      return open_ && r.index < facts_.interfaces && r.value == 0;
    default:
      known = false;
      return false;
  }
}

std::optional<std::size_t> UsbControl::slot_of(std::uint16_t endpoint_address) const {
  const auto found = std::ranges::find(facts_.endpoints, endpoint_address);
  if (found == facts_.endpoints.end()) return std::nullopt;
  return static_cast<std::size_t>(found - facts_.endpoints.begin());
}

bool UsbControl::halt(const usb::Request& request, bool on) {
  const auto slot = slot_of(request.index);
  if (!open_ || !slot || request.value != 0) return false;
  const auto mask = static_cast<std::uint8_t>(1u << *slot);
  halted_ = static_cast<std::uint8_t>(on ? halted_ | mask : halted_ & ~mask);
  changed_ |= mask;
  return true;
}

bool UsbControl::describe(std::uint16_t which) {
  switch (which) {
    case usb::kDevice << 8:
      reply_ = facts_.device;
      return true;
    case usb::kConfiguration << 8:
      reply_ = facts_.configuration;
      return true;
    case usb::kString << 8 | usb::kLanguages:
      reply(4 | usb::kString << 8 | kEnglish << 16, 4);
      return true;
    case usb::kString << 8 | usb::kManufacturerString:
      say(facts_.manufacturer);
      return true;
    case usb::kString << 8 | usb::kProductString:
      say(facts_.product);
      return true;
    case usb::kString << 8 | usb::kSerialString:
      serial_number();
      return true;
    default:
      return false;
  }
}

void UsbControl::serial_number() {
  std::array<char, 24> digits{};
  for (std::size_t i = 0; i < digits.size(); ++i)
    digits[i] = "0123456789ABCDEF"[unique_id_[i / 8] >> (28 - i % 8 * 4) & 0xF];
  say({digits.data(), digits.size()});
}

// A string descriptor: UTF-16.
void UsbControl::say(std::string_view text) {
  buffer_.fill(0);
  buffer_[0] = static_cast<std::uint8_t>(2 + 2 * text.size());
  buffer_[1] = usb::kString;
  for (std::size_t i = 0; i < text.size(); ++i) buffer_[2 + 2 * i] = static_cast<std::uint8_t>(text[i]);
  reply_ = Packet(buffer_).first(buffer_[0]);
}
static_assert(2 + 2 * 24 < usb::kPacketBytes, "a string is one packet");

void UsbControl::reply(Packet data) {
  reply_ = data.first(std::min<std::size_t>(data.size(), length_));
  stage_ = Stage::kReply;
}

void UsbControl::reply(std::uint32_t value, std::size_t bytes) {
  put_u32_le(buffer_, value);
  reply(Packet(buffer_).first(bytes));
}

std::optional<UsbControl::Packet> UsbControl::on_data(Packet packet) {
  if (stage_ != Stage::kTakes) return std::nullopt;
  stage_ = packet.size() == length_ ? Stage::kReply : Stage::kStalled;
  return packet.size() == length_ ? std::optional(packet) : std::nullopt;
}

std::optional<UsbControl::Packet> UsbControl::next_packet() {
  if (stage_ != Stage::kReply) return std::nullopt;
  const Packet packet = reply_.first(std::min(reply_.size(), usb::kPacketBytes));
  reply_ = reply_.subspan(packet.size());
  if (reply_.empty()) stage_ = Stage::kIdle;
  return packet;
}

std::uint8_t UsbControl::take_changes() {
  return std::exchange(changed_, std::uint8_t{0});
}

bool UsbControl::take_configured() {
  return std::exchange(configured_, false);
}

}  // namespace kinebus
