#pragma once
// The control endpoint of a USB device, without registers: the requests that every device has, and the way of
// those that only one kind knows. Whatever a host sends, what is not known is stalled, and nothing grows.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace kinebus {

namespace usb {

/// Largest packet of full speed, but for isochronous ones.
inline constexpr std::size_t kPacketBytes = 64;

enum Descriptor : std::uint8_t {
  kDevice = 1,
  kConfiguration,
  kString,
  kInterface,
  kEndpoint,
  kFunctional = 0x24
};
enum StringIndex : std::uint8_t { kLanguages, kManufacturerString, kProductString, kSerialString };

/// bmRequestType in the upper byte of `what`, bRequest in the lower.
struct Request {
  std::uint16_t what = 0, value = 0, index = 0, length = 0;
  bool to_host() const { return (what & 0x8000) != 0; }
};

/// What a device says of itself.
struct Facts {
  std::span<const std::uint8_t> device, configuration;
  std::string_view manufacturer, product;
  std::uint8_t interfaces = 1;
  std::span<const std::uint8_t> endpoints;  ///< their addresses: an endpoint's place here is its slot
};

}  // namespace usb

class UsbControl {
 public:
  using Packet = std::span<const std::uint8_t>;
  explicit constexpr UsbControl(const usb::Facts& facts) : facts_(facts) {}

  /// The chip's 96 bits: the serial number as 24 hexadecimal digits.
  void identify(const std::array<std::uint32_t, 3>& unique_id) { unique_id_ = unique_id; }

  // From the bus.
  void on_reset();
  /// A request that not every device has: it is stalled unless reply() or take() follows at once.
  std::optional<usb::Request> on_setup(std::span<const std::uint8_t, 8> bytes);
  /// A packet of the data stage (or the empty one of its status). All that take() waited for: the status
  /// follows unless stall() is called.
  std::optional<Packet> on_data(Packet packet);

  // The answer to a request.
  void reply(Packet data);
  /// Of up to four bytes.
  void reply(std::uint32_t value, std::size_t bytes);
  /// Its data are one packet of as many bytes as the request says.
  void take() { stage_ = Stage::kTakes; }
  void stall() { stage_ = Stage::kStalled; }

  // To the bus.
  /// What the control endpoint sends next, once the packet before is gone; at most usb::kPacketBytes.
  std::optional<Packet> next_packet();
  /// It answers with STALL until the next setup packet.
  bool stalled() const { return stage_ == Stage::kStalled; }
  /// In force from the answer on (the OTG core wants it before).
  std::uint8_t address() const { return address_; }
  bool open() const { return open_; }
  bool halted(std::size_t slot) const { return (halted_ >> slot & 1) != 0; }
  /// Bit per slot: to be set up anew as open() and halted() say, with its data toggle at DATA0.
  std::uint8_t take_changes();
  /// True once after each configuration, and after what ended one.
  bool take_configured();

 private:
  enum class Stage : std::uint8_t { kIdle, kReply, kTakes, kStalled };
  bool answer(const usb::Request& request, bool& known);
  bool describe(std::uint16_t which);
  void say(std::string_view text);
  void serial_number();
  void configure(bool open);
  std::optional<std::size_t> slot_of(std::uint16_t endpoint_address) const;
  /// False: there is no such endpoint, or the device is not configured.
  bool halt(const usb::Request& request, bool on);

  const usb::Facts& facts_;
  std::array<std::uint32_t, 3> unique_id_{};
  std::array<std::uint8_t, usb::kPacketBytes> buffer_{};
  Packet reply_;
  std::uint16_t length_ = 0;  // of the request
  std::uint8_t address_ = 0, halted_ = 0, changed_ = 0;
  Stage stage_ = Stage::kIdle;
  bool open_ = false, configured_ = false;
};

}  // namespace kinebus
