#pragma once
// Finds the job link among the interfaces of the devices that are plugged in.

#include <cstdint>
#include <functional>

#include "gui/link/usb/usb_watch.hpp"

struct libusb_device;

namespace kinebus::gui {

struct UsbLinkInterface {
  int number = 0;
  std::uint8_t bulk_in = 0, bulk_out = 0;
};

/// Calls back for every device with a job link until the callback answers false.
void for_each_usb_gateway(libusb_context* context,
                          const std::function<bool(libusb_device*, const UsbLinkInterface&)>& found);
UsbGateway describe_usb_gateway(libusb_device* device);

}  // namespace kinebus::gui
