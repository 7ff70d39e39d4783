#include "node_firmware/port/stm32f4/bridged_can.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"

namespace kinebus::stm32 {
namespace {

// A receiver has a frame at the last but one bit of its end, its sender a bit later (ISO 11898-1).
constexpr std::uint32_t kSenderLater = kLocalHz / 1'000'000;

}  // namespace

void BridgedCan::start() {
  CanPort::start();
  enable_interrupt(Irq::kCan1Tx, 0);
}

CanPort::Received BridgedCan::as_received(const CanFrame& frame, std::uint32_t counts) {
  return {identifier_register(frame), frame.length, get_u32_le(frame.data),
          get_u32_le(std::span(frame.data).subspan(4)), counts};
}

void BridgedCan::drop() {
  CanPort::drop();
  if (stalled_.load(std::memory_order_relaxed) && received_.size() < kMostWaiting)
    pend_interrupt(Irq::kOtgFs);
}

void BridgedCan::accept(std::span<const CanAccept> filters) {
  filter_count_ = std::min(filters.size(), filters_.size());
  std::copy_n(filters.begin(), filter_count_, filters_.begin());
  find_wanted();
  if (!open_) apply(pack_filters(filters));
}

void BridgedCan::find_wanted() {
  std::array<std::uint32_t, kStandardIds / 32> wanted{};
  for (const CanAccept& filter : std::span(filters_).first(filter_count_)) {
    // Where the mask has low bits at 0, so many ids in a row.
    const std::uint32_t row = ~std::uint32_t{filter.mask} & (kStandardIds - 1);
    for (std::uint32_t id = filter.value; id <= (filter.value | row); ++id)
      if ((id & filter.mask) == filter.value) wanted[id / 32] |= std::uint32_t{1} << (id % 32);
  }
  // Word by word: an interrupt between finds the one or the other of each.
  std::ranges::copy(wanted, wanted_.begin());
}

bool BridgedCan::wanted(const Received& item) const {
  if ((item.identifier & Can::kExtended) != 0) return false;
  const std::uint32_t id = item.identifier >> 21;
  return (wanted_[id / 32] >> (id % 32) & 1) != 0;
}

void BridgedCan::serve_mailboxes() {
  if (!joined()) join();
  for (int i = 0; i < kHostMailbox; ++i) {
    const std::uint8_t done = done_[static_cast<std::size_t>(i)].exchange(kNotYet, std::memory_order_acquire);
    if (done != kNotYet) queue_.on_empty(i, done == kSent);
  }
  while (locals_.size() < 8) {
    const auto action = queue_.next();
    if (action.kind == TransmitQueue::Action::Kind::kNothing) return;
    if (action.kind == TransmitQueue::Action::Kind::kAbort) {
      can1().TSR = Can::kAbort[action.mailbox];
      return;
    }
    if (alone()) {
      queue_.on_empty(action.mailbox, true);
      locals_.push(action.frame);
      pend_interrupt(Irq::kOtgFs);
    } else {
      load(action.mailbox, action.frame);
    }
  }
}

void BridgedCan::serve() {
  clock_.keep();
  if (open_ != hosted()) {
    open_ = hosted();
    apply(open_ ? kEveryFrame : pack_filters(std::span(filters_).first(filter_count_)));
    if (!open_) alone_.store(false);
    pend_interrupt(Irq::kOtgFs);
  }
  const bool waits = !joined() || !queue_.idle() || loads_.load(std::memory_order_relaxed);
  const bool lonely = lonely_.look(local_counts(), waits, progress_.load(std::memory_order_relaxed));
  if (lonely && open_ && !alone()) {
    alone_.store(true);
    // What waits there goes to those inside.
    can1().TSR = Can::kAbort[0] | Can::kAbort[1] | Can::kAbort[2];
    pend_interrupt(Irq::kOtgFs);
  }
  if (!queue_.idle()) serve_mailboxes();
  if (open_ && state_bits() != told_state_.load(std::memory_order_relaxed)) pend_interrupt(Irq::kOtgFs);
}

void BridgedCan::tell_nodes(const Received& item) {
  if (wanted(item) && !received_.push(item)) ++events_.overruns;
}

void BridgedCan::tell_host(const Received& item, const GsUsbDevice::Ticket* ticket) {
  if (!hosted()) return;
  // Echoes have room always: the host waits for each.
  if (ticket == nullptr && for_host_.size() >= kForHost - 2 * gs_usb::kMostEchoes) {
    lost_.store(true, std::memory_order_relaxed);
    return;
  }
  for_host_.push({item, ticket != nullptr ? *ticket : GsUsbDevice::Ticket{}});
  if (host_.sleeps()) pend_interrupt(Irq::kOtgFs);
}

std::optional<UsbControl::Packet> BridgedCan::next_for_host() {
  if (const ForHost* next = for_host_.front()) {
    const std::uint32_t at = clock_.at(next->item.counts);
    if (lost_.exchange(false, std::memory_order_relaxed)) host_.on_lost();
    if (next->ticket.echo != gs_usb::kNoEcho)
      host_.on_sent(next->ticket, next->item.frame(), at);
    else
      host_.on_received(next->item.frame(), at);
    for_host_.drop();
  } else {
    tell_state();
  }
  return host_.next_data();
}

void BridgedCan::tell_state() {
  if (!hosted()) {
    told_alone_ = false;
    return;
  }
  const std::uint32_t bits = state_bits();
  const bool lonely = alone();
  if (bits == told_state_.load(std::memory_order_relaxed) && lonely == told_alone_) return;
  told_state_.store(bits, std::memory_order_relaxed);
  const CanState::Kind kind = lonely                        ? CanState::kActive
                              : (bits & Can::kBusOff) != 0  ? CanState::kBusOff
                              : (bits & Can::kPassive) != 0 ? CanState::kPassive
                              : (bits & Can::kWarning) != 0 ? CanState::kWarning
                                                            : CanState::kActive;
  host_.on_state({kind, static_cast<std::uint8_t>(bits >> 24), static_cast<std::uint8_t>(bits >> 16)},
                 clock_.now());
  if (lonely && !told_alone_) host_.on_alone(clock_.now());
  told_alone_ = lonely;
}

void BridgedCan::on_progress() {
  progress_.store(progress_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  alone_.store(false, std::memory_order_relaxed);
}

void BridgedCan::on_receive(std::uint32_t counts) {
  while (const auto item = take(counts)) {
    on_progress();
    tell_host(*item);
    tell_nodes(*item);
  }
  count_overruns();
}

void BridgedCan::on_transmit(std::uint32_t counts) {
  Can& can = can1();
  const std::uint32_t status = can.TSR;
  for (int i = 0; i <= kHostMailbox; ++i) {
    if ((status & Can::kRequestDone[i]) == 0) continue;
    const bool sent = (status & Can::kSentGood[i]) != 0;
    // They stay what they were until the next frame is put in.
    const Can::TxMailbox& mailbox = can.tx[i];
    const Received item{mailbox.TIR & ~Can::kTransmit, mailbox.TDTR & 0xF, mailbox.TDLR, mailbox.TDHR,
                        sent ? counts - kSenderLater : counts};
    can.TSR = Can::kRequestDone[i];
    if (sent) on_progress();
    if (i < kHostMailbox) {
      if (sent) tell_host(item);
      done_[static_cast<std::size_t>(i)].store(sent ? kSent : kTakenBack, std::memory_order_release);
    } else if (loads_.load(std::memory_order_acquire)) {
      tell_host(item, &loaded_);
      tell_nodes(item);
      loads_.store(false, std::memory_order_release);
    } else {
      probing_.store(false);
    }
  }
  pend_interrupt(Irq::kOtgFs);
}

// What is said inside: the other interrupts must not come between, as they put frames into the same rings.
void BridgedCan::say_inside(const CanFrame& frame, const GsUsbDevice::Ticket* ticket) {
  const Received item = as_received(frame, local_counts());
  disable_interrupts();
  tell_host(item, ticket);
  if (ticket != nullptr) tell_nodes(item);
  enable_interrupts();
}

void BridgedCan::look_for_frames() {
  for (const CanFrame* frame = locals_.front(); frame != nullptr; frame = locals_.front()) {
    say_inside(*frame, nullptr);
    locals_.drop();
  }
  while (!loads_.load(std::memory_order_acquire) && (alone() || !probing_.load(std::memory_order_relaxed))) {
    const auto* next = host_.next_frame();
    if (next == nullptr) break;
    const bool full = received_.size() >= kMostWaiting;
    stalled_.store(full, std::memory_order_relaxed);
    if (full) return;
    if (!alone()) {
      loaded_ = next->ticket;
      loads_.store(true, std::memory_order_release);
      load(kHostMailbox, next->frame);
    } else {
      say_inside(next->frame, &next->ticket);
    }
    host_.drop_frame();
  }
  if (!alone() || loads_.load() || probing_.load()) return;
  probing_.store(true);
  load(kHostMailbox, kProbe);
}

}  // namespace kinebus::stm32
