#pragma once
// A cable from an emulated board's USB connector to this computer: Linux's vhci_hcd takes it for a device of
// its own (USB/IP over a socket pair), so that the real cdc_acm enumerates the image and makes a /dev/ttyACM
// of it.

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "vcan_tests/emulator/usb_socket.hpp"

namespace kinebus::emulator {

class UsbCable {
 public:
  explicit UsbCable(UsbSocket& board) : board_(board) {}
  ~UsbCable() { pull(); }
  UsbCable(const UsbCable&) = delete;
  UsbCable& operator=(const UsbCable&) = delete;

  /// Call after each piece of the board's time, 100 us or so: a transaction for whoever waits. Attaches when
  /// the board's device is there, detaches when it goes.
  void serve();
  /// What does not work here, such as no vhci_hcd; empty: nothing.
  const std::string& error() const { return error_; }
  int fd() const { return fd_; }

 private:
  struct Urb {
    std::uint32_t sequence = 0;
    int endpoint = 0;
    bool in = false;
    std::uint32_t length = 0;
    std::array<std::uint8_t, 8> setup{};
    std::vector<std::uint8_t> data;  // to send, or received so far
    enum class Stage : std::uint8_t { kSetup, kData, kStatus } stage = Stage::kData;
    std::size_t sent = 0;
    int toggle = 1;  // of the control endpoint
  };
  void plug();
  void pull();
  void give_address();
  bool read_requests();
  void take(const std::vector<std::uint8_t>& header);
  /// True: done, with this status.
  bool advance(Urb& urb, int& status);
  bool advance_in(Urb& urb, int& status);
  bool advance_out(Urb& urb, int& status);
  void finish(const Urb& urb, int status);
  void note_toggles(const Urb& urb);
  void send(const std::vector<std::uint8_t>& bytes);

  UsbSocket& board_;
  std::string error_;
  int fd_ = -1;
  bool addressed_ = false;
  int address_step_ = 0;
  std::vector<std::uint8_t> input_;
  std::deque<Urb> urbs_;
  int out_toggle_ = 0;
};

}  // namespace kinebus::emulator
