#include "gui/link/usb/usb_watch.hpp"

#include <libusb.h>

#include <QMetaObject>
#include <QTimer>
#include <array>

#include "gui/link/usb/usb_devices.hpp"

namespace kinebus::gui {

UsbContext::UsbContext() {
  if (libusb_init(&context_) != 0) {
    context_ = nullptr;  // no USB on this computer: no gateways are found there
    return;
  }
  thread_ = std::thread([this] {
    while (!ends_ || open_pipes > 0) {
      timeval patience{0, 200'000};
      libusb_handle_events_timeout_completed(context_, &patience, nullptr);
    }
  });
}

UsbContext::~UsbContext() {
  if (context_ == nullptr) return;
  ends_ = true;
  libusb_interrupt_event_handler(context_);
  thread_.join();
  libusb_exit(context_);
}

namespace {

/// Called in libusb's thread.
int on_hotplug(libusb_context*, libusb_device*, libusb_hotplug_event, void* user) {
  auto* watch = static_cast<UsbWatch*>(user);
  // udev sets the permissions a moment after the device has appeared.
  QMetaObject::invokeMethod(
      watch,
      [watch] {
        QTimer::singleShot(250, watch, [watch] { QMetaObject::invokeMethod(watch, "look_again"); });
      },
      Qt::QueuedConnection);
  return 0;
}

}  // namespace

UsbWatch::UsbWatch(QObject* parent) : QObject(parent), context_(std::make_shared<UsbContext>()) {
  if (context_->get() == nullptr) return;
  libusb_hotplug_register_callback(context_->get(),
                                   LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT, 0,
                                   LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
                                   LIBUSB_HOTPLUG_MATCH_ANY, on_hotplug, this, &callback_);
  look_again();
}

UsbWatch::~UsbWatch() {
  if (context_->get() != nullptr) libusb_hotplug_deregister_callback(context_->get(), callback_);
}

void UsbWatch::look_again() {
  QVector<UsbGateway> found;
  for_each_usb_gateway(context_->get(), [&](libusb_device* device, const UsbLinkInterface&) {
    found.push_back(describe_usb_gateway(device));
    return true;
  });
  if (found == gateways_) return;
  gateways_ = std::move(found);
  emit changed();
}

}  // namespace kinebus::gui
