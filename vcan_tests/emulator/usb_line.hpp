#pragma once
// Whose computer is at the other end of an emulated board's USB cable: this one, or one that is reached by a
// stream.

#include <cstdint>
#include <string>
#include <vector>

#include "vcan_tests/usb_port/cable_stream.hpp"
#include "vcan_tests/usb_port/virtual_host.hpp"

namespace kinebus::emulator {

class UsbLine {
 public:
  UsbLine() = default;
  UsbLine(const UsbLine&) = delete;
  UsbLine& operator=(const UsbLine&) = delete;
  virtual ~UsbLine() = default;

  /// Adds what the computer has said in USB/IP. False: it has let go of the device.
  virtual bool receive(std::vector<std::uint8_t>& bytes) = 0;
  virtual void send(const std::vector<std::uint8_t>& bytes) = 0;
  /// The cable is in the board's connector, with power at its other end.
  virtual bool plugged() const = 0;
  /// There is a device: the computer may speak to it once it is attached().
  virtual void attach() = 0;
  virtual void detach() = 0;
  virtual bool attached() const = 0;
  virtual int fd() const = 0;
  virtual bool closed() const = 0;
  /// Why nothing goes; empty: it goes, or has ended well.
  virtual const std::string& error() const = 0;
};

/// This computer, by its vhci_hcd.
class OwnUsb final : public UsbLine {
 public:
  bool receive(std::vector<std::uint8_t>& bytes) override {
    return !host_.attached() || host_.receive(bytes);
  }
  void send(const std::vector<std::uint8_t>& bytes) override { host_.send(bytes); }
  bool plugged() const override { return true; }
  void attach() override { host_.attach(); }
  void detach() override { host_.detach(); }
  bool attached() const override { return host_.attached(); }
  int fd() const override { return host_.fd(); }
  bool closed() const override { return !host_.error().empty(); }
  const std::string& error() const override { return host_.error(); }

 private:
  VirtualHost host_;
};

/// Who has connected to a Unix socket (kinebus-usb-port).
class StreamedUsb final : public UsbLine {
 public:
  /// Waits for the one who connects. Empty: there. Otherwise what is wrong.
  std::string open(const std::string& path);

  bool receive(std::vector<std::uint8_t>& bytes) override;
  void send(const std::vector<std::uint8_t>& bytes) override {
    cable_.send(CableStream::Kind::kData, session_, bytes);
  }
  bool plugged() const override { return plugged_; }
  void attach() override;
  void detach() override;
  bool attached() const override { return attached_; }
  int fd() const override { return fd_; }
  bool closed() const override { return cable_.closed(); }
  const std::string& error() const override { return cable_.trouble(); }

 private:
  CableStream cable_;
  int fd_ = -1;
  bool plugged_ = false, attached_ = false;
  std::uint8_t session_ = 0;
};

}  // namespace kinebus::emulator
