#include "gateway/io/usb/usb_pipe.hpp"

#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "protocol/joblink/usb_ids.hpp"

namespace kinebus {

UsbPipe::UsbPipe(int out_endpoint, int in_endpoint)
    : out_endpoint_(out_endpoint),
      in_endpoint_(in_endpoint),
      signal_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (signal_ < 0 || ::syscall(SYS_io_setup, reads_.size() + writes_.size(), &context_) != 0)
    throw std::system_error(errno, std::generic_category(), "asynchronous I/O for USB");
  for (Transfer& transfer : reads_) transfer.bytes.resize(usb_ids::kTransferBytes);
  for (Transfer& transfer : writes_) transfer.bytes.resize(usb_ids::kTransferBytes);
  for (Transfer& transfer : reads_) submit(transfer, false, transfer.bytes.size());
}

UsbPipe::~UsbPipe() {
  // Cancels what is under way and waits for it: the buffers go right after.
  ::syscall(SYS_io_destroy, context_);
  ::close(signal_);
}

bool UsbPipe::submit(Transfer& transfer, bool in, std::size_t size) {
  transfer.control = {};
  transfer.control.aio_data = reinterpret_cast<std::uintptr_t>(&transfer);
  transfer.control.aio_lio_opcode = in ? IOCB_CMD_PWRITE : IOCB_CMD_PREAD;
  transfer.control.aio_fildes = static_cast<std::uint32_t>(in ? in_endpoint_ : out_endpoint_);
  transfer.control.aio_buf = reinterpret_cast<std::uintptr_t>(transfer.bytes.data());
  transfer.control.aio_nbytes = size;
  transfer.control.aio_flags = IOCB_FLAG_RESFD;
  transfer.control.aio_resfd = static_cast<std::uint32_t>(signal_);
  transfer.busy = true;
  transfer.size = transfer.taken = 0;
  iocb* one = &transfer.control;
  if (::syscall(SYS_io_submit, context_, 1, &one) != 1) {
    transfer.busy = false;
    close();
    return false;
  }
  if (!in) order_.push_back(&transfer);
  return true;
}

void UsbPipe::close() {
  closed_ = true;
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(signal_, &one, sizeof one);
}

void UsbPipe::collect() {
  std::uint64_t news = 0;
  if (!closed_) {
    [[maybe_unused]] const ssize_t drained = ::read(signal_, &news, sizeof news);
  }
  std::array<io_event, 8> events{};
  timespec at_once{};
  for (;;) {
    const long count = ::syscall(SYS_io_getevents, context_, 0, events.size(), events.data(), &at_once);
    for (long i = 0; i < count; ++i) {
      const io_event& event = events[static_cast<std::size_t>(i)];
      // The kernel hands back what it was given with the transfer. NOLINTNEXTLINE(performance-no-int-to-ptr)
      auto& transfer = *reinterpret_cast<Transfer*>(static_cast<std::uintptr_t>(event.data));
      transfer.busy = false;
      if (event.res < 0)
        close();  // ESHUTDOWN: the host has gone
      else
        transfer.size = static_cast<std::size_t>(event.res);
    }
    if (count < static_cast<long>(events.size())) return;
  }
}

bool UsbPipe::has_bytes() {
  collect();
  // Empty packets are nothing.
  for (std::size_t i = 0; i < reads_.size() && !closed_ && !order_.empty(); ++i) {
    Transfer& transfer = *order_.front();
    if (transfer.busy || transfer.size > 0) break;
    order_.pop_front();
    submit(transfer, false, transfer.bytes.size());
  }
  return !order_.empty() && !order_.front()->busy && order_.front()->size > 0;
}

ByteStream::Moved UsbPipe::read(std::span<std::uint8_t> buffer) {
  collect();
  std::size_t moved = 0;
  while (moved < buffer.size() && !order_.empty() && !order_.front()->busy) {
    Transfer& transfer = *order_.front();
    const std::size_t count = std::min(buffer.size() - moved, transfer.size - transfer.taken);
    std::copy_n(transfer.bytes.data() + transfer.taken, count, buffer.data() + moved);
    transfer.taken += count;
    moved += count;
    if (transfer.taken < transfer.size) break;
    order_.pop_front();
    if (!closed_) submit(transfer, false, transfer.bytes.size());
  }
  return {.count = moved, .closed = closed_ && moved == 0};
}

ByteStream::Moved UsbPipe::write(std::span<const std::uint8_t> bytes) {
  collect();
  std::size_t moved = 0;
  for (Transfer& transfer : writes_) {
    if (closed_) return {.count = 0, .closed = true};
    if (transfer.busy) continue;
    if (moved == bytes.size()) break;
    const std::size_t part = usb_ids::transfer_bytes(bytes.size() - moved);
    std::copy_n(bytes.data() + moved, part, transfer.bytes.data());
    if (!submit(transfer, true, part)) return {.count = 0, .closed = true};
    moved += part;
  }
  return {.count = moved, .closed = false};
}

}  // namespace kinebus
