#pragma once
// OTG_FS of the Octopus: a CAN interface for a Linux board (gs_usb). By interrupt, less urgent than all
// others: frames go on while the main loop is busy. The socket's VBUS leads to no pin: the board is always
// there for a host, and a cable that is pulled shows as a bus that sleeps.

#include <array>
#include <cstdint>
#include <optional>

#include "node_firmware/port/stm32f4/bridged_can.hpp"
#include "node_firmware/port/stm32f4/otg_port.hpp"
#include "node_firmware/usb/gs_usb_device.hpp"

namespace kinebus::stm32 {

struct OtgFsCore {
  static Otg& registers() { return otg_fs(); }
  static void enable() { enable_clock(rcc().AHB2ENR, Rcc::kUsbFs); }
  static constexpr std::uint32_t kGccfg = Otg::kTransceiver, kGotgctl = Otg::kVbusOverride;
  static constexpr std::uint32_t kMemoryWords = 320;
};

/// The packets of the CAN interface.
class BridgeDevice {
 public:
  static constexpr std::array<OtgEndpoint, GsUsbDevice::kSlots> kEndpoints{
      {{.address = gs_usb::kDataOut}, {.address = gs_usb::kDataIn}}};
  constexpr BridgeDevice(GsUsbDevice& device, BridgedCan& can) : device_(device), can_(can) {}
  UsbControl& control() { return device_.control(); }
  void on_reset() { device_.on_reset(); }
  void on_suspend() { device_.on_suspend(); }
  void on_setup(std::span<const std::uint8_t, 8> bytes) { device_.on_setup(bytes, can_.now_us()); }
  void on_control_data(UsbControl::Packet packet) { device_.on_control_data(packet); }
  bool takes(std::size_t) const { return device_.takes_data(); }
  void on_packet(std::size_t, UsbControl::Packet packet) { device_.on_data(packet); }
  void frames_to_bus() { can_.look_for_frames(); }
  std::optional<UsbControl::Packet> next_packet(std::size_t) { return can_.next_for_host(); }

 private:
  GsUsbDevice& device_;
  BridgedCan& can_;
};

class BridgePort {
 public:
  constexpr BridgePort(GsUsbDevice& device, BridgedCan& can) : device_(device, can) {}
  void start();
  /// Main loop, each pass.
  void serve();
  /// Interrupt.
  void on_event();

 private:
  BridgeDevice device_;
  OtgPort<OtgFsCore, BridgeDevice> otg_{device_};
  std::uint32_t since_ = 0;  ///< local counts
  bool good_ = false;
};

}  // namespace kinebus::stm32
