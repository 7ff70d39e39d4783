#include "node_firmware/usb/gs_usb_device.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

using gs_usb::Breq;

constexpr std::uint16_t what(std::uint16_t direction, Breq request) {
  return static_cast<std::uint16_t>(direction | static_cast<std::uint16_t>(request));
}
/// Bytes of a request's data stage; 0: it is none that takes data.
constexpr std::size_t bytes_of(std::uint16_t request) {
  switch (request) {
    case what(gs_usb::kToDevice, Breq::kHostFormat):
      return 4;
    case what(gs_usb::kToDevice, Breq::kBitTiming):
      return 20;
    case what(gs_usb::kToDevice, Breq::kMode):
      return 8;
    default:
      return 0;
  }
}
constexpr std::uint32_t word(UsbControl::Packet bytes, std::size_t index) {
  return get_u32_le(bytes.subspan(4 * index));
}
/// Where there is one channel: 0; who asks for the device as a whole says 1.
constexpr bool of_channel(const usb::Request& request) {
  return request.value == 0 && request.index == 0;
}
constexpr bool of_device(const usb::Request& request) {
  return request.value <= 1 && request.index == 0;
}

}  // namespace

void GsUsbDevice::on_reset() {
  control_.on_reset();
  control_.take_configured();
  stop();
}

void GsUsbDevice::start(std::uint32_t flags) {
  stop();
  stamps_ = (flags & gs_usb::kTimestamps) != 0;
  session_.store(static_cast<std::uint8_t>(session_.load() + 1));
}

void GsUsbDevice::stop() {
  if (started()) session_.store(static_cast<std::uint8_t>(session_.load() + 1));
}

void GsUsbDevice::on_setup(std::span<const std::uint8_t, 8> bytes, std::uint32_t now_us) {
  const auto request = control_.on_setup(bytes);
  if (control_.take_configured()) stop();
  if (!request || !control_.open()) return;
  if (const std::size_t size = bytes_of(request->what); size != 0) {
    const bool format = size == 4;
    if (request->length != size || !(format ? of_device(*request) : of_channel(*request))) return;
    taking_ = *request;
    return control_.take();
  }
  const auto put = [&](std::size_t index, std::uint32_t value) {
    put_u32_le(std::span(reply_).subspan(4 * index), value);
  };
  reply_.fill(0);
  switch (request->what) {
    case what(gs_usb::kToHost, Breq::kDeviceConfig):
      if (!of_device(*request)) return;
      // One channel (counted from 0), version 2 of the protocol, version 1 of the device.
      put(1, 2);
      put(2, 1);
      return control_.reply(Packet(reply_).first(12));
    case what(gs_usb::kToHost, Breq::kBtConst): {
      if (!of_channel(*request)) return;
      const std::array<std::uint32_t, 10> words{gs_usb::kTimestamps | gs_usb::kState,
                                                facts_.clock_hz,
                                                1,
                                                facts_.segment1_max,
                                                1,
                                                facts_.segment2_max,
                                                facts_.jump_max,
                                                1,
                                                facts_.prescaler_max,
                                                1};
      for (std::size_t i = 0; i < words.size(); ++i) put(i, words[i]);
      return control_.reply(reply_);
    }
    case what(gs_usb::kToHost, Breq::kTimestamp):
      if (of_channel(*request)) control_.reply(now_us, 4);
      return;
    case what(gs_usb::kToHost, Breq::kGetState): {
      if (!of_channel(*request)) return;
      constexpr std::uint32_t kStopped = 4;
      const std::uint32_t state = state_.load(std::memory_order_relaxed);
      put(0, started() ? state & 0xFF : kStopped);
      put(1, state >> 8 & 0xFF);
      put(2, state >> 16 & 0xFF);
      return control_.reply(Packet(reply_).first(12));
    }
    default:
      return;
  }
}

// 1 quantum to synchronise, propagation and first phase, second phase.
bool GsUsbDevice::good_timing(Packet words) const {
  const std::uint32_t propagation = word(words, 0), phase1 = word(words, 1), phase2 = word(words, 2),
                      prescaler = word(words, 4);
  if (propagation > facts_.segment1_max || phase1 > facts_.segment1_max || phase2 > facts_.segment2_max ||
      prescaler == 0 || prescaler > facts_.prescaler_max)
    return false;
  return facts_.clock_hz == facts_.bit_rate * prescaler * (1 + propagation + phase1 + phase2);
}

void GsUsbDevice::on_control_data(Packet packet) {
  const auto data = control_.on_data(packet);
  if (!data) return;
  bool good = true;
  switch (static_cast<Breq>(taking_.what & 0xFF)) {
    case Breq::kHostFormat:
      good = word(*data, 0) == gs_usb::kByteOrder;
      break;
    case Breq::kBitTiming:
      good = good_timing(*data);
      break;
    default:  // kMode
      if (word(*data, 0) == gs_usb::kModeReset)
        stop();
      else if (good = word(*data, 0) == gs_usb::kModeStart && (word(*data, 1) & ~gs_usb::kTimestamps) == 0;
               good)
        start(word(*data, 1));
      break;
  }
  if (!good) control_.stall();
}

void GsUsbDevice::on_data(Packet packet) {
  // Frames back to back, as far as they are whole; Linux sends one a packet.
  for (; packet.size() >= gs_usb::kHostFrameBytes; packet = packet.subspan(gs_usb::kHostFrameBytes)) {
    const std::uint32_t id = word(packet, 1);
    const std::uint8_t length = packet[8], channel = packet[9], flags = packet[10];
    const bool extended = (id & gs_usb::kExtended) != 0;
    const std::uint32_t number = id & 0x1FFF'FFFF;
    if (!started() || channel != 0 || flags != 0 || length > 8 || (id & gs_usb::kError) != 0 ||
        (!extended && number > 0x7FF)) {
      ++malformed_;
      continue;
    }
    HostFrame item{.frame = CanFrame::from_bytes(number, packet.subspan(12, length)),
                   .ticket = {word(packet, 0), session_.load(std::memory_order_relaxed)}};
    item.frame.extended = extended;
    item.frame.remote = (id & gs_usb::kRemote) != 0;
    if (item.frame.remote) item.frame.data = {};
    if (!from_host_.push(item)) ++malformed_;
  }
  if (!packet.empty()) ++malformed_;
}

const GsUsbDevice::HostFrame* GsUsbDevice::next_frame() {
  const std::uint8_t session = session_.load(std::memory_order_relaxed);
  for (const HostFrame* item = from_host_.front(); item != nullptr; item = from_host_.front()) {
    if (started() && item->ticket.session == session) return item;
    from_host_.drop();
  }
  return nullptr;
}

void GsUsbDevice::push(const ToHost& item, std::uint32_t reserve) {
  if (!started()) return;
  ToHost stamped = item;
  stamped.session = session_.load(std::memory_order_relaxed);
  stamped.overflow = lost_some_;
  if (to_host_.size() + reserve < kQueue && to_host_.push(stamped)) {
    lost_some_ = false;
    return;
  }
  lost_some_ = true;
  ++lost_;
}

void GsUsbDevice::on_sent(const Ticket& ticket, const CanFrame& frame, std::uint32_t at_us) {
  if (ticket.session != session_.load(std::memory_order_relaxed)) return;
  push({.frame = frame, .echo = ticket.echo, .at_us = at_us}, 0);
}

void GsUsbDevice::on_received(const CanFrame& frame, std::uint32_t at_us) {
  push({.frame = frame, .at_us = at_us}, 2 * gs_usb::kMostEchoes);
}

void GsUsbDevice::on_state(const CanState& state, std::uint32_t at_us) {
  const std::uint32_t packed =
      state.kind | std::uint32_t{state.receive_errors} << 8 | std::uint32_t{state.transmit_errors} << 16;
  const auto before = static_cast<CanState::Kind>(state_.exchange(packed, std::memory_order_relaxed) & 0xFF);
  if (state.kind == before) return;
  if (state.kind == CanState::kBusOff)
    push_error(gs_usb::kErrorBusOff, 0, at_us);
  else if (before == CanState::kBusOff)
    push_error(gs_usb::kErrorRestarted, 0, at_us);
  else
    push_error(gs_usb::kErrorController,
               state.kind == CanState::kPassive   ? gs_usb::kNowPassive
               : state.kind == CanState::kWarning ? gs_usb::kNowWarning
                                                  : gs_usb::kNowActive,
               at_us);
}

void GsUsbDevice::on_alone(std::uint32_t at_us) {
  push_error(gs_usb::kErrorNoAck, 0, at_us);
}

void GsUsbDevice::push_error(std::uint32_t classes, std::uint8_t state, std::uint32_t at_us) {
  const std::uint32_t packed = state_.load(std::memory_order_relaxed);
  const CanFrame frame{.length = 8,
                       .data = {0, state, 0, 0, 0, 0, static_cast<std::uint8_t>(packed >> 16),
                                static_cast<std::uint8_t>(packed >> 8)}};
  push({.frame = frame, .error = gs_usb::kError | gs_usb::kErrorCounters | classes, .at_us = at_us},
       2 * gs_usb::kMostEchoes);
}

std::optional<GsUsbDevice::Packet> GsUsbDevice::next_data() {
  // Before it looks: what comes in between is told.
  sleeps_.store(true);
  const std::uint8_t session = session_.load(std::memory_order_relaxed);
  for (const ToHost* item = to_host_.front(); item != nullptr; item = to_host_.front()) {
    const ToHost out = *item;
    to_host_.drop();
    if (!started() || out.session != session) continue;
    sleeps_.store(false);
    const std::span packet(packet_);
    packet_.fill(0);
    put_u32_le(packet, out.echo);
    put_u32_le(packet.subspan(4), out.error | out.frame.id | (out.frame.extended ? gs_usb::kExtended : 0) |
                                      (out.frame.remote ? gs_usb::kRemote : 0));
    packet_[8] = out.frame.length;
    packet_[10] = out.overflow ? gs_usb::kOverflow : 0;
    std::ranges::copy(out.frame.data, packet.subspan(12).begin());
    put_u32_le(packet.subspan(20), out.at_us);
    return Packet(packet_).first(stamps_ ? gs_usb::kDeviceFrameBytes : gs_usb::kHostFrameBytes);
  }
  return std::nullopt;
}

}  // namespace kinebus
