#pragma once
// OTG_HS as a full-speed device: a serial port, and the console behind it. Polled by the main loop, so that
// it has no interrupt that could come between.

#include <array>
#include <cstdint>
#include <optional>

#include "node_firmware/board/console.hpp"
#include "node_firmware/port/stm32f4/otg_port.hpp"
#include "node_firmware/usb/cdc_device.hpp"

namespace kinebus::stm32 {

/// The serial port's packets: what is for the console, and what it says.
class ConsoleDevice : public CdcDevice {
 public:
  static constexpr std::array<OtgEndpoint, kSlots> kEndpoints{
      {{.address = cdc::kDataOut},
       {.address = cdc::kDataIn},
       {.address = cdc::kNotifyIn, .interrupt = true, .bytes = cdc::kNotificationBytes}}};
  bool takes(std::size_t) const { return takes_data(); }
  void on_packet(std::size_t, Packet packet) { on_data(packet); }
  std::optional<Packet> next_packet(std::size_t slot);
  Console& console() { return console_; }
  const Console& console() const { return console_; }

 private:
  // A stream to a terminal: packets that are never full need no empty one after them.
  std::array<std::uint8_t, usb::kPacketBytes - 1> text_{};
  Console console_;
};

struct OtgHsCore {
  static Otg& registers() { return otg_hs(); }
  static void enable();
  static constexpr std::uint32_t kGccfg = Otg::kTransceiver | Otg::kNoVbusSensing, kGotgctl = 0;
  static constexpr std::uint32_t kMemoryWords = 1024;
};

class UsbPort {
 public:
  void start();
  /// Main loop, each pass.
  void serve(const Console::Subject& subject);
  const Console& console() const { return device_.console(); }

 private:
  ConsoleDevice device_;
  OtgPort<OtgHsCore, ConsoleDevice> otg_{device_};
  std::uint32_t cable_since_ = 0;  ///< local counts
  bool good_ = false;
};

}  // namespace kinebus::stm32
