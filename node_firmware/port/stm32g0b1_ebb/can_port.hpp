#pragma once
// FDCAN2 for classic frames: 1 Mbit/s, receive time stamps at interrupt entry, three transmit buffers by
// TransmitQueue. Recovery from bus-off is begun by the interrupt that tells of it. Each program of the
// chip listens and sends through a CanTap of its own.

#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/board/can_timing.hpp"
#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/ring.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "protocol/can/frame.hpp"

namespace kinebus::g0b1 {

inline constexpr CanTiming kCanTiming = can_timing(kCoreHz, 1'000'000, 800);
static_assert(kCanTiming.prescaler * kCanTiming.quanta() * 1'000'000 == kCoreHz);
static_assert(kCanTiming.sample_permille() >= 750 && kCanTiming.sample_permille() <= 875,
              "CiA 301: 75 to 87.5 %");

class CanPort {
 public:
  static constexpr std::size_t kTaps = 1;  // as many as are emptied: one that is not counts overruns
  static_assert(kTaps * kCanFilters <= 28, "standard filters of an instance");

  /// As the controller gives it: the interrupt only copies.
  struct Received {
    std::uint32_t identifier = 0, control = 0, low = 0, high = 0;
    std::uint32_t counts = 0;  ///< local time at interrupt entry
    CanFrame frame() const;
  };

  /// Sets the controller up. It joins the bus when that has been recessive for 11 bits: soon, or when there
  /// is one.
  void start();

  // Main loop.
  void accept(std::size_t tap, std::span<const CanAccept> filters);
  const Received* front(std::size_t tap) const { return received_[tap].front(); }
  void drop(std::size_t tap) { received_[tap].drop(); }
  TransmitQueue& queue() { return queue_; }
  /// Moves frames into the buffers, and finds those that were sent.
  void serve_mailboxes();
  const CanEvents& events() const { return events_; }
  bool bus_off() const;

  // Interrupts.
  void on_receive(std::uint32_t counts);
  void on_state();

 private:
  TransmitQueue queue_;
  std::array<std::uint32_t, TransmitQueue::kMailboxes> buffer_{};  // by mailbox: its buffer's bit; 0: none
  // The longest pass of the main loop is stated in README.md; 128 of the shortest frames are 6 ms.
  std::array<Ring<Received, 128>, kTaps> received_;
  CanEvents events_;
  bool was_off_ = false, was_passive_ = false;
};

/// One program's share of the controller.
class CanTap {
 public:
  /// A frame takes the node 0.5 ms.
  static constexpr int kInputsPerPass = 2;
  constexpr CanTap(CanPort& port, std::size_t number) : port_(port), number_(number) {}
  const CanPort::Received* front() const { return port_.front(number_); }
  void drop() { port_.drop(number_); }
  TransmitQueue& queue() { return port_.queue(); }
  void serve_mailboxes() { port_.serve_mailboxes(); }
  void accept(std::span<const CanAccept> filters) { port_.accept(number_, filters); }
  const CanEvents& events() const { return port_.events(); }
  bool bus_off() const { return port_.bus_off(); }

 private:
  CanPort& port_;
  std::size_t number_;
};
static_assert(CanDriver<CanTap>);

}  // namespace kinebus::g0b1
