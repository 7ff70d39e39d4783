#pragma once
// The board's nodes, a host on USB and the CAN connector as one bus. The wire has the say: what the host
// sends reaches the board's nodes when the wire has it, with the time stamp of its end, as if they had heard
// it; what they send reaches the host then. All see one order, whatever the main loop does meanwhile.
//
// Where nobody acknowledges (LonelyBus), the bus goes on inside the chip alone. A probe, which means nothing
// to anybody, stays in a mailbox: once it is acknowledged, or something is heard, the wire has the say again.

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/board/lonely_bus.hpp"
#include "node_firmware/board/microseconds.hpp"
#include "node_firmware/port/stm32f4/can_port.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/usb/gs_usb_device.hpp"

namespace kinebus::stm32 {

class BridgedCan : public CanPort {
 public:
  explicit constexpr BridgedCan(GsUsbDevice& host)
      : CanPort(kHostMailbox, Can::kOnMailboxEmpty), host_(host) {}

  void start();

  // A CanDriver.
  void drop();
  void accept(std::span<const CanAccept> filters);
  void serve_mailboxes();

  /// Main loop, each pass: whether there is a host, and a bus.
  void serve();
  /// Nobody acknowledges what is sent.
  bool alone() const { return alone_.load(std::memory_order_relaxed); }
  std::uint32_t now_us() const { return clock_.now(); }

  // USB's interrupt, the least urgent.
  /// Frames of the host go on the bus, one at a time.
  void look_for_frames();
  /// What the IN endpoint sends next.
  std::optional<UsbControl::Packet> next_for_host();
  // The controller's interrupts, of one priority: they only note what was on the wire.
  void on_receive(std::uint32_t counts);
  void on_transmit(std::uint32_t counts);

 private:
  enum Done : std::uint8_t { kNotYet, kSent, kTakenBack };
  static constexpr int kHostMailbox = 2;
  static constexpr std::size_t kMostFilters = 96, kStandardIds = 0x800;
  // Reserved by CiA 301, so that nobody sends or takes it.
  static constexpr CanFrame kProbe{.id = 0x7EF};
  // Until then there is room for what comes meanwhile.
  static constexpr std::uint32_t kMostWaiting = 64;

  bool hosted() const { return host_.started(); }
  void find_wanted();
  bool wanted(const Received& item) const;
  void tell_nodes(const Received& item);
  void tell_host(const Received& item, const GsUsbDevice::Ticket* ticket = nullptr);
  void tell_state();
  void on_progress();
  void say_inside(const CanFrame& frame, const GsUsbDevice::Ticket* ticket);
  static std::uint32_t state_bits() { return can1().ESR & 0xFFFF'0007; }
  static Received as_received(const CanFrame& frame, std::uint32_t counts);

  GsUsbDevice& host_;
  Microseconds<LocalTimer> clock_;
  LonelyBus lonely_;
  std::array<CanAccept, kMostFilters> filters_{};
  std::size_t filter_count_ = 0;
  // What the nodes take, of what all is heard for the host.
  std::array<std::uint32_t, kStandardIds / 32> wanted_{};
  bool open_ = false;
  std::atomic<bool> alone_{false}, loads_{false}, stalled_{false};
  std::atomic<std::uint32_t> progress_{0}, told_state_{0};
  std::array<std::atomic<std::uint8_t>, kHostMailbox> done_{};
  struct ForHost {
    Received item;
    GsUsbDevice::Ticket ticket;
  };
  // 15 ms of a full bus.
  static constexpr std::uint32_t kForHost = 128;
  Ring<ForHost, kForHost> for_host_;
  std::atomic<bool> lost_{false};
  Ring<CanFrame, 8> locals_;    // what the nodes say while it is lonely, for the host
  GsUsbDevice::Ticket loaded_;  // of the frame in the host's mailbox, while loads_
  std::atomic<bool> probing_{false};
  // USB's interrupt's own.
  bool told_alone_ = false;
};
static_assert(CanDriver<BridgedCan>);

}  // namespace kinebus::stm32
