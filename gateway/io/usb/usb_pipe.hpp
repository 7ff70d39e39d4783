#pragma once
// The two bulk endpoints of the job link while a host has them enabled: transfers by the kernel's
// asynchronous I/O, so that one thread serves them beside the bus. Lives from ENABLE to DISABLE.

#include <linux/aio_abi.h>

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "gateway/io/byte_stream.hpp"

namespace kinebus {

class UsbPipe {
 public:
  /// Reads are under way from now on. The endpoints' fds stay the caller's.
  UsbPipe(int out_endpoint, int in_endpoint);
  ~UsbPipe();
  UsbPipe(const UsbPipe&) = delete;
  UsbPipe& operator=(const UsbPipe&) = delete;

  int fd() const { return signal_; }  ///< readable when transfers came back
  bool closed() const { return closed_; }
  bool has_bytes();
  ByteStream::Moved read(std::span<std::uint8_t> buffer);
  ByteStream::Moved write(std::span<const std::uint8_t> bytes);
  /// The host has gone; whoever reads sees the end.
  void close();

 private:
  struct Transfer {
    iocb control{};
    std::vector<std::uint8_t> bytes;
    std::size_t size = 0, taken = 0;
    bool busy = false;
  };
  void collect();
  bool submit(Transfer& transfer, bool in, std::size_t size);

  int out_endpoint_, in_endpoint_;
  int signal_ = -1;
  aio_context_t context_ = 0;
  bool closed_ = false;
  // The host has up to eight transfers under way: as many are taken in one turn of the loop.
  std::array<Transfer, 8> reads_;
  std::array<Transfer, 4> writes_;
  std::deque<Transfer*> order_;  ///< reads, oldest first: bytes are taken in this order
};

/// A stream on a pipe; several, one after the other, may use the same.
class UsbStream : public ByteStream {
 public:
  UsbStream(std::shared_ptr<UsbPipe> pipe, std::shared_ptr<bool> in_use)
      : pipe_(std::move(pipe)), in_use_(std::move(in_use)) {
    *in_use_ = true;
  }
  ~UsbStream() override { *in_use_ = false; }
  UsbStream(const UsbStream&) = delete;
  UsbStream& operator=(const UsbStream&) = delete;

  int fd() const override { return pipe_->fd(); }
  std::uint32_t interest(bool) const override { return EPOLLIN; }
  Moved read(std::span<std::uint8_t> buffer) override { return pipe_->read(buffer); }
  Moved write(std::span<const std::uint8_t> bytes) override { return pipe_->write(bytes); }
  std::string closed_reason() const override { return "the USB cable was pulled"; }

 private:
  std::shared_ptr<UsbPipe> pipe_;
  std::shared_ptr<bool> in_use_;
};

}  // namespace kinebus
