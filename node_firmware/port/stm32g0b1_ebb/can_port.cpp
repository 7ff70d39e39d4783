#include "node_firmware/port/stm32g0b1_ebb/can_port.hpp"

#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"
#include "protocol/bytes.hpp"

namespace kinebus::g0b1 {
namespace {

constexpr std::uint32_t kBitTiming = (kCanTiming.jump - 1) << 25 | (kCanTiming.prescaler - 1) << 16 |
                                     (kCanTiming.segment1 - 1) << 8 | (kCanTiming.segment2 - 1);

}  // namespace

CanFrame CanPort::Received::frame() const {
  CanFrame frame;
  frame.extended = (identifier & CanMemory::kExtended) != 0;
  frame.remote = (identifier & CanMemory::kRemote) != 0;
  frame.id = frame.extended ? identifier & 0x1FFF'FFFF : identifier >> 18 & 0x7FF;
  const std::uint32_t length = control >> 16 & 0xF;
  frame.length = static_cast<std::uint8_t>(length > 8 ? 8 : length);
  put_u32_le(frame.data, low);
  put_u32_le(std::span(frame.data).subspan(4), high);
  return frame;
}

void CanPort::start() {
  enable_clock(rcc().APBENR1, Rcc::kCan);
  rcc().CCIPR2 = rcc().CCIPR2 & ~Rcc::kCanClockMask;
  Fdcan& can = fdcan2();
  can.CCCR = Fdcan::kInit;
  static_cast<void>(wait_until([&] { return (can.CCCR & Fdcan::kInit) != 0; }, 10'000));
  can.CCCR = Fdcan::kInit | Fdcan::kChange;
  can.NBTP = kBitTiming;
  can.RXGFC = Fdcan::standard_filters(kTaps * kCanFilters) | Fdcan::kRejectStandard | Fdcan::kRejectExtended |
              Fdcan::kRejectExtendedRemote;
  can.TXBC = Fdcan::kQueue;  // lowest identifier first; TransmitQueue has one frame of each in a buffer
  // After power-on the message RAM holds anything.
  for (Reg& filter : can_memory2().standard_filter) filter = 0;
  can.ILS = Fdcan::kErrorsToLine1;
  can.IE = Fdcan::kNew0 | Fdcan::kLost0 | Fdcan::kPassiveChanged | Fdcan::kBusOffChanged;
  can.ILE = Fdcan::kBothLines;
  enable_interrupt(Irq::kCan0, 0);
  enable_interrupt(Irq::kCan1, 3);
  can.CCCR = 0;
}

void CanPort::accept(std::size_t tap, std::span<const CanAccept> filters) {
  Reg* place = &can_memory2().standard_filter[tap * kCanFilters];
  for (std::size_t i = 0; i < kCanFilters; ++i)
    place[i] = i < filters.size() ? CanMemory::filter(filters[i].value, filters[i].mask) : 0;
}

void CanPort::on_receive(std::uint32_t counts) {
  Fdcan& can = fdcan2();
  const std::uint32_t flags = can.IR;
  can.IR = Fdcan::kNew0 | Fdcan::kLost0;
  for (std::uint32_t status = can.RXF0S; (status & 0xF) != 0; status = can.RXF0S) {
    const std::uint32_t at = status >> 8 & 3;
    const CanMemory::Element& element = can_memory2().fifo0[at];
    const Received received{element.id, element.control, element.data[0], element.data[1], counts};
    can.RXF0A = at;
    for (auto& ring : received_)
      if (!ring.push(received)) ++events_.overruns;
  }
  if ((flags & Fdcan::kLost0) != 0) ++events_.overruns;
}

void CanPort::on_state() {
  Fdcan& can = fdcan2();
  can.IR = Fdcan::kPassiveChanged | Fdcan::kBusOffChanged;
  const std::uint32_t state = can.PSR;
  const bool off = (state & Fdcan::kBusOff) != 0;
  const bool passive = (state & Fdcan::kPassive) != 0;
  if (off && !was_off_) ++events_.bus_off;
  if (passive && !was_passive_) ++events_.passive;
  was_off_ = off;
  was_passive_ = passive;
  // The controller has stopped itself. Let go, it waits for 129 times 11 recessive bits and takes part again;
  // what it had to send is still asked for.
  if (off) can.CCCR = 0;
}

bool CanPort::bus_off() const {
  return (fdcan2().PSR & Fdcan::kBusOff) != 0;
}

void CanPort::serve_mailboxes() {
  Fdcan& can = fdcan2();
  for (int i = 0; i < TransmitQueue::kMailboxes; ++i) {
    std::uint32_t& buffer = buffer_[static_cast<std::size_t>(i)];
    if (buffer == 0 || (can.TXBRP & buffer) != 0) continue;
    queue_.on_empty(i, (can.TXBTO & buffer) != 0);
    buffer = 0;
  }
  for (auto action = queue_.next(); action.kind != TransmitQueue::Action::Kind::kNothing;
       action = queue_.next()) {
    std::uint32_t& buffer = buffer_[static_cast<std::size_t>(action.mailbox)];
    if (action.kind == TransmitQueue::Action::Kind::kAbort) {
      can.TXBCR = buffer;
      return;
    }
    const std::uint32_t place = can.TXFQS >> 16 & 3;  // where the controller wants the next one
    CanMemory::Element& element = can_memory2().transmit[place];
    element.id = CanMemory::standard(action.frame.id);
    element.control = CanMemory::length(action.frame.length);
    element.data[0] = get_u32_le(action.frame.data);
    element.data[1] = get_u32_le(std::span(action.frame.data).subspan(4));
    buffer = std::uint32_t{1} << place;
    can.TXBAR = buffer;
  }
}

}  // namespace kinebus::g0b1
