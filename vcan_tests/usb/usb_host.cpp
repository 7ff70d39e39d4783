#include "vcan_tests/usb/usb_host.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "protocol/joblink/usb_ids.hpp"

namespace kinebus {
namespace {
using namespace std::chrono_literals;
constexpr LocalTime kTryAgain = 50ms;
}  // namespace

LocalTime UsbHost::now() {
  return std::chrono::duration_cast<LocalTime>(std::chrono::steady_clock::now().time_since_epoch());
}

UsbHost::UsbHost(joblink::Client& client) : client_(client) {
  if (libusb_init(&context_) != 0) throw std::runtime_error("libusb does not start");
}

UsbHost::~UsbHost() {
  disconnect("the test ends");
  libusb_exit(context_);
}

void UsbHost::connect() {
  // libusb learns of new devices from udev, which the lab guest has not; a new context looks for itself.
  libusb_exit(std::exchange(context_, nullptr));
  if (libusb_init(&context_) != 0) throw std::runtime_error("libusb does not start");
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context_, &list);
  for (ssize_t i = 0; i < count && handle_ == nullptr; ++i) {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(list[i], &config) != 0) continue;
    for (int n = 0; n < config->bNumInterfaces && handle_ == nullptr; ++n) {
      const libusb_interface_descriptor& link = config->interface[n].altsetting[0];
      if (link.bInterfaceClass != usb_ids::kLinkClass || link.bInterfaceSubClass != usb_ids::kLinkSubclass ||
          link.bInterfaceProtocol != usb_ids::kLinkProtocol)
        continue;
      for (int e = 0; e < link.bNumEndpoints; ++e) {
        const unsigned char address = link.endpoint[e].bEndpointAddress;
        ((address & LIBUSB_ENDPOINT_IN) != 0 ? bulk_in_ : bulk_out_) = address;
      }
      if (libusb_open(list[i], &handle_) != 0) handle_ = nullptr;
      if (handle_ != nullptr && libusb_claim_interface(handle_, link.bInterfaceNumber) != 0) {
        libusb_close(handle_);
        handle_ = nullptr;
      }
    }
    libusb_free_config_descriptor(config);
  }
  if (list != nullptr) libusb_free_device_list(list, 1);
  if (handle_ == nullptr) return;
  broken_ = false;
  ++connections_;
  in_ = make_slots(3, true);
  out_ = make_slots(gui::transfers_under_way(handle_), false);
  for (Slot& slot : in_) broken_ = !submit(slot, static_cast<int>(slot.memory.size())) || broken_;
  client_.on_connected(now());
}

std::vector<UsbHost::Slot> UsbHost::make_slots(std::size_t count, bool in) {
  std::vector<Slot> slots(count);
  for (Slot& slot : slots) {
    slot.memory = gui::TransferMemory(handle_, usb_ids::kTransferBytes);
    slot.transfer = libusb_alloc_transfer(0);
    slot.host = this;
    slot.in = in;
  }
  return slots;
}

void UsbHost::disconnect(const char* why) {
  if (handle_ == nullptr) return;
  for (auto* slots : {&in_, &out_})
    for (Slot& slot : *slots)
      if (slot.busy) libusb_cancel_transfer(slot.transfer);
  const auto any_busy = [](const auto& slots) {
    return std::any_of(slots.begin(), slots.end(), [](const Slot& slot) { return slot.busy; });
  };
  broken_ = true;
  while (any_busy(in_) || any_busy(out_)) {
    timeval wait{0, 10'000};
    libusb_handle_events_timeout_completed(context_, &wait, nullptr);
  }
  for (auto* slots : {&in_, &out_}) {
    for (Slot& slot : *slots) libusb_free_transfer(slot.transfer);
    slots->clear();
  }
  libusb_close(handle_);
  handle_ = nullptr;
  client_.on_disconnected(now(), why);
}

bool UsbHost::submit(Slot& slot, int size) {
  libusb_fill_bulk_transfer(slot.transfer, handle_, slot.in ? bulk_in_ : bulk_out_, slot.memory.data(), size,
                            &UsbHost::completed, &slot, 0);
  slot.busy = libusb_submit_transfer(slot.transfer) == 0;
  return slot.busy;
}

void LIBUSB_CALL UsbHost::completed(libusb_transfer* transfer) {
  auto& slot = *static_cast<Slot*>(transfer->user_data);
  UsbHost& host = *slot.host;
  slot.busy = false;
  if (transfer->status != LIBUSB_TRANSFER_COMPLETED) host.broken_ = true;
  if (host.broken_ || !slot.in) return;
  host.client_.on_bytes(now(), {slot.memory.data(), static_cast<std::size_t>(transfer->actual_length)});
  if (!host.submit(slot, static_cast<int>(slot.memory.size()))) host.broken_ = true;
}

void UsbHost::send() {
  for (Slot& slot : out_) {
    if (slot.busy || broken_) continue;
    const auto bytes = client_.next_bytes();
    if (bytes.empty()) return;
    const std::size_t part = usb_ids::transfer_bytes(bytes.size());
    std::copy_n(bytes.data(), part, slot.memory.data());
    if (!submit(slot, static_cast<int>(part))) {
      broken_ = true;
      return;
    }
    client_.on_bytes_sent(part);
  }
}

void UsbHost::turn(std::chrono::milliseconds longest) {
  if (handle_ == nullptr && now() >= next_try_) {
    connect();
    next_try_ = now() + kTryAgain;
  }
  client_.on_time(now());
  if (handle_ != nullptr) send();
  auto wait =
      std::min<LocalTime>(longest, std::max<LocalTime>(client_.next_deadline() - now(), LocalTime{0}));
  if (handle_ == nullptr) wait = std::min<LocalTime>(wait, kTryAgain);
  timeval left{wait.count() / 1'000'000'000, wait.count() % 1'000'000'000 / 1000};
  libusb_handle_events_timeout_completed(context_, &left, nullptr);
  if (handle_ != nullptr && broken_) disconnect("the cable was pulled");
  if (handle_ != nullptr) send();
}

}  // namespace kinebus
