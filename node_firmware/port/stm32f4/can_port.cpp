#include "node_firmware/port/stm32f4/can_port.hpp"

#include "node_firmware/port/stm32f4/registers.hpp"
#include "protocol/bytes.hpp"

namespace kinebus::stm32 {
namespace {

constexpr std::uint32_t kBitTiming = (kCanTiming.jump - 1) << 24 | (kCanTiming.segment2 - 1) << 20 |
                                     (kCanTiming.segment1 - 1) << 16 | (kCanTiming.prescaler - 1);

}  // namespace

CanFrame CanPort::Received::frame() const {
  CanFrame frame;
  frame.extended = (identifier & Can::kExtended) != 0;
  frame.remote = (identifier & Can::kRemote) != 0;
  frame.id = frame.extended ? identifier >> 3 : identifier >> 21;
  frame.length = static_cast<std::uint8_t>((length & 0xF) > 8 ? 8 : length & 0xF);
  put_u32_le(frame.data, low);
  put_u32_le(std::span(frame.data).subspan(4), high);
  return frame;
}

void CanPort::start() {
  enable_clock(rcc().APB1ENR, Rcc::kCan1);
  can1().MCR = Can::kInitRequest;
  static_cast<void>(wait_until([] { return (can1().MSR & Can::kInitDone) != 0; }, 10'000));
  join();
  enable_interrupt(Irq::kCan1Rx0, 0);
  enable_interrupt(Irq::kCan1Sce, 12);
}

// A bus that is stuck, or none, must not hold up what can be said elsewhere: no step is waited for.
void CanPort::join() {
  Can& can = can1();
  const bool initialising = (can.MSR & Can::kInitDone) != 0;
  if (progress_ == Progress::kAsked && initialising) {
    can.MCR = Can::kInitRequest | Can::kAutoBusOff;
    can.BTR = kBitTiming;
    can.IER =
        interrupts_ | Can::kOnFifo0 | Can::kOnOverrun0 | Can::kOnPassive | Can::kOnBusOff | Can::kOnError;
    can.MCR = Can::kAutoBusOff;
    progress_ = Progress::kSetUp;
  } else if (progress_ == Progress::kSetUp && !initialising) {
    progress_ = Progress::kJoined;
  }
}

void CanPort::accept(std::span<const CanAccept> filters) {
  apply(pack_filters(filters));
}

void CanPort::apply(const CanBanks& banks) {
  Can& can = can1();
  can.FMR = can.FMR | Can::kFilterInit;
  can.FA1R = 0;
  can.FM1R = banks.lists;
  can.FS1R = 0;   // 16 bits
  can.FFA1R = 0;  // all to FIFO 0: one order of arrival
  for (std::size_t i = 0; i < CanBanks::kBanks; ++i) {
    can.filter[i].R1 = banks.words[i][0];
    can.filter[i].R2 = banks.words[i][1];
  }
  can.FA1R = banks.used;
  can.FMR = can.FMR & ~Can::kFilterInit;
}

std::optional<CanPort::Received> CanPort::take(std::uint32_t counts) {
  Can& can = can1();
  if ((can.RFR[0] & Can::kFifoCount) == 0) return std::nullopt;
  const Can::RxFifo& fifo = can.rx[0];
  const Received item{fifo.RIR, fifo.RDTR, fifo.RDLR, fifo.RDHR, counts};
  can.RFR[0] = Can::kFifoRelease;
  // The hardware needs a moment before the count shows the release; the flag clears by itself.
  static_cast<void>(wait_until([&] { return (can.RFR[0] & Can::kFifoRelease) == 0; }, 100));
  return item;
}

void CanPort::count_overruns() {
  Can& can = can1();
  if ((can.RFR[0] & Can::kFifoOverrun) == 0) return;
  can.RFR[0] = Can::kFifoOverrun;
  ++events_.overruns;
}

void CanPort::on_receive(std::uint32_t counts) {
  while (const auto item = take(counts))
    if (!received_.push(*item)) ++events_.overruns;
  count_overruns();
}

void CanPort::on_state() {
  Can& can = can1();
  const std::uint32_t state = can.ESR;
  const bool off = (state & Can::kBusOff) != 0;
  const bool passive = (state & Can::kPassive) != 0;
  if (off && !was_off_) ++events_.bus_off;
  if (passive && !was_passive_) ++events_.passive;
  was_off_ = off;
  was_passive_ = passive;
  can.MSR = Can::kErrorInterruptFlag;
}

bool CanPort::bus_off() const {
  return (can1().ESR & Can::kBusOff) != 0;
}

void CanPort::serve_mailboxes() {
  if (!joined()) join();
  Can& can = can1();
  for (int i = 0; i < TransmitQueue::kMailboxes; ++i) {
    const std::uint32_t status = can.TSR;
    if ((status & Can::kRequestDone[i]) == 0) continue;
    can.TSR = Can::kRequestDone[i];
    queue_.on_empty(i, (status & Can::kSentGood[i]) != 0);
  }
  for (auto action = queue_.next(); action.kind != TransmitQueue::Action::Kind::kNothing;
       action = queue_.next()) {
    if (action.kind == TransmitQueue::Action::Kind::kAbort) {
      can.TSR = Can::kAbort[action.mailbox];
      return;
    }
    load(action.mailbox, action.frame);
  }
}

std::uint32_t CanPort::identifier_register(const CanFrame& frame) {
  return (frame.extended ? frame.id << 3 | Can::kExtended : frame.id << 21) |
         (frame.remote ? Can::kRemote : 0);
}

void CanPort::load(int mailbox, const CanFrame& frame) {
  Can::TxMailbox& registers = can1().tx[mailbox];
  registers.TDTR = frame.length;
  registers.TDLR = get_u32_le(frame.data);
  registers.TDHR = get_u32_le(std::span(frame.data).subspan(4));
  registers.TIR = identifier_register(frame) | Can::kTransmit;
}

}  // namespace kinebus::stm32
