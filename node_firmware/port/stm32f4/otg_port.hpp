#pragma once
// The OTG core as a full-speed device: moves the packets of a device of node_firmware/usb. Polled, or called
// by its interrupt. The core holds the host off (NAK) until it is looked after, and every wait is bounded.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/port/stm32f4/registers.hpp"
#include "node_firmware/usb/usb_control.hpp"
#include "protocol/bytes.hpp"

namespace kinebus::stm32 {

/// An endpoint besides the control endpoint, by its slot in the device.
struct OtgEndpoint {
  std::uint8_t address = 0;
  bool interrupt = false;  ///< else bulk
  std::uint16_t bytes = usb::kPacketBytes;
  constexpr unsigned number() const { return address & 0xF; }
  constexpr bool in() const { return (address & 0x80) != 0; }
};

/// Core: registers(), enable(), kGccfg, kGotgctl, kMemoryWords. Device: control(), on_reset(), on_setup(),
/// on_control_data(), kEndpoints, and for its slots takes(), on_packet(), next_packet().
template <typename Core, typename Device>
class OtgPort {
 public:
  explicit constexpr OtgPort(Device& device) : device_(device) {}

  /// False: the core does not answer.
  bool start();
  void attach();
  void detach();
  bool attached() const { return attached_; }
  /// Asks for the interrupt whenever serve() has something to do.
  void interrupt_on_events();
  /// What has come, and what waits.
  void serve();
  /// What an IN endpoint has in its FIFO is thrown away.
  void stop_sending(unsigned endpoint);

 private:
  static constexpr auto& kEndpoints = Device::kEndpoints;
  static constexpr unsigned kControl = 0, kAllFifos = 16;
  // The core's memory. Received: a packet with its status, setup packets, and room for one more.
  static constexpr std::uint32_t kReceiveWords = 128, kControlWords = 32;
  // What the core does within a few clocks, or when a packet that is on the wire (50 us) has ended.
  static constexpr std::uint32_t kFewLooks = 1000;
  // Of the receive FIFO, that one call takes: there is room for no more packets.
  static constexpr int kMostEntries = 4;
  // Between a packet and its answer at full speed with a fast bus clock: RM0090, table of TRDT.
  static constexpr unsigned kTurnaround = 6;
  // What GRXSTSP says has come.
  enum : std::uint32_t { kOutData = 2, kOutDone = 3, kSetupDone = 4, kSetupData = 6 };

  static Otg& otg() { return Core::registers(); }
  static constexpr std::uint32_t send_words(std::uint16_t bytes) { return std::max(16, (bytes + 3) / 4 * 2); }
  void flush(std::uint32_t which);
  void on_bus_reset();
  void receive();
  void on_setup();
  void stall_if_told();
  void set_up(std::size_t slot);
  void take_control();
  void take_data(std::size_t slot);
  bool can_send(unsigned endpoint) const { return (otg().in[endpoint].CTL & Otg::kEnable) == 0; }
  void send(unsigned endpoint, UsbControl::Packet packet);
  void send_what_waits();

  Device& device_;
  std::array<std::uint32_t, 2> setup_{};
  std::uint8_t taking_ = 0;  // slots whose endpoint may receive
  bool attached_ = false;
};

template <typename Core, typename Device>
bool OtgPort<Core, Device>::start() {
  Otg& u = otg();
  Core::enable();
  u.GUSBCFG = Otg::kInternalPhy;
  if (!wait_until([&] { return (u.GRSTCTL & Otg::kBusIdle) != 0; }, kFewLooks)) return false;
  u.GRSTCTL = Otg::kCoreReset;
  if (!wait_until([&] { return (u.GRSTCTL & Otg::kCoreReset) == 0; }, kFewLooks)) return false;
  u.GUSBCFG = Otg::kInternalPhy | Otg::kForceDevice | Otg::turnaround(kTurnaround);
  u.DCTL = Otg::kDetach;
  u.GCCFG = Core::kGccfg;
  u.GOTGCTL = Core::kGotgctl;
  device_.control().identify({unique_id()[0], unique_id()[1], unique_id()[2]});
  return true;
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::interrupt_on_events() {
  Otg& u = otg();
  u.DIEPMSK = Otg::kComplete;
  u.GINTMSK = Otg::kReceived | Otg::kSuspend | Otg::kReset | Otg::kSendEvent;
  u.GAHBCFG = Otg::kInterruptOn;
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::attach() {
  Otg& u = otg();
  u.PCGCCTL = 0;
  u.DCFG = Otg::kFullSpeed;
  u.GRXFSIZ = kReceiveWords;
  std::uint32_t at = kReceiveWords;
  const auto give = [&](Reg& size, std::uint32_t words) {
    size = words << 16 | at;
    at += words;
  };
  give(u.DIEPTXF0, kControlWords);
  for (const OtgEndpoint& e : kEndpoints)
    if (e.in()) give(u.DIEPTXF[e.number() - 1], send_words(e.bytes));
  static_assert([] {
    std::uint32_t words = kReceiveWords + kControlWords;
    for (const OtgEndpoint& e : kEndpoints)
      if (e.in()) words += send_words(e.bytes);
    return words;
  }() <= Core::kMemoryWords);
  on_bus_reset();
  u.GINTSTS = 0xFFFF'FFFF;
  u.DCTL = 0;
  attached_ = true;
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::detach() {
  otg().DCTL = Otg::kDetach;
  device_.on_reset();
  attached_ = false;
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::flush(std::uint32_t which) {
  otg().GRSTCTL = which;
  constexpr std::uint32_t kBusy = Otg::kFlushReceive | Otg::kFlushSend;
  static_cast<void>(wait_until([] { return (otg().GRSTCTL & kBusy) == 0; }, kFewLooks));
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::on_bus_reset() {
  Otg& u = otg();
  u.out[kControl].CTL = Otg::kSetNak;
  stop_sending(kControl);
  for (const OtgEndpoint& e : kEndpoints) {
    if (e.in())
      stop_sending(e.number());
    else
      u.out[e.number()].CTL = Otg::kSetNak;
  }
  taking_ = 0;
  flush(Otg::kFlushSend | Otg::fifo_number(kAllFifos));
  flush(Otg::kFlushReceive);
  u.DCFG = u.DCFG & ~Otg::kAddressMask;
  device_.on_reset();
  u.out[kControl].TSIZ = Otg::kThreeSetups;
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::stop_sending(unsigned endpoint) {
  Otg::Endpoint& e = otg().in[endpoint];
  if ((e.CTL & Otg::kEnable) == 0) return;
  e.CTL = e.CTL | Otg::kSetNak;
  static_cast<void>(wait_until([&] { return (e.INT & Otg::kNakInForce) != 0; }, kFewLooks));
  e.CTL = e.CTL | Otg::kSetNak | Otg::kDisable;
  static_cast<void>(wait_until([&] { return (e.INT & Otg::kDisabled) != 0; }, kFewLooks));
  e.INT = Otg::kDisabled;
  flush(Otg::kFlushSend | Otg::fifo_number(endpoint));
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::set_up(std::size_t slot) {
  const OtgEndpoint& e = kEndpoints[slot];
  const UsbControl& control = device_.control();
  const std::uint32_t state = (!control.open()        ? 0
                               : control.halted(slot) ? Otg::kActive | Otg::kDataZero | Otg::kStall
                                                      : Otg::kActive | Otg::kDataZero) |
                              Otg::kSetNak | (e.interrupt ? Otg::kInterrupt : Otg::kBulk) | e.bytes;
  if (e.in()) {
    stop_sending(e.number());
    otg().in[e.number()].CTL = state | Otg::fifo_of(e.number());
  } else {
    otg().out[e.number()].CTL = state;
    taking_ = static_cast<std::uint8_t>(taking_ & ~(1u << slot));
  }
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::take_control() {
  Otg::Endpoint& e = otg().out[kControl];
  e.TSIZ = Otg::kThreeSetups | Otg::kOnePacket | usb::kPacketBytes;
  e.CTL = e.CTL | Otg::kEnable | Otg::kClearNak;
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::take_data(std::size_t slot) {
  Otg::Endpoint& e = otg().out[kEndpoints[slot].number()];
  e.TSIZ = Otg::kOnePacket | kEndpoints[slot].bytes;
  e.CTL = e.CTL | Otg::kEnable | Otg::kClearNak;
  taking_ = static_cast<std::uint8_t>(taking_ | 1u << slot);
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::send(unsigned endpoint, UsbControl::Packet packet) {
  Otg::Endpoint& e = otg().in[endpoint];
  e.TSIZ = Otg::kOnePacket | static_cast<std::uint32_t>(packet.size());
  e.CTL = e.CTL | Otg::kEnable | Otg::kClearNak;
  Reg& fifo = otg().fifo[endpoint].word[0];
  std::size_t at = 0;
  for (; at + 4 <= packet.size(); at += 4) fifo = get_u32_le(packet.subspan(at));
  if (at < packet.size()) fifo = static_cast<std::uint32_t>(get_le(packet.subspan(at), packet.size() - at));
}

// One entry of the receive FIFO.
template <typename Core, typename Device>
void OtgPort<Core, Device>::receive() {
  const std::uint32_t status = otg().GRXSTSP;
  const std::uint32_t endpoint = status & 0xF, bytes = status >> 4 & 0x7FF, what = status >> 17 & 0xF;
  const auto slot_of = [&](auto&& then) {
    for (std::size_t slot = 0; slot < kEndpoints.size(); ++slot)
      if (kEndpoints[slot].address == endpoint) then(slot);
  };
  Reg& fifo = otg().fifo[0].word[0];
  if (what == kSetupData) {
    setup_ = {fifo, fifo};
  } else if (what == kSetupDone) {
    on_setup();
  } else if (what == kOutData) {
    std::array<std::uint8_t, usb::kPacketBytes> packet;
    for (std::size_t at = 0; at < bytes; at += 4) {
      const std::uint32_t word = fifo;
      if (at < packet.size()) put_u32_le(std::span(packet).subspan(at), word);
    }
    const auto got = std::span(packet).first(std::min<std::size_t>(bytes, packet.size()));
    if (endpoint == kControl)
      device_.on_control_data(got);
    else
      slot_of([&](std::size_t slot) { device_.on_packet(slot, got); });
    stall_if_told();
  } else if (what == kOutDone) {
    if (endpoint == kControl)
      take_control();
    else
      slot_of([&](std::size_t slot) { taking_ = static_cast<std::uint8_t>(taking_ & ~(1u << slot)); });
  }
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::on_setup() {
  Otg& u = otg();
  stop_sending(kControl);
  std::array<std::uint8_t, 8> bytes{};
  put_u32_le(bytes, setup_[0]);
  put_u32_le(std::span(bytes).subspan(4), setup_[1]);
  device_.on_setup(bytes);
  u.DCFG = (u.DCFG & ~Otg::kAddressMask) | Otg::address(device_.control().address());
  take_control();
  stall_if_told();
}

// Once, and at once: the core itself takes it back with the next setup packet.
template <typename Core, typename Device>
void OtgPort<Core, Device>::stall_if_told() {
  if (!device_.control().stalled()) return;
  Otg& u = otg();
  u.in[kControl].CTL = u.in[kControl].CTL | Otg::kStall;
  u.out[kControl].CTL = u.out[kControl].CTL | Otg::kStall;
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::send_what_waits() {
  if (can_send(kControl))
    if (const auto packet = device_.control().next_packet()) send(kControl, *packet);
  if (!device_.control().open()) return;
  for (std::size_t slot = 0; slot < kEndpoints.size(); ++slot) {
    const OtgEndpoint& e = kEndpoints[slot];
    if (e.in()) {
      if (!can_send(e.number())) continue;
      if (const auto packet = device_.next_packet(slot)) send(e.number(), *packet);
    } else if ((taking_ >> slot & 1) == 0 && device_.takes(slot)) {
      take_data(slot);
    }
  }
}

template <typename Core, typename Device>
void OtgPort<Core, Device>::serve() {
  Otg& u = otg();
  const std::uint32_t events = u.GINTSTS;
  if ((events & Otg::kSendEvent) != 0) {
    u.in[kControl].INT = Otg::kComplete;
    for (const OtgEndpoint& e : kEndpoints)
      if (e.in()) u.in[e.number()].INT = Otg::kComplete;
  }
  if ((events & Otg::kReset) != 0) {
    u.GINTSTS = Otg::kReset | Otg::kSuspend;
    on_bus_reset();
  } else if ((events & Otg::kReceived) != 0) {
    for (int i = 0; i < kMostEntries && (u.GINTSTS & Otg::kReceived) != 0; ++i) receive();
  } else if ((events & Otg::kSuspend) != 0) {
    u.GINTSTS = Otg::kSuspend;
    if constexpr (requires { device_.on_suspend(); }) device_.on_suspend();
  }
  const std::uint8_t changes = device_.control().take_changes();
  for (std::size_t slot = 0; slot < kEndpoints.size(); ++slot)
    if ((changes >> slot & 1) != 0) set_up(slot);
  send_what_waits();
}

}  // namespace kinebus::stm32
