#include "gui/link/usb/usb_link.hpp"

#include <QByteArray>
#include <QMetaObject>
#include <QObject>
#include <QString>

#include <libusb.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

#include "gui/link/usb/transfer_memory.hpp"
#include "gui/link/usb/usb_devices.hpp"
#include "protocol/joblink/usb_ids.hpp"

namespace kinebus::gui {
namespace {
constexpr const char* kUsbWords = "kinebus::gui::UsbLink";
Phrase usb_words(const char* source) {
  return {kUsbWords, source};
}
}  // namespace

/// Several transfers are always on their way, so that the bus never waits for the program. A transfer
/// that is submitted holds a reference to the pipe: it is freed when the last one has come back.
class UsbLink::Pipe : public std::enable_shared_from_this<Pipe> {
 public:
  Pipe(UsbContext& context, libusb_device_handle* handle, UsbLinkInterface link, UsbLink* owner)
      : context_(context),
        handle_(handle),
        link_(link),
        owner_(owner),
        in_(kReads),
        out_(transfers_under_way(handle)) {
    for (auto* all : {&in_, &out_})
      for (Slot& slot : *all) slot.memory = TransferMemory(handle, kBytes);
    ++context_.open_pipes;
  }
  ~Pipe() {
    in_.clear();
    out_.clear();
    libusb_release_interface(handle_, link_.number);
    libusb_close(handle_);
    --context_.open_pipes;
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  bool start() {
    bool started = true;
    for (Slot& slot : in_) started = submit(slot, link_.bulk_in, kBytes) && started;
    return started;
  }

  qint64 write(const char* data, qint64 size) {
    qint64 taken = 0;
    while (taken < size) {
      Slot* free = nullptr;
      {
        const std::lock_guard lock(mutex_);
        for (Slot& slot : out_)
          if (!slot.busy) free = &slot;
        if (free == nullptr) {
          full_ = true;
          break;
        }
        free->busy = true;
      }
      const auto part = static_cast<int>(usb_ids::transfer_bytes(static_cast<std::size_t>(size - taken)));
      std::memcpy(free->memory.data(), data + taken, static_cast<std::size_t>(part));
      if (!submit(*free, link_.bulk_out, part)) break;
      taken += part;
    }
    return taken;
  }

  /// No news any more; transfers come back and are freed.
  void abandon() {
    const std::lock_guard lock(mutex_);
    owner_ = nullptr;
    for (auto* all : {&in_, &out_})
      for (Slot& slot : *all)
        if (slot.transfer != nullptr && slot.busy) libusb_cancel_transfer(slot.transfer);
  }

 private:
  static constexpr int kBytes = static_cast<int>(usb_ids::kTransferBytes);
  static constexpr std::size_t kReads = 2;
  struct Slot {
    TransferMemory memory;
    libusb_transfer* transfer = nullptr;
    std::shared_ptr<Pipe> pipe;  ///< while submitted
    bool busy = false;
  };

  bool submit(Slot& slot, std::uint8_t endpoint, int size) {
    if (slot.transfer == nullptr) slot.transfer = libusb_alloc_transfer(0);
    libusb_fill_bulk_transfer(slot.transfer, handle_, endpoint, slot.memory.data(), size, &Pipe::completed,
                              &slot, 0);
    slot.pipe = shared_from_this();
    slot.busy = true;
    if (libusb_submit_transfer(slot.transfer) == 0) return true;
    slot.busy = false;
    const auto keep = std::move(slot.pipe);
    libusb_free_transfer(std::exchange(slot.transfer, nullptr));
    return false;
  }

  /// In libusb's thread.
  static void LIBUSB_CALL completed(libusb_transfer* transfer) {
    auto& slot = *static_cast<Slot*>(transfer->user_data);
    const std::shared_ptr<Pipe> pipe = slot.pipe;
    pipe->complete(slot);
  }

  void complete(Slot& slot) {
    const libusb_transfer& transfer = *slot.transfer;
    const bool in = transfer.endpoint == link_.bulk_in;
    const bool well =
        transfer.status == LIBUSB_TRANSFER_COMPLETED && (in || transfer.actual_length == transfer.length);
    QByteArray bytes;
    if (in && well)
      bytes = QByteArray(reinterpret_cast<const char*>(slot.memory.data()), transfer.actual_length);
    bool drained = false;
    {
      const std::lock_guard lock(mutex_);
      slot.busy = false;
      drained = !in && std::exchange(full_, false);
      if (owner_ != nullptr) {
        UsbLink* owner = owner_;
        // The owner abandons the pipe before it goes, under the same lock: it is alive here.
        if (!well) {
          QMetaObject::invokeMethod(
              owner,
              [owner] {
                owner->fail(
                    usb_words(QT_TRANSLATE_NOOP("kinebus::gui::UsbLink", "the USB cable was pulled")));
              },
              Qt::QueuedConnection);
        } else if (in) {
          QMetaObject::invokeMethod(
              owner, [owner, bytes] { emit owner->received(bytes); }, Qt::QueuedConnection);
        }
        if (well && drained)
          QMetaObject::invokeMethod(
              owner, [owner] { emit owner->drained(); }, Qt::QueuedConnection);
      }
      if (owner_ == nullptr || !well) {
        libusb_free_transfer(std::exchange(slot.transfer, nullptr));
        slot.pipe.reset();
        return;
      }
    }
    if (in)
      submit(slot, link_.bulk_in, kBytes);
    else
      slot.pipe.reset();
  }

  UsbContext& context_;  ///< waits for open pipes before it ends
  libusb_device_handle* handle_;
  UsbLinkInterface link_;
  std::mutex mutex_;
  UsbLink* owner_;
  std::vector<Slot> in_, out_;  ///< never moved
  bool full_ = false;
};

UsbLink::UsbLink(std::shared_ptr<UsbContext> context, UsbGateway gateway, QObject* parent)
    : Link(parent), context_(std::move(context)), gateway_(std::move(gateway)) {}

UsbLink::~UsbLink() {
  if (pipe_ != nullptr) pipe_->abandon();
}

void UsbLink::fail(const Phrase& why) {
  if (pipe_ == nullptr) return;
  pipe_->abandon();
  pipe_.reset();
  emit closed(why);
}

void UsbLink::open() {
  Phrase why = usb_words(QT_TRANSLATE_NOOP("kinebus::gui::UsbLink", "the gateway is not plugged in"));
  for_each_usb_gateway(context_->get(), [&](libusb_device* device, const UsbLinkInterface& link) {
    const UsbGateway here = describe_usb_gateway(device);
    if (!gateway_.serial.isEmpty() ? here.serial != gateway_.serial : here.place != gateway_.place)
      return true;
    libusb_device_handle* handle = nullptr;
    if (const int error = libusb_open(device, &handle); error != 0) {
      why = error == LIBUSB_ERROR_ACCESS
                ? usb_words(QT_TRANSLATE_NOOP(
                      "kinebus::gui::UsbLink",
                      "this user may not use the USB device: install the udev rule of the package"))
                : Phrase(QString::fromUtf8(libusb_strerror(static_cast<libusb_error>(error))));
      return false;
    }
    if (const int error = libusb_claim_interface(handle, link.number); error != 0) {
      why = error == LIBUSB_ERROR_BUSY
                ? usb_words(QT_TRANSLATE_NOOP("kinebus::gui::UsbLink",
                                              "another program uses the gateway's USB link"))
                : Phrase(QString::fromUtf8(libusb_strerror(static_cast<libusb_error>(error))));
      libusb_close(handle);
      return false;
    }
    pipe_ = std::make_shared<Pipe>(*context_, handle, link, this);
    if (!pipe_->start()) {
      pipe_->abandon();
      pipe_.reset();
      why = usb_words(QT_TRANSLATE_NOOP("kinebus::gui::UsbLink", "the USB link does not start"));
    }
    return false;
  });
  // Never from within open(): the caller is not ready for news yet.
  const bool opens = pipe_ != nullptr;
  QMetaObject::invokeMethod(
      this, [this, opens, why] { opens ? emit opened() : emit closed(why); }, Qt::QueuedConnection);
}

qint64 UsbLink::write(const char* data, qint64 size) {
  return pipe_ == nullptr ? 0 : pipe_->write(data, size);
}

Phrase UsbLink::description() const {
  return {kUsbWords, QT_TRANSLATE_NOOP("kinebus::gui::UsbLink", "USB %1"), {gateway_.place}};
}

}  // namespace kinebus::gui
