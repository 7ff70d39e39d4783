#pragma once
// A serial port on USB (CDC ACM), without registers: packets in, packets out; a port moves them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/usb/cdc_descriptors.hpp"
#include "node_firmware/usb/usb_control.hpp"

namespace kinebus {

class CdcDevice {
 public:
  using Packet = UsbControl::Packet;
  /// The endpoints besides the control endpoint.
  enum Slot : std::uint8_t { kDataOut, kDataIn, kNotifyIn, kSlots };

  UsbControl& control() { return control_; }
  const UsbControl& control() const { return control_; }

  // From the bus.
  /// Bus reset, or the cable was pulled.
  void on_reset();
  void on_setup(std::span<const std::uint8_t, 8> bytes);
  /// A packet of the control endpoint's data stage (or the empty one of its status).
  void on_control_data(Packet packet);
  /// A packet of the data endpoint. Only when takes_data().
  void on_data(Packet packet);

  // To the bus.
  /// Once after each configuration: what goes out on the notification endpoint.
  std::optional<Packet> next_notification();
  bool takes_data() const { return control_.open() && taken_ == received_; }

  // The serial port.
  std::optional<char> next_char();
  /// True once after the program at the other end has closed the port, or the bus has gone: what was to be
  /// sent is for nobody.
  bool take_hang_up();
  std::span<const std::uint8_t, 7> line_coding() const { return line_coding_; }

 private:
  void begin_anew();

  UsbControl control_{cdc::kFacts};
  std::array<std::uint8_t, usb::kPacketBytes> data_{};
  std::array<std::uint8_t, 7> line_coding_{};
  std::uint8_t received_ = 0, taken_ = 0;
  bool notify_ = false, terminal_ = false, hung_up_ = false;
};

}  // namespace kinebus
