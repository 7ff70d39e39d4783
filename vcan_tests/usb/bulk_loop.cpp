#include "vcan_tests/usb/bulk_loop.hpp"

#include <fcntl.h>
#include <libusb.h>
#include <linux/usb/functionfs.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>
#include <vector>

#include "gateway/io/usb/usb_descriptors.hpp"
#include "protocol/joblink/usb_ids.hpp"

namespace kinebus {

int bulk_sink(const std::string& folder) {
  const int control = ::open((folder + "/ep0").c_str(), O_RDWR);
  for (const auto& bytes : {function_descriptors(), function_strings()})
    if (::write(control, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("FunctionFS refuses the descriptors");
  const int out = ::open((folder + "/ep1").c_str(), O_RDWR);
  std::vector<char> buffer(usb_ids::kTransferBytes);
  // Waits for the host to enable the endpoints by itself; ends with the gadget.
  while (::read(out, buffer.data(), buffer.size()) > 0) continue;
  ::close(out);
  ::close(control);
  return 0;
}

int bulk_loop(std::size_t mib) {
  libusb_context* context = nullptr;
  if (libusb_init(&context) != 0) throw std::runtime_error("libusb does not start");
  libusb_device_handle* handle = nullptr;
  unsigned char bulk_out = 0;
  // The kernel takes a moment to configure a device that was just plugged in; libusb learns of new devices
  // from udev, which the lab guest has not: a new context looks for itself.
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (handle == nullptr && std::chrono::steady_clock::now() < patience) {
    libusb_exit(context);
    if (libusb_init(&context) != 0) throw std::runtime_error("libusb does not start");
    handle = libusb_open_device_with_vid_pid(context, usb_ids::kVendor, usb_ids::kProduct);
    libusb_config_descriptor* config = nullptr;
    if (handle != nullptr && libusb_claim_interface(handle, 0) == 0 &&
        libusb_get_active_config_descriptor(libusb_get_device(handle), &config) == 0) {
      // The controller numbers the endpoints as it likes.
      const libusb_interface_descriptor& link = config->interface[0].altsetting[0];
      for (int e = 0; e < link.bNumEndpoints; ++e)
        if ((link.endpoint[e].bEndpointAddress & LIBUSB_ENDPOINT_IN) == 0)
          bulk_out = link.endpoint[e].bEndpointAddress;
      libusb_free_config_descriptor(config);
      break;
    }
    if (handle != nullptr) libusb_close(handle);
    handle = nullptr;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (handle == nullptr) throw std::runtime_error("no gadget");
  const std::size_t bytes = mib << 20U;
  // Four transfers are always on their way, as many as the job link's host has.
  struct Loop {
    std::size_t left = 0;
    int busy = 0;
    bool failed = false;
  } loop{.left = bytes};
  std::vector<unsigned char> block(usb_ids::kTransferBytes, 'x');
  const auto next = [](libusb_transfer* transfer) {
    auto& state = *static_cast<Loop*>(transfer->user_data);
    --state.busy;
    state.failed = state.failed || transfer->status != LIBUSB_TRANSFER_COMPLETED;
    if (state.failed || state.left == 0) return;
    const std::size_t part = usb_ids::transfer_bytes(state.left);
    transfer->length = static_cast<int>(part);
    state.left -= part;
    if (libusb_submit_transfer(transfer) == 0)
      ++state.busy;
    else
      state.failed = true;
  };
  std::vector<libusb_transfer*> transfers(4);
  const auto begin = std::chrono::steady_clock::now();
  for (libusb_transfer*& transfer : transfers) {
    transfer = libusb_alloc_transfer(0);
    libusb_fill_bulk_transfer(transfer, handle, bulk_out, block.data(), 0, next, &loop, 0);
    ++loop.busy;
    next(transfer);
  }
  for (const auto limit = begin + std::chrono::seconds(60);
       loop.busy > 0 && std::chrono::steady_clock::now() < limit;) {
    timeval wait{1, 0};
    libusb_handle_events_timeout_completed(context, &wait, nullptr);
  }
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (loop.failed || loop.busy > 0) throw std::runtime_error("the bulk loop broke");
  for (libusb_transfer* transfer : transfers) libusb_free_transfer(transfer);
  libusb_close(handle);
  libusb_exit(context);
  std::printf("bulk loop: %.2f MB/s\n", static_cast<double>(bytes) / 1e6 / took);
  return 0;
}

}  // namespace kinebus
