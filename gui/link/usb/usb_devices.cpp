#include "gui/link/usb/usb_devices.hpp"

#include <QLatin1Char>
#include <QString>

#include <libusb.h>

#include <array>
#include <optional>

#include "protocol/joblink/usb_ids.hpp"

namespace kinebus::gui {
namespace {

std::optional<UsbLinkInterface> job_link_of(const libusb_config_descriptor& configuration) {
  for (int i = 0; i < configuration.bNumInterfaces; ++i) {
    const libusb_interface& interface = configuration.interface[i];
    for (int k = 0; k < interface.num_altsetting; ++k) {
      const libusb_interface_descriptor& d = interface.altsetting[k];
      if (d.bInterfaceClass != usb_ids::kLinkClass || d.bInterfaceSubClass != usb_ids::kLinkSubclass ||
          d.bInterfaceProtocol != usb_ids::kLinkProtocol)
        continue;
      UsbLinkInterface link{.number = d.bInterfaceNumber};
      for (int e = 0; e < d.bNumEndpoints; ++e) {
        const libusb_endpoint_descriptor& endpoint = d.endpoint[e];
        if ((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_BULK) continue;
        const bool in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_DIR_MASK) == LIBUSB_ENDPOINT_IN;
        (in ? link.bulk_in : link.bulk_out) = endpoint.bEndpointAddress;
      }
      if (link.bulk_in != 0 && link.bulk_out != 0) return link;
    }
  }
  return std::nullopt;
}

QString string_of(libusb_device_handle* handle, std::uint8_t index) {
  std::array<unsigned char, 256> text{};
  const int length =
      index == 0 ? 0 : libusb_get_string_descriptor_ascii(handle, index, text.data(), text.size());
  return length > 0 ? QString::fromLatin1(reinterpret_cast<const char*>(text.data()), length) : QString();
}

}  // namespace

void for_each_usb_gateway(libusb_context* context,
                          const std::function<bool(libusb_device*, const UsbLinkInterface&)>& found) {
  if (context == nullptr) return;
  libusb_device** devices = nullptr;
  const auto count = libusb_get_device_list(context, &devices);
  bool go_on = true;
  for (ssize_t i = 0; i < count && go_on; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(devices[i], &descriptor) != 0) continue;
    if (descriptor.idVendor != usb_ids::kVendor || descriptor.idProduct != usb_ids::kProduct) continue;
    libusb_config_descriptor* configuration = nullptr;
    if (libusb_get_active_config_descriptor(devices[i], &configuration) != 0) continue;
    if (const auto link = job_link_of(*configuration)) go_on = found(devices[i], *link);
    libusb_free_config_descriptor(configuration);
  }
  if (count >= 0) libusb_free_device_list(devices, 1);
}

UsbGateway describe_usb_gateway(libusb_device* device) {
  UsbGateway gateway;
  std::array<std::uint8_t, 8> ports{};
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  gateway.place = QString::number(libusb_get_bus_number(device)) + QLatin1Char('-');
  for (int i = 0; i < depth; ++i)
    gateway.place +=
        (i > 0 ? QStringLiteral(".") : QString()) + QString::number(ports[static_cast<std::size_t>(i)]);
  gateway.product = QString::fromLatin1(usb_ids::kProductName);
  libusb_device_descriptor descriptor{};
  libusb_device_handle* handle = nullptr;
  if (libusb_get_device_descriptor(device, &descriptor) == 0 && libusb_open(device, &handle) == 0) {
    gateway.serial = string_of(handle, descriptor.iSerialNumber);
    if (const QString product = string_of(handle, descriptor.iProduct); !product.isEmpty())
      gateway.product = product;
    libusb_close(handle);
  }
  return gateway;
}

}  // namespace kinebus::gui
