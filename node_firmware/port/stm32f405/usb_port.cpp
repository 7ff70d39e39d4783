#include "node_firmware/port/stm32f405/usb_port.hpp"

#include <algorithm>
#include <array>

#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f405/board.hpp"
#include "protocol/bytes.hpp"

namespace kinebus::stm32 {
namespace {

enum : unsigned { kControl, kData, kNotify, kEndpoints };
constexpr unsigned kAllFifos = 16;
// The OTG core's memory: 1024 words. Received: a packet with its status, setup packets, and room for one
// more.
constexpr std::uint32_t kReceiveWords = 128, kControlWords = 32, kDataWords = 32, kNotifyWords = 16;
static_assert(kReceiveWords + kControlWords + kDataWords + kNotifyWords <= 1024);
// A stream to a terminal: packets that are never full need no empty one after them.
constexpr std::size_t kTextBytes = cdc::kPacketBytes - 1;
// What the core does within a few clocks, or when a packet that is on the wire (50 us) has ended.
constexpr std::uint32_t kFewLooks = 1000;
// A plug's contacts come to rest, and the core has become a device (25 ms).
constexpr std::uint32_t kSettle = kLocalHz / 20;
// Between a packet and its answer at full speed with a fast bus clock: RM0090, table of TRDT.
constexpr unsigned kTurnaround = 6;
// What GRXSTSP says has come.
enum : std::uint32_t { kOutData = 2, kOutDone = 3, kSetupDone = 4, kSetupData = 6 };

void configure_sending(std::uint32_t& at, Reg& size_register, std::uint32_t words) {
  size_register = words << 16 | at;
  at += words;
}

}  // namespace

void UsbPort::start() {
  Otg& u = otg();
  // The core would wait for an external PHY's clock whenever the processor sleeps.
  rcc().AHB1LPENR = rcc().AHB1LPENR & ~Rcc::kUsbUlpi;
  enable_clock(rcc().AHB1ENR, Rcc::kUsbHs);
  u.GUSBCFG = Otg::kInternalPhy;
  if (!wait_until([&] { return (u.GRSTCTL & Otg::kBusIdle) != 0; }, kFewLooks)) return;
  u.GRSTCTL = Otg::kCoreReset;
  if (!wait_until([&] { return (u.GRSTCTL & Otg::kCoreReset) == 0; }, kFewLooks)) return;
  u.GUSBCFG = Otg::kInternalPhy | Otg::kForceDevice | Otg::turnaround(kTurnaround);
  u.DCTL = Otg::kDetach;
  u.GCCFG = Otg::kTransceiver | Otg::kNoVbusSensing;
  device_.identify({unique_id()[0], unique_id()[1], unique_id()[2]});
  good_ = true;
}

void UsbPort::attach() {
  Otg& u = otg();
  u.PCGCCTL = 0;
  u.DCFG = Otg::kFullSpeed;
  u.GRXFSIZ = kReceiveWords;
  std::uint32_t at = kReceiveWords;
  configure_sending(at, u.DIEPTXF0, kControlWords);
  configure_sending(at, u.DIEPTXF[kData - 1], kDataWords);
  configure_sending(at, u.DIEPTXF[kNotify - 1], kNotifyWords);
  on_bus_reset();
  u.GINTSTS = 0xFFFF'FFFF;
  u.DCTL = 0;
  attached_ = true;
}

void UsbPort::detach() {
  otg().DCTL = Otg::kDetach;
  device_.on_reset();
  attached_ = false;
}

void UsbPort::flush(std::uint32_t which) {
  otg().GRSTCTL = which;
  constexpr std::uint32_t kBusy = Otg::kFlushReceive | Otg::kFlushSend;
  static_cast<void>(wait_until([] { return (otg().GRSTCTL & kBusy) == 0; }, kFewLooks));
}

void UsbPort::on_bus_reset() {
  Otg& u = otg();
  u.out[kControl].CTL = Otg::kSetNak;
  u.out[kData].CTL = Otg::kSetNak;
  for (unsigned endpoint = kControl; endpoint < kEndpoints; ++endpoint) stop_sending(endpoint);
  flush(Otg::kFlushSend | Otg::fifo_number(kAllFifos));
  flush(Otg::kFlushReceive);
  u.DCFG = u.DCFG & ~Otg::kAddressMask;
  device_.on_reset();
  u.out[kControl].TSIZ = Otg::kThreeSetups;
}

// Whatever an IN endpoint has in its FIFO is thrown away.
void UsbPort::stop_sending(unsigned endpoint) {
  Otg::Endpoint& e = otg().in[endpoint];
  if ((e.CTL & Otg::kEnable) == 0) return;
  e.CTL = e.CTL | Otg::kSetNak;
  static_cast<void>(wait_until([&] { return (e.INT & Otg::kNakInForce) != 0; }, kFewLooks));
  e.CTL = e.CTL | Otg::kSetNak | Otg::kDisable;
  static_cast<void>(wait_until([&] { return (e.INT & Otg::kDisabled) != 0; }, kFewLooks));
  e.INT = Otg::kDisabled;
  flush(Otg::kFlushSend | Otg::fifo_number(endpoint));
}

void UsbPort::set_up(CdcDevice::Slot slot) {
  Otg& u = otg();
  const std::uint32_t state = !device_.open()        ? 0
                              : device_.halted(slot) ? Otg::kActive | Otg::kDataZero | Otg::kStall
                                                     : Otg::kActive | Otg::kDataZero;
  switch (slot) {
    case CdcDevice::kDataOut:
      u.out[kData].CTL = state | Otg::kSetNak | Otg::kBulk | cdc::kPacketBytes;
      taking_data_ = false;
      break;
    case CdcDevice::kDataIn:
      stop_sending(kData);
      u.in[kData].CTL = state | Otg::kSetNak | Otg::kBulk | Otg::fifo_of(kData) | cdc::kPacketBytes;
      break;
    default:
      stop_sending(kNotify);
      u.in[kNotify].CTL =
          state | Otg::kSetNak | Otg::kInterrupt | Otg::fifo_of(kNotify) | cdc::kNotificationBytes;
      break;
  }
}

void UsbPort::take_control() {
  Otg::Endpoint& e = otg().out[kControl];
  e.TSIZ = Otg::kThreeSetups | Otg::kOnePacket | cdc::kPacketBytes;
  e.CTL = e.CTL | Otg::kEnable | Otg::kClearNak;
}

void UsbPort::take_data() {
  Otg::Endpoint& e = otg().out[kData];
  e.TSIZ = Otg::kOnePacket | cdc::kPacketBytes;
  e.CTL = e.CTL | Otg::kEnable | Otg::kClearNak;
  taking_data_ = true;
}

bool UsbPort::can_send(unsigned endpoint) const {
  return (otg().in[endpoint].CTL & Otg::kEnable) == 0;
}

void UsbPort::send(unsigned endpoint, CdcDevice::Packet packet) {
  Otg::Endpoint& e = otg().in[endpoint];
  e.TSIZ = Otg::kOnePacket | static_cast<std::uint32_t>(packet.size());
  e.CTL = e.CTL | Otg::kEnable | Otg::kClearNak;
  for (std::size_t at = 0; at < packet.size(); at += 4)
    otg().fifo[endpoint].word[0] =
        static_cast<std::uint32_t>(get_le(packet.subspan(at), std::min<std::size_t>(4, packet.size() - at)));
}

// One entry of the receive FIFO.
void UsbPort::receive() {
  const std::uint32_t status = otg().GRXSTSP;
  const std::uint32_t endpoint = status & 0xF, bytes = status >> 4 & 0x7FF, what = status >> 17 & 0xF;
  Reg& fifo = otg().fifo[0].word[0];
  if (what == kSetupData) {
    setup_ = {fifo, fifo};
  } else if (what == kSetupDone) {
    on_setup();
  } else if (what == kOutData) {
    std::array<std::uint8_t, cdc::kPacketBytes> packet{};
    for (std::size_t at = 0; at < bytes; at += 4) {
      const std::uint32_t word = fifo;
      if (at < packet.size()) put_u32_le(std::span(packet).subspan(at), word);
    }
    const auto got = std::span(packet).first(std::min<std::size_t>(bytes, packet.size()));
    if (endpoint == kControl)
      device_.on_control_data(got);
    else
      device_.on_data(got);
    stall_if_told();
  } else if (what == kOutDone) {
    if (endpoint == kControl)
      take_control();
    else
      taking_data_ = false;
  }
}

void UsbPort::on_setup() {
  Otg& u = otg();
  stop_sending(kControl);
  std::array<std::uint8_t, 8> bytes{};
  put_u32_le(bytes, setup_[0]);
  put_u32_le(std::span(bytes).subspan(4), setup_[1]);
  device_.on_setup(bytes);
  u.DCFG = (u.DCFG & ~Otg::kAddressMask) | Otg::address(device_.address());
  take_control();
  stall_if_told();
}

// Once, and at once: the core itself takes it back with the next setup packet.
void UsbPort::stall_if_told() {
  if (!device_.stalled()) return;
  Otg& u = otg();
  u.in[kControl].CTL = u.in[kControl].CTL | Otg::kStall;
  u.out[kControl].CTL = u.out[kControl].CTL | Otg::kStall;
}

void UsbPort::send_what_waits() {
  if (can_send(kControl))
    if (const auto packet = device_.next_control_packet()) send(kControl, *packet);
  if (!device_.open()) return;
  if (can_send(kNotify))
    if (const auto packet = device_.next_notification()) send(kNotify, *packet);
  if (const auto text = console_.waiting(); !text.empty() && can_send(kData)) {
    std::array<std::uint8_t, kTextBytes> bytes{};
    const std::size_t count = std::min(text.size(), bytes.size());
    std::copy_n(text.begin(), count, bytes.begin());
    send(kData, std::span(bytes).first(count));
    console_.sent(count);
  }
  if (!taking_data_ && device_.takes_data()) take_data();
}

void UsbPort::serve(const Console::Subject& subject) {
  if (!good_) return;
  const std::uint32_t counts = local_counts();
  if (!read(board::kUsbVbus)) {
    cable_since_ = counts;
    if (attached_) detach();
  } else if (!attached_ && counts - cable_since_ > kSettle) {
    attach();
  }
  if (!attached_) return;
  Otg& u = otg();
  const std::uint32_t events = u.GINTSTS;
  if ((events & Otg::kReset) != 0) {
    u.GINTSTS = Otg::kReset;
    on_bus_reset();
  } else if ((events & Otg::kReceived) != 0) {
    receive();
  }
  const std::uint8_t changes = device_.take_changes();
  for (const auto slot : {CdcDevice::kDataOut, CdcDevice::kDataIn, CdcDevice::kNotifyIn})
    if ((changes >> slot & 1) != 0) set_up(slot);
  if (device_.take_hang_up()) {
    console_.forget();
    stop_sending(kData);
  }
  if (console_.waiting().empty())
    if (const auto letter = device_.next_char()) console_.hear(*letter, subject);
  send_what_waits();
}

}  // namespace kinebus::stm32
