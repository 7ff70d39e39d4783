#pragma once
// A small host of the job link: libusb's transfers joined with joblink::Client, in one thread.

#include <libusb.h>

#include <functional>
#include <string>
#include <vector>

#include "gui/link/usb/transfer_memory.hpp"
#include "protocol/joblink/client.hpp"

namespace kinebus {

class UsbHost {
 public:
  explicit UsbHost(joblink::Client& client);
  ~UsbHost();
  UsbHost(const UsbHost&) = delete;
  UsbHost& operator=(const UsbHost&) = delete;

  /// Waits at most `longest` for news, moves bytes, and connects again whenever the device is there.
  void turn(std::chrono::milliseconds longest);
  bool plugged() const { return handle_ != nullptr; }
  std::uint32_t connections() const { return connections_; }
  static LocalTime now();

 private:
  struct Slot {
    gui::TransferMemory memory;
    libusb_transfer* transfer = nullptr;
    UsbHost* host = nullptr;
    bool busy = false, in = false;
  };
  void connect();
  void disconnect(const char* why);
  std::vector<Slot> make_slots(std::size_t count, bool in);
  bool submit(Slot& slot, int size);
  void send();
  static void LIBUSB_CALL completed(libusb_transfer* transfer);

  joblink::Client& client_;
  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  unsigned char bulk_in_ = 0, bulk_out_ = 0;
  std::vector<Slot> in_, out_;
  bool broken_ = false;
  LocalTime next_try_{0};
  std::uint32_t connections_ = 0;
};

}  // namespace kinebus
