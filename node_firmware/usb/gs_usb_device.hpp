#pragma once
// A CAN interface on USB as Linux's gs_usb wants it, without registers: control requests and packets on one
// side, CAN frames on the other. The sides may be an interrupt and another one, or the main loop: between
// them are rings. What was queued before the host reset or started the channel is gone for both.

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/board/ring.hpp"
#include "node_firmware/usb/gs_usb_protocol.hpp"
#include "node_firmware/usb/usb_control.hpp"
#include "protocol/can/frame.hpp"

namespace kinebus {

/// What the device can do, in the chip's units.
struct GsUsbFacts {
  std::uint32_t clock_hz = 0;  ///< of time quanta before the prescaler
  std::uint32_t bit_rate = 0;  ///< the only one that it takes
  std::uint32_t segment1_max = 16, segment2_max = 8, jump_max = 4, prescaler_max = 1024;
};

/// As GET_STATE has it.
struct CanState {
  enum Kind : std::uint8_t { kActive, kWarning, kPassive, kBusOff };
  Kind kind = kActive;
  std::uint8_t receive_errors = 0, transmit_errors = 0;
  friend constexpr bool operator==(const CanState&, const CanState&) = default;
};

class GsUsbDevice {
 public:
  using Packet = UsbControl::Packet;
  enum Slot : std::uint8_t { kDataOut, kDataIn, kSlots };
  /// Which of the host's frames: for the echo when it was sent.
  struct Ticket {
    std::uint32_t echo = gs_usb::kNoEcho;
    std::uint8_t session = 0;
  };
  struct HostFrame {
    CanFrame frame;
    Ticket ticket;
  };

  explicit constexpr GsUsbDevice(const GsUsbFacts& facts) : facts_(facts) {}

  // USB's side.
  UsbControl& control() { return control_; }
  const UsbControl& control() const { return control_; }
  void on_reset();
  /// The host is no longer heard.
  void on_suspend() { stop(); }
  /// now_us: free-running, for whoever asks the time.
  void on_setup(std::span<const std::uint8_t, 8> bytes, std::uint32_t now_us);
  void on_control_data(Packet packet);
  /// Only when takes_data().
  void on_data(Packet packet);
  bool takes_data() const {
    return control_.open() && from_host_.size() + usb::kPacketBytes / gs_usb::kHostFrameBytes <= kWaiting;
  }
  /// There are frames for CAN's side.
  bool frames_wait() const { return from_host_.front() != nullptr; }
  /// The next packet of the IN endpoint, valid until the next call.
  std::optional<Packet> next_data();

  // CAN's side.
  /// The host has switched the channel on.
  bool started() const { return (session_.load(std::memory_order_relaxed) & 1) != 0; }
  /// The host's next frame, until drop_frame(). One taker only.
  const HostFrame* next_frame();
  void drop_frame() { from_host_.drop(); }
  /// USB's side has nothing to send and will not look by itself.
  bool sleeps() const { return sleeps_.load(std::memory_order_relaxed); }
  // What follows is one giver's only. Frames that find no room are lost and told (overflow); echoes have room
  // always.
  void on_sent(const Ticket& ticket, const CanFrame& frame, std::uint32_t at_us);
  void on_received(const CanFrame& frame, std::uint32_t at_us);
  /// The controller's state is another one: the host is told.
  void on_state(const CanState& state, std::uint32_t at_us);
  /// Frames were lost before they came here.
  void on_lost() { lost_some_ = true; }
  /// Nobody acknowledges what is sent (any more).
  void on_alone(std::uint32_t at_us);

  /// Frames that did not fit, and packets that were none.
  std::uint32_t lost() const { return lost_; }
  std::uint32_t malformed() const { return malformed_; }

 private:
  struct ToHost {
    CanFrame frame;
    std::uint32_t echo = gs_usb::kNoEcho, error = 0, at_us = 0;
    std::uint8_t session = 0;
    bool overflow = false;
  };
  static constexpr std::uint32_t kWaiting = 16, kQueue = 32;
  void start(std::uint32_t flags);
  void stop();
  bool good_timing(Packet words) const;
  void push(const ToHost& item, std::uint32_t reserve);
  void push_error(std::uint32_t classes, std::uint8_t state, std::uint32_t at_us);

  const GsUsbFacts& facts_;
  UsbControl control_{gs_usb::kFacts};
  std::array<std::uint8_t, 40> reply_{};
  std::array<std::uint8_t, gs_usb::kDeviceFrameBytes> packet_{};
  usb::Request taking_;
  // Odd while the channel is started; another one after each start and stop.
  std::atomic<std::uint8_t> session_{0};
  std::atomic<std::uint32_t> state_{0};
  std::atomic<bool> sleeps_{true};
  bool stamps_ = false;
  Ring<HostFrame, kWaiting> from_host_;
  Ring<ToHost, kQueue> to_host_;
  bool lost_some_ = false;
  std::uint32_t lost_ = 0, malformed_ = 0;
};

}  // namespace kinebus
