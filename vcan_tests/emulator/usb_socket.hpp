#pragma once
// A board's USB socket, as a computer at the other end of the cable sees it.

#include "vcan_tests/emulator/peripherals/otg_hs.hpp"

namespace kinebus::emulator {

class UsbSocket {
 public:
  virtual ~UsbSocket() = default;
  virtual OtgHs& usb() = 0;
  /// A cable with a host at its other end comes or goes.
  virtual void set_usb_cable(bool plugged) = 0;
  /// A host finds a full-speed device at the cable: pins, clocks and the core are as they must be for that.
  virtual bool usb_device_seen() = 0;
};

}  // namespace kinebus::emulator
