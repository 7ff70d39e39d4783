#pragma once
// A serial port on USB (CDC ACM), without registers: packets in, packets out; a port moves them. Whatever a
// host sends, what is not known is stalled, and nothing grows.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "node_firmware/usb/cdc_descriptors.hpp"

namespace kinebus {

class CdcDevice {
 public:
  using Packet = std::span<const std::uint8_t>;
  /// The endpoints besides the control endpoint.
  enum Slot : std::uint8_t { kDataOut, kDataIn, kNotifyIn, kSlots };

  /// The chip's 96 bits: the serial number as 24 hexadecimal digits.
  void identify(const std::array<std::uint32_t, 3>& unique_id) { unique_id_ = unique_id; }

  // From the bus.
  /// Bus reset, or the cable was pulled.
  void on_reset();
  void on_setup(std::span<const std::uint8_t, 8> bytes);
  /// A packet of the control endpoint's data stage (or the empty one of its status).
  void on_control_data(Packet packet);
  /// A packet of the data endpoint. Only when takes_data().
  void on_data(Packet packet);

  // To the bus.
  /// What the control endpoint sends next, once the packet before is gone; at most kPacketBytes.
  std::optional<Packet> next_control_packet();
  /// The control endpoint answers with STALL until the next setup packet.
  bool stalled() const { return stage_ == Stage::kStalled; }
  /// Once after each configuration: what goes out on the notification endpoint.
  std::optional<Packet> next_notification();
  bool takes_data() const { return open_ && taken_ == received_; }
  /// In force from the answer on (the OTG core wants it before).
  std::uint8_t address() const { return address_; }
  bool open() const { return open_; }
  bool halted(Slot slot) const { return (halted_ >> slot & 1) != 0; }
  /// Bit per slot: to be set up anew as open() and halted() say, with its data toggle at DATA0.
  std::uint8_t take_changes();

  // The serial port.
  std::optional<char> next_char();
  /// True once after the program at the other end has closed the port, or the bus has gone: what was to be
  /// sent is for nobody.
  bool take_hang_up();
  std::span<const std::uint8_t, 7> line_coding() const { return line_coding_; }

 private:
  enum class Stage : std::uint8_t { kIdle, kReply, kLineCoding, kStalled };
  struct Request {
    std::uint16_t what, value, index, length;
  };
  bool answer(const Request& request);
  bool describe(std::uint16_t which);
  void say(std::string_view text);
  void serial_number();
  void short_reply(unsigned value, std::size_t bytes);
  void configure(bool open);
  /// False: there is no such endpoint, or the device is not configured.
  bool halt(const Request& request, bool on);

  std::array<std::uint32_t, 3> unique_id_{};
  std::array<std::uint8_t, cdc::kPacketBytes> buffer_{}, data_{};
  Packet reply_;
  std::array<std::uint8_t, 7> line_coding_{};
  std::uint8_t received_ = 0, taken_ = 0;
  std::uint8_t address_ = 0, halted_ = 0, changed_ = 0;
  Stage stage_ = Stage::kIdle;
  bool open_ = false, notify_ = false, terminal_ = false, hung_up_ = false;
};

}  // namespace kinebus
