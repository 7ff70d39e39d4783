#pragma once
// bxCAN: 1 Mbit/s, receive time stamps at interrupt entry, mailboxes by TransmitQueue, recovery from bus-off
// by the controller itself.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/board/can_timing.hpp"
#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/ring.hpp"
#include "node_firmware/core/transmit_queue.hpp"
#include "node_firmware/port/stm32f4/can_filters.hpp"
#include "node_firmware/port/stm32f4/clocks.hpp"
#include "protocol/can/frame.hpp"

namespace kinebus::stm32 {

inline constexpr CanTiming kCanTiming = can_timing(kApb1Hz, 1'000'000, 800);
static_assert(kCanTiming.prescaler * kCanTiming.quanta() * 1'000'000 == kApb1Hz);
static_assert(kCanTiming.sample_permille() >= 750 && kCanTiming.sample_permille() <= 875,
              "CiA 301: 75 to 87.5 %");

class CanPort {
 public:
  /// As the controller gives it: the interrupt only copies.
  struct Received {
    std::uint32_t identifier = 0, length = 0, low = 0, high = 0;
    std::uint32_t counts = 0;  ///< local time at interrupt entry
    CanFrame frame() const;
  };
  constexpr CanPort() = default;

  /// Sets the controller up. It joins the bus when that has been recessive for 11 bits: soon, or when there
  /// is one.
  void start();
  bool joined() const { return progress_ == Progress::kJoined; }
  void accept(std::span<const CanAccept> filters);

  /// Main loop.
  const Received* front() const { return received_.front(); }
  void drop() { received_.drop(); }
  TransmitQueue& queue() { return queue_; }
  /// Moves frames into the mailboxes, and finds those that were sent. Looks whether the bus was joined.
  void serve_mailboxes();
  const CanEvents& events() const { return events_; }
  bool bus_off() const;

  // Interrupts.
  void on_receive(std::uint32_t counts);
  void on_state();

 protected:
  /// Only the first mailboxes are the queue's; further interrupts (IER).
  constexpr CanPort(int mailboxes, std::uint32_t interrupts) : queue_(mailboxes), interrupts_(interrupts) {}
  void join();
  void apply(const CanBanks& banks);
  /// The oldest frame of the controller's FIFO, which it then has no more.
  std::optional<Received> take(std::uint32_t counts);
  void count_overruns();
  static std::uint32_t identifier_register(const CanFrame& frame);
  static void load(int mailbox, const CanFrame& frame);

  TransmitQueue queue_;
  // The longest pass of the main loop, 3.2 ms, is 68 of the shortest frames.
  Ring<Received, 128> received_;
  CanEvents events_;
  bool was_off_ = false, was_passive_ = false;
  std::uint32_t interrupts_ = 0;
  enum class Progress : std::uint8_t { kAsked, kSetUp, kJoined } progress_ = Progress::kAsked;
};
static_assert(CanDriver<CanPort>);

}  // namespace kinebus::stm32
