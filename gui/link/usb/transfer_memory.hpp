#pragma once
// Memory for one USB transfer at a time. The kernel lends its own where it can: what is written there needs
// no copy and no fresh pages on its way to the controller.

#include <libusb.h>

#include <cstddef>
#include <memory>
#include <utility>

namespace kinebus::gui {

class TransferMemory {
 public:
  TransferMemory() = default;
  /// The handle must stay open until this memory is gone.
  TransferMemory(libusb_device_handle* handle, std::size_t size)
      : handle_(handle), lent_(libusb_dev_mem_alloc(handle, size)), size_(size) {
    if (lent_ == nullptr) own_ = std::make_unique<unsigned char[]>(size);
  }
  ~TransferMemory() {
    if (lent_ != nullptr) libusb_dev_mem_free(handle_, lent_, size_);
  }
  TransferMemory(TransferMemory&& other) noexcept { swap(other); }
  TransferMemory& operator=(TransferMemory&& other) noexcept {
    TransferMemory taken(std::move(other));
    swap(taken);
    return *this;
  }

  unsigned char* data() const { return lent_ != nullptr ? lent_ : own_.get(); }
  std::size_t size() const { return size_; }

 private:
  void swap(TransferMemory& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(lent_, other.lent_);
    std::swap(own_, other.own_);
    std::swap(size_, other.size_);
  }

  libusb_device_handle* handle_ = nullptr;
  unsigned char* lent_ = nullptr;
  std::unique_ptr<unsigned char[]> own_;
  std::size_t size_ = 0;
};

/// Transfers to the gateway that are under way at once: enough that the bus never waits for the program, but
/// on a slow bus no more than lets a command (hold!) get through within a quarter of a second.
inline std::size_t transfers_under_way(libusb_device_handle* handle) {
  return libusb_get_device_speed(libusb_get_device(handle)) >= LIBUSB_SPEED_HIGH ? 8 : 2;
}

}  // namespace kinebus::gui
