#include "node_firmware/usb/cdc_device.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {
namespace {

enum : std::uint16_t { kSetLineCoding = 0x2120, kGetLineCoding = 0xA121, kSetControlLineState = 0x2122 };

}  // namespace

void CdcDevice::on_reset() {
  control_.on_reset();
  line_coding_ = cdc::kDefaultLineCoding;
  begin_anew();
}

void CdcDevice::begin_anew() {
  if (!control_.take_configured()) return;
  notify_ = control_.open();
  received_ = taken_ = 0;
  hung_up_ = true;
  terminal_ = false;
}

void CdcDevice::on_setup(std::span<const std::uint8_t, 8> bytes) {
  const auto request = control_.on_setup(bytes);
  begin_anew();
  if (!request) return;
  switch (request->what) {
    case kSetLineCoding:
      if (request->length == line_coding_.size()) control_.take();
      break;
    case kGetLineCoding:
      control_.reply(line_coding_);
      break;
    case kSetControlLineState:
      if (request->length != 0) break;
      hung_up_ = hung_up_ || (terminal_ && (request->value & 1) == 0);
      terminal_ = (request->value & 1) != 0;
      control_.reply({});
      break;
    default:
      break;
  }
}

void CdcDevice::on_control_data(Packet packet) {
  if (const auto data = control_.on_data(packet)) std::ranges::copy(*data, line_coding_.begin());
}

void CdcDevice::on_data(Packet packet) {
  received_ = static_cast<std::uint8_t>(std::min(packet.size(), data_.size()));
  taken_ = 0;
  std::copy_n(packet.begin(), received_, data_.begin());
}

std::optional<CdcDevice::Packet> CdcDevice::next_notification() {
  if (!std::exchange(notify_, false)) return std::nullopt;
  return cdc::kSerialState;
}

std::optional<char> CdcDevice::next_char() {
  if (taken_ == received_) return std::nullopt;
  return static_cast<char>(data_[taken_++] & 0x7F);
}

bool CdcDevice::take_hang_up() {
  return std::exchange(hung_up_, false);
}

}  // namespace kinebus
