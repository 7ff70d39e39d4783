#pragma once
// OTG_HS as a full-speed device: the packets of CdcDevice, and the console behind them. Polled by the main
// loop, at most one received packet and one to send an endpoint a pass: it has no interrupt that could come
// between, the core holds the host off (NAK) until it is looked after, and every wait is bounded.

#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/board/console.hpp"
#include "node_firmware/usb/cdc_device.hpp"

namespace kinebus::stm32 {

class UsbPort {
 public:
  void start();
  /// Main loop, each pass.
  void serve(const Console::Subject& subject);
  const Console& console() const { return console_; }

 private:
  void attach();
  void detach();
  void on_bus_reset();
  void receive();
  void on_setup();
  void stall_if_told();
  void set_up(CdcDevice::Slot slot);
  void stop_sending(unsigned endpoint);
  void flush(std::uint32_t which);
  bool can_send(unsigned endpoint) const;
  void send(unsigned endpoint, CdcDevice::Packet packet);
  void send_what_waits();
  void take_control();
  void take_data();

  CdcDevice device_;
  Console console_;
  std::array<std::uint32_t, 2> setup_{};
  std::uint32_t cable_since_ = 0;  ///< local counts
  bool good_ = false, attached_ = false, taking_data_ = false;
};

}  // namespace kinebus::stm32
