#pragma once
// A USART of the STM32G0B1 with FIFOs, at the bits of its wire: 8 data bits, one stop bit, half duplex, DMA
// for what it receives (RM0444). Its interrupts and other modes are not modelled.

#include <cstdint>
#include <deque>
#include <functional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator::g0 {

class Usart final : public Peripheral {
 public:
  static constexpr std::size_t kFifo = 8;

  /// `ticks` of its clock are `cycles`.
  Usart(Cycle cycles, Cycle ticks) : cycles_(cycles), ticks_(ticks) {}

  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return bit_at_ < sample_at_ ? bit_at_ : sample_at_; }
  void advance(Cycle now) override;
  void reset();

  /// It has one wire for both ways, and that is at the pin that is otherwise RX.
  bool one_wire_at_rx() const;
  /// It puts a bit out now; otherwise it lets go of the wire.
  bool drives() const { return sends_; }
  bool drives_low() const { return sends_ && !out_; }
  void on_wire(bool high, Cycle now);

  std::function<void(Cycle)> on_output;   ///< what it drives has changed
  std::function<void(Cycle)> on_request;  ///< DMA is to fetch a byte from RDR
  /// Bytes that were written where there was no room, or read where there was none.
  std::uint64_t misused() const { return misused_; }

 private:
  bool on(std::uint32_t bits) const { return (cr1_ & (bits | 1)) == (bits | 1); }
  std::size_t room() const { return (cr1_ >> 29 & 1) != 0 ? kFifo : 1; }
  Cycle after(Cycle from, std::uint32_t half_bits) const {
    return from + half_bits * Cycle{brr_} * cycles_ / (2 * ticks_);
  }
  void next_bit();
  void sample();
  void ask(Cycle now);
  void put_out(bool sends, bool high, Cycle now);

  Cycle cycles_, ticks_;
  std::uint32_t cr1_ = 0, cr2_ = 0, cr3_ = 0, brr_ = 0, errors_ = 0;
  std::deque<std::uint8_t> to_send_, received_;
  // Sending: a frame of 10 bits, the lowest first; after the transmitter was switched on, one without edges.
  bool sends_ = false, out_ = true, idle_frame_ = false;
  std::uint32_t frame_ = 0, bits_left_ = 0, bit_ = 0;
  Cycle frame_at_ = 0, bit_at_ = kNever;
  // Receiving.
  bool wire_high_ = true;
  std::uint32_t heard_ = 0, bits_heard_ = 0;
  Cycle edge_at_ = 0, sample_at_ = kNever;
  std::uint64_t misused_ = 0;
};

}  // namespace kinebus::emulator::g0
